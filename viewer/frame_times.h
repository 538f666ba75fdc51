// The last frames' times, and what is said of them. Plain numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace fathom::viewer {

// The newest times, in milliseconds.
struct FrameTimes {
    static constexpr std::size_t maximum = 240;
    std::vector<float> milliseconds; // the newest last

    void add(double value) {
        if (milliseconds.size() == maximum) milliseconds.erase(milliseconds.begin());
        milliseconds.push_back(static_cast<float>(value));
    }
    // The value below which that share of all lie (nearest rank); 0 where there are none.
    double at_share(double share) const {
        if (milliseconds.empty()) return 0;
        std::vector<float> sorted = milliseconds;
        std::sort(sorted.begin(), sorted.end());
        const double rank = std::ceil(share * static_cast<double>(sorted.size()));
        return sorted[static_cast<std::size_t>(
                          std::clamp(rank, 1.0, static_cast<double>(sorted.size()))) -
                      1];
    }
};

} // namespace fathom::viewer
