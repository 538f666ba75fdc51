// fathom slice: where planes cut a solid, as files of contours or pictures.
#include "base/text.h"
#include "cli/frames.h"
#include "cli/interrupt.h"
#include "cli/solid.h"

#include <fathom/slice.h>

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace fathom::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string bytes_of(const v1::Slices &cut, std::size_t k, const SliceCommand &command,
                     const std::string &suffix) {
    const UnitRow *unit = unit_named(command.solid.units);
    const v1::MeshUnit of = unit ? unit->unit : v1::MeshUnit::Unsaid;
    if (suffix == ".dxf") return v1::dxf_file(cut, k, of);
    if (suffix == ".png")
        return v1::encode_png(v1::slice_picture(cut, k, command.width, command.height));
    return v1::svg_file(cut, k, of,
                        command.solid.flat
                            ? command.solid.scene.file
                            : fmt::format("{} at {} = {}", command.solid.scene.file, command.axis,
                                          format_shortest(cut.slices[k].at)));
}

// `out`: with the frame's number, where there are frames; then there is one height.
std::string file_of(const SliceCommand &command, const std::string &out, std::size_t k) {
    return !command.solid.frames.numbers.empty() ||
                   (command.heights.size() == 1 && out.find('#') == out.npos)
               ? out
               : frame_name(out, static_cast<int>(k));
}

Json json_of(const v1::Slice &slice, const std::string &file) {
    Json json{{"at", slice.at},
              {"file", file},
              {"status", slice.certified ? "certified" : "partial"},
              {"contours", slice.contours.size()},
              {"area",
               {{"value", std::clamp(slice.contours_area, slice.area.lo, slice.area.hi)},
                {"least", slice.area.lo},
                {"most", slice.area.hi}}}};
    const auto everywhere = [&](double d) { return slice.certified ? Json(d) : Json(); };
    json["contours_to_border"] = everywhere(slice.contours_to_border);
    json["border_to_contours"] = everywhere(slice.border_to_contours);
    json["undecided_squares"] = slice.undecided_squares;
    return json;
}

void say_undecided(const v1::Slices &cut, const SliceCommand &command, const std::string &out,
                   Terminal &terminal) {
    std::size_t slices = 0, squares = 0;
    const v1::Slice *first = nullptr;
    for (const v1::Slice &slice : cut.slices) {
        if (slice.certified) continue;
        if (!first) first = &slice;
        ++slices;
        squares += slice.undecided_squares;
    }
    if (!first) return;
    const v1::PlaneBox &box = first->undecided.front();
    const bool flat = command.solid.flat; // a drawing has no height
    terminal.say(fmt::format(
        "{}: {} square{}{} may hold border that the contours do not show, the first of them{} from "
        "[{:.6g}, {:.6g}] to [{:.6g}, {:.6g}]; {}a larger `--resolution` tells more",
        out, squares, squares == 1 ? "" : "s",
        flat ? "" : fmt::format(" of {} slice{}", slices, slices == 1 ? "" : "s"),
        flat ? "" : fmt::format(" at {} = {}", command.axis, format_shortest(first->at)), box.lo[0],
        box.lo[1], box.hi[0], box.hi[1],
        flat ? "" : "another height, if a face lies in the plane, or "));
}

// Where no slice has a contour.
void say_empty(const v1::Slices &cut, const SliceCommand &command, const std::string &out,
               Terminal &terminal) {
    const auto &[from, to] = cut.along;
    const bool beside = std::ranges::all_of(
        cut.slices, [&](const v1::Slice &s) { return s.at < from || s.at > to; });
    const std::string where = fmt::format("which lies from {} = {} to {}", command.axis,
                                          format_shortest(from), format_shortest(to));
    if (beside)
        terminal.say(fmt::format("{}: no plane meets the solid, {}", out, where));
    else
        terminal.say(fmt::format("{}: no plane meets the solid{} in an area that squares of a side "
                                 "of {:.3g} show",
                                 out, command.solid.flat ? "" : ", " + where + ",", cut.side));
}

// Refused before any work is done.
Exit refused(const SliceCommand &command, const std::string &out, Terminal &terminal) {
    if (misnamed(out, Content::Slice, terminal)) return usage_error;
    if (out == "-" && command.heights.size() > 1) {
        terminal.say(
            "fathom: -o -: standard output takes one slice: name files, as layer_####.svg");
        return usage_error;
    }
    if (!command.solid.frames.numbers.empty()) return done; // their files are looked at as such
    for (const std::size_t k : {std::size_t{0}, command.heights.size() - 1}) {
        if (overwrites(command.solid.scene.file, file_of(command, out, k), terminal))
            return usage_error;
        if (unwritable(file_of(command, out, k), terminal)) return device_error;
    }
    return done;
}

Exit make(const SliceCommand &command, const SolidFrame &frame, Terminal &terminal) {
    const v1::Axis axis = command.axis == 'x'   ? v1::Axis::X
                          : command.axis == 'y' ? v1::Axis::Y
                                                : v1::Axis::Z;
    v1::MeshOptions options = options_of(frame.arguments);
    options.progress = frame.progress;
    std::vector<float> heights(command.heights.begin(), command.heights.end());
    const v1::Slices cut = v1::slice(frame.scene, axis, heights, options);
    stop_if_interrupted(terminal); // nothing is written
    terminal.finish_progress();
    if (!cut)
        return say_refusal(command.solid, frame.number ? frame.out : command.solid.scene.file,
                           "slices", cut.status, cut.message, terminal);
    say_undecided(cut, command, frame.out, terminal);
    if (!cut.message.empty()) terminal.say(fmt::format("{}: {}", frame.out, cut.message));
    Json json{{"axis", std::string(1, command.axis)}, {"side", cut.side}};
    json["slices"] = Json::array();
    std::size_t empty = 0;
    for (std::size_t k = 0; k < cut.slices.size(); ++k) {
        const std::string file = file_of(command, frame.out, k);
        const std::string bytes =
            bytes_of(cut, k, command, command.out == "-" ? ".svg" : suffix_of(file));
        if (bytes.empty()) throw std::bad_alloc();
        if (const Exit exit = write_result(file, bytes, terminal); exit != done) return exit;
        if (Interrupts::noticed()) Interrupts::obey(); // between files, each of them whole
        json["slices"].push_back(json_of(cut.slices[k], file));
        empty += cut.slices[k].contours.empty();
    }
    if (empty == cut.slices.size()) say_empty(cut, command, frame.out, terminal);
    json["rests_on"] = cut.rests_on;
    if (command.solid.json) terminal.put(frame_json(frame, json.dump()) + "\n");
    return done;
}

} // namespace

Exit run(const SliceCommand &given, Terminal &terminal) {
    SliceCommand command = given;
    if (command.axis == 0) { // no height: the scene is flat
        command.solid.flat = true;
        command.axis = 'z';
        command.heights = {0};
    }
    const std::string out = with_places(command.out);
    if (const Exit exit = refused(command, out, terminal); exit != done) return exit;
    return make_frames(command.solid, out, terminal, [&](const SolidFrame &frame) {
        if (!frame.number)
            for (std::size_t k = 0; k < command.heights.size(); ++k)
                if (overwrites(frame.files, file_of(command, out, k), terminal)) return usage_error;
        return make(command, frame, terminal);
    });
}

} // namespace fathom::cli
