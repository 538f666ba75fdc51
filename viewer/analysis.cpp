// The analysis panel (thesis, 6.5, and more): what is drawn in false colours, how fast, and at
// which size.
#include "viewer/panels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <imgui.h>

namespace fathom::viewer {
namespace {

void show_times(const char *what, const FrameTimes &times) {
    if (times.milliseconds.empty()) return;
    const double median = times.at_share(0.5), high = times.at_share(0.99);
    ImGui::Text("%s",
                fmt::format("{}: median {:.2f} ms, p99 {:.2f} ms", what, median, high).c_str());
    ImGui::PlotLines(fmt::format("##{}", what).c_str(), times.milliseconds.data(),
                     static_cast<int>(times.milliseconds.size()), 0, nullptr, 0,
                     static_cast<float>(2 * high),
                     {ImGui::GetFontSize() * 18, ImGui::GetFontSize() * 3});
}

// The ramp of the shaders (marcher.cpp, post.cpp) as a bar, with numbers under it.
void show_ramp(const std::vector<std::string> &marks) {
    constexpr int pieces = 64;
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetFontSize() * 18, height = ImGui::GetFontSize() * 0.8f;
    const auto channel = [](float x) { return static_cast<int>(255 * std::clamp(x, 0.0f, 1.0f)); };
    for (int i = 0; i < pieces; ++i) {
        const float x = (static_cast<float>(i) + 0.5f) / pieces, turn = 3.2f * x - 1.6f;
        ImGui::GetWindowDrawList()->AddRectFilled(
            {from.x + width * static_cast<float>(i) / pieces, from.y},
            {from.x + width * static_cast<float>(i + 1) / pieces, from.y + height},
            IM_COL32(channel(2 * x - 0.6f), channel(1.6f - (turn < 0 ? -turn : turn)),
                     channel(1 - 2.2f * x), 255));
    }
    ImGui::Dummy({width, height});
    for (std::size_t i = 0; i < marks.size(); ++i) {
        if (i)
            ImGui::SameLine(width * static_cast<float>(i) / static_cast<float>(marks.size() - 1) -
                            (i + 1 == marks.size() ? ImGui::GetFontSize() : 0));
        ImGui::TextUnformatted(marks[i].c_str());
    }
}

void show_look(Controls &controls, const Shown &shown, Asked &asked) {
    switch (controls.look) {
    case gl::Look::Picture: break;
    case gl::Look::Heat:
        show_ramp({"0 steps", fmt::to_string(shown.max_steps)});
        ImGui::Text("%s rays undecided (magenta)", fmt::to_string(shown.undecided).c_str());
        break;
    case gl::Look::Bound:
        ImGui::TextUnformatted("steps that the bound costs, times as many:");
        show_ramp({"1", "32"});
        break;
    case gl::Look::Slice: {
        constexpr const char *names[] = {"x", "y", "z"};
        for (int axis = 0; axis < 3; ++axis) {
            if (axis) ImGui::SameLine();
            asked.look |= ImGui::RadioButton(names[axis], &controls.slice_axis, axis);
        }
        float offset = static_cast<float>(controls.slice_offset);
        if (ImGui::SliderFloat("plane at", &offset, static_cast<float>(-shown.reach),
                               static_cast<float>(shown.reach), "%.3g")) {
            controls.slice_offset = offset;
            asked.look = true;
        }
        ImGui::TextUnformatted("the marched field; blue outside, brown inside, white 0");
        break;
    }
    case gl::Look::Check: {
        const auto &v = shown.verdicts;
        ImGui::Text("%zu pixels passed a surface (red)", v[1]);
        ImGui::Text("%zu stayed undecided (yellow), %zu could not be checked (pink)", v[2], v[3]);
        ImGui::TextUnformatted("against a march at a tenth of the step");
        break;
    }
    }
}

// What the noise cache did in its last frame, and how old its keys are (thesis, figure 8.3).
void show_cache(Controls &controls, const CacheFigures &cache) {
    ImGui::Separator();
    ImGui::Checkbox("noise cache while moving", &controls.use_cache);
    ImGui::SameLine();
    ImGui::Checkbox("misses red", &controls.cache);
    const auto line = [](const std::string &text) { ImGui::TextUnformatted(text.c_str()); };
    const gl::CacheOccupancy &there = cache.occupancy;
    line(fmt::format("{} keys in {} cells, {:.1f} %", there.keys, there.cells,
                     100.0 * static_cast<double>(there.keys) /
                         static_cast<double>(std::max<std::size_t>(there.cells, 1))));
    // Short lines: the panel takes the width of the frame before.
    line(fmt::format("last frame: {} hits, {} misses", cache.tally.hits, cache.tally.misses));
    line(fmt::format("{} pixels computed", cache.tally.computed));
    line(fmt::format("{} inserted, {} evicted", cache.counts.inserted, cache.counts.evicted));
    line(fmt::format("{} deleted, {} without room", cache.counts.deleted,
                     cache.counts.crowded + cache.counts.full));
    line(fmt::format("cached {:.1f} ms, exact {:.1f} ms: {}", cache.choice.cached_ms,
                     cache.choice.exact_ms,
                     !cache.looked_up ? "look-ups do not pay here"
                     : cache.choice.state == gl::CacheChoice::State::Exact    ? "drawn exactly"
                     : cache.choice.state == gl::CacheChoice::State::Learning ? "learning"
                                                                              : "cached"));
    std::array<float, glsl::cache_ages> ages{};
    for (std::size_t i = 0; i < ages.size(); ++i)
        ages[i] = std::log2(1 + static_cast<float>(there.ages[i]));
    ImGui::PlotHistogram("keys by age, log", ages.data(), static_cast<int>(ages.size()), 0, nullptr,
                         0, 21, {ImGui::GetFontSize() * 12, ImGui::GetFontSize() * 3});
}

} // namespace

void show_analysis(Controls &controls, const Shown &shown, Asked &asked) {
    ImVec2 display = ImGui::GetIO().DisplaySize;
    const float top = shown.errors.empty() ? 12.0f : display.y * 0.4f;
    ImGui::SetNextWindowPos({12, top}, ImGuiCond_Always);
    ImGui::SetNextWindowBgAlpha(0.8f);
    ImGui::Begin("Analysis", nullptr,
                 ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoCollapse);
    int look = static_cast<int>(controls.look);
    bool changed = false;
    constexpr const char *looks[] = {"picture", "steps", "bound", "slice", "check"};
    for (int i = 0; i < 5; ++i) {
        if (i) ImGui::SameLine();
        changed |= ImGui::RadioButton(looks[i], &look, i);
    }
    if (changed) {
        controls.look = static_cast<gl::Look>(look);
        asked.look = true;
    }
    show_look(controls, shown, asked);
    if (controls.analysis) {
        ImGui::Separator();
        asked.look |= ImGui::Checkbox("redraw always", &controls.always);
        ImGui::SameLine();
        asked.look |= ImGui::Checkbox("turn", &controls.rotate);
        ImGui::SameLine();
        asked.look |= ImGui::Checkbox("FXAA", &controls.fxaa);
        ImGui::SameLine();
        asked.look |= ImGui::Checkbox("4 samples", &controls.accumulate);
        std::array<int, 2> size{shown.status.width, shown.status.height};
        ImGui::PushItemWidth(ImGui::GetFontSize() * 10);
        if (ImGui::InputInt2("viewport", size.data(), ImGuiInputTextFlags_EnterReturnsTrue) &&
            size[0] > 15 && size[1] > 15)
            asked.size = size;
        ImGui::PopItemWidth();
        show_times("frame to frame", shown.frame_times);
        show_times("graphics card", shown.gpu_times);
        if (shown.cache) show_cache(controls, *shown.cache);
    }
    ImGui::End();
}

} // namespace fathom::viewer
