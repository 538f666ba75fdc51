// Where the frames of one command go: a file each, standard output, one film, or one contact sheet.
#pragma once

#include "cli/film.h"
#include "cli/outputs.h"
#include "cli/parts.h"

#include <fathom/picture.h>

#include <memory>
#include <string>

namespace fathom::cli {

// Frames as they come, in the order of their numbers.
class Delivery {
  public:
    Delivery(const RenderCommand &command, Terminal &terminal);

    // The file of a frame; standard output's and a film's is the same for all.
    std::string file_of(int frame) const;
    // Whether each frame has a file of its own, and its frame's number in the name.
    bool has_files() const { return kind_ == Kind::Files; }
    bool wants_sums() const { return sums_; }

    // A frame that is made. Prints why it cannot be taken.
    Exit take(int frame, const Note &note, v1::Picture picture);
    Exit finish(); // after the last

  private:
    enum class Kind { Files, Stream, Film, Sheet };
    Exit refuse(const std::string &why);
    Exit add_to_film(const v1::Picture &picture);
    Exit add_to_sheet(const v1::Picture &picture);

    const RenderCommand &command_;
    Terminal &terminal_;
    Kind kind_ = Kind::Files;
    bool sums_ = false;
    std::unique_ptr<Film> film_;
    v1::Picture sheet_;
    int on_sheet_ = 0;
};

// A picture's bytes in the format of the file's suffix, of a PNG or a JPEG; a PNG with the note.
std::string encoded(const v1::Picture &picture, const std::string &out, int quality,
                    std::string_view note);

} // namespace fathom::cli
