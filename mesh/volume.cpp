#include "mesh/volume.h"

#include "mesh/nearest.h"

#include <cmath>
#include <limits>

namespace fathom::mesh {
namespace {

constexpr std::int32_t block_side = 8;

// The numbers of the blocks along each axis.
std::array<std::int32_t, 3> blocks_of(const VoxelGrid &grid) {
    std::array<std::int32_t, 3> blocks{};
    for (std::size_t i = 0; i < 3; ++i) blocks[i] = (grid.counts[i] + block_side - 1) / block_side;
    return blocks;
}

// Where a distance's sign is asked when the field does not say: ways from the voxel.
constexpr std::size_t ways = 14; // the axes and the diagonals, both ways
Point way(std::size_t k) {
    constexpr float diagonal = 0.57735f;
    Point p{};
    if (k < 6)
        p[k / 2] = k % 2 == 0 ? 1.0f : -1.0f;
    else
        for (std::size_t i = 0; i < 3; ++i) p[i] = (k - 6) >> i & 1 ? diagonal : -diagonal;
    return p;
}

// Gives the distances their signs: negative where the field is not positive, as in meshes. Where it
// is 0, but for rounding, and the mesh is farther than the surface can be from it, parts of the solid
// touch or a sheet without thickness hangs in space: there the sign is that of the largest number
// that the field has about.
void sign(Evaluator &evaluator, const VoxelGrid &grid, double off, std::vector<Voxel> &voxels,
          std::size_t first) {
    Points points;
    for (std::size_t k = first; k < voxels.size(); ++k) points.add(grid.point(voxels[k].at));
    std::vector<float> values;
    values_at(evaluator, *evaluator.field.whole, points, values);
    const double rounding = 64 * grid.ulp();
    std::vector<std::size_t> doubtful;
    Points about;
    for (std::size_t k = first; k < voxels.size(); ++k) {
        const float value = values[k - first], d = voxels[k].distance;
        if (value <= 0) voxels[k].distance = -d;
        if (!(d > off) || !(std::fabs(value) <= rounding)) continue;
        doubtful.push_back(k);
        const auto far = static_cast<float>(std::max(0.5 * (d - off), rounding));
        for (std::size_t w = 0; w < ways; ++w) {
            Point p = grid.point(voxels[k].at);
            const Point to = way(w);
            for (std::size_t i = 0; i < 3; ++i) p[i] += far * to[i];
            about.add(p);
        }
    }
    if (doubtful.empty()) return;
    values_at(evaluator, *evaluator.field.whole, about, values);
    for (std::size_t n = 0; n < doubtful.size(); ++n) {
        float largest = 0;
        for (std::size_t w = 0; w < ways; ++w)
            if (const float v = values[n * ways + w]; std::fabs(v) > std::fabs(largest))
                largest = v;
        float &distance = voxels[doubtful[n]].distance;
        if (largest != 0) distance = std::copysign(distance, largest);
    }
}

} // namespace

double VoxelGrid::ulp() const {
    double largest = 0;
    for (std::size_t i = 0; i < 3; ++i)
        largest = std::max(
            {largest, std::fabs(origin[i]), std::fabs(origin[i] + side * (counts[i] - 1))});
    return std::ldexp(largest, -23);
}

std::optional<VoxelGrid> make_grid(const ir::Box &box, double side, int padding) {
    VoxelGrid grid;
    grid.side = side;
    double count = 1, largest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double lo = std::floor(box.lo[i] / side) - padding,
                     hi = std::ceil(box.hi[i] / side) + padding;
        grid.origin[i] = lo * side;
        largest = std::max({largest, std::fabs(lo), std::fabs(hi)});
        if (!(hi - lo < 1e6)) return std::nullopt;
        grid.counts[i] = static_cast<std::int32_t>(hi - lo) + 1;
        count *= grid.counts[i];
    }
    // Floats have 2^24 numbers to the largest coordinate: 64 of them tell two points apart.
    if (!(side > 0) || !(largest < 262144) || count > std::numeric_limits<std::int32_t>::max())
        return std::nullopt;
    return grid;
}

std::vector<Voxel> band_of(const ir::Scene &scene, const Settings &settings, const Mesh &mesh,
                           double off, const VoxelGrid &grid, double band,
                           std::span<const Point> colors, Progress &progress) {
    const TriangleTree tree(mesh);
    const Field field(scene, settings.time, settings.bounds);
    const std::array<std::int32_t, 3> blocks = blocks_of(grid);
    // A row of blocks along x is a piece of work.
    const auto rows = static_cast<std::size_t>(blocks[1]) * static_cast<std::size_t>(blocks[2]);
    std::vector<std::vector<Voxel>> found(rows);
    const double half = 0.5 * (block_side - 1) * std::sqrt(3.0) * grid.side;
    const auto search = [&](Evaluator &evaluator, std::size_t row) {
        const Index from{
            0, block_side * static_cast<std::int32_t>(row % static_cast<std::size_t>(blocks[1])),
            block_side * static_cast<std::int32_t>(row / static_cast<std::size_t>(blocks[1]))};
        for (std::int32_t block = 0; block < blocks[0]; ++block) {
            const Index at{block * block_side, from[1], from[2]};
            Point middle = grid.point(at);
            for (float &x : middle) x += static_cast<float>(0.5 * (block_side - 1) * grid.side);
            if (!tree.nearest(middle, (half + band) * (1 + 1e-6))) continue;
            const std::size_t first = found[row].size();
            for (std::int32_t n = 0; n < block_side * block_side * block_side; ++n) {
                const Index voxel{at[0] + n / (block_side * block_side),
                                  at[1] + n / block_side % block_side, at[2] + n % block_side};
                bool in_grid = true;
                for (std::size_t i = 0; i < 3; ++i) in_grid = in_grid && voxel[i] < grid.counts[i];
                if (!in_grid) continue;
                const std::optional<Nearest> near = tree.nearest(grid.point(voxel), band);
                if (!near) continue;
                Voxel made{voxel, static_cast<float>(near->distance), {}};
                for (std::size_t c = 0; c < 3 && !colors.empty(); ++c)
                    for (std::size_t i = 0; i < 3; ++i)
                        made.color[i] += static_cast<float>(
                            near->shares[c] * colors[mesh.triangles[near->triangle][c]][i]);
                found[row].push_back(made);
            }
            sign(evaluator, grid, off, found[row], first);
        }
    };
    in_parallel(
        rows, threads_of(settings), progress, [&] { return Evaluator(field); }, search);
    std::vector<Voxel> all;
    for (const std::vector<Voxel> &some : found) all.insert(all.end(), some.begin(), some.end());
    return all;
}

std::vector<float> distances_of(const ir::Scene &scene, const Settings &settings, const Mesh &mesh,
                                double off, const VoxelGrid &grid, Progress &progress) {
    const TriangleTree tree(mesh);
    const Field field(scene, settings.time, settings.bounds);
    const auto width = static_cast<std::size_t>(grid.counts[0]);
    const auto rows =
        static_cast<std::size_t>(grid.counts[1]) * static_cast<std::size_t>(grid.counts[2]);
    std::vector<float> distances(width * rows);
    in_parallel(
        rows, threads_of(settings), progress, [&] { return Evaluator(field); },
        [&](Evaluator &evaluator, std::size_t row) {
            std::vector<Voxel> voxels(width);
            double last = std::numeric_limits<double>::infinity();
            for (std::size_t k = 0; k < width; ++k) {
                Voxel &voxel = voxels[k];
                voxel.at = {
                    static_cast<std::int32_t>(k),
                    static_cast<std::int32_t>(row % static_cast<std::size_t>(grid.counts[1])),
                    static_cast<std::int32_t>(row / static_cast<std::size_t>(grid.counts[1]))};
                // A neighbour's distance says how far the nearest can be.
                const std::optional<Nearest> near =
                    tree.nearest(grid.point(voxel.at), last + 1.001 * grid.side);
                last = near ? near->distance : std::numeric_limits<double>::infinity();
                if (!near) last = tree.nearest(grid.point(voxel.at), 1e30)->distance;
                voxel.distance = static_cast<float>(last);
            }
            sign(evaluator, grid, off, voxels, 0);
            for (std::size_t k = 0; k < width; ++k) distances[row * width + k] = voxels[k].distance;
        });
    return distances;
}

std::vector<float> values_of(const ir::Scene &scene, ir::FunctionId function,
                             const Settings &settings, const VoxelGrid &grid, Progress &progress) {
    const cpu::Program program = cpu::compile(scene, function);
    const cpu::Inputs inputs = cpu::inputs_of(scene, settings.time);
    const auto size = static_cast<std::size_t>(
        ir::components(scene.graph.type(scene.graph.function(function).result)));
    const auto width = static_cast<std::size_t>(grid.counts[0]);
    const auto rows =
        static_cast<std::size_t>(grid.counts[1]) * static_cast<std::size_t>(grid.counts[2]);
    std::vector<float> values(size * width * rows);
    in_parallel(
        rows, threads_of(settings), progress, [&] { return cpu::make_scratch(program, inputs); },
        [&](cpu::Scratch &scratch, std::size_t row) {
            Points points;
            for (std::size_t k = 0; k < width; ++k)
                points.add(grid.point(
                    {static_cast<std::int32_t>(k),
                     static_cast<std::int32_t>(row % static_cast<std::size_t>(grid.counts[1])),
                     static_cast<std::int32_t>(row / static_cast<std::size_t>(grid.counts[1]))}));
            std::array<std::vector<float>, 3> out;
            for (std::vector<float> &one : out) one.resize(width);
            const float *in[] = {points.at[0].data(), points.at[1].data(), points.at[2].data()};
            float *to[] = {out[0].data(), out[1].data(), out[2].data()};
            cpu::evaluate(program, scratch, in, to, width);
            for (std::size_t k = 0; k < width; ++k)
                for (std::size_t c = 0; c < size; ++c)
                    values[(row * width + k) * size + c] = out[c][k];
        });
    return values;
}

} // namespace fathom::mesh
