#include "cli/preview.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fmt/format.h>
#include <string_view>
#include <sys/ioctl.h>
#include <unistd.h>

namespace fathom::cli {
namespace {

bool says(const char *name, std::initializer_list<std::string_view> words) {
    const char *value = std::getenv(name);
    return value && std::any_of(words.begin(), words.end(), [&](std::string_view word) {
               return std::string_view(value).find(word) != std::string_view::npos;
           });
}

bool is_utf8() {
    for (const char *name : {"LC_ALL", "LC_CTYPE", "LANG"}) { // the first that is set decides
        const char *value = std::getenv(name);
        if (value && *value) return says(name, {"UTF-8", "utf-8", "UTF8", "utf8"});
    }
    return false;
}

// The mean colour of a part of the picture; nothing, where nothing of it is drawn.
std::array<int, 4> mean(std::span<const std::uint8_t> rgba, int width, int x0, int x1, int y0,
                        int y1) {
    std::array<int, 4> sum{};
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            const std::uint8_t *pixel =
                rgba.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                   static_cast<std::size_t>(x));
            if (pixel[3] == 0) continue;
            for (std::size_t c = 0; c < 3; ++c) sum[c] += pixel[c];
            ++sum[3];
        }
    for (std::size_t c = 0; c < 3; ++c) sum[c] /= std::max(sum[3], 1);
    return sum;
}

} // namespace

PreviewSize preview_size(int width, int height) {
    winsize window{};
    if (!says("COLORTERM", {"truecolor", "24bit"}) || !is_utf8() ||
        ::ioctl(STDERR_FILENO, TIOCGWINSZ, &window) != 0)
        return {};
    const int max_columns = window.ws_col - 1, max_rows = window.ws_row / 2 - 1;
    if (max_columns < 8 || max_rows < 4) return {};
    // a character is two pixels high, each about as wide as it is high
    const double scale =
        std::min({static_cast<double>(max_columns) / width, 2.0 * max_rows / height, 1.0});
    return {std::max(1, static_cast<int>(width * scale)),
            std::max(1, static_cast<int>(height * scale / 2))};
}

std::string preview_lines(std::span<const std::uint8_t> rgba, int width, int height,
                          PreviewSize size) {
    std::string text;
    const auto edge = [](int i, int n, int all) {
        return static_cast<int>(static_cast<long long>(i) * all / n);
    };
    for (int row = 0; row < size.rows; ++row) {
        text += "\x1b[K";
        for (int column = 0; column < size.columns; ++column) {
            const int x0 = edge(column, size.columns, width),
                      x1 = std::max(edge(column + 1, size.columns, width), x0 + 1);
            std::array<std::array<int, 4>, 2> half;
            for (int i = 0; i < 2; ++i) {
                const int y0 = edge(2 * row + i, 2 * size.rows, height),
                          y1 = std::max(edge(2 * row + i + 1, 2 * size.rows, height), y0 + 1);
                half[static_cast<std::size_t>(i)] =
                    mean(rgba, width, x0, std::min(x1, width), y0, std::min(y1, height));
            }
            if (half[0][3] == 0 && half[1][3] == 0) {
                text += "\x1b[0m ";
                continue;
            }
            text += fmt::format("\x1b[38;2;{};{};{};48;2;{};{};{}m▀", half[0][0], half[0][1],
                                half[0][2], half[1][0], half[1][1], half[1][2]);
        }
        text += "\x1b[0m\r\n";
    }
    return text;
}

} // namespace fathom::cli
