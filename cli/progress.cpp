#include "cli/progress.h"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace fathom::cli {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

namespace {

// Milliseconds; JSON has no infinity, and a reader no use for more digits.
Json rounded(double seconds) {
    return seconds < 0 ? Json() : Json(std::round(1000 * seconds) / 1000);
}

std::string line_of(const Json &json) {
    return json.dump(-1, ' ', true, Json::error_handler_t::replace);
}

} // namespace

Progress::Progress(ProgressFormat format, std::size_t frames, Terminal &terminal)
    : format_(format), frames_(frames), terminal_(terminal), begin_(Clock::now()), next_(begin_) {}

double Progress::seconds() const {
    return std::chrono::duration<double>(Clock::now() - begin_).count();
}

// Frames that were kept took no time.
double Progress::left(double frames_made) const {
    const double all = static_cast<double>(frames_ - kept_);
    return frames_made > 0 ? seconds() / frames_made * (all - frames_made) : -1;
}

void Progress::share(const std::string &file, double share) {
    const double made = static_cast<double>(done_ - kept_) + share;
    if (format_ == ProgressFormat::Bar) {
        terminal_.progress(
            file, (static_cast<double>(done_) + share) / static_cast<double>(frames_), left(made));
        return;
    }
    if (Clock::now() < next_) return;
    next_ = Clock::now() + std::chrono::seconds(1);
    terminal_.say(line_of(Json{{"event", "progress"},
                               {"done", done_},
                               {"of", frames_},
                               {"share", std::round(1000 * share) / 1000},
                               {"seconds", rounded(seconds())},
                               {"left", rounded(left(made))}}));
}

void Progress::finished(int frame, const std::string &file, bool kept) {
    ++done_;
    if (kept) ++kept_;
    if (format_ == ProgressFormat::Bar) return;
    terminal_.say(line_of(Json{{"event", kept ? "kept" : "made"},
                               {"frame", frame},
                               {"file", file},
                               {"done", done_},
                               {"of", frames_},
                               {"seconds", rounded(seconds())},
                               {"left", rounded(left(static_cast<double>(done_ - kept_)))}}));
}

} // namespace fathom::cli
