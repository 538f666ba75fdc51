// A film that ffmpeg writes from frames: an MP4, a WebM, a GIF or an animated PNG by its suffix. The
// film is written beside its target and renamed when it is whole.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace fathom::cli {

bool is_film(const std::string &out); // by its suffix: .mp4, .webm, .gif, .apng

// Why this film cannot be written: ffmpeg is not installed, or a size that the format has not.
// Empty where it can.
std::string refused_film(const std::string &out, int width, int height);

class Film {
  public:
    // Starts ffmpeg; `error` says why it could not be.
    static std::unique_ptr<Film> open(const std::string &out, int width, int height,
                                      double frame_rate, std::string &error);
    ~Film(); // without `finish`: ends ffmpeg and removes what it wrote
    Film(const Film &) = delete;
    Film &operator=(const Film &) = delete;
    std::string add(std::span<const std::uint8_t> rgba); // a frame; the reason where it failed
    std::string finish();                                // the film is whole, or the reason

  private:
    Film() = default;
    std::string why(const std::string &otherwise); // what ffmpeg said, after it has ended
    std::string target_, temporary_;
    int lock_ = -1, frames_ = -1, words_ = -1, process_ = -1;
};

} // namespace fathom::cli
