#include "cli/delivery.h"

#include "cli/exr.h"

#include <algorithm>
#include <fmt/format.h>

namespace fathom::cli {
namespace {

std::string rgb_of(const v1::Picture &picture) {
    std::string bytes;
    bytes.reserve(picture.rgba.size() / 4 * 3);
    for (std::size_t i = 0; i < picture.rgba.size(); ++i)
        if (i % 4 != 3) bytes += static_cast<char>(picture.rgba[i]);
    return bytes;
}

std::string streamed(const v1::Picture &picture, StreamFormat format, std::string_view note) {
    switch (format) {
    case StreamFormat::Png: return v1::encode_png(picture, note);
    case StreamFormat::Pam:
        return fmt::format("P7\nWIDTH {}\nHEIGHT {}\nDEPTH 3\nMAXVAL 255\nTUPLTYPE RGB\nENDHDR\n",
                           picture.width, picture.height) +
               rgb_of(picture);
    case StreamFormat::Raw: return rgb_of(picture);
    }
    return "";
}

void paste(const v1::Picture &from, v1::Picture &to, int x, int y) {
    for (int row = 0; row < from.height; ++row)
        std::copy_n(from.rgba.begin() + 4 * (static_cast<std::ptrdiff_t>(row) * from.width),
                    4 * from.width,
                    to.rgba.begin() + 4 * (static_cast<std::ptrdiff_t>(y + row) * to.width + x));
}

} // namespace

std::string encoded(const v1::Picture &picture, const std::string &out, int quality,
                    std::string_view note) {
    return picture_format(out) == PictureFormat::Jpeg ? v1::encode_jpeg(picture, quality)
                                                      : v1::encode_png(picture, note);
}

Delivery::Delivery(const RenderCommand &command, Terminal &terminal)
    : command_(command), terminal_(terminal), sums_(is_sums_name(command.out)) {
    if (is_film(command.out))
        kind_ = Kind::Film;
    else if (command.sheet.first > 0)
        kind_ = Kind::Sheet;
    else if (command.out == "-")
        kind_ = Kind::Stream;
}

std::string Delivery::file_of(int frame) const {
    const bool one = command_.frames.numbers.empty() && command_.turntable == 0;
    return kind_ != Kind::Files || one ? command_.out : frame_name(command_.out, frame);
}

Exit Delivery::refuse(const std::string &why) {
    terminal_.say(fmt::format("fathom: cannot write `{}`: {}", command_.out, why));
    return device_error;
}

Exit Delivery::add_to_film(const v1::Picture &picture) {
    std::string error;
    if (!film_)
        film_ = Film::open(command_.out, picture.width, picture.height, command_.frame_rate, error);
    if (film_) error = film_->add(picture.rgba);
    return error.empty() ? done : refuse(error);
}

Exit Delivery::add_to_sheet(const v1::Picture &picture) {
    if (sheet_.rgba.empty()) {
        const int frames = static_cast<int>(frames_to_make(command_).size()),
                  columns = std::min(frames, command_.sheet.first),
                  rows = (frames + command_.sheet.first - 1) / command_.sheet.first;
        sheet_.width = columns * picture.width;
        sheet_.height = rows * picture.height;
        sheet_.rgba.resize(4 * static_cast<std::size_t>(sheet_.width) *
                           static_cast<std::size_t>(sheet_.height));
        for (std::size_t i = 3; i < sheet_.rgba.size(); i += 4) sheet_.rgba[i] = 255;
    }
    paste(picture, sheet_, on_sheet_ % command_.sheet.first * picture.width,
          on_sheet_ / command_.sheet.first * picture.height);
    ++on_sheet_;
    return done;
}

Exit Delivery::take(int frame, const Note &note, v1::Picture picture) {
    switch (kind_) {
    case Kind::Files: {
        const std::string out = file_of(frame);
        if (picture_format(out) == PictureFormat::Exr) {
            const std::string bytes = encode_exr(picture.width, picture.height, picture.linear);
            return bytes.empty() ? refuse("there is no memory for it")
                                 : write_result(out, bytes, terminal_);
        }
        if (!sums_)
            return write_result(out, encoded(picture, out, command_.quality, text_of(note)),
                                terminal_);
        const Sums sums{note, picture.undecided, picture.undecided_shadows,
                        std::move(picture.sums)};
        return write_result(out, write_sums(sums), terminal_);
    }
    case Kind::Stream:
        terminal_.put(streamed(picture, command_.stream, text_of(note)));
        return terminal_.flush();
    case Kind::Film: return add_to_film(picture);
    case Kind::Sheet: return add_to_sheet(picture);
    }
    return done;
}

Exit Delivery::finish() {
    if (film_) {
        const std::string error = film_->finish();
        return error.empty() ? done : refuse(error);
    }
    if (kind_ == Kind::Sheet)
        return write_result(command_.out, encoded(sheet_, command_.out, command_.quality, ""),
                            terminal_);
    return done;
}

} // namespace fathom::cli
