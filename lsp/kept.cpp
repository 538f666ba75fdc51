#include "lsp/kept.h"

#include <fathom/fathom.h>

#include <cstdlib>
#include <map>

namespace fathom::lsp {

namespace fs = std::filesystem;

namespace {

// Where a file lies, or would; empty without a home.
fs::path kept_path(const std::string &name) {
    const char *cache = std::getenv("XDG_CACHE_HOME"), *home = std::getenv("HOME");
    fs::path folder;
    if (cache && *cache)
        folder = cache;
    else if (home && *home)
        folder = fs::path(home) / ".cache";
    else
        return {};
    return folder / "fathom" / std::string(v1::version()) / name;
}

// The code of the line "Example: `sphere(1.2)`".
std::string example_in(const std::string &doc) {
    constexpr std::string_view before = "Example: `";
    const std::size_t at = doc.find(before);
    if (at == doc.npos) return "";
    const std::size_t begin = at + before.size(), end = doc.find('`', begin);
    return end == doc.npos ? "" : doc.substr(begin, end - begin);
}

// A PNG file, or nothing.
std::string drawn(const std::string &example, const std::string &module) {
    std::string text = module.empty() ? "" : "import \"" + module + "\" as " + module + "\n";
    text += example + "\nlighting(ambient: 0.25, ambient_occlusion: 1, shadow_darkness: 0.6)\n"
                      "background(#e9edf1)\n";
    v1::CompileOptions options;
    options.files = [](const std::string &) { return std::nullopt; };
    const auto result = v1::compile_text(example, text, options);
    if (!result || result.scene->facts().shapes.empty()) return "";
    v1::PictureOptions size;
    size.width = 160;
    size.height = 120;
    v1::Picture picture = v1::draw(*result.scene, size);
    if (!picture.complete) return "";
    return v1::encode_png(picture);
}

} // namespace

std::optional<fs::path> kept_file(const std::string &name, std::string_view bytes) {
    static std::map<fs::path, bool> written; // by this process, or found to be as they should be
    const fs::path file = kept_path(name);
    if (file.empty()) return std::nullopt;
    const auto [known, is_new] = written.try_emplace(file, true);
    if (is_new) {
        std::string why;
        std::error_code error;
        if (v1::read_file(file, bytes.size(), why) != bytes) {
            fs::create_directories(file.parent_path(), error);
            known->second = v1::write_file(file, bytes).empty();
            fs::permissions(file,
                            fs::perms::owner_read | fs::perms::group_read | fs::perms::others_read,
                            error);
        }
    }
    return known->second ? std::optional(file) : std::nullopt;
}

std::optional<fs::path> picture_of_entry(const std::string &name, const std::string &module,
                                         const std::string &doc) {
    static std::map<std::string, std::string> made; // what was drawn in vain is not drawn again
    const std::string file = "pictures/" + (module.empty() ? "" : module + "_") + name + ".png";
    std::error_code error;
    if (const fs::path there = kept_path(file); !there.empty() && fs::exists(there, error))
        return there;
    const std::string example = example_in(doc);
    const auto [known, is_new] = made.try_emplace(file);
    if (is_new && !example.empty()) known->second = drawn(example, module);
    return known->second.empty() ? std::nullopt : kept_file(file, known->second);
}

} // namespace fathom::lsp
