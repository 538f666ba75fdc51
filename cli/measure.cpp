// fathom measure: what a solid or a drawing measures, as numbers of a mesh or of contours and as proved
// enclosures.
#include "base/text.h"
#include "cli/interrupt.h"
#include "cli/solid.h"

#include <fathom/measure.h>
#include <fathom/parts.h>

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace fathom::cli {
namespace {

using Json = nlohmann::ordered_json;

// A number, and between what the solid's is proved to lie.
struct Row {
    std::string name, unit;
    double value = 0;
    std::optional<v1::Enclosure> proved;
};

// The number that is printed: the mesh's or, where that is proved to be off, the nearest that may be.
double best(double of_mesh, const v1::Enclosure &proved) {
    return std::max(proved.lo, std::min(of_mesh, proved.hi));
}

// The power of the unit that a number has: 1 a length, 2 an area, 3 a volume.
std::string unit_of(const MeasureCommand &command, int power) {
    if (command.solid.units.empty()) return "";
    return power == 1 ? command.solid.units : fmt::format("{}{}", command.solid.units, power);
}

// The mass of a volume of 1: grams where the unit is known, for a density in g/cm3.
double mass_of_one(const MeasureCommand &command) {
    const UnitRow *unit = unit_named(command.solid.units);
    return *command.density * (unit ? std::pow(unit->metres * 100, 3) : 1);
}

v1::Enclosure times(const v1::Enclosure &e, double factor) {
    return {e.lo * factor * (1 - 1e-15), e.hi * factor * (1 + 1e-15)};
}

// What is known along an axis: of the box, and of the centre.
struct Along {
    double lo, hi, center;
    v1::Enclosure least, greatest, middle;
};
void add_axis(char axis, const std::string &length, const Along &of, std::vector<Row> &rows) {
    const double lo = best(of.lo, of.least), hi = best(of.hi, of.greatest);
    rows.push_back(
        {fmt::format("size {}", axis), length, hi - lo,
         v1::Enclosure{std::max(0.0, of.greatest.lo - of.least.hi), of.greatest.hi - of.least.lo}});
    rows.push_back({fmt::format("from {}", axis), length, lo, of.least});
    rows.push_back({fmt::format("to {}", axis), length, hi, of.greatest});
    rows.push_back({fmt::format("centre {}", axis), length, best(of.center, of.middle), of.middle});
}

std::vector<Row> rows_of(const v1::Measures &of, const MeasureCommand &command) {
    const std::string length = unit_of(command, 1);
    const double volume = best(of.mesh_volume, of.volume);
    std::vector<Row> rows{{"volume", unit_of(command, 3), volume, of.volume},
                          {"area", unit_of(command, 2), best(of.mesh_area, of.area), of.area}};
    if (command.density) {
        const double one = mass_of_one(command);
        rows.push_back({"mass", length.empty() ? "" : "g", one * volume, times(of.volume, one)});
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const Along along{of.mesh_box.lo[i], of.mesh_box.hi[i], of.mesh_center[i],
                          of.least[i],       of.greatest[i],    of.center[i]};
        add_axis("xyz"[i], length, along, rows);
    }
    return rows;
}

std::vector<Row> rows_of(const v1::FlatMeasures &of, const MeasureCommand &command) {
    const std::string length = unit_of(command, 1);
    std::vector<Row> rows{
        {"area", unit_of(command, 2), best(of.contours_area, of.area), of.area},
        {"perimeter", length, best(of.contours_perimeter, of.perimeter), of.perimeter}};
    for (std::size_t i = 0; i < 2; ++i) {
        const Along along{of.contours_least[i], of.contours_greatest[i], of.contours_center[i],
                          of.least[i],          of.greatest[i],          of.center[i]};
        add_axis("xy"[i], length, along, rows);
    }
    return rows;
}

// Seven digits; 0 where it is that beside `scale`, but for rounding.
std::string printed(double number, double scale) {
    if (std::fabs(number) < 1e-9 * scale) number = 0;
    return fmt::format("{:.7g}", number);
}
// Of an enclosure's ends, rounded outward.
std::string printed_end(double number, double scale, bool up) {
    double read = number;
    for (const double beside : {scale, 0.0}) {
        const std::string text = printed(number, beside);
        read = parse_number(text).value_or(number);
        if (up ? read >= number : read <= number) return text;
    }
    const double step = std::pow(10.0, std::floor(std::log10(std::fabs(number))) - 6);
    return fmt::format("{:.7g}", up ? read + step : read - step);
}

bool is_coordinate(const Row &row) {
    return row.name.starts_with("from ") || row.name.starts_with("to ") ||
           row.name.starts_with("centre ");
}

// `size`: of the solid, beside which coordinates may be 0.
void put_table(const std::string &title, const std::vector<Row> &rows, double size,
               Terminal &terminal) {
    terminal.put(
        fmt::format("{}\n{:24}{:>14}{:>16}{:>14}\n", title, "", "value", "at least", "at most"));
    for (const Row &row : rows) {
        const double scale = is_coordinate(row) ? size : 0;
        const std::string name =
            row.unit.empty() ? row.name : fmt::format("{} ({})", row.name, row.unit);
        terminal.put(row.proved ? fmt::format("  {:22}{:>14}{:>16}{:>14}\n", name,
                                              printed(row.value, scale),
                                              printed_end(row.proved->lo, scale, false),
                                              std::isfinite(row.proved->hi)
                                                  ? printed_end(row.proved->hi, scale, true)
                                                  : "-")
                                : fmt::format("  {:22}{:>14}{:>16}{:>14}\n", name,
                                              printed(row.value, scale), "-", "-"));
    }
}

Json json_of(const v1::Enclosure &e) {
    const auto end = [](double d) { return std::isfinite(d) ? Json(d) : Json(); };
    return {{"least", end(e.lo)}, {"most", end(e.hi)}};
}
Json json_of(double of_mesh, const v1::Enclosure &proved) {
    Json json{{"value", best(of_mesh, proved)}};
    json.update(json_of(proved));
    return json;
}

Json json_of(const v1::Measures &of, const MeasureCommand &command) {
    Json json;
    json["volume"] = json_of(of.mesh_volume, of.volume);
    json["area"] = json_of(of.mesh_area, of.area);
    if (of.open_places > 0) {
        json["area"]["open_places"] = of.open_places;
        json["area"]["open_place"] = of.open_place;
    }
    if (command.density) {
        const double one = mass_of_one(command);
        json["mass"] = json_of(one * best(of.mesh_volume, of.volume), times(of.volume, one));
    }
    for (const char *name : {"center", "from", "to"}) json[name] = Json::array();
    for (std::size_t i = 0; i < 3; ++i) {
        json["center"].push_back(json_of(of.mesh_center[i], of.center[i]));
        json["from"].push_back(json_of(of.mesh_box.lo[i], of.least[i]));
        json["to"].push_back(json_of(of.mesh_box.hi[i], of.greatest[i]));
    }
    json["mesh_components"] = of.components;
    json["mesh_genus"] = of.genus;
    json["rests_on"] = of.rests_on;
    return json;
}

Json json_of(const v1::FlatMeasures &of, const MeasureCommand &) {
    Json json;
    json["area"] = json_of(of.contours_area, of.area);
    json["perimeter"] = json_of(of.contours_perimeter, of.perimeter);
    if (of.open_places > 0) {
        json["perimeter"]["open_places"] = of.open_places;
        json["perimeter"]["open_place"] = of.open_place;
    }
    for (const char *name : {"center", "from", "to"}) json[name] = Json::array();
    for (std::size_t i = 0; i < 2; ++i) {
        json["center"].push_back(json_of(of.contours_center[i], of.center[i]));
        json["from"].push_back(json_of(of.contours_least[i], of.least[i]));
        json["to"].push_back(json_of(of.contours_greatest[i], of.greatest[i]));
    }
    json["outlines"] = of.outlines;
    json["holes"] = of.holes;
    json["rests_on"] = of.rests_on;
    return json;
}

// What is measured one after the other, on one bar.
class Measuring {
  public:
    Measuring(const MeasureCommand &command, std::size_t pieces, Terminal &terminal)
        : command_(command), pieces_(pieces), terminal_(terminal) {}
    std::function<bool(double)> next() {
        return [this, before = begun_++](double share) {
            terminal_.progress(command_.solid.scene.file, (static_cast<double>(before) + share) /
                                                              static_cast<double>(pieces_));
            return !Interrupts::noticed();
        };
    }

  private:
    const MeasureCommand &command_;
    std::size_t pieces_, begun_ = 0;
    Terminal &terminal_;
};

struct Between {
    const std::pair<std::string, std::string> *names;
    v1::Clearance of;
};

// What is measured, and what there is to say of it.
struct Subject {
    std::string name;
    int line = 0; // of a part; 0: it is the whole
    v1::Scene scene;
    bool flat = false, empty = false;
    v1::MeshStatus status = v1::MeshStatus::Done;
    std::string message, open; // `open`: of places where nothing bounds an area or a perimeter
    std::vector<Row> rows;
    Json json;
};

template <class Measures>
void fill(const Measures &of, const MeasureCommand &command, const char *what, Subject &subject) {
    subject.status = of.status;
    subject.message = of.message;
    subject.empty = subject.line > 0 && of.status == v1::MeshStatus::Empty;
    if (!of) return;
    subject.rows = rows_of(of, command);
    subject.json = json_of(of, command);
    if (of.open_places > 0)
        subject.open = fmt::format("  (the {} has no upper end: in {} of the smallest boxes it is "
                                   "not known how the {} runs, near [{:.4g}] for instance)\n",
                                   what, of.open_places, subject.flat ? "border" : "surface",
                                   fmt::join(of.open_place, ", "));
}

// The farthest coordinate of its box.
double size_of(const std::vector<Row> &rows) {
    double size = 0;
    for (const Row &row : rows)
        if (is_coordinate(row)) size = std::max(size, std::fabs(row.value));
    return size;
}

// How narrow clearances are enclosed, unless said: a 2,000th of the smaller part's box.
double tolerance_of(const MeasureCommand &command, const v1::Scene &a, const v1::Scene &b) {
    if (command.solid.tolerance.number > 0) return in_scene(command.solid.tolerance, command.solid);
    double least = 2;
    for (const v1::Scene *scene : {&a, &b}) {
        if (!scene->facts().bounds) continue;
        const v1::Box &box = *scene->facts().bounds;
        double longest = 0;
        for (std::size_t i = 0; i < 3; ++i)
            longest = std::max<double>(longest, box.hi[i] - box.lo[i]);
        if (longest > 0) least = std::min(least, longest);
    }
    return least / 2000;
}

void put_clearance(const Between &between, const MeasureCommand &command, Terminal &terminal) {
    const auto &[a, b] = *between.names;
    const v1::Clearance &c = between.of;
    const std::string length = unit_of(command, 1);
    terminal.put(fmt::format("{} and {}{}\n", a, b, length.empty() ? "" : " (" + length + ")"));
    if (c.distance.hi == 0) {
        terminal.put(fmt::format("  they have points in common: [{:.6g}, {:.6g}, {:.6g}]\n",
                                 c.near[0][0], c.near[0][1], c.near[0][2]));
    } else if (!std::isfinite(c.distance.hi)) {
        terminal.put(fmt::format("  apart by {} at least; no point of one of them was found\n",
                                 printed_end(c.distance.lo, c.distance.lo, false)));
    } else {
        terminal.put(fmt::format("  apart by {} at least and {} at most, from [{:.6g}, {:.6g}, "
                                 "{:.6g}] to [{:.6g}, {:.6g}, {:.6g}]\n",
                                 printed_end(c.distance.lo, c.distance.hi, false),
                                 printed_end(c.distance.hi, c.distance.hi, true), c.near[0][0],
                                 c.near[0][1], c.near[0][2], c.near[1][0], c.near[1][1],
                                 c.near[1][2]));
    }
}

Json json_of(const Between &between) {
    Json json{{"between", {between.names->first, between.names->second}}};
    json.update(json_of(between.of.distance));
    json["near"] = std::isfinite(between.of.distance.hi) ? Json(between.of.near) : Json();
    json["rests_on"] = between.of.rests_on;
    return json;
}

void put_json(const MeasureCommand &command, const std::vector<Subject> &subjects,
              const std::vector<Between> &clearances, Terminal &terminal) {
    Json json = subjects[0].json;
    json["unit"] = command.solid.units.empty() ? Json() : Json(command.solid.units);
    if (command.parts) json["parts"] = Json::array();
    if (command.parts) json["empty"] = Json::array();
    for (std::size_t k = 1; k < subjects.size(); ++k) {
        if (subjects[k].empty) {
            json["empty"].push_back(subjects[k].name);
            continue;
        }
        Json part{{"name", subjects[k].name}, {"line", subjects[k].line}};
        part.update(subjects[k].json);
        json["parts"].push_back(std::move(part));
    }
    if (!clearances.empty()) json["clearances"] = Json::array();
    for (const Between &between : clearances) json["clearances"].push_back(json_of(between));
    terminal.put(json.dump() + "\n");
}

} // namespace

Exit run(const MeasureCommand &command, Terminal &terminal) {
    const std::string &file = command.solid.scene.file;
    SolidArguments arguments = command.solid;
    arguments.maybe = true;
    const Solid solid = open_solid(arguments, terminal);
    if (!solid.scene) return solid.exit;
    if (solid.flat && command.density) {
        terminal.say(fmt::format("fathom: {}: --density is of solids: this is a drawing, which has "
                                 "no volume; `.extrude(…)` gives it a thickness",
                                 file));
        return usage_error;
    }
    const auto subject_of = [&](const std::string &name, int line, v1::Scene scene) {
        return Subject{name, line, std::move(scene), solid.flat, false, {}, "", "", {}, {}};
    };
    std::vector<Subject> subjects{
        subject_of(command.solid.part.empty() ? file : command.solid.part, 0, *solid.scene)};
    if (command.parts)
        for (const v1::Part &part : v1::parts_of(*solid.scene)) {
            std::optional<v1::Scene> scene = part_named(*solid.scene, part.name, terminal);
            if (!scene) return device_error;
            subjects.push_back(subject_of(part.name, part.at.line, std::move(*scene)));
        }
    std::vector<std::array<v1::Scene, 2>> pairs;
    for (const auto &[a, b] : command.between) {
        std::optional<v1::Scene> first = part_named(*solid.scene, a, terminal),
                                 second = part_named(*solid.scene, b, terminal);
        if (!first || !second) return usage_error;
        pairs.push_back({std::move(*first), std::move(*second)});
    }

    const Interrupts interrupts;
    Measuring work(command, subjects.size() + pairs.size(), terminal);
    const auto heed_interrupts = [&] {
        if (!Interrupts::noticed()) return;
        terminal.finish_progress();
        Interrupts::obey();
    };
    for (Subject &subject : subjects) {
        v1::MeshOptions options = options_of(command.solid);
        options.progress = work.next();
        if (solid.flat)
            fill(v1::measure_flat(subject.scene, options), command, "perimeter", subject);
        else
            fill(v1::measure(subject.scene, options), command, "area", subject);
        heed_interrupts();
        if (subject.empty) continue;
        if (subject.status != v1::MeshStatus::Done) {
            terminal.finish_progress();
            return say_refusal(command.solid, file, fmt::format("measures of `{}`", subject.name),
                               subject.status, subject.message, terminal);
        }
        if (subject.message.empty()) continue;
        terminal.finish_progress();
        terminal.say(fmt::format("{}: what stands beside the enclosures is of a mesh: {}",
                                 subject.name, subject.message));
    }
    std::vector<Between> clearances;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const auto &[a, b] = pairs[k];
        clearances.push_back({&command.between[k], v1::clearance(a, b, tolerance_of(command, a, b),
                                                                 command.solid.time, work.next())});
        heed_interrupts();
        const v1::Clearance &c = clearances.back().of;
        if (!c) {
            terminal.finish_progress();
            return say_refusal(command.solid, file, "clearance", c.status, c.message, terminal);
        }
    }
    terminal.finish_progress();

    if (command.solid.json) {
        put_json(command, subjects, clearances, terminal);
        return done;
    }
    for (const Subject &subject : subjects) {
        const std::string title = subject.line > 0
                                      ? fmt::format("{}, line {}", subject.name, subject.line)
                                      : subject.name;
        if (subject.empty)
            terminal.put(title + "\n  holds no point\n");
        else
            put_table(title, subject.rows, size_of(subject.rows), terminal);
        terminal.put(subject.open);
    }
    for (const Between &between : clearances) put_clearance(between, command, terminal);
    return done;
}

} // namespace fathom::cli
