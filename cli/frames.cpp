#include "cli/frames.h"

#include "base/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <numbers>

namespace fathom::cli {

std::vector<int> frames_of_film(const RenderCommand &command) {
    if (!command.frames.numbers.empty()) return command.frames.numbers;
    std::vector<int> numbers(static_cast<std::size_t>(std::max(command.turntable, 1)));
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<int>(i);
    return numbers;
}

std::vector<int> frames_to_make(const RenderCommand &command) {
    if (!command.only.numbers.empty()) return command.only.numbers;
    std::vector<int> film = frames_of_film(command);
    const auto cells = static_cast<std::size_t>(command.sheet.first) *
                       static_cast<std::size_t>(command.sheet.second);
    if (cells == 0 || film.size() <= cells) return film;
    std::vector<int> chosen;
    for (std::size_t i = 0; i < cells; ++i) chosen.push_back(film[i * film.size() / cells]);
    return chosen;
}

Moment moment_of(const RenderCommand &command, int frame) {
    Moment moment;
    // A turntable shows one moment from all sides.
    const bool moves = !command.frames.numbers.empty() && command.turntable == 0;
    moment.time = command.time + (moves ? frame / command.frame_rate : 0);
    moment.open = command.shutter / command.frame_rate;
    if (command.turntable > 0)
        moment.turned = 2 * std::numbers::pi * (frame % command.turntable) / command.turntable;
    return moment;
}

double latest_time(const RenderCommand &command, const std::vector<int> &frames) {
    const Moment moment = moment_of(command, frames.back());
    return moment.time + moment.open;
}

std::vector<Definition> swept(const RenderCommand &command, int frame) {
    return swept(command.sweeps, frames_of_film(command), frame);
}

std::vector<Definition> swept(const std::vector<Sweep> &sweeps, const std::vector<int> &film,
                              int frame) {
    std::vector<Definition> values;
    for (const Sweep &sweep : sweeps) {
        const int length = film.back() - film.front() + (sweep.to_last ? 0 : 1);
        const double share = length > 0 ? static_cast<double>(frame - film.front()) / length : 0;
        // At its ends the value is what was written, to the bit.
        const double value = share == 1 ? sweep.to : sweep.from + share * (sweep.to - sweep.from);
        values.push_back({sweep.name, format_shortest(value)});
    }
    return values;
}

std::string with_places(const std::string &out) {
    const std::size_t begin = out.rfind('%'), end = out.find('d', begin);
    if (begin == out.npos || end == out.npos || out.find('#') != out.npos) return out;
    const std::string_view digits = std::string_view(out).substr(begin + 1, end - begin - 1);
    const std::optional<double> count = digits.empty() ? 1 : parse_number(digits);
    if (!count || !(*count >= 1 && *count <= 12) ||
        digits.find_first_not_of("0123456789") != digits.npos)
        return out;
    return out.substr(0, begin) + std::string(static_cast<std::size_t>(*count), '#') +
           out.substr(end + 1);
}

std::string frame_name(const std::string &name, int frame) {
    const std::string out = with_places(name);
    std::size_t last = out.find_last_of('#');
    if (last != out.npos) {
        std::size_t before = out.find_last_not_of('#', last);
        std::size_t first = before == out.npos ? 0 : before + 1;
        return fmt::format("{}{:0{}}{}", out.substr(0, first), frame, last + 1 - first,
                           out.substr(last + 1));
    }
    std::filesystem::path path(out);
    path.replace_filename(
        fmt::format("{}_{:04}{}", path.stem().string(), frame, path.extension().string()));
    return path.string();
}

int tile_row(int height, int i, int n) {
    return static_cast<int>(static_cast<long long>(height) * i / n);
}

std::string words_of_frames(const std::vector<int> &frames) {
    std::string words;
    for (std::size_t i = 0; i < frames.size();) {
        std::size_t end = i + 1;
        while (end < frames.size() && frames[end] == frames[end - 1] + 1) ++end;
        words += words.empty() ? "" : ",";
        words += end - i > 1 ? fmt::format("{}..={}", frames[i], frames[end - 1])
                             : fmt::format("{}", frames[i]);
        i = end;
    }
    return words;
}

} // namespace fathom::cli
