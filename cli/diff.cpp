#include "cli/diff.h"

#include <algorithm>
#include <fmt/format.h>
#include <vector>

namespace fathom::cli {
namespace {

// Lines with their ends; the last may have none.
std::vector<std::string_view> lines_of(std::string_view text) {
    std::vector<std::string_view> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
        lines.push_back(text.substr(0, end));
        text.remove_prefix(end);
    }
    return lines;
}

// A line that stays (' '), goes ('-') or comes ('+').
struct DiffLine {
    char sign;
    std::string_view text;
};

constexpr std::size_t max_changes = 2000; // beyond it all that differs is one change

// The shortest edit between two lists of lines (Myers, "An O(ND) difference algorithm", 1986): the
// furthest place on each diagonal for each number of changes, then the way back.
void shortest_edit(std::vector<std::string_view> a, std::vector<std::string_view> b,
                   std::vector<DiffLine> &out) {
    const auto n = static_cast<long>(a.size()), m = static_cast<long>(b.size());
    const long most = std::min(n + m, static_cast<long>(max_changes));
    std::vector<std::vector<long>> furthest; // by changes; of diagonal k at k + changes
    const auto at = [&](long changes, long k) {
        return furthest[static_cast<std::size_t>(changes)][static_cast<std::size_t>(k + changes)];
    };
    const auto comes_down = [&](long changes, long k) { // from the diagonal above, by a line of b
        return k == -changes || (k != changes && at(changes - 1, k - 1) < at(changes - 1, k + 1));
    };
    long found = -1;
    for (long changes = 0; changes <= most && found < 0; ++changes) {
        furthest.emplace_back(static_cast<std::size_t>(2 * changes + 1));
        for (long k = -changes; k <= changes && found < 0; k += 2) {
            long x = changes == 0             ? 0
                     : comes_down(changes, k) ? at(changes - 1, k + 1)
                                              : at(changes - 1, k - 1) + 1;
            while (x < n && x - k < m &&
                   a[static_cast<std::size_t>(x)] == b[static_cast<std::size_t>(x - k)])
                ++x;
            furthest.back()[static_cast<std::size_t>(k + changes)] = x;
            if (x >= n && x - k >= m) found = changes;
        }
    }
    if (found < 0) {
        for (std::string_view line : a) out.push_back({'-', line});
        for (std::string_view line : b) out.push_back({'+', line});
        return;
    }
    std::vector<DiffLine> back;
    long x = n, y = m;
    for (long changes = found; changes >= 0; --changes) {
        const long k = x - y;
        const bool down = changes > 0 && comes_down(changes, k);
        const long from_k = down ? k + 1 : k - 1;
        const long from_x = changes == 0 ? 0 : at(changes - 1, from_k),
                   from_y = changes == 0 ? 0 : from_x - from_k;
        const long begin_x = changes == 0 ? 0 : down ? from_x : from_x + 1;
        for (; x > begin_x; --x, --y) back.push_back({' ', a[static_cast<std::size_t>(x - 1)]});
        if (changes == 0) break;
        if (down)
            back.push_back({'+', b[static_cast<std::size_t>(from_y)]});
        else
            back.push_back({'-', a[static_cast<std::size_t>(from_x)]});
        x = from_x, y = from_y;
    }
    out.insert(out.end(), back.rbegin(), back.rend());
}

void put_line(std::string &text, const DiffLine &line) {
    text += line.sign;
    text += line.text;
    if (!line.text.ends_with('\n')) text += "\n\\ No newline at end of file\n";
}

// `first,count` as `diff -u` has it: no count is 1, and the line before an empty stretch.
std::string stretch(std::size_t first, std::size_t count) {
    return count == 1 ? fmt::to_string(first + 1)
                      : fmt::format("{},{}", count == 0 ? first : first + 1, count);
}

} // namespace

std::string unified_diff(std::string_view name, std::string_view before, std::string_view after) {
    if (before == after) return "";
    std::vector<DiffLine> edit;
    shortest_edit(lines_of(before), lines_of(after), edit);
    constexpr std::size_t around = 3;
    std::string text = fmt::format("--- {}\n+++ {}\n", name, name);
    std::size_t old_line = 0, new_line = 0, i = 0;
    const auto changes = [&](std::size_t k) { return edit[k].sign != ' '; };
    while (i < edit.size()) {
        std::size_t change = i;
        while (change < edit.size() && !changes(change)) ++change;
        if (change == edit.size()) break;
        const std::size_t begin = change - std::min(change - i, around);
        old_line += begin - i, new_line += begin - i;
        std::size_t end = change, quiet = 0;
        while (end < edit.size() && quiet <= 2 * around) quiet = changes(end++) ? 0 : quiet + 1;
        end -= quiet > around ? quiet - around : 0;
        const auto count = [&](char sign) {
            return static_cast<std::size_t>(std::count_if(
                edit.begin() + static_cast<long>(begin), edit.begin() + static_cast<long>(end),
                [&](const DiffLine &line) { return line.sign == ' ' || line.sign == sign; }));
        };
        const std::size_t gone = count('-'), come = count('+');
        text += fmt::format("@@ -{} +{} @@\n", stretch(old_line, gone), stretch(new_line, come));
        for (std::size_t k = begin; k < end; ++k) put_line(text, edit[k]);
        old_line += gone, new_line += come;
        i = end;
    }
    return text;
}

} // namespace fathom::cli
