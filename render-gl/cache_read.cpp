// What a frame through the noise cache left behind, read back: see cache_passes.h.
#include "render-gl/cache_passes.h"

#include <epoxy/gl.h>

namespace fathom::gl {

Pixels CachedView::read_pixels() const {
    Pixels pixels{targets_.width, targets_.height, {}};
    const std::size_t row = static_cast<std::size_t>(targets_.width) * 4;
    std::vector<float> upward(row * static_cast<std::size_t>(targets_.height));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, targets_.picture);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, targets_.width, targets_.height, GL_RGBA, GL_FLOAT, upward.data());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    for (int y = targets_.height; y-- > 0;)
        pixels.rgba.insert(pixels.rgba.end(), upward.begin() + static_cast<std::ptrdiff_t>(row) * y,
                           upward.begin() + static_cast<std::ptrdiff_t>(row) * (y + 1));
    for (std::size_t i = 3; i < pixels.rgba.size(); i += 4) // 0.5, 0.875 or 1 (marcher.h)
        if (pixels.rgba[i] < 0.75f)
            ++pixels.undecided;
        else
            pixels.rgba[i] = 1;
    return pixels;
}

std::vector<std::uint32_t> CachedView::read_counted() const {
    std::vector<std::uint32_t> words(static_cast<std::size_t>(targets_.width) *
                                     static_cast<std::size_t>(targets_.height) * 2);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, targets_.picture);
    glReadBuffer(GL_COLOR_ATTACHMENT3);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, targets_.width, targets_.height, GL_RG_INTEGER, GL_UNSIGNED_INT,
                 words.data());
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    return words;
}

CacheTally CachedView::read_tally() const {
    const std::vector<std::uint32_t> words = read_counted();
    CacheTally tally;
    for (std::size_t i = 0; i < words.size(); i += 2) {
        const auto state = static_cast<PixelState>(words[i + 1] & 3u);
        tally.hits += words[i];
        tally.misses += state == PixelState::Missed;
        tally.computed += state != PixelState::Finished;
    }
    return tally;
}

std::vector<PixelState> CachedView::read_states() const {
    const std::vector<std::uint32_t> words = read_counted();
    std::vector<PixelState> states;
    const auto width = static_cast<std::size_t>(targets_.width);
    for (std::size_t y = static_cast<std::size_t>(targets_.height); y-- > 0;)
        for (std::size_t x = 0; x < width; ++x)
            states.push_back(static_cast<PixelState>(words[2 * (y * width + x) + 1] & 3u));
    return states;
}

} // namespace fathom::gl
