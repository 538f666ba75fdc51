// See mesh_advice.h.
#include "api/mesh_advice.h"

#include "mesh/drawn.h"
#include "mesh/loose.h"
#include "mesh/thin.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace fathom::v1 {
namespace {

// What shows a wall or a gap of a thickness: a sentence's end.
std::string shown_by(double thickness, const fathom::mesh::Lattice &lattice, const ir::Box &solid) {
    const double tolerance = thickness / fathom::mesh::cells_across;
    if (!fathom::mesh::make_lattice(solid, tolerance, 0))
        return ", thinner than the finest cells of any mesh: make it thicker, or leave it out";
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i) longest = std::max(longest, solid.hi[i] - solid.lo[i]);
    const double now = lattice.side(lattice.level);
    return fmt::format(", and cells have sides of {:.2g}: a tolerance of {:.2g} shows it, or a "
                       "resolution of {:.0f}",
                       now, tolerance, std::ceil(longest / tolerance));
}

// Of how thick something is at some places, from the least: a sharp edge is as thin as one likes
// somewhere; of a wall all places tell its thickness.
double lower_quarter(const std::vector<double> &thick) { return thick[thick.size() / 4]; }

// What decides such cells: a sentence.
std::string advice_on_loose(const fathom::mesh::Field &field, const fathom::mesh::Made &made,
                            const std::vector<fathom::mesh::Cell> &cells) {
    const fathom::mesh::Lattice &lattice = made.octree.lattice;
    const double times = shrunk_to_decide(field, lattice, cells);
    const double side = lattice.side(lattice.level);
    if (times > 1 && fathom::mesh::make_lattice(made.box, side / times, 0))
        return fmt::format(
            "what is proved of the field there decides it in cells {:.0f} times smaller: with a "
            "tolerance of {:.2g}, or a bound nearer to the field's true slope",
            times, side / times);
    return "what is proved of the field there decides it in no cells of a mesh: a bound nearer to "
           "its true slope does, as of shapes in place of a formula, or a part of it by itself";
}

// What of a kernel or another step has no slopes.
std::string what_has_no_slopes(const fathom::mesh::Unknown &unknown) {
    using Why = fathom::mesh::Unknown::Why;
    using cpu::Kernel;
    using cpu::StepKind;
    switch (unknown.why) {
    case Why::Step: break;
    case Why::TooLong: return "too many operations in one place";
    case Why::Jump: return "a field that may jump there, since its bound is not proved";
    case Why::NoNumber: return "numbers that are not finite there";
    }
    switch (unknown.missing.kind) {
    case StepKind::Run: break;
    case StepKind::TableRead: return "a list that is read by the place";
    case StepKind::Image: return "an image";
    case StepKind::Grid: return "a grid of distances";
    case StepKind::Call: return "a function";
    case StepKind::Loop:
    case StepKind::BreakUnless: return "a loop that is long, or ends early at some places";
    }
    struct Row {
        Kernel kernel;
        const char *words;
    };
    constexpr Row rows[] = {
        {Kernel::SqrtF, "a root of what may be 0 (`sqrt`; cones, frames and polygons take one)"},
        {Kernel::DivF, "a quotient by what may be 0"},
        {Kernel::ModF, "a remainder (`%`) by what may be 0"},
        {Kernel::Atan2F, "an angle about its axis (`atan`)"},
        {Kernel::PowF, "a power that is no whole number (`pow`)"},
        {Kernel::Perlin, "`noise`"},
        {Kernel::Simplex, "`simplex`"},
        {Kernel::ValueNoise, "`value_noise`"},
        {Kernel::Worley, "`worley`"},
        {Kernel::SpotNoise, "`spot_noise`"},
        {Kernel::BlendStairs, "a blend in stairs"},
        {Kernel::BlendColumns, "a blend in columns"},
    };
    for (const Row &row : rows)
        if (row.kernel == unknown.missing.kernel) return row.words;
    std::string name = cpu::kernel_name(unknown.missing.kernel);
    if (name.ends_with('F')) name.pop_back();
    for (char &c : name)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return fmt::format("`{}`", name);
}

} // namespace

std::string advice_of(const ir::Scene &scene, const fathom::mesh::Settings &settings,
                      const fathom::mesh::Made &made,
                      const std::vector<fathom::mesh::Cell> &cells) {
    fathom::mesh::Progress progress;
    const fathom::mesh::Lattice &lattice = made.octree.lattice;
    std::vector<double> thick;
    std::size_t touch = 0;
    const fathom::mesh::Field field(scene, settings.time, settings.bounds);
    const auto found = thin_in(field, lattice, cells, threads_of(settings), progress);
    for (const fathom::mesh::Thin &thin : found) {
        if (thin.thickness > 0) thick.push_back(thin.thickness);
        touch += thin.touches;
    }
    if (touch > thick.size())
        return "parts of the solid touch there, and rounding leaves open where each ends, which no "
               "finer mesh tells: let them overlap a little, or move them by the same transforms";
    if (thick.empty()) return advice_on_loose(field, made, cells);
    std::ranges::sort(thick);
    return fmt::format("a wall, a gap or a sharp edge there is about {:.2g} thick{}",
                       lower_quarter(thick), shown_by(lower_quarter(thick), lattice, made.box));
}

std::string advice_on_drawn(const ir::Scene &scene, const fathom::mesh::Settings &settings,
                            const fathom::mesh::Made &made,
                            const std::optional<fathom::mesh::TooThin> &seen) {
    const double side = made.octree.lattice.side(made.octree.lattice.level);
    if (made.widened > 0)
        return fmt::format(
            "walls thinner than cells are drawn by the solid grown by {0:.2g}, with its vertices "
            "moved to the surface: gaps and holes narrower than {1:.2g} may be closed, which a "
            "tolerance of {2:.2g} shows",
            made.widened, 2 * made.widened, 0.5 * side);
    if (made.widened < 0)
        return fmt::format("gaps thinner than cells are drawn by the solid shrunk by {0:.2g}, with "
                           "its vertices moved to the surface: walls thinner than {1:.2g} may have "
                           "holes, which a tolerance of {2:.2g} shows",
                           -made.widened, -2 * made.widened, 0.5 * side);
    const fathom::mesh::TooThin thin =
        seen ? *seen
             : too_thin_in(fathom::mesh::Field(scene, settings.time, settings.bounds), settings,
                           made);
    const std::string shown = shown_by(thin.thickness, made.octree.lattice, made.box);
    switch (thin.sort) {
    case fathom::mesh::TooThin::Sort::None: break;
    case fathom::mesh::TooThin::Sort::Holes:
        return fmt::format("walls or gaps may have holes: one is about {:.2g} thick{}",
                           thin.thickness, shown);
    case fathom::mesh::TooThin::Sort::Gaps:
        return fmt::format("parts that are apart may be drawn as one: a gap is about {:.2g} wide{}",
                           thin.thickness, shown);
    case fathom::mesh::TooThin::Sort::Pieces:
        return fmt::format("the mesh has {} pieces, of which {}{} may belong to another: a wall or "
                           "a sharp edge there is about {:.2g} thick{}",
                           thin.pieces, thin.more ? "at least " : "", thin.splinters,
                           thin.thickness, shown);
    }
    return "";
}

std::string why_shape_is_open(const fathom::mesh::Made &made,
                              const fathom::mesh::Certificate &certificate) {
    const fathom::mesh::ShapeAnswer &shape = certificate.shape;
    if (shape.proved) return "";
    if (!certificate.near())
        return "it is looked for where nothing is undecided and both distances hold";
    if (made.widened != 0)
        return "it is not looked for where walls or gaps thinner than cells are drawn wider: "
               "smaller cells draw them as they are";
    const std::string place = fmt::format("near [{:.4g}, {:.4g}, {:.4g}]", shape.place[0],
                                          shape.place[1], shape.place[2]);
    if (shape.why)
        return fmt::format(
            "how fast the field changes {} is not known, by {}: what is made without "
            "that is proved alone, as by `--part` or `--bounds`",
            place, what_has_no_slopes(*shape.why));
    if (shape.dear)
        return "it would take more than the work that is spent: larger cells take less, or a part "
               "of it, by `--part` or `--bounds`";
    const fathom::mesh::Lattice &lattice = made.octree.lattice;
    return fmt::format(
        "in {} cells, as {}, the field is not seen to rise one way: smaller ones may "
        "show it, as with a tolerance of {:.2g}",
        shape.unseen > 0 ? fmt::format("more than {}", shape.open - shape.unseen)
                         : fmt::format("{}", shape.open),
        place, 0.5 * lattice.side(lattice.level));
}

std::string why_area_is_open(const fathom::mesh::Certificate &certificate) {
    if (std::isfinite(certificate.area.hi)) return "";
    if (!certificate.looked_for_area)
        return "an upper end was not looked for, which would take too much: `fathom measure` looks "
               "for it";
    const fathom::mesh::Real3 &at = certificate.open_place;
    return fmt::format(
        "how the surface runs near [{:.4g}, {:.4g}, {:.4g}] is not known in boxes as "
        "small as were looked at: `fathom measure` looks closer",
        at[0], at[1], at[2]);
}

std::string advice_on_shape(const fathom::mesh::Made &made, const fathom::mesh::Form &finer) {
    const fathom::mesh::Lattice &lattice = made.octree.lattice;
    return fmt::format("smaller cells show another shape, {} piece{} and {} handle{}, with a "
                       "tolerance of {:.2g}",
                       finer.components, finer.components == 1 ? "" : "s", finer.genus,
                       finer.genus == 1 ? "" : "s", 0.5 * lattice.side(lattice.level));
}

} // namespace fathom::v1
