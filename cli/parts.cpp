#include "cli/parts.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace fathom::cli {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::string_view mark = "fathom sums 1\n";

std::string bytes_of_numbers(std::span<const double> values) {
    std::string bytes;
    bytes.reserve(8 * values.size());
    for (const double value : values) {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        for (int shift = 0; shift < 64; shift += 8)
            bytes += static_cast<char>(static_cast<unsigned char>(bits >> shift));
    }
    return bytes;
}

std::vector<double> values_of(std::string_view bytes) {
    std::vector<double> values(bytes.size() / 8);
    for (std::size_t i = 0; i < values.size(); ++i) {
        std::uint64_t bits = 0;
        for (std::size_t k = 8; k-- > 0;)
            bits = bits << 8 | static_cast<unsigned char>(bytes[8 * i + k]);
        values[i] = std::bit_cast<double>(bits);
    }
    return values;
}

} // namespace

bool is_sums(std::string_view bytes) { return bytes.starts_with(mark); }

std::string write_sums(const Sums &sums) {
    const std::string data = bytes_of_numbers(sums.values);
    const Json head{{"note", text_of(sums.note)},
                    {"undecided", sums.undecided},
                    {"undecided_shadows", sums.undecided_shadows},
                    {"checksum", fingerprint(data)}};
    return std::string(mark) + head.dump() + "\n" + data;
}

std::optional<Sums> read_sums(std::string_view bytes) {
    if (!is_sums(bytes)) return std::nullopt;
    bytes.remove_prefix(mark.size());
    const std::size_t end = bytes.find('\n');
    if (end == bytes.npos) return std::nullopt;
    const Json head = Json::parse(bytes.substr(0, end), nullptr, false);
    const auto is = [&](const char *name, bool (Json::*kind)() const noexcept) {
        return head.is_object() && head.contains(name) && (head[name].*kind)();
    };
    if (!is("note", &Json::is_string) || !is("checksum", &Json::is_string) ||
        !is("undecided", &Json::is_number_unsigned) ||
        !is("undecided_shadows", &Json::is_number_unsigned))
        return std::nullopt;
    const std::optional<Note> note = note_of(head["note"].get<std::string>());
    bytes.remove_prefix(end + 1);
    if (!note || fingerprint(bytes) != head["checksum"].get<std::string>()) return std::nullopt;
    const std::size_t pixels =
        static_cast<std::size_t>(note->region[2]) * static_cast<std::size_t>(note->region[3]);
    if (bytes.size() != 24 * pixels) return std::nullopt;
    return Sums{*note, head["undecided"].get<std::uint64_t>(),
                head["undecided_shadows"].get<std::uint64_t>(), values_of(bytes)};
}

Block block_of(const Note &note) {
    return {note.region[0], note.region[1],    note.region[2],
            note.region[3], note.first_sample, note.samples};
}

std::string words_of(const Block &block) {
    return fmt::format("x {}..{}, y {}..{}, samples {}..{}", block.x, block.x + block.width,
                       block.y, block.y + block.height, block.first_sample,
                       block.first_sample + block.samples);
}

bool overlap(const Block &a, const Block &b) {
    const auto meet = [](int first, int count, int other, int others) {
        return first < other + others && other < first + count;
    };
    return meet(a.x, a.width, b.x, b.width) && meet(a.y, a.height, b.y, b.height) &&
           meet(a.first_sample, a.samples, b.first_sample, b.samples);
}

namespace {

// What of `whole` the part does not hold: slabs before and behind it, by samples, rows, columns.
void cut_off(const Block &whole, const Block &part, std::vector<Block> &rest) {
    if (!overlap(whole, part)) {
        rest.push_back(whole);
        return;
    }
    Block inner = whole;
    const auto along = [&](int Block::*first, int Block::*count, int from, int number) {
        const int end = inner.*first + inner.*count;
        Block slab = inner;
        slab.*count = from - inner.*first;
        if (slab.*count > 0) rest.push_back(slab);
        slab.*first = from + number;
        slab.*count = end - slab.*first;
        if (slab.*count > 0) rest.push_back(slab);
        const int begin = std::max(inner.*first, from);
        inner.*count = std::min(end, from + number) - begin;
        inner.*first = begin;
    };
    along(&Block::first_sample, &Block::samples, part.first_sample, part.samples);
    along(&Block::y, &Block::height, part.y, part.height);
    along(&Block::x, &Block::width, part.x, part.width);
}

} // namespace

std::vector<Block> missing(const Block &whole, std::span<const Block> parts) {
    std::vector<Block> rest{whole};
    for (const Block &part : parts) {
        std::vector<Block> next;
        for (const Block &block : rest) cut_off(block, part, next);
        rest = std::move(next);
    }
    return rest;
}

} // namespace fathom::cli
