// The main list of a save file: version, textures, materials, tree, lighting, and the unlabelled
// rest, in this order; and the layout of the text that comes of it.
#include "save-format/import/importer.h"

#include "base/encode.h"
#include "base/text.h"
#include "ir/shading.h"

#include <charconv>
#include <cmath>
#include <numbers>

namespace fathom::save {
namespace {

// Three levels of YAML a node (its list, its properties, its children), and some for values.
constexpr std::size_t levels_per_node = 3, levels_beside = 24;

struct Camera {
    double target[3], yaw, pitch, distance, fov;
    bool orthographic;
};

// Ten items: target, yaw and pitch in degrees, distance, field of view, three switches, of which
// the first is taken for the orthographic projection (the example's front, side and top views have
// it).
std::optional<Camera> camera_of(const Value &value) {
    if (value.kind != Value::Kind::Sequence || value.items.size() != 10) return std::nullopt;
    double numbers[7];
    for (std::size_t i = 0; i < 7; ++i) {
        const auto number = number_of(value.items[i]);
        if (!number || std::abs(*number) > 1e9) return std::nullopt;
        numbers[i] = *number;
    }
    const auto orthographic = switch_of(value.items[7]);
    if (!orthographic || numbers[5] <= 0 || numbers[6] <= 0 || numbers[6] >= 180)
        return std::nullopt;
    return Camera{{numbers[0], numbers[1], numbers[2]},
                  numbers[3],
                  numbers[4],
                  numbers[5],
                  numbers[6],
                  *orthographic};
}

// People read six digits; the exact camera is kept beside it.
double rounded(double value, double scale) {
    const double unit = std::pow(10, std::floor(std::log10(scale)) - 6);
    return std::round(value / unit) * unit;
}

double readable(double value, double scale) {
    const double close = rounded(value, scale);
    char text[48];
    const auto end =
        std::to_chars(text, text + sizeof text, close, std::chars_format::general, 12).ptr;
    return parse_number({text, static_cast<std::size_t>(end - text)}).value_or(close);
}

std::string camera_text(const Camera &camera) {
    const double degree = std::numbers::pi / 180;
    const double yaw = camera.yaw * degree, pitch = camera.pitch * degree;
    // The camera looks along Ry(yaw) Rx(pitch) (0, 0, -1), from `distance` before its target.
    const double away[3] = {std::cos(pitch) * std::sin(yaw), -std::sin(pitch),
                            std::cos(pitch) * std::cos(yaw)};
    double at[3];
    for (int i = 0; i < 3; ++i)
        at[i] = readable(camera.target[i] + camera.distance * away[i], camera.distance);
    return "camera(at: " + sdf_vector(at) + ", look_at: " + sdf_vector(camera.target) +
           ", fov: " + sdf_number(camera.fov) + "deg" +
           (camera.orthographic ? ", orthographic: true)" : ")");
}

// The unlabelled items behind the tree. The first is the largest number of steps; the ten-item
// lists are cameras, the lists of three views. All are kept as they are; the first two also become
// statements.
class Settings {
  public:
    void read(Importer &in, TakenValue taken) {
        const Value &value = taken.value;
        if (!seen_ && value.kind == Value::Kind::Scalar) {
            const auto steps = number_of(value);
            if (steps && *steps >= 1 && *steps <= 100000 && *steps == std::floor(*steps)) {
                if (*steps != ir::shading::budget) {
                    in.settings.push_back("render(max_steps: " + sdf_number(*steps) + in.limits +
                                          ")");
                    in.limits.clear();
                }
            } else {
                in.report.content(
                    value.span,
                    "the largest number of steps has to be a whole number from 1 to 100000");
            }
            in.keep("steps", "", std::move(taken.flow));
        } else if (value.kind == Value::Kind::Sequence && value.items.size() == 10) {
            cameras_.push_back(camera_of(value));
            if (!cameras_.back())
                in.report.content(value.span, "this camera's numbers make no sense")
                    .note("it is kept for an export");
            in.keep("camera", "", std::move(taken.flow));
        } else if (value.kind == Value::Kind::Sequence && value.items.size() == 3) {
            if (!view_) view_ = number_of(value.items[0]).value_or(0);
            in.keep("view", "", std::move(taken.flow));
        } else {
            if (value.kind == Value::Kind::Mapping)
                in.report.content(value.span, "this item of the main list is unknown")
                    .note("it is kept for an export");
            in.keep("setting", "", std::move(taken.flow));
        }
        seen_ = true;
    }

    // The camera of the first view, or the first one.
    void camera(Importer &in) const {
        if (!in.limits.empty()) in.settings.push_back("render(" + in.limits.substr(2) + ")");
        if (!in.camera.empty()) {
            in.settings.insert(in.settings.begin(), in.camera);
            return;
        }
        const double index = view_.value_or(0);
        const bool legal = index >= 0 && index < static_cast<double>(cameras_.size()) &&
                           index == std::floor(index);
        const std::size_t chosen = legal ? static_cast<std::size_t>(index) : 0;
        if (chosen < cameras_.size() && cameras_[chosen])
            in.settings.insert(in.settings.begin(), camera_text(*cameras_[chosen]));
    }

  private:
    bool seen_ = false;
    std::vector<std::optional<Camera>> cameras_;
    std::optional<double> view_;
};

// A node as it stands in the file, in flow form: its lines are given their indentation back and
// read again.
std::string verbatim_flow(std::string_view text, Span span) {
    // A block's first line begins in the middle of one of the file's; flow text needs no column.
    std::size_t column = 0;
    const auto at_line = [&] {
        const char before = text[span.begin - column - 1];
        return before == '\n' || before == '\r';
    };
    if (text[span.begin] == '-')
        while (column < span.begin && !at_line()) ++column;
    std::string slice(column, ' ');
    slice += text.substr(span.begin, span.end - span.begin);
    Diagnostics discarded;
    YamlReader reader(slice, SourceId{0}, Report{discarded, false}, 4000);
    Event first = reader.next();
    std::string flow;
    if (first.kind != EventKind::Broken && first.kind != EventKind::End)
        take_flow(reader, std::move(first), flow);
    return flow.empty() ? "~" : flow;
}

std::string assemble(Importer &in, std::string_view version) {
    std::string text = "// From the save file " + for_comment(in.source.name) + ", version " +
                       for_comment(version) + ".\nimport \"dfmodel\" as dfmodel\n\n";
    text += in.out;
    text += marked(no_part, "");
    if (!in.scene.empty()) text += '\n';
    for (const std::string &name : in.scene) text += name + "\n";
    if (in.scene.empty()) text += "empty // the file has no shape that could be read\n";
    if (!in.settings.empty()) text += '\n';
    for (const std::string &statement : in.settings) text += statement + "\n";
    std::string kept;
    for (const KeptRecord &record : in.kept) {
        if (!record.filled) continue;
        const std::string flow =
            record.verbatim.source ? verbatim_flow(in.source.text, record.verbatim) : record.flow;
        kept += "dfmodel.keep(" +
                sdf_string(record.label + (record.path.empty() ? "" : " " + record.path) + ": " +
                           flow) +
                ")\n";
    }
    if (!kept.empty())
        text += "\n// What the language has no word for, kept for an export.\n" + kept;
    return text;
}

// True where an item stands; reports a list that ends too early.
bool item(Importer &in, Event &event, const char *wanted) {
    event = in.reader.next();
    if (event.kind == EventKind::Broken) return false;
    if (event.kind == EventKind::SequenceEnd || event.kind == EventKind::End) {
        in.reader.break_off(event.span, std::string("the main list ends before ") + wanted);
        return false;
    }
    return true;
}

void read_main_list(Importer &in, std::string &version) {
    Event event = in.reader.next();
    if (event.kind == EventKind::Broken) return;
    if (event.kind == EventKind::End) return in.reader.break_off(event.span, "the file is empty");
    if (event.kind != EventKind::SequenceStart) {
        return in.reader.break_off(event.span, event.kind == EventKind::MappingStart
                                                   ? "the file has to be a list, and is a mapping"
                                                   : "the file has to be a list");
    }
    if (!item(in, event, "its version")) return;
    const bool scalar = event.kind == EventKind::Scalar;
    if (!scalar || !dialect_of(event.text).is_version) {
        return in.reader.break_off(event.span, "the main list has to begin with its version, 0.3");
    }
    version = event.text;
    if (!dialect_of(version).known) {
        in.report
            .content(event.span,
                     "this is version " + std::string(cut(version, 40)) +
                         ", and what is known is 0.3",
                     Code::YamlVersion)
            .note("the file is read as far as it is understood");
        in.keep("version", "", flow_scalar(version, event.plain));
    }
    if (!item(in, event, "its textures")) return;
    if (event.kind != EventKind::MappingStart)
        return in.reader.break_off(event.span,
                                   "the textures have to be a mapping of names to files");
    in.read_textures(event);
    if (!item(in, event, "its materials")) return;
    if (event.kind != EventKind::SequenceStart)
        return in.reader.break_off(event.span, "the materials have to be a list");
    in.read_materials(event);
    if (!item(in, event, "its scene tree")) return;
    if (event.kind != EventKind::SequenceStart)
        return in.reader.break_off(event.span, "the scene tree has to be a node, a list");
    in.read_tree(event);
    Settings settings;
    bool first = true;
    for (;;) {
        event = in.reader.next();
        if (event.kind == EventKind::SequenceEnd || event.kind == EventKind::Broken ||
            event.kind == EventKind::End)
            break;
        if (first && event.kind == EventKind::SequenceStart && !in.lighting_seen) {
            // Lighting, or a list that some other version has here
            const Event begin = event;
            event = in.reader.next();
            const NodeTypeRow *row =
                event.kind == EventKind::Scalar ? find_node_type(event.text) : nullptr;
            if (row && row->type == NodeType::Lighting) {
                in.read_lighting(false);
            } else {
                std::string flow = "[";
                if (event.kind == EventKind::SequenceEnd) {
                    flow += ']';
                } else {
                    take_flow(in.reader, std::move(event), flow);
                    in.rest_of_sequence(flow);
                }
                in.report.content(begin.span, "the `LightingNode` is missing here");
                in.keep("setting", "", std::move(flow));
            }
            first = false;
            continue;
        }
        first = false;
        settings.read(in, take_value(in.reader, std::move(event), 64));
    }
    settings.camera(in);
    if (in.reader.broken()) return;
    event = in.reader.next();
    if (in.reader.more_documents())
        in.report.content(event.span, "the file holds a second document, which is left out");
}

} // namespace

Importer::Importer(const Sources &sources, SourceId id, Diagnostics &diagnostics,
                   const ImportOptions &import_options)
    : source(sources[id]), source_id(id),
      options(import_options), report{diagnostics, import_options.strict},
      reader(source.text, id, report, import_options.max_depth * levels_per_node + levels_beside) {}

void Importer::keep(std::string label, std::string path, std::string flow) {
    kept.push_back({std::move(label), std::move(path), std::move(flow), {}, true});
}

void Importer::rest_of_sequence(std::string &flow) {
    for (;;) {
        Event event = reader.next();
        if (event.kind == EventKind::SequenceEnd || event.kind == EventKind::Broken ||
            event.kind == EventKind::End)
            break;
        if (flow.size() > 1) flow += ", ";
        take_flow(reader, std::move(event), flow);
    }
    flow += ']';
}

std::string Importer::text_of_asset(const std::string &file) const {
    const bool absolute =
        !file.empty() && (file[0] == '/' || file[0] == '\\' || (file.size() > 1 && file[1] == ':'));
    return absolute ? file : options.asset_prefix + file;
}

ImportResult import_yaml(const Sources &sources, SourceId source, Diagnostics &diagnostics,
                         const ImportOptions &options) {
    Importer in(sources, source, diagnostics, options);
    std::string version = "unknown";
    read_main_list(in, version);
    ImportResult result;
    result.structural_error = in.reader.broken();
    result.nodes = in.nodes;
    result.sdf = assemble(in, version);
    for (const auto &[offset, place] : take_marks(result.sdf))
        result.parts.emplace_back(offset, place == no_part ? Span{} : Span{source, place, place});
    return result;
}

} // namespace fathom::save
