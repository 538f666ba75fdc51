// Near names by optimal string alignment: insertions, deletions, replacements and swaps of
// neighbours, each of cost one (Damerau 1964), with three rows of the usual table.
#include "base/suggest.h"

#include <algorithm>

namespace fathom {

namespace {

char folded(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// Nobody mistypes a name of this length; and the table is quadratic.
constexpr std::size_t longest_word = 100;

} // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
    const std::size_t width = b.size() + 1;
    std::vector<std::size_t> rows(3 * width);
    std::size_t *before = rows.data(), *above = before + width, *row = above + width;
    for (std::size_t j = 0; j <= b.size(); ++j) above[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const char x = folded(a[i - 1]), y = folded(b[j - 1]);
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (x == y ? 0u : 1u)});
            const bool swapped = i > 1 && j > 1 && x == folded(b[j - 2]) && folded(a[i - 2]) == y;
            if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
        }
        std::swap(before, above);
        std::swap(above, row);
    }
    return above[b.size()];
}

std::string nearest_name(std::string_view word, const std::vector<std::string> &names) {
    if (word.empty() || word.size() > longest_word) return {};
    std::size_t best = std::max<std::size_t>(1, word.size() / 3) + 1;
    const std::string *nearest = nullptr;
    for (const std::string &name : names) {
        const std::size_t longer = std::max(name.size(), word.size());
        if (longer - std::min(name.size(), word.size()) >= best || name == word) continue;
        // A single letter is near to every other one, and to words of two; only its other case is
        // meant.
        if (word.size() == 1 && (longer > 1 || folded(name[0]) != folded(word[0]))) continue;
        const std::size_t distance = edit_distance(word, name);
        if (distance < best) best = distance, nearest = &name;
    }
    if (nearest) return *nearest;
    return word.size() < 3 ? std::string{} : shortest_begun_by(word, names);
}

std::string shortest_begun_by(std::string_view word, const std::vector<std::string> &names) {
    const std::string *shortest = nullptr;
    for (const std::string &name : names) {
        const bool begun = !word.empty() && name.size() > word.size() &&
                           std::equal(word.begin(), word.end(), name.begin(),
                                      [](char a, char b) { return folded(a) == folded(b); });
        if (begun && (!shortest || name.size() < shortest->size())) shortest = &name;
    }
    return shortest ? *shortest : std::string{};
}

} // namespace fathom
