// See framing.h.
#include "driver/framing.h"

#include "backend-cpu/prune/solid_box.h"
#include "ir/passes/operations.h"
#include "ir/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <numeric>
#include <optional>
#include <utility>

namespace fathom::driver {
namespace {

constexpr int moments = 16;             // of a scene that moves
constexpr double most_work = 200e6;     // operations on boxes
constexpr int plane_places = 17;        // a side, of the plane that an orthographic view begins on
constexpr std::size_t first_a_side = 1; // parts that are looked at together at first

// Spread over the whole time by the golden ratio, so that no period of the motion is met in step.
std::vector<double> moments_of(const ir::Scene &scene, ir::FunctionId part, ir::Interval times) {
    std::vector<double> all{times.lo};
    if (!scene.graph.reads(scene.graph.function(part).result).time || !(times.lo < times.hi))
        return all;
    constexpr double golden = 0.61803398874989485;
    for (int k = 1; k < moments; ++k)
        all.push_back(times.lo + (times.hi - times.lo) * (golden * k - std::floor(golden * k)));
    return all;
}

cpu::Extent over_time(const ir::Scene &scene, ir::FunctionId part, const ir::Box &domain,
                      ir::Interval times, double &work) {
    const std::vector<std::array<double, 3>> directions = ir::framing_directions();
    cpu::Extent extent;
    for (const double time : moments_of(scene, part, times))
        extent = cpu::hull(std::move(extent),
                           cpu::solid_extent(scene, part, domain, directions, time, work));
    return extent;
}

// The parts that reach farthest to each of the six sides and along each of the directions.
std::vector<std::size_t> outermost(const std::vector<ir::Scene::Framed> &parts,
                                   std::span<const std::array<double, 3>> directions,
                                   std::vector<std::size_t> of, std::size_t a_side) {
    std::vector<std::array<double, 3>> ways{{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                            {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    ways.insert(ways.end(), directions.begin(), directions.end());
    if (of.size() <= ways.size() * a_side) return of;
    std::vector<std::size_t> chosen;
    for (const std::array<double, 3> &way : ways) {
        const auto near = [&](std::size_t k) {
            return std::pair(-ir::reach_of(parts[k].bounds, way), k);
        };
        const auto end = of.begin() + static_cast<std::ptrdiff_t>(a_side);
        std::ranges::nth_element(of, end, {}, near);
        chosen.insert(chosen.end(), of.begin(), end);
    }
    std::ranges::sort(chosen);
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    return chosen;
}

bool within(const ir::Box &box, const cpu::Extent &outer,
            std::span<const std::array<double, 3>> directions) {
    for (std::size_t i = 0; i < 3; ++i)
        if (box.lo[i] < outer.box.lo[i] || box.hi[i] > outer.box.hi[i]) return false;
    for (std::size_t k = 0; k < outer.reach.size(); ++k)
        if (ir::reach_of(box, directions[k]) > outer.reach[k]) return false;
    return true;
}

// How deep places lie in the solid, at least, below 0 outside. Not to be asked of a scene of more than
// `most_operations_inside` operations a point.
class Depth {
  public:
    Depth(const ir::Scene &scene, double time)
        : program_(cpu::compile(scene, scene.distance)),
          scratch_(cpu::make_scratch(program_, cpu::inputs_of(scene, time))) {}
    double operator()(const glm::dvec3 &place) {
        std::array<float, 3> at;
        for (int i = 0; i < 3; ++i) at[static_cast<std::size_t>(i)] = static_cast<float>(place[i]);
        const float *const in[] = {&at[0], &at[1], &at[2]};
        float distance = 0, *const out[] = {&distance};
        cpu::evaluate(program_, scratch_, in, out, 1);
        return -static_cast<double>(distance);
    }
    static bool affordable(const ir::Scene &scene) {
        const ir::Graph &graph = scene.graph;
        return ir::operations(graph, graph.function(scene.distance).result) <=
               most_operations_inside;
    }

  private:
    cpu::Program program_;
    cpu::Scratch scratch_;
};

// What has no end is seen from near the origin; where that lies in the solid or hard by it, as among
// hills, from as many times as far as it takes. Where it is everywhere about, as a lattice of balls, from the first
// place outside; and where there is none, that is told (tell_of_view_inside).
void stand_outside(ir::Scene &scene, double time) {
    if (!Depth::affordable(scene)) return;
    Depth depth(scene, time);
    constexpr int most_doublings = 10;
    constexpr double room = 0.1; // of the way to what is looked at
    std::optional<ir::Box> outside;
    for (int i = 0; i <= most_doublings; ++i) {
        const double half = std::exp2(i);
        if (i > 0) scene.framed = ir::Box{{-half, -half, -half}, {half, half, half}};
        const ir::View view = ir::view_of(scene, time, 1);
        const double in_front = -depth(view.origin);
        if (in_front > room * view.focus) return;
        if (in_front > 0 && !outside) outside = scene.framed;
    }
    scene.framed = outside.value_or(ir::Box{});
}

// How high a ground is that has no end, by columns far from the origin: the lowest and the highest place
// that they meet from above. None where a column meets nothing, or begins in the solid.
std::optional<ir::Interval> ground_of(Depth &depth, double operations, double &work) {
    constexpr int columns = 48, most_steps = 300;
    constexpr double nearest = 64, highest = 2048, near = 1e-3, golden = 0.61803398874989485;
    ir::Interval heights(highest, -highest);
    for (int k = 0; k < columns; ++k) {
        const double far = nearest * std::exp2(k % 4), turn = 2 * glm::pi<double>() * golden * k;
        double y = highest, free = 0;
        for (int step = 0; step < most_steps && y > -highest; ++step, y -= free) {
            if ((work -= operations) <= 0) return std::nullopt;
            free = -depth({far * std::cos(turn), y, far * std::sin(turn)});
            if (free < near) break;
        }
        if (free >= near || y >= highest) return std::nullopt;
        heights = ir::Interval(std::min(heights.lo, y), std::max(heights.hi, y));
    }
    return heights;
}

// What stands on or over such a ground, where that has an end: as `min(p.y, …)` of a field of one's
// own, whose parts nobody knows.
ir::Box above_ground(const ir::Scene &scene, double time, double &work) {
    if (!Depth::affordable(scene)) return {};
    Depth depth(scene, time);
    const ir::Graph &graph = scene.graph;
    const double operations = ir::operations(graph, graph.function(scene.distance).result);
    const std::optional<ir::Interval> ground = ground_of(depth, operations, work);
    if (!ground) return {};
    // Columns do not meet the highest hill.
    const double floor = ground->hi + std::max(0.02, 0.25 * (ground->hi - ground->lo));
    for (const double half : {64.0, cpu::endless_from}) { // near the origin it is found sooner
        ir::Box domain{{-half, floor, -half}, {half, half, half}};
        for (int turn = 0; turn < 2 && !domain.empty(); ++turn) // the finer the smaller
            domain = cpu::solid_box(scene, scene.distance, domain, time, work);
        bool ends = !domain.empty() && work > 0;
        for (std::size_t i = 0; i < 3; ++i)
            ends = ends && domain.lo[i] > -0.75 * half && domain.hi[i] < 0.75 * half;
        domain.lo[1] = std::min(domain.lo[1], ground->hi);
        if (ends) return domain;
    }
    return {};
}

// The extent of the parts that have bounds: first that of the outermost, which mostly holds the bounds
// of all others; then of more of those that it does not.
cpu::Extent of_bounded(ir::Scene &scene, ir::Interval times, double &work) {
    const std::vector<ir::Scene::Framed> &parts = scene.framed_bounded;
    const std::vector<std::array<double, 3>> directions = ir::framing_directions();
    std::vector<std::size_t> left(parts.size());
    std::iota(left.begin(), left.end(), std::size_t{0});
    cpu::Extent found;
    for (std::size_t a_side = first_a_side; !left.empty(); a_side *= 4) {
        std::vector<ir::NodeId> distances;
        ir::Box domain;
        const std::vector<std::size_t> chosen = outermost(parts, directions, left, a_side);
        for (const std::size_t k : chosen) {
            distances.push_back(parts[k].distance);
            domain = ir::hull(domain, parts[k].bounds);
        }
        const ir::FunctionId together =
            scene.graph.add_function({"framed",
                                      {},
                                      {scene.framed_point},
                                      scene.graph.make(ir::Op::Union, ir::Type::Float, distances)});
        found = cpu::hull(std::move(found), over_time(scene, together, domain, times, work));
        std::erase_if(left, [&](std::size_t k) {
            return within(parts[k].bounds, found, directions) ||
                   std::ranges::binary_search(chosen, k);
        });
    }
    return found;
}

} // namespace

// Where a section keeps nothing of a solid that has an end along its axis.
static void tell_of_section(const ir::Scene &scene, const ir::Section &section, Span span,
                            Diagnostics &diagnostics) {
    const ir::ShapeId whole = scene.shapes[scene.root].children[0]; // as cut_open makes it
    const ir::Box &box = scene.facts[whole.index].bounds;
    const auto i = static_cast<std::size_t>(section.axis);
    const char axis = "xyz"[i];
    const auto end = [](double height) {
        return std::isfinite(height) ? fmt::format("{:.6g}", height) : std::string();
    };
    Diagnostic &told =
        diagnostics.add(Code::NothingFramed, span,
                        fmt::format("the section {}={}..{} keeps nothing of this scene", axis,
                                    end(section.from), end(section.to)));
    if (box.empty() || !(std::isfinite(box.lo[i]) && std::isfinite(box.hi[i]))) return;
    told.note(fmt::format("its solid lies from {} = {:.6g} to {:.6g}", axis, box.lo[i], box.hi[i]))
        .help(fmt::format("cut within that, as by `--section {}=..{:.3g}`", axis,
                          0.5 * (box.lo[i] + box.hi[i])));
}

void find_framing(ir::Scene &scene, ir::Interval times, const std::optional<ir::Section> &section,
                  Diagnostics &diagnostics) {
    if (scene.camera.given || scene.top_level.empty()) return;
    double work = most_work;
    cpu::Extent found = of_bounded(scene, times, work);
    constexpr double far = cpu::endless_from;
    const ir::Box space{{-far, -far, -far}, {far, far, far}};
    bool endless = false;
    for (const ir::FunctionId part : scene.framed_alone) {
        const cpu::Extent extent = over_time(scene, part, space, times, work);
        const ir::Box &box = extent.box;
        bool inside = true;
        for (std::size_t i = 0; i < 3; ++i)
            inside = inside && (box.empty() || (box.lo[i] > -far / 2 && box.hi[i] < far / 2));
        if (inside)
            found = cpu::hull(std::move(found), extent);
        else
            endless = true;
    }
    scene.framed = found.box;
    if (!found.box.empty()) scene.framed_reach = std::move(found.reach);
    if (!scene.framed.empty() || work <= 0) return; // what was not found may be there
    const Span span = scene.top_level.front().span;
    if (endless && !section) {
        for (const double time : moments_of(scene, scene.distance, times))
            scene.framed = ir::hull(scene.framed, above_ground(scene, time, work));
        if (!scene.framed.empty()) return;
    }
    if (endless) stand_outside(scene, times.lo);
    if (endless)
        diagnostics
            .add(Code::NothingFramed, span,
                 "nothing of this scene has an end, so there is nothing to frame")
            .note("the view shows the surroundings of the origin")
            .help("write `camera(at: [3, 2, 5], look_at: [0, 0, 0])`, from where you want to see "
                  "it, or cut the solid off, as with `& box(10)`");
    else if (section)
        tell_of_section(scene, *section, span, diagnostics);
    else
        diagnostics
            .add(Code::NothingFramed, span, "this scene is empty: no point lies in the solid")
            .help("look for an intersection or a difference that leaves nothing over");
}

void tell_of_view_inside(const ir::Scene &scene, double time, Diagnostics &diagnostics) {
    if (scene.top_level.empty()) return;
    if (!Depth::affordable(scene)) return;
    const ir::View view = ir::view_of(scene, time, 1);
    Depth depth(scene, time);
    const auto inside = [&](const glm::dvec3 &place) {
        return depth(place) > scene.render.epsilon;
    };
    const auto tell = [&](std::string_view how) -> Diagnostic & {
        return diagnostics.add(
            Code::ViewInside, scene.top_level.front().span,
            fmt::format(fmt::runtime(how), view.origin.x, view.origin.y, view.origin.z));
    };
    if (view.orthographic) { // its rays begin all over a plane
        bool cut = false;
        for (int i = 0; i < plane_places * plane_places && !cut; ++i) {
            const auto part = [](int k) { return 2.0 * k / (plane_places - 1) - 1; };
            cut = inside(view.origin + view.extent * (part(i % plane_places) * view.right +
                                                      part(i / plane_places) * view.up));
        }
        if (cut)
            tell("the view begins on the plane through [{:.3g}, {:.3g}, {:.3g}], which cuts the "
                 "solid: what lies behind the plane is not seen")
                .help("set the camera's `at` farther back: an orthographic picture shows all as "
                      "large from there");
        return;
    }
    if (!inside(view.origin)) return;
    Diagnostic &told =
        tell("the view begins at [{:.3g}, {:.3g}, {:.3g}], within the solid, and so shows nothing "
             "of its surface");
    if (!scene.camera.given)
        told.note("without a `camera(…)` the whole solid is framed from outside");
    told.help(
        "write a `camera(at: …, look_at: …)` from a place outside the solid or in a hollow of "
        "it, or cut the solid open, as with `- plane(Z, 0)`");
}

} // namespace fathom::driver
