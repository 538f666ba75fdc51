#include "cli/identity.h"

#include "base/picture.h"
#include "base/text.h"

#include "cli/parts.h"
#include "cli/words.h"
#include <fathom/files.h>
#include <fathom/reference.h>

#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

namespace fathom::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// The path below the folder, or nothing where it is not in it.
std::optional<std::string> below(const fs::path &folder, const fs::path &path) {
    const fs::path relative = path.lexically_normal().lexically_relative(folder.lexically_normal());
    if (relative.empty() || *relative.begin() == "..") return std::nullopt;
    return relative.generic_string();
}

// So that no two lists of texts give the same bytes.
void append(std::string &bytes, std::string_view text) {
    bytes += fmt::format("{}:", text.size());
    bytes += text;
}

} // namespace

std::string fingerprint(std::string_view bytes) {
    __extension__ using Word = unsigned __int128;
    const auto word = [](std::uint64_t high, std::uint64_t low) { return Word{high} << 64 | low; };
    Word hash = word(0x6c62272e07bb0142, 0x62b821756295c58d);
    const Word prime = word(0x0000000001000000, 0x000000000000013b);
    for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * prime;
    return fmt::format("{:016x}{:016x}", static_cast<std::uint64_t>(hash >> 64),
                       static_cast<std::uint64_t>(hash));
}

std::vector<SceneFile> files_of(const v1::CompileResult &result, const SceneArguments &scene) {
    // The scene's own folder, then those of -I.
    std::vector<fs::path> folders{scene.file == "-" ? fs::path()
                                                    : fs::path(scene.file).parent_path()};
    folders.insert(folders.end(), scene.include_folders.begin(), scene.include_folders.end());
    for (fs::path &folder : folders)
        if (folder.empty()) folder = ".";
    std::vector<SceneFile> files;
    const auto add = [&](const fs::path &file, const std::function<fs::path(fs::path)> &form) {
        for (std::size_t i = 0; i < folders.size(); ++i)
            if (const std::optional<std::string> name = below(form(folders[i]), form(file))) {
                const std::optional<std::size_t> include =
                    i > 0 ? std::optional(i - 1) : std::nullopt;
                files.push_back({include, *name, fs::absolute(file)});
                return true;
            }
        return false;
    };
    for (const fs::path &file : result.files) {
        std::error_code error;
        if (!fs::is_regular_file(file, error)) continue;
        // By its name as it was looked up, so that symbolic links keep theirs; where that leads out of
        // all folders and into one again, by where it is. None else is read (driver/scene_files).
        if (!add(file, [](const fs::path &path) { return fs::absolute(path); }))
            add(file, [](const fs::path &path) { return fs::weakly_canonical(path); });
    }
    std::ranges::sort(files, [](const SceneFile &a, const SceneFile &b) {
        return std::pair(a.include, a.name) < std::pair(b.include, b.name);
    });
    return files;
}

std::string identity_of_film(const v1::CompileResult &result, const RenderCommand &command,
                             std::string_view maker, std::string &error) {
    std::string bytes;
    append(bytes, FATHOM_VERSION);
    for (const v1::LibraryText &file : v1::library_texts()) append(bytes, file.text);
    for (const SceneFile &file : files_of(result, command.scene)) {
        const std::optional<std::string> text =
            v1::read_file(file.path, std::numeric_limits<std::size_t>::max() / 4, error);
        if (!text) {
            error = fmt::format("cannot read `{}`: {}", file.path.string(), error);
            return "";
        }
        append(bytes, file.include ? fmt::format("-I {}", *file.include) : "");
        append(bytes, file.name);
        append(bytes, *text);
    }
    if (command.scene.file == "-")
        for (std::size_t i = 0; i < result.texts.count(); ++i) append(bytes, result.texts.text(i));
    else
        append(bytes, fs::path(command.scene.file).filename().string());
    for (const Definition &override : command.scene.overrides) {
        append(bytes, override.name);
        append(bytes, override.text);
    }
    // Limits decide how much is computed for a bound, and so the bound.
    for (const std::string &word : command.scene.limit_words) append(bytes, word);
    // All frames: what is proved is proved for them all, and a tighter bound may move a pixel.
    append(bytes, command.frames.numbers.empty() && command.turntable == 0 ? "one" : "film");
    for (const int frame : frames_of_film(command)) append(bytes, fmt::format("{}", frame));
    for (const Sweep &sweep : command.sweeps)
        append(bytes, fmt::format("{}={} {} {}", sweep.name, format_shortest(sweep.from),
                                  format_shortest(sweep.to), sweep.to_last));
    append(bytes, fmt::format("{}x{} {} {} {} {} {} {}", command.width, command.height,
                              format_shortest(command.time), format_shortest(command.frame_rate),
                              command.turntable, format_shortest(command.shutter),
                              command.max_steps, maker));
    if (command.alpha) append(bytes, "alpha");
    if (command.section) append(bytes, word_of_section(*command.section));
    return fingerprint(bytes);
}

void set_samples(Note &note, int samples) {
    note.samples = std::max(samples, 1);
    note.rough = samples == 0;
}

std::string text_of(const Note &note) {
    Json json{{"film", note.film}};
    if (note.frame) json["frame"] = *note.frame;
    json["size"] = {note.width, note.height};
    json["region"] = note.region;
    json["samples"] = {note.first_sample, note.first_sample + note.samples};
    if (note.rough) json["rough"] = true;
    return json.dump();
}

std::optional<Note> note_of(std::string_view text) {
    const Json json = Json::parse(text, nullptr, false);
    const auto numbers = [&](const char *name, std::size_t count) -> std::vector<int> {
        if (!json.is_object() || !json.contains(name)) return {};
        const Json &list = json[name];
        if (!list.is_array() || list.size() != count) return {};
        std::vector<int> all;
        for (const Json &number : list) {
            if (!number.is_number_integer() || number < 0 || number > 1'000'000) return {};
            all.push_back(number.get<int>());
        }
        return all;
    };
    const std::vector<int> size = numbers("size", 2), region = numbers("region", 4),
                           samples = numbers("samples", 2);
    if (size.empty() || region.empty() || samples.empty() || samples[1] <= samples[0] ||
        !json.contains("film") || !json["film"].is_string())
        return std::nullopt;
    if (region[2] < 1 || region[3] < 1 || region[0] + region[2] > size[0] ||
        region[1] + region[3] > size[1])
        return std::nullopt;
    Note note{json["film"].get<std::string>(),
              std::nullopt,
              size[0],
              size[1],
              {region[0], region[1], region[2], region[3]},
              samples[0],
              samples[1] - samples[0]};
    if (json.contains("frame")) {
        if (!json["frame"].is_number_integer()) return std::nullopt;
        note.frame = json["frame"].get<int>();
    }
    note.rough = json.contains("rough") && json["rough"] == true;
    return note;
}

std::optional<Note> note_of_file(const std::string &file) {
    std::string error;
    const std::optional<std::string> bytes =
        v1::read_file(file, std::numeric_limits<std::size_t>::max() / 4, error);
    if (!bytes) return std::nullopt;
    if (is_sums(*bytes)) {
        const std::optional<Sums> sums = read_sums(*bytes);
        return sums ? std::optional(sums->note) : std::nullopt;
    }
    const std::optional<std::string> text = note_of_png(*bytes);
    return text ? note_of(*text) : std::nullopt;
}

} // namespace fathom::cli
