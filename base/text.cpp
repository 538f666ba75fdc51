// Number and text helpers. Numbers are written by std::to_chars and read by its counterpart of the
// library fast_float, which know no locale (libc++ cannot read fractions by std::from_chars).
#include "base/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fast_float/fast_float.h>
#include <iterator>

namespace fathom {

namespace {

template <class T> std::string shortest(T value) {
    std::array<char, 64> buffer;
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return error == std::errc{} ? std::string(buffer.data(), end) : std::string("0");
}

constexpr CodePoint not_utf8{0xFFFD, 1, false};

struct CodeRange {
    std::uint32_t first, last;
};

template <std::size_t N> bool in_ranges(const CodeRange (&ranges)[N], std::uint32_t c) {
    const auto *after =
        std::upper_bound(std::begin(ranges), std::end(ranges), c,
                         [](std::uint32_t v, const CodeRange &r) { return v < r.first; });
    return after != std::begin(ranges) && c <= std::prev(after)->last;
}

// The blocks of combining marks and joiners that people do type; Unicode 15, by block.
constexpr CodeRange no_width[] = {
    {0x0300, 0x036F}, {0x0483, 0x0489}, {0x0591, 0x05BD}, {0x0610, 0x061A}, {0x064B, 0x065F},
    {0x0900, 0x0902}, {0x093C, 0x093C}, {0x0941, 0x0948}, {0x0E31, 0x0E31}, {0x0E34, 0x0E3A},
    {0x0E47, 0x0E4E}, {0x1AB0, 0x1AFF}, {0x1DC0, 0x1DFF}, {0x200B, 0x200D}, {0x2060, 0x2060},
    {0x20D0, 0x20FF}, {0xFE00, 0xFE0F}, {0xFE20, 0xFE2F}, {0xFEFF, 0xFEFF}, {0xE0100, 0xE01EF}};

// East Asian Width W and F, and emoji that terminals draw wide; Unicode 15, by block.
constexpr CodeRange wide[] = {
    {0x1100, 0x115F},   {0x231A, 0x231B},   {0x23E9, 0x23EC},   {0x25FD, 0x25FE},
    {0x2614, 0x2615},   {0x2648, 0x2653},   {0x26A1, 0x26A1},   {0x26BD, 0x26BE},
    {0x26C4, 0x26C5},   {0x2705, 0x2705},   {0x270A, 0x270B},   {0x2728, 0x2728},
    {0x274C, 0x274C},   {0x2753, 0x2755},   {0x2757, 0x2757},   {0x2795, 0x2797},
    {0x27B0, 0x27B0},   {0x2B1B, 0x2B1C},   {0x2B50, 0x2B50},   {0x2B55, 0x2B55},
    {0x2E80, 0x303E},   {0x3041, 0x33FF},   {0x3400, 0x4DBF},   {0x4E00, 0x9FFF},
    {0xA000, 0xA4CF},   {0xA960, 0xA97F},   {0xAC00, 0xD7A3},   {0xF900, 0xFAFF},
    {0xFE30, 0xFE6F},   {0xFF00, 0xFF60},   {0xFFE0, 0xFFE6},   {0x1F004, 0x1F004},
    {0x1F0CF, 0x1F0CF}, {0x1F18E, 0x1F18E}, {0x1F191, 0x1F19A}, {0x1F200, 0x1F320},
    {0x1F32D, 0x1F335}, {0x1F337, 0x1F37C}, {0x1F37E, 0x1F393}, {0x1F3A0, 0x1F3CA},
    {0x1F3CF, 0x1F3D3}, {0x1F3E0, 0x1F3F0}, {0x1F3F4, 0x1F3F4}, {0x1F3F8, 0x1F43E},
    {0x1F440, 0x1F440}, {0x1F442, 0x1F4FC}, {0x1F4FF, 0x1F53D}, {0x1F54B, 0x1F567},
    {0x1F595, 0x1F596}, {0x1F5A4, 0x1F5A4}, {0x1F5FB, 0x1F64F}, {0x1F680, 0x1F6C5},
    {0x1F6CC, 0x1F6CC}, {0x1F6D0, 0x1F6D2}, {0x1F6EB, 0x1F6EC}, {0x1F6F4, 0x1F6FC},
    {0x1F7E0, 0x1F7EB}, {0x1F90C, 0x1FAFF}, {0x20000, 0x3FFFD}};

} // namespace

std::string format_shortest(double value) { return shortest(value); }
std::string format_shortest(float value) { return shortest(value); }

std::optional<double> parse_number(std::string_view text) {
    double value = 0;
    const auto [end, error] = fast_float::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    // older versions of the library have what is too large as infinite and what is too small as 0,
    // without an error
    const std::string_view digits = text.substr(0, text.find_first_of("eE"));
    if (std::isinf(value) && digits.find_first_of("0123456789") != digits.npos) return std::nullopt;
    if (value == 0 && digits.find_first_of("123456789") != digits.npos) return std::nullopt;
    return value;
}

CodePoint decode_utf8(std::string_view text, std::size_t offset) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[offset + i]); };
    const std::size_t left = text.size() - offset;
    const unsigned char lead = byte(0);
    if (lead < 0x80) return {lead, 1, true};
    std::uint32_t length = 0, value = 0, minimum = 0;
    if (lead >= 0xC2 && lead < 0xE0)
        length = 2, value = lead & 0x1Fu, minimum = 0x80;
    else if (lead >= 0xE0 && lead < 0xF0)
        length = 3, value = lead & 0x0Fu, minimum = 0x800;
    else if (lead >= 0xF0 && lead < 0xF5)
        length = 4, value = lead & 0x07u, minimum = 0x10000;
    else
        return not_utf8;
    if (left < length) return not_utf8;
    for (std::uint32_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0) != 0x80) return not_utf8;
        value = value << 6 | (byte(i) & 0x3Fu);
    }
    const bool surrogate = value >= 0xD800 && value < 0xE000;
    if (value < minimum || value > 0x10FFFF || surrogate) return not_utf8;
    return {value, length, true};
}

void append_utf8(std::string &out, std::uint32_t c) {
    const auto add = [&](std::uint32_t byte) { out.push_back(static_cast<char>(byte)); };
    if (c < 0x80) {
        add(c);
    } else if (c < 0x800) {
        add(0xC0 | c >> 6), add(0x80 | (c & 0x3F));
    } else if (c < 0x10000) {
        add(0xE0 | c >> 12), add(0x80 | (c >> 6 & 0x3F)), add(0x80 | (c & 0x3F));
    } else {
        add(0xF0 | c >> 18), add(0x80 | (c >> 12 & 0x3F)), add(0x80 | (c >> 6 & 0x3F));
        add(0x80 | (c & 0x3F));
    }
}

int display_width(std::uint32_t c) {
    if (c < 0x300) return 1;
    if (in_ranges(no_width, c)) return 0;
    return in_ranges(wide, c) ? 2 : 1;
}

std::string_view cut(std::string_view text, std::size_t bytes) {
    if (text.size() <= bytes) return text;
    const auto continues = [&](std::size_t at) {
        return (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80;
    };
    while (bytes > 0 && continues(bytes)) --bytes;
    return text.substr(0, bytes);
}

namespace {

constexpr std::string_view ellipsis = "…";

} // namespace

std::string shortened(std::string_view text, std::size_t bytes) {
    if (text.size() <= bytes) return std::string(text);
    if (bytes < ellipsis.size()) return "";
    return std::string(cut(text, bytes - ellipsis.size())).append(ellipsis);
}

std::string short_name(std::string_view name) {
    constexpr std::size_t most = 80;
    std::size_t end = 0;
    for (std::size_t i = 0; i < most && end < name.size(); ++i)
        end += decode_utf8(name, end).length;
    std::string text(name.substr(0, end));
    return end < name.size() ? text.append(ellipsis) : text;
}

} // namespace fathom
