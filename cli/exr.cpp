#include "cli/exr.h"

#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfRgbaFile.h>

#include <algorithm>
#include <exception>
#include <vector>

namespace fathom::cli {
namespace {

// A file in memory.
class Bytes : public Imf::OStream {
  public:
    Bytes() : OStream("") {}
    void write(const char *bytes, int count) override {
        const auto size = static_cast<std::size_t>(count);
        bytes_.resize(std::max(bytes_.size(), at_ + size));
        std::copy_n(bytes, size, bytes_.begin() + static_cast<std::ptrdiff_t>(at_));
        at_ += size;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t place) override { at_ = place; }
    std::string take() { return std::move(bytes_); }

  private:
    std::string bytes_;
    std::size_t at_ = 0;
};

half half_of(float x) { return half(std::clamp(x, -65504.0f, 65504.0f)); } // keeps a NaN

} // namespace

std::string encode_exr(int width, int height, std::span<const float> rgba) {
    try {
        std::vector<Imf::Rgba> pixels(rgba.size() / 4);
        for (std::size_t i = 0; i < pixels.size(); ++i)
            pixels[i] = {half_of(rgba[4 * i]), half_of(rgba[4 * i + 1]), half_of(rgba[4 * i + 2]),
                         half_of(rgba[4 * i + 3])};
        Bytes bytes;
        {
            Imf::Header header(width, height);
            header.compression() = Imf::ZIP_COMPRESSION;
            Imf::RgbaOutputFile file(bytes, header, Imf::WRITE_RGBA, 0);
            file.setFrameBuffer(pixels.data(), 1, static_cast<std::size_t>(width));
            file.writePixels(height);
        } // its end writes where the lines lie
        return bytes.take();
    } catch (const std::exception &) {
        return "";
    }
}

} // namespace fathom::cli
