#include "cli/outputs.h"

#include <fathom/files.h>

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace fathom::cli {
namespace {

namespace fs = std::filesystem;

struct Suffix {
    std::string_view text;
    Content content;
};

// The suffixes that promise what a file holds. Others promise nothing and are free.
constexpr std::array<Suffix, 27> suffixes{
    {{".png", Content::Picture}, {".jpg", Content::Picture},   {".jpeg", Content::Picture},
     {".exr", Content::Picture}, {".mp4", Content::Film},      {".webm", Content::Film},
     {".gif", Content::Film},    {".apng", Content::Film},     {".sums", Content::Sums},
     {".glsl", Content::Shader}, {".frag", Content::Shader},   {".spv", Content::SpirV},
     {".html", Content::Page},   {".htm", Content::Page},      {".stl", Content::Mesh},
     {".obj", Content::Mesh},    {".ply", Content::Mesh},      {".glb", Content::Mesh},
     {".3mf", Content::Mesh},    {".svg", Content::Slice},     {".dxf", Content::Slice},
     {".sdf", Content::Scene},   {".vdb", Content::Volume},    {".nrrd", Content::Volume},
     {".npy", Content::Volume},  {".yaml", Content::SaveFile}, {".yml", Content::SaveFile}}};

const Suffix *known_suffix(std::string_view suffix) {
    const auto *known = std::find_if(suffixes.begin(), suffixes.end(),
                                     [&](const Suffix &s) { return s.text == suffix; });
    return known == suffixes.end() ? nullptr : known;
}

std::string_view name_of(Content content) {
    switch (content) {
    case Content::Picture: return "a picture";
    case Content::Film: return "a film";
    case Content::Sums: return "a file of sums";
    case Content::Shader: return "a GLSL text";
    case Content::SpirV: return "a SPIR-V file";
    case Content::Page: return "a web page";
    case Content::Mesh: return "a mesh";
    case Content::Slice: return "a slice";
    case Content::Volume: return "a volume";
    case Content::Scene: return "a scene";
    case Content::SaveFile: return "a save file";
    }
    return "";
}

// The first target that writes it.
std::string compiler_of(Content content) {
    const std::vector<v1::ShaderTarget> targets = v1::shader_target_table();
    for (const v1::ShaderTarget &target : targets)
        if (content_of(target) == content)
            return &target == &targets.front()
                       ? "`fathom compile`"
                       : fmt::format("`fathom compile --target {}`", target.name);
    return "";
}

std::string writer_of(Content content) {
    switch (content) {
    case Content::Picture: return "`fathom render`";
    case Content::Film: return "`fathom render --frames A..B`";
    case Content::Sums: return "`fathom render --samples A..B`";
    case Content::Shader:
    case Content::SpirV:
    case Content::Page: return compiler_of(content);
    case Content::Mesh: return "`fathom mesh`";
    case Content::Slice: return "`fathom slice`";
    case Content::Volume: return "`fathom volume`";
    case Content::Scene: return "`fathom import`";
    case Content::SaveFile: return "`fathom export`";
    }
    return "";
}

bool is_stream(const std::string &out) {
    std::error_code none;
    return out.empty() || out == "-" || fs::is_character_file(out, none) || fs::is_fifo(out, none);
}

bool refuse_overwriting(const std::string &out, Terminal &terminal, const char *option) {
    terminal.say(
        fmt::format("fathom: {} {}: that is the file that is read; write to another", option, out));
    return true;
}

} // namespace

std::string suffix_of(const std::string &out) {
    std::string suffix = fs::path(out).extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return suffix;
}

std::string listed(const std::vector<std::string> &names) {
    std::string all;
    for (std::size_t i = 0; i < names.size(); ++i)
        all += (i == 0 ? "" : i + 1 < names.size() ? ", " : " or ") + names[i];
    return all;
}

std::string targets_with(bool v1::ShaderTarget::*trait) {
    std::vector<std::string> names;
    for (const v1::ShaderTarget &target : v1::shader_target_table())
        if (target.*trait) names.push_back(target.name);
    return listed(names);
}

Content content_of(const v1::ShaderTarget &target) {
    const Suffix *known = known_suffix(target.suffix);
    return known ? known->content : Content::Shader;
}

v1::ShaderTarget target_named(const std::string &name) {
    const std::vector<v1::ShaderTarget> targets = v1::shader_target_table();
    const auto named = std::ranges::find(targets, name, &v1::ShaderTarget::name);
    return named == targets.end() ? targets.front() : *named;
}

std::optional<PictureFormat> picture_format(const std::string &out) {
    if (is_stream(out)) return PictureFormat::Png;
    const std::string suffix = suffix_of(out);
    if (suffix == ".png") return PictureFormat::Png;
    if (suffix == ".jpg" || suffix == ".jpeg") return PictureFormat::Jpeg;
    if (suffix == ".exr") return PictureFormat::Exr;
    return std::nullopt;
}

bool is_sums_name(const std::string &out) { return suffix_of(out) == ".sums"; }

bool misnamed(const std::string &out, Content content, Terminal &terminal) {
    if (is_stream(out)) return false;
    const std::string suffix = suffix_of(out);
    const Suffix *known = known_suffix(suffix);
    if (content == Content::Slice && suffix == ".png") return false;
    if (known && known->content != content) {
        terminal.say(fmt::format("fathom: -o {}: `{}` is {}, and this writes {}; {} writes {}", out,
                                 suffix, name_of(known->content), name_of(content),
                                 writer_of(known->content), name_of(known->content)));
        return true;
    }
    if (content == Content::Film && !known) {
        terminal.say(
            fmt::format("fathom: -o {}: films are written as .mp4, .webm, .gif or .apng", out));
        return true;
    }
    if (content == Content::Picture && !picture_format(out)) {
        terminal.say(
            fmt::format("fathom: -o {}: pictures are written as .png, .jpg, .jpeg or .exr", out));
        return true;
    }
    if (content == Content::Mesh && !known) {
        terminal.say(fmt::format(
            "fathom: -o {}: meshes are written as .stl, .obj, .ply, .glb or .3mf", out));
        return true;
    }
    if (content == Content::Volume && !known) {
        terminal.say(fmt::format("fathom: -o {}: volumes are written as .vdb, .nrrd or .npy", out));
        return true;
    }
    if (content == Content::Slice && !known) {
        terminal.say(fmt::format("fathom: -o {}: slices are written as .svg, .dxf or .png", out));
        return true;
    }
    return false;
}

bool overwrites(const std::string &file, const std::string &out, Terminal &terminal,
                const char *option) {
    std::error_code none;
    if (file == "-" || out.empty() || out == "-" || !fs::equivalent(file, out, none)) return false;
    return refuse_overwriting(out, terminal, option);
}

bool overwrites(const std::vector<fs::path> &files, const std::string &out, Terminal &terminal,
                const char *option) {
    std::error_code none;
    if (is_stream(out) || !fs::exists(out, none)) return false;
    for (const fs::path &file : files)
        if (fs::equivalent(file, out, none)) return refuse_overwriting(out, terminal, option);
    return false;
}

bool unwritable(const std::string &out, Terminal &terminal) {
    std::error_code none;
    if (is_stream(out)) return false;
    fs::path folder = fs::path(out).parent_path();
    if (folder.empty()) folder = ".";
    std::string why;
    if (fs::is_directory(out, none))
        why = "is a directory";
    else if (!fs::is_directory(folder, none))
        why = fmt::format("there is no folder `{}`", folder.string());
    if (why.empty()) return false;
    terminal.say(fmt::format("fathom: cannot write `{}`: {}", out, why));
    return true;
}

Exit write_result(const std::string &out, std::string_view bytes, Terminal &terminal) {
    if (out.empty() || out == "-") {
        terminal.put(bytes);
        return done; // a failed write is told when the results are flushed
    }
    std::string error = v1::write_file(out, bytes);
    if (error.empty()) return done;
    terminal.say(fmt::format("fathom: cannot write `{}`: {}", out, error));
    return device_error;
}

Exit write_results(const std::vector<OutFile> &files, Terminal &terminal) {
    std::vector<v1::FileBytes> all;
    for (const OutFile &file : files) all.push_back({file.out, file.bytes});
    std::size_t failed = 0;
    const std::string error = v1::write_files(all, failed);
    if (error.empty()) return done;
    terminal.say(fmt::format("fathom: cannot write `{}`: {}", files[failed].out, error));
    return device_error;
}

} // namespace fathom::cli
