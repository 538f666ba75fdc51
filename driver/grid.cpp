// Grids of values. Of NRRD (teem.sourceforge.net/nrrd/format.html) what a solid needs: attached data,
// three dimensions, numbers of any type, raw, gzip or ascii encoding, axes along x, y and z.
#include "driver/grid.h"

#include "base/text.h"
#include "driver/vdb/vdb.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include <zlib.h>

namespace fathom::driver {
namespace {

// Of one grid, whatever the memory: places in it are counted by ints.
constexpr std::uint64_t max_values = std::uint64_t{1} << 30;

LoadError no_grid(std::string why) { return {LoadError::Reason::Unreadable, std::move(why)}; }

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
        text.remove_suffix(1);
    return text;
}

std::string_view next_word(std::string_view &text) {
    constexpr std::string_view space = " \t\r\n";
    std::size_t begin = text.find_first_not_of(space);
    if (begin == text.npos) {
        text = {};
        return {};
    }
    std::size_t end = std::min(text.find_first_of(space, begin), text.size());
    std::string_view word = text.substr(begin, end - begin);
    text.remove_prefix(end);
    return word;
}

struct Header {
    std::string_view type, encoding = "raw", endian = "little";
    std::array<std::size_t, 3> sizes{};
    std::array<double, 3> spacings{1, 1, 1};
    std::optional<std::array<double, 3>> origin;
    double dimension = 0;
    std::string error;
};

// "(1,0,0) (0,1,0) (0,0,2)": the numbers, whatever stands between them.
std::vector<double> numbers_of(std::string_view text) {
    std::vector<double> out;
    std::string spaced(text);
    for (char &c : spaced)
        if (c == '(' || c == ')' || c == ',') c = ' ';
    std::string_view rest = spaced;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest))
        out.push_back(parse_number(word).value_or(std::nan("")));
    return out;
}

void read_place(Header &header, std::string_view field, std::string_view value) {
    const std::vector<double> numbers = numbers_of(value);
    const bool three = numbers.size() == 3 && std::isfinite(numbers[0] + numbers[1] + numbers[2]);
    if (field == "spacings") {
        if (!three)
            header.error = "an NRRD header whose `spacings` are not three numbers";
        else
            std::copy(numbers.begin(), numbers.end(), header.spacings.begin());
    } else if (field == "space origin") {
        if (!three)
            header.error = "an NRRD header whose `space origin` is not three numbers";
        else
            header.origin = {numbers[0], numbers[1], numbers[2]};
    } else if (field == "space directions") {
        bool straight = numbers.size() == 9;
        for (std::size_t i = 0; straight && i < 9; ++i) {
            if (i % 4 == 0) {
                header.spacings[i / 4] = numbers[i];
                straight = numbers[i] > 0;
            } else {
                straight = numbers[i] == 0;
            }
        }
        if (!straight)
            header.error = "an NRRD header whose `space directions` are not along x, y and z, "
                           "upward: resample the grid along the axes, and turn the shape by "
                           "`rotate`";
    }
    for (double spacing : header.spacings)
        if (header.error.empty() && !(spacing > 0 && std::isfinite(spacing)))
            header.error = "an NRRD header with a spacing that is not above 0";
}

Header read_header(std::string_view &bytes) {
    Header header;
    bool first = true;
    for (;;) {
        std::size_t end = bytes.find('\n');
        if (end == bytes.npos) {
            header.error = "an NRRD header that never ends";
            return header;
        }
        std::string_view line = trimmed(bytes.substr(0, end));
        bytes.remove_prefix(end + 1);
        if (std::exchange(first, false) || line.starts_with('#')) continue;
        if (line.empty()) return header;
        std::size_t colon = line.find(':');
        if (colon == line.npos) continue;
        std::string_view field = line.substr(0, colon), value = trimmed(line.substr(colon + 1));
        if (field == "type") header.type = value;
        if (field == "encoding") header.encoding = value;
        if (field == "endian") header.endian = value;
        if (field == "dimension") header.dimension = parse_number(value).value_or(0);
        read_place(header, field, value);
        if (!header.error.empty()) return header;
        if (field == "data file" || field == "datafile")
            header.error =
                "an NRRD header whose data is elsewhere: write both into one file (.nrrd)";
        if ((field == "line skip" || field == "byte skip") && parse_number(value) != 0.0)
            header.error = fmt::format("an NRRD header with a `{}`: write the file without", field);
        if (field == "sizes")
            for (std::size_t &size : header.sizes) {
                double number = parse_number(next_word(value)).value_or(0);
                size = number >= 2 && number <= 4096 ? static_cast<std::size_t>(number) : 0;
            }
    }
}

// A number of `Number` at `at`, as a float; its bytes the other way round where `swap`.
template <class Number> float read_raw(const char *at, bool swap) {
    std::array<char, sizeof(Number)> raw;
    std::memcpy(raw.data(), at, raw.size());
    if (swap) std::reverse(raw.begin(), raw.end());
    return static_cast<float>(std::bit_cast<Number>(raw));
}

struct NumberType {
    std::size_t width = 0; // bytes
    float (*read)(const char *at, bool swap) = nullptr;
};
template <class Number> constexpr NumberType type_of() {
    return {sizeof(Number), read_raw<Number>};
}

// By all the names that the format has for one.
std::optional<NumberType> number_type(std::string_view name) {
    using Names = std::vector<std::string_view>;
    static const std::vector<std::pair<Names, NumberType>> types{
        {{"signed char", "int8", "int8_t"}, type_of<std::int8_t>()},
        {{"uchar", "unsigned char", "uint8", "uint8_t"}, type_of<std::uint8_t>()},
        {{"short", "short int", "signed short", "signed short int", "int16", "int16_t"},
         type_of<std::int16_t>()},
        {{"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"},
         type_of<std::uint16_t>()},
        {{"int", "signed int", "int32", "int32_t"}, type_of<std::int32_t>()},
        {{"uint", "unsigned int", "uint32", "uint32_t"}, type_of<std::uint32_t>()},
        {{"longlong", "long long", "long long int", "signed long long", "signed long long int",
          "int64", "int64_t"},
         type_of<std::int64_t>()},
        {{"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"},
         type_of<std::uint64_t>()},
        {{"float"}, type_of<float>()},
        {{"double"}, type_of<double>()}};
    for (const auto &[names, type] : types)
        if (std::find(names.begin(), names.end(), name) != names.end()) return type;
    return std::nullopt;
}

// The first `count` bytes that `packed` (gzip) holds, or fewer where there are fewer.
std::string unpacked(std::string_view packed, std::size_t count) {
    std::string bytes(count, '\0');
    z_stream stream{};
    constexpr int gzip = 16 + MAX_WBITS;
    if (inflateInit2(&stream, gzip) != Z_OK) return {};
    std::size_t read = 0, made = 0;
    const auto piece = [](std::size_t left) {
        return static_cast<uInt>(std::min<std::size_t>(left, std::size_t{1} << 30));
    };
    int state = Z_OK;
    while (state == Z_OK && made < count) {
        const uInt in = piece(packed.size() - read), out = piece(count - made);
        stream.next_in = reinterpret_cast<Bytef *>(const_cast<char *>(packed.data() + read));
        stream.avail_in = in;
        stream.next_out = reinterpret_cast<Bytef *>(bytes.data() + made);
        stream.avail_out = out;
        state = inflate(&stream, Z_NO_FLUSH); // Z_BUF_ERROR where nothing is left to read
        read += in - stream.avail_in;
        made += out - stream.avail_out;
    }
    inflateEnd(&stream);
    bytes.resize(made);
    return bytes;
}

std::variant<ir::GridData, LoadError> decode_nrrd(std::string_view bytes, Room &room) {
    const Header header = read_header(bytes);
    if (!header.error.empty()) return no_grid(header.error);
    const std::optional<NumberType> type = number_type(header.type);
    if (!type)
        return no_grid(fmt::format(
            "an NRRD grid whose `type` is `{}`, and not `float`, `double` or one of integers "
            "(`uint8`, `int16`, `uint16`, …)",
            header.type));
    if (header.dimension != 3) return no_grid("an NRRD grid that has not three dimensions");
    for (std::size_t size : header.sizes)
        if (size == 0)
            return no_grid("an NRRD grid whose `sizes` are not three numbers from 2 to 4096");
    const bool raw = header.encoding == "raw";
    const bool packed = header.encoding == "gzip" || header.encoding == "gz";
    const bool words =
        header.encoding == "ascii" || header.encoding == "text" || header.encoding == "txt";
    if (!raw && !packed && !words)
        return no_grid(
            fmt::format("an NRRD grid whose `encoding` is `{}`, and not `raw`, `gzip` or `ascii`",
                        header.encoding));
    if (type->width > 1 && !words && header.endian != "little" && header.endian != "big")
        return no_grid("an NRRD grid whose `endian` is neither `little` nor `big`");
    const std::size_t count = header.sizes[0] * header.sizes[1] * header.sizes[2];
    ir::GridData grid;
    if (auto wrong = make_place({header.sizes[0], header.sizes[1], header.sizes[2]},
                                packed ? count * type->width : 0, room, grid))
        return *wrong;
    for (std::size_t i = 0; i < 3; ++i) {
        const double extent = header.spacings[i] * static_cast<double>(header.sizes[i] - 1);
        grid.lo[i] = header.origin ? (*header.origin)[i] : -extent / 2;
        grid.hi[i] = grid.lo[i] + extent;
    }
    const char *too_few = "an NRRD grid with fewer values than its `sizes` say";
    if (words) {
        for (std::size_t i = 0; i < count; ++i) {
            const std::optional<double> value = parse_number(next_word(bytes));
            if (!value) return no_grid(too_few);
            grid.values.push_back(static_cast<float>(*value));
        }
    } else {
        std::string unpacked_bytes;
        if (packed) bytes = unpacked_bytes = unpacked(bytes, count * type->width);
        if (bytes.size() < count * type->width) return no_grid(too_few);
        const bool swap = (header.endian == "big") != (std::endian::native == std::endian::big);
        grid.values.reserve(count);
        for (std::size_t i = 0; i < count; ++i)
            grid.values.push_back(type->read(bytes.data() + i * type->width, swap));
    }
    if (auto wrong = take_grid(grid, room)) return *wrong;
    return grid;
}

} // namespace

std::optional<LoadError> make_place(const std::array<std::uint64_t, 3> &size, std::size_t extra,
                                    const Room &room, ir::GridData &grid) {
    const double voxels =
        static_cast<double>(size[0]) * static_cast<double>(size[1]) * static_cast<double>(size[2]);
    const std::string shape =
        fmt::format("its box has {} x {} x {} values", size[0], size[1], size[2]);
    // Not beyond what can be counted, so that a larger limit is a way out.
    if (voxels > static_cast<double>(max_values))
        return no_grid(shape + ", more than 1,073,741,824: crop it or make its voxels larger");
    const std::uint64_t count = size[0] * size[1] * size[2];
    if (count * sizeof(float) > room.bytes || extra > room.bytes - count * sizeof(float))
        return LoadError{LoadError::Reason::TooLarge,
                         shape + ", which take more memory than is left"};
    if (count / 16 > room.steps)
        return LoadError{LoadError::Reason::TooMuchWork,
                         shape + ", which take more work than is left"};
    for (std::size_t i = 0; i < 3; ++i) grid.size[i] = static_cast<int>(size[i]);
    return std::nullopt;
}

std::optional<LoadError> take_grid(const ir::GridData &grid, Room &room) {
    for (float value : grid.values)
        if (!std::isfinite(value)) return no_grid("a grid with a value that is no finite number");
    room.bytes -= grid.values.size() * sizeof(float);
    room.steps -= grid.values.size() / 16;
    return std::nullopt;
}

std::variant<ir::GridData, LoadError> decode_grid(std::string_view bytes, Room &room,
                                                  const std::string &name) {
    if (is_vdb(bytes)) return decode_vdb(bytes, room, name);
    if (!name.empty())
        return no_grid("not an OpenVDB file, whose grids have names: leave `grid` out");
    if (bytes.starts_with("NRRD000")) return decode_nrrd(bytes, room);
    return no_grid("neither an NRRD nor an OpenVDB grid");
}

} // namespace fathom::driver
