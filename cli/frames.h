// A film's frames: what each of them shows, and the names of their files. Nothing here depends on
// which of the frames one process makes, so a film is the same however it is divided.
#pragma once

#include "cli/command.h"

#include <string>
#include <vector>

namespace fathom::cli {

// Frames in the order in which they are made; one, of the number 0, where there is no film.
std::vector<int> frames_of_film(const RenderCommand &command);
std::vector<int> frames_to_make(const RenderCommand &command); // by --only, --contact-sheet

// What one picture shows.
struct Moment {
    double time = 0;   // seconds, as the shutter opens
    double open = 0;   // seconds for which it is open
    double turned = 0; // radians that the camera has gone around what it looks at, about y
};
Moment moment_of(const RenderCommand &command, int frame);
double latest_time(const RenderCommand &command, const std::vector<int> &frames);

// The swept params' values at a frame, as `-D` writes them.
std::vector<Definition> swept(const RenderCommand &command, int frame);
std::vector<Definition> swept(const std::vector<Sweep> &sweeps, const std::vector<int> &film,
                              int frame);

// %04d as ####, which frames are named by.
std::string with_places(const std::string &out);

// `out` with the frame's number in place of its last row of `#`s, or of %04d, or before its suffix
// where it has neither.
std::string frame_name(const std::string &out, int frame);

// The first row of tile i of n; that of tile n is the height.
int tile_row(int height, int i, int n);

// "3,5..=8", as read_frames reads it.
std::string words_of_frames(const std::vector<int> &frames);

} // namespace fathom::cli
