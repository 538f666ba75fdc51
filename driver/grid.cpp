// The subset of NRRD (teem.sourceforge.net/nrrd/format.html) that a grid of distances needs:
// attached data, three dimensions, float or double, raw or ascii encoding.
#include "base/text.h"
#include "driver/image.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

namespace fathom::driver {
namespace {

constexpr std::size_t max_values = std::size_t{1} << 26;

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
            if (i % 4 == 0)
                header.spacings[i / 4] = numbers[i];
            else
                straight = numbers[i] == 0;
        }
        if (!straight)
            header.error = "an NRRD header whose `space directions` are not along x, y and z";
    }
    for (double spacing : header.spacings)
        if (!(spacing > 0 && std::isfinite(spacing)))
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
            header.error = "an NRRD header whose data is elsewhere";
        if (field == "sizes")
            for (std::size_t &size : header.sizes) {
                double number = parse_number(next_word(value)).value_or(0);
                size = number >= 2 && number <= 4096 ? static_cast<std::size_t>(number) : 0;
            }
    }
}

template <class Float> Float read_raw(const char *at, bool swap) {
    std::array<char, sizeof(Float)> raw;
    std::memcpy(raw.data(), at, raw.size());
    if (swap) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<Float>(raw);
}

} // namespace

std::variant<ir::GridData, LoadError> decode_grid(std::string_view bytes, Room &room) {
    auto fail = [](std::string why) {
        return LoadError{LoadError::Reason::Unreadable, std::move(why)};
    };
    if (!bytes.starts_with("NRRD000")) return fail("not an NRRD grid");
    Header header = read_header(bytes);
    if (!header.error.empty()) return fail(header.error);
    bool doubles = header.type == "double";
    if (!doubles && header.type != "float")
        return fail("an NRRD grid whose `type` is neither `float` nor `double`");
    if (header.dimension != 3) return fail("an NRRD grid that has not three dimensions");
    for (std::size_t size : header.sizes)
        if (size == 0)
            return fail("an NRRD grid whose `sizes` are not three numbers from 2 to 4096");
    std::size_t count = header.sizes[0] * header.sizes[1] * header.sizes[2];
    if (count > max_values) return fail("an NRRD grid of more than 64 million values");
    if (count * sizeof(float) > room.bytes)
        return LoadError{LoadError::Reason::TooLarge, "takes more memory than is left"};
    if (count / 16 > room.steps)
        return LoadError{LoadError::Reason::TooMuchWork, "takes more work than is left"};

    ir::GridData grid;
    for (std::size_t i = 0; i < 3; ++i) {
        grid.size[i] = static_cast<int>(header.sizes[i]);
        const double extent = header.spacings[i] * static_cast<double>(header.sizes[i] - 1);
        grid.lo[i] = header.origin ? (*header.origin)[i] : -extent / 2;
        grid.hi[i] = grid.lo[i] + extent;
    }
    if (header.encoding == "raw") {
        std::size_t width = doubles ? sizeof(double) : sizeof(float);
        if (bytes.size() < count * width)
            return fail("an NRRD grid with fewer values than its `sizes` say");
        bool swap = (header.endian == "big") != (std::endian::native == std::endian::big);
        grid.values.reserve(count);
        for (std::size_t i = 0; i < count; ++i)
            grid.values.push_back(
                doubles ? static_cast<float>(read_raw<double>(bytes.data() + i * width, swap))
                        : read_raw<float>(bytes.data() + i * width, swap));
    } else if (header.encoding == "ascii" || header.encoding == "text" ||
               header.encoding == "txt") {
        for (std::size_t i = 0; i < count; ++i) {
            std::optional<double> value = parse_number(next_word(bytes));
            if (!value) return fail("an NRRD grid with fewer values than its `sizes` say");
            grid.values.push_back(static_cast<float>(*value));
        }
    } else {
        return fail("an NRRD grid whose `encoding` is neither `raw` nor `ascii`");
    }
    for (float value : grid.values)
        if (!std::isfinite(value))
            return fail("an NRRD grid with a value that is no finite number");
    room.bytes -= count * sizeof(float);
    room.steps -= count / 16;
    return grid;
}

} // namespace fathom::driver
