#include "viewer/panels.h"
#include "base/srgb.h"

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
                                   ImGuiWindowFlags_NoSavedSettings |
                                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

// A diagnostic as it is printed: the head in its colour, the line that underlines in another, the
// help in a third.
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

void show_messages(const char *name, const std::vector<std::string> &messages, const ImVec4 &head,
                   float top) {
    constexpr std::size_t maximum = 6;
    ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({12, top});
    ImGui::SetNextWindowBgAlpha(0.85f);
    ImGui::SetNextWindowSizeConstraints(
        {0, 0}, {std::max(size.x - 24, 50.0f), std::max(size.y - 80, 50.0f)});
    ImGui::Begin(name, nullptr,
                 plain | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_HorizontalScrollbar);
    for (std::size_t i = 0; i < std::min(maximum, messages.size()); ++i)
        show_diagnostic(messages[i], head);
    if (messages.size() > maximum) ImGui::Text("and %zu more", messages.size() - maximum);
    ImGui::End();
}

// Its height.
float show_status(const Shown &shown) {
    const Status &status = shown.status;
    ImVec2 size = ImGui::GetIO().DisplaySize;
    const std::size_t remarks = shown.remarks.size();
    std::vector<std::string> parts{
        shown.file + (shown.errors.empty() ? "" : " (last good)"),
        status.bound + (status.bound_now.empty() ? "" : ", " + status.bound_now),
        fmt::format("front end {:.1f} ms", status.front_end_ms),
        fmt::format("{:.1f} KB GLSL", static_cast<double>(status.shader_bytes) / 1024),
        status.linked_anew ? fmt::format("driver {:.0f} ms", status.driver_ms)
                           : std::string("driver untouched"),
        fmt::format("frame {:.1f} ms", status.frame_ms),
        fmt::format("{:.1f} steps a ray", status.mean_steps),
        fmt::format("{}x{}", status.width, status.height),
        "? keys"};
    if (!status.lists.empty()) parts.insert(parts.end() - 2, status.lists);
    if (remarks)
        parts.insert(parts.begin() + 2,
                     fmt::format("{} remark{} (N)", remarks, remarks == 1 ? "" : "s"));
    std::vector<std::string> lines;
    for (const std::string &line : {status.trouble, shown.doing, status.note})
        if (!line.empty()) lines.push_back(line);
    const float room = size.x - 2 * ImGui::GetStyle().WindowPadding.x;
    bool begun = false; // a line of parts
    for (const std::string &part : parts) {
        if (part.empty()) continue;
        const std::string longer = begun ? lines.back() + " | " + part : part;
        if (begun && ImGui::CalcTextSize(longer.c_str()).x <= room)
            lines.back() = longer;
        else
            lines.push_back(part);
        begun = true;
    }
    const float height = ImGui::GetTextLineHeightWithSpacing() * static_cast<float>(lines.size()) +
                         ImGui::GetStyle().WindowPadding.y * 2;
    ImGui::SetNextWindowPos({0, size.y - height});
    ImGui::SetNextWindowSize({size.x, height});
    ImGui::SetNextWindowBgAlpha(0.7f);
    ImGui::Begin("status", nullptr, plain | ImGuiWindowFlags_NoInputs);
    for (const std::string &line : lines) ImGui::TextUnformatted(line.c_str());
    ImGui::End();
    return height;
}

void show_keys(bool &open) {
    struct Row {
        const char *keys, *what;
    };
    static constexpr std::array rows{
        Row{"click", "name a shape, outline it, open its line ($EDITOR)"},
        Row{"O", "open the selected shape's line, in a terminal too"},
        Row{"drag", "turn round the target"},
        Row{"right drag, shift drag", "move the target across the picture"},
        Row{"wheel, + and -", "nearer, farther"},
        Row{"W A S D, Q E", "fly: forward, left, back, right, down, up"},
        Row{"F, Z", "frame everything, the selected shape"},
        Row{"1 3 7", "from the front, the right, the top"},
        Row{"5", "perspective or orthographic"},
        Row{"V", "one, two or four views"},
        Row{"R", "the scene's own camera"},
        Row{"C, Ctrl S", "copy the camera as a line, write the views into the file"},
        Row{"Tab", "show or hide the params"},
        Row{"[ ], comma period", "choose a param, change it (shift: more)"},
        Row{"Y, I, Del", "copy its value, write it into the file, reset it"},
        Row{"Backspace", "all params back to the text's values"},
        Row{"H B L K", "colours: steps, bound, slice, check of steps"},
        Row{"2", "the noise cache at work: misses red"},
        Row{"4", "the noise cache, or none, while it is moved"},
        Row{"G", "the analysis panel"},
        Row{"X, J", "FXAA, four samples at rest"},
        Row{"T, U", "turn by itself, draw as fast as it can"},
        Row{"Space, 0", "stop and run time, set it to 0"},
        Row{"N", "show or hide warnings and notes"},
        Row{"P, M", "save a picture of the window, every frame"},
        Row{"Esc", "close a menu, these keys; select nothing"},
        Row{"?, F1", "these keys"},
        Row{"Ctrl Q", "close"},
    };
    ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {size.x - 20, std::max(size.y - 20, 60.0f)});
    ImGui::SetNextWindowBgAlpha(0.92f);
    ImGui::Begin("Keys", &open,
                 ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse |
                     ImGuiWindowFlags_NoSavedSettings);
    if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
        for (const Row &row : rows)
            for (const char *cell : {row.keys, row.what}) {
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(cell);
            }
        ImGui::EndTable();
    }
    ImGui::End();
}

const char *label_of(const ir::Param &param) {
    return param.label.empty() ? param.name.c_str() : param.label.c_str();
}

// One param's widget; true where its value changed.
bool edit(ir::Param &param) {
    const char *label = label_of(param);
    if (param.type == ir::Type::Bool) {
        bool on = param.value[0] != 0;
        bool edited = ImGui::Checkbox(label, &on);
        param.value[0] = on;
        return edited;
    }
    if (param.type == ir::Type::Int) {
        int value = static_cast<int>(param.value[0]);
        bool edited = param.has_range
                          ? ImGui::SliderInt(label, &value, static_cast<int>(param.lo[0]),
                                             static_cast<int>(param.hi[0]), "%d",
                                             ImGuiSliderFlags_AlwaysClamp)
                          : ImGui::DragInt(label, &value);
        param.value[0] = value;
        return edited;
    }
    std::size_t count = static_cast<std::size_t>(ir::components(param.type));
    std::array<float, 4> value{};
    for (std::size_t i = 0; i < count; ++i)
        value[i] =
            static_cast<float>(param.is_color ? srgb_of_linear(param.value[i]) : param.value[i]);
    bool edited = false;
    if (param.is_color) {
        edited = ImGui::ColorEdit3(label, value.data());
    } else if (count == 1) {
        float lo = static_cast<float>(param.lo[0]), hi = static_cast<float>(param.hi[0]);
        edited = param.has_range ? ImGui::SliderFloat(label, &value[0], lo, hi, "%.4g",
                                                      ImGuiSliderFlags_AlwaysClamp)
                                 : ImGui::DragFloat(label, &value[0], 0.01f, 0, 0, "%.4g");
    } else {
        for (std::size_t i = 0; i < count; ++i) { // by component: each has its own range
            std::string part = fmt::format("{}.{}", label, "xyzw"[i]);
            float lo = static_cast<float>(param.lo[i]), hi = static_cast<float>(param.hi[i]);
            edited |= param.has_range
                          ? ImGui::SliderFloat(part.c_str(), &value[i], lo, hi, "%.4g",
                                               ImGuiSliderFlags_AlwaysClamp)
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

// Where the buttons of all params stand: behind the longest label.
float button_column(const std::vector<ir::Param> &params, float item_width) {
    float longest = 0;
    for (const ir::Param &param : params) {
        const bool by_component = !param.is_color && ir::components(param.type) > 1;
        const std::string label = std::string(label_of(param)) + (by_component ? ".x" : "");
        longest = std::max(longest, ImGui::CalcTextSize(label.c_str()).x);
    }
    const ImGuiStyle &style = ImGui::GetStyle();
    return style.WindowPadding.x + item_width + style.ItemInnerSpacing.x + longest +
           style.ItemSpacing.x;
}

void show_params(Controls &controls, std::vector<ir::Param> &params, Asked &asked) {
    ImVec2 size = ImGui::GetIO().DisplaySize;
    // While something is held the panel stays where it is, whatever a reload makes of it.
    const ImGuiCond place = ImGui::IsAnyItemActive() ? ImGuiCond_Appearing : ImGuiCond_Always;
    ImGui::SetNextWindowPos({size.x - 12, 12}, place, {1, 0});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {size.x - 24, std::max(size.y - 80, 50.0f)});
    ImGui::SetNextWindowBgAlpha(0.8f);
    ImGui::Begin("Params", nullptr,
                 ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoFocusOnAppearing);
    const float item_width = ImGui::GetFontSize() * 12, buttons = button_column(params, item_width);
    ImGui::PushItemWidth(item_width);
    for (std::size_t i = 0; i < params.size(); ++i) {
        ir::Param &param = params[i];
        // Its own, also where a reload moves it in the list; modules may have the same names.
        ImGui::PushID(param.name.c_str());
        ImGui::PushID(static_cast<int>(
            std::count_if(params.begin(), params.begin() + static_cast<std::ptrdiff_t>(i),
                          [&](const ir::Param &other) { return other.name == param.name; })));
        const bool chosen = i == controls.chosen;
        if (chosen) ImGui::PushStyleColor(ImGuiCol_Text, yellow);
        bool edited = edit(param);
        if (chosen) ImGui::PopStyleColor();
        if (ImGui::IsItemActivated()) controls.chosen = i;
        if (ImGui::BeginPopupContextItem("more")) {
            if (ImGui::MenuItem("Back to the text's value")) {
                param.value = param.initial;
                edited = true;
            }
            if (ImGui::MenuItem("Copy the value")) asked.copy.push_back(i);
            if (ImGui::MenuItem("Write it into the file")) asked.write.push_back(i);
            ImGui::EndPopup();
        }
        // What stands off the text's value can be sent back, or into the text. The buttons have
        // their room also where they do nothing: a panel that grew would run away under the mouse.
        ImGui::BeginDisabled(!changed(param));
        ImGui::SameLine(buttons);
        if (ImGui::SmallButton("reset")) {
            param.value = param.initial;
            edited = true;
        }
        ImGui::SameLine();
        if (ImGui::SmallButton("write")) asked.write.push_back(i);
        ImGui::EndDisabled();
        if (edited) asked.changed.push_back(i);
        ImGui::PopID();
        ImGui::PopID();
    }
    ImGui::PopItemWidth();
    ImGui::End();
}

void show_words_at(const std::string &words, float x, float y, const ImVec4 &color) {
    ImDrawList *list = ImGui::GetBackgroundDrawList();
    list->AddText({x + 1, y + 1}, IM_COL32(0, 0, 0, 200), words.c_str());
    list->AddText({x, y}, ImGui::GetColorU32(color), words.c_str());
}

void show_picked(const Shown &shown, float below, bool tooltip) {
    if (!shown.selected.empty()) {
        const ImVec2 size = ImGui::CalcTextSize(shown.selected.c_str());
        const ImVec2 window = ImGui::GetIO().DisplaySize;
        show_words_at(shown.selected, std::max((window.x - size.x) / 2, 8.0f),
                      window.y - below - size.y - 6, {1.0f, 0.75f, 0.35f, 1});
    }
    if (tooltip && !shown.hovered.empty() && !ImGui::GetIO().WantCaptureMouse)
        ImGui::SetTooltip("%s", shown.hovered.c_str());
}

} // namespace

Asked show_panels(Controls &controls, const Shown &shown, std::vector<ir::Param> &params) {
    Asked asked;
    for (const auto &[name, place] : shown.view_names)
        show_words_at(name, place[0] + 8, place[1] + 6, pale);
    if (controls.look == gl::Look::Slice)
        for (const IsolineLabel &label : shown.labels) {
            const std::string words = fmt::format("{:.3g}", label.value + 0.0);
            const ImVec2 size = ImGui::CalcTextSize(words.c_str());
            show_words_at(words, label.x - size.x / 2, label.y - size.y / 2, pale);
        }
    if (!shown.picture && shown.errors.empty()) {
        const ImVec2 window = ImGui::GetIO().DisplaySize;
        const ImVec2 room = ImGui::CalcTextSize(shown.doing.c_str());
        show_words_at(shown.doing, (window.x - room.x) / 2, (window.y - room.y) / 2, pale);
    }
    const float status_height = show_status(shown);
    show_picked(shown, status_height, !controls.keys);
    if (controls.params && !params.empty()) show_params(controls, params, asked);
    if (controls.analysis || controls.look != gl::Look::Picture)
        show_analysis(controls, shown, asked);
    if (!shown.errors.empty())
        show_messages("errors", shown.errors, red, 12);
    else if (controls.remarks && !shown.remarks.empty())
        show_messages("remarks", shown.remarks, yellow, 12);
    if (controls.keys) show_keys(controls.keys);
    return asked;
}

} // namespace fathom::viewer
