// Of what a picture is: fingerprints of the scene and of all options that decide a pixel, which are
// written into the picture. By them files are kept, joined and told apart, on any machine.
#pragma once

#include "cli/frames.h"

#include <fathom/scene.h>

#include <array>
#include <optional>
#include <string>

namespace fathom::cli {

// 128 bits of FNV-1a (Fowler, Noll and Vo; RFC 9923), in hexadecimal digits: finds what changed by
// accident, not what was forged.
std::string fingerprint(std::string_view bytes);

// The files that a scene was read from, each with a name that does not depend on where it lies.
struct SceneFile {
    std::optional<std::size_t> include; // which -I folder; none: the scene's own
    std::string name;                   // relative to it, with `/`
    std::filesystem::path path;         // absolute
};
std::vector<SceneFile> files_of(const v1::CompileResult &result, const SceneArguments &scene);

// The fingerprint of the film: the program, the scene's files, and the options but for which frames,
// samples and pixels are made, and `maker`: what draws them (maker_of). `error` says why a file could
// not be read.
std::string identity_of_film(const v1::CompileResult &result, const RenderCommand &command,
                             std::string_view maker, std::string &error);

// What a file of pixels holds.
struct Note {
    std::string film;            // its fingerprint
    std::optional<int> frame;    // none: a single picture
    int width = 0, height = 0;   // of the whole picture
    std::array<int, 4> region{}; // x, y, width, height
    int first_sample = 0, samples = 1;
    bool rough = false; // more samples where a pixel is rough
    friend bool operator==(const Note &, const Note &) = default;
};
void set_samples(Note &note, int samples); // 0: one, and more where a pixel is rough
std::string text_of(const Note &note);     // one line of JSON, ASCII
std::optional<Note> note_of(std::string_view text);

// The note of a file, which is whole: a PNG or sums (parts.h). Nothing where it is not.
std::optional<Note> note_of_file(const std::string &file);

} // namespace fathom::cli
