#include "viewer/panels.h"

#include "viewer/params.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <imgui.h>

namespace fathom::viewer {
namespace {

const ImVec4 red{1.0f, 0.45f, 0.4f, 1}, yellow{1.0f, 0.85f, 0.4f, 1}, green{0.55f, 0.9f, 0.6f, 1},
    pale{0.92f, 0.92f, 0.92f, 1};
constexpr ImGuiWindowFlags plain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                   ImGuiWindowFlags_NoNav;

// A diagnostic as it is printed: the head in its colour, the line that underlines in another, the help in a third.
void show_diagnostic(const std::string &text, const ImVec4 &head) {
    std::size_t begin = 0;
    bool first = true;
    while (begin < text.size()) {
        std::size_t end = std::min(text.find('\n', begin), text.size());
        std::string_view line(text.data() + begin, end - begin);
        const ImVec4 *color = &pale;
        if (first)
            color = &head;
        else if (line.find("help:") != line.npos)
            color = &green;
        else if (line.find('^') != line.npos)
            color = &yellow;
        ImGui::PushStyleColor(ImGuiCol_Text, *color);
        ImGui::TextUnformatted(line.data(), line.data() + line.size());
        ImGui::PopStyleColor();
        first = false;
        begin = end + 1;
    }
    ImGui::Spacing();
}

void show_messages(const char *name, const std::vector<std::string> &messages, const ImVec4 &head, float top) {
    constexpr std::size_t most = 6;
    ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({12, top});
    ImGui::SetNextWindowBgAlpha(0.85f);
    ImGui::SetNextWindowSizeConstraints({0, 0}, {std::max(size.x - 24, 50.0f), std::max(size.y - 80, 50.0f)});
    ImGui::Begin(name, nullptr, plain | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_HorizontalScrollbar);
    for (std::size_t i = 0; i < std::min(most, messages.size()); ++i) show_diagnostic(messages[i], head);
    if (messages.size() > most) ImGui::Text("and %zu more", messages.size() - most);
    ImGui::End();
}

void show_status(const Status &status, const std::string &file, bool has_errors, std::size_t remarks) {
    ImVec2 size = ImGui::GetIO().DisplaySize;
    float height = ImGui::GetFrameHeight() + 6;
    ImGui::SetNextWindowPos({0, size.y - height});
    ImGui::SetNextWindowSize({size.x, height});
    ImGui::SetNextWindowBgAlpha(0.7f);
    ImGui::Begin("status", nullptr, plain | ImGuiWindowFlags_NoInputs);
    std::string line = fmt::format(
        "{}{} | {} | front end {:.1f} ms | {:.1f} KB GLSL | {} | frame {:.1f} ms", file, has_errors ? " (last good)" : "",
        status.bound, status.front_end_ms, static_cast<double>(status.shader_bytes) / 1024,
        status.linked_anew ? fmt::format("driver {:.0f} ms", status.link_ms) : std::string("driver untouched"),
        status.frame_ms);
    if (remarks) line += fmt::format(" | {} remark{} (N)", remarks, remarks == 1 ? "" : "s");
    line += " | ? keys";
    if (!status.note.empty()) line += " | " + status.note;
    ImGui::TextUnformatted(line.c_str());
    ImGui::End();
}

void show_keys(bool &open) {
    static constexpr std::array<std::array<const char *, 2>, 17> rows{{
        {"drag", "turn round the target"},
        {"right drag, shift drag", "move the target across the picture"},
        {"wheel, + and -", "nearer, farther"},
        {"W A S D, Q E", "fly: forward, left, back, right, down, up"},
        {"F", "frame everything"},
        {"1 3 7", "from the front, the right, the top"},
        {"5", "perspective or orthographic"},
        {"R", "the scene's own camera"},
        {"C", "copy the camera as a line of the scene"},
        {"Tab", "show or hide the sliders"},
        {"Backspace", "all sliders back to the text's values"},
        {"H", "picture, or steps per ray as colours"},
        {"Space, 0", "stop and run time, set it to 0"},
        {"N", "show or hide warnings and notes"},
        {"P", "save a picture of the window"},
        {"?, F1", "these keys"},
        {"Ctrl Q", "close"},
    }};
    ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowBgAlpha(0.9f);
    ImGui::Begin("Keys", &open,
                 ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
    if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
        for (const auto &row : rows)
            for (const char *cell : row) {
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(cell);
            }
        ImGui::EndTable();
    }
    ImGui::End();
}

// One param's widget; true where its value changed.
bool edit(ir::Param &param) {
    const char *label = param.label.empty() ? param.name.c_str() : param.label.c_str();
    if (param.type == ir::Type::Bool) {
        bool on = param.value[0] != 0;
        bool edited = ImGui::Checkbox(label, &on);
        param.value[0] = on;
        return edited;
    }
    if (param.type == ir::Type::Int) {
        int value = static_cast<int>(param.value[0]);
        bool edited = param.has_range ? ImGui::SliderInt(label, &value, static_cast<int>(param.lo[0]),
                                                         static_cast<int>(param.hi[0]), "%d", ImGuiSliderFlags_AlwaysClamp)
                                      : ImGui::DragInt(label, &value);
        param.value[0] = value;
        return edited;
    }
    std::size_t count = static_cast<std::size_t>(ir::components(param.type));
    std::array<float, 4> value{};
    for (std::size_t i = 0; i < count; ++i)
        value[i] = static_cast<float>(param.is_color ? srgb_of_linear(param.value[i]) : param.value[i]);
    bool edited = false;
    if (param.is_color) {
        edited = ImGui::ColorEdit3(label, value.data());
    } else if (count == 1) {
        float lo = static_cast<float>(param.lo[0]), hi = static_cast<float>(param.hi[0]);
        edited = param.has_range ? ImGui::SliderFloat(label, &value[0], lo, hi, "%.4g", ImGuiSliderFlags_AlwaysClamp)
                                 : ImGui::DragFloat(label, &value[0], 0.01f, 0, 0, "%.4g");
    } else {
        for (std::size_t i = 0; i < count; ++i) { // by component: each has its own range
            std::string part = fmt::format("{}.{}", label, "xyzw"[i]);
            float lo = static_cast<float>(param.lo[i]), hi = static_cast<float>(param.hi[i]);
            edited |= param.has_range
                          ? ImGui::SliderFloat(part.c_str(), &value[i], lo, hi, "%.4g", ImGuiSliderFlags_AlwaysClamp)
                          : ImGui::DragFloat(part.c_str(), &value[i], 0.01f, 0, 0, "%.4g");
        }
    }
    if (!edited) return false;
    for (std::size_t i = 0; i < count; ++i) {
        double number = param.is_color ? linear_of_srgb(value[i]) : value[i];
        param.value[i] = param.has_range ? std::clamp(number, param.lo[i], param.hi[i]) : number;
    }
    return true;
}

Asked show_params(std::vector<ir::Param> &params) {
    Asked asked;
    ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x - 12, 12}, ImGuiCond_Always, {1, 0});
    ImGui::SetNextWindowBgAlpha(0.8f);
    ImGui::Begin("Params", nullptr,
                 ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::PushItemWidth(ImGui::GetFontSize() * 14);
    for (std::size_t i = 0; i < params.size(); ++i) {
        ir::Param &param = params[i];
        ImGui::PushID(static_cast<int>(i));
        bool edited = edit(param);
        if (ImGui::BeginPopupContextItem("more")) {
            if (ImGui::MenuItem("Back to the text's value")) {
                param.value = param.initial;
                edited = true;
            }
            if (ImGui::MenuItem("Copy the value")) asked.copy = value_text(param);
            ImGui::EndPopup();
        }
        if (edited) (param.structural ? asked.rebuild : asked.redraw) = true;
        ImGui::PopID();
    }
    ImGui::PopItemWidth();
    ImGui::End();
    return asked;
}

} // namespace

Asked show_panels(PanelState &state, const Status &status, const std::string &file, std::vector<ir::Param> &params,
                  const std::vector<std::string> &errors, const std::vector<std::string> &remarks) {
    Asked asked;
    if (state.params && !params.empty()) asked = show_params(params);
    if (!errors.empty())
        show_messages("errors", errors, red, 12);
    else if (state.remarks && !remarks.empty())
        show_messages("remarks", remarks, yellow, 12);
    if (state.keys) show_keys(state.keys);
    show_status(status, file, !errors.empty(), remarks.size());
    return asked;
}

} // namespace fathom::viewer
