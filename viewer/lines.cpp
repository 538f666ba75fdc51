#include "viewer/lines.h"

#include <algorithm>

namespace fathom::viewer {
namespace {

std::vector<std::string_view> lines_of(std::string_view text) {
    std::vector<std::string_view> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        const std::size_t first = std::min(line.find_first_not_of(" \t\r"), line.size());
        line.remove_prefix(first); // a line that is only indented anew is the same line
        while (!line.empty() && (line.back() == ' ' || line.back() == '\t' || line.back() == '\r'))
            line.remove_suffix(1);
        lines.push_back(line);
    }
    return lines;
}

using Lines = std::vector<std::string_view>;
struct Stretch { // lines [begin, end) of both, from 0
    std::size_t begin_a, end_a, begin_b, end_b;
};

// Beyond that many pairs of lines only what both ends share is found.
constexpr std::size_t max_pairs = 4'000'000;

// The longest common subsequence, by its table of lengths.
void pair_common(const Lines &a, const Lines &b, const Stretch &part,
                 std::vector<std::uint32_t> &to) {
    const std::size_t rows = part.end_a - part.begin_a, columns = part.end_b - part.begin_b;
    if (rows == 0 || columns == 0 || rows * columns > max_pairs) return;
    std::vector<std::uint32_t> length((rows + 1) * (columns + 1), 0);
    const auto at = [&](std::size_t i, std::size_t k) -> std::uint32_t & {
        return length[i * (columns + 1) + k];
    };
    const auto same = [&](std::size_t i, std::size_t k) {
        return a[part.begin_a + i] == b[part.begin_b + k];
    };
    for (std::size_t i = rows; i-- > 0;)
        for (std::size_t k = columns; k-- > 0;)
            at(i, k) = same(i, k) ? at(i + 1, k + 1) + 1 : std::max(at(i + 1, k), at(i, k + 1));
    for (std::size_t i = 0, k = 0; i < rows && k < columns;) {
        if (same(i, k)) {
            to[part.begin_a + i + 1] = static_cast<std::uint32_t>(part.begin_b + k + 1);
            ++i, ++k;
        } else if (at(i + 1, k) >= at(i, k + 1)) {
            ++i;
        } else {
            ++k;
        }
    }
}

} // namespace

std::vector<std::uint32_t> lines_after(std::string_view before, std::string_view after) {
    const Lines a = lines_of(before), b = lines_of(after);
    std::vector<std::uint32_t> to(a.size() + 1, 0);
    std::size_t first = 0, last = 0; // shared at the beginning, at the end
    const std::size_t shorter = std::min(a.size(), b.size());
    while (first < shorter && a[first] == b[first]) ++first;
    while (first + last < shorter && a[a.size() - 1 - last] == b[b.size() - 1 - last]) ++last;
    for (std::size_t i = 0; i < first; ++i) to[i + 1] = static_cast<std::uint32_t>(i + 1);
    for (std::size_t i = 0; i < last; ++i)
        to[a.size() - i] = static_cast<std::uint32_t>(b.size() - i);
    pair_common(a, b, {first, a.size() - last, first, b.size() - last}, to);

    for (std::size_t i = 1; i <= a.size();) { // runs without a partner
        std::size_t end = i;
        while (end <= a.size() && to[end] == 0) ++end;
        const std::size_t begin_b = to[i - 1] + 1;
        const std::size_t end_b = end <= a.size() ? to[end] : b.size() + 1;
        if (end - i == end_b - begin_b)
            for (std::size_t k = i; k < end; ++k)
                to[k] = static_cast<std::uint32_t>(begin_b + (k - i));
        i = end + 1;
    }
    return to;
}

} // namespace fathom::viewer
