// Where a command's result goes: a file whose suffix says what it holds, or standard output. What
// can be refused is refused before any work is done.
#pragma once

#include "cli/terminal.h"

#include <fathom/shader.h>

namespace fathom::cli {

// What a command writes.
enum class Content {
    Picture,
    Film,
    Sums,
    Shader,
    SpirV,
    Page,
    Mesh,
    Slice,
    Volume,
    Scene,
    SaveFile
};

Content content_of(const v1::ShaderTarget &target); // by its suffix

v1::ShaderTarget target_named(const std::string &name); // that there is; empty: the first

// The names of the targets that have the trait; names as "a, b or c".
std::string targets_with(bool v1::ShaderTarget::*trait);
std::string listed(const std::vector<std::string> &names);

// The picture files that can be written.
enum class PictureFormat { Png, Jpeg, Exr };

// By the suffix of `out`. Standard output, devices and pipes take PNGs. None: the suffix is of no
// picture that can be written.
std::optional<PictureFormat> picture_format(const std::string &out);

std::string suffix_of(const std::string &out); // with its dot, in lower case
bool is_sums_name(const std::string &out);     // by its suffix, .sums

// Whether `out` has the suffix of something else than the command writes, and so would lie about
// what it holds; says so, with the way to what the suffix promises.
bool misnamed(const std::string &out, Content content, Terminal &terminal);

// Whether a result would be written over the very file that it is made from, or over one that the
// scene reads; says so. `option` named it.
bool overwrites(const std::string &file, const std::string &out, Terminal &terminal,
                const char *option = "-o");
bool overwrites(const std::vector<std::filesystem::path> &files, const std::string &out,
                Terminal &terminal, const char *option = "-o");

// Whether `out` is a folder, or lies in none; says so. For results that take long to make.
bool unwritable(const std::string &out, Terminal &terminal);

// Writes a result to a file, or to standard output where `out` is empty or `-`.
Exit write_result(const std::string &out, std::string_view bytes, Terminal &terminal);

// Writes several files, all or none of them.
struct OutFile {
    std::string out;
    std::string_view bytes;
};
Exit write_results(const std::vector<OutFile> &files, Terminal &terminal);

} // namespace fathom::cli
