// The program fathom-read-vdb: the voxels of a grid of numbers of an OpenVDB file. It is a process of
// its own because OpenVDB trusts what it reads: of a broken file it may take any memory, or crash.
#include "interface.h"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

#include <tbb/global_control.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <iterator>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

namespace {

using openvdb::Coord;
using openvdb::GridBase;

// A file that ends too early is an error: OpenVDB itself does not ask its stream.
openvdb::GridPtrVec grids_in(std::string bytes) {
    std::istringstream stream(std::move(bytes), std::ios::binary);
    stream.exceptions(std::ios::failbit | std::ios::badbit);
    try {
        openvdb::io::Stream file(stream, /*delayLoad=*/false);
        return file.getGrids() ? *file.getGrids() : openvdb::GridPtrVec();
    } catch (const std::ios::failure &) {
        throw std::runtime_error("the file ends too early, or is broken");
    }
}

bool of_numbers(const GridBase &grid) {
    return grid.isType<openvdb::FloatGrid>() || grid.isType<openvdb::DoubleGrid>();
}

// What a grid is called: of several with one name each has its number too, and so has one without,
// as OpenVDB's own programs print them.
std::string name_of(const openvdb::GridPtrVec &grids, const GridBase &grid) {
    const std::string name = grid.getName();
    std::size_t before = 0, alike = 0;
    bool seen = false;
    for (const GridBase::Ptr &other : grids) {
        seen = seen || other.get() == &grid;
        if (other->getName() != name) continue;
        ++alike;
        before += !seen;
    }
    return alike == 1 && !name.empty() ? name : name + "[" + std::to_string(before) + "]";
}

// The grid of that name or, where it is empty, the only level set, or the only grid of numbers.
const GridBase &wanted(const openvdb::GridPtrVec &grids, const std::string &name) {
    std::vector<const GridBase *> numbers, level_sets;
    std::string names, first;
    for (const GridBase::Ptr &grid : grids) {
        if (!of_numbers(*grid)) continue;
        const std::string called = name_of(grids, *grid);
        if (!name.empty() && called == name) return *grid;
        numbers.push_back(grid.get());
        if (grid->getGridClass() == openvdb::GRID_LEVEL_SET) level_sets.push_back(grid.get());
        if (numbers.size() == 1) first = called;
        if (numbers.size() <= 8) names += (names.empty() ? "`" : ", `") + called + "`";
        if (numbers.size() == 9) names += ", and more";
    }
    if (numbers.empty()) throw std::runtime_error("the file has no grid of floats or doubles");
    if (!name.empty())
        throw std::runtime_error("the file has no grid `" + name +
                                 "` of numbers, those it has are " + names);
    if (level_sets.size() == 1) return *level_sets[0];
    if (numbers.size() == 1) return *numbers[0];
    throw std::runtime_error("the file has several grids of numbers (" + names +
                             "): name one, as by `grid: \"" + first + "\"`");
}

// Where voxel 0 is, and how far apart voxels are along each axis.
void read_place(const GridBase &grid, openvdb::Vec3d &origin, openvdb::Vec3d &spacing) {
    bool straight = grid.transform().isLinear();
    if (straight) {
        const openvdb::Mat4R matrix = grid.transform().baseMap()->getAffineMap()->getMat4();
        for (int i = 0; i < 3; ++i) {
            origin[i] = matrix(3, i); // OpenVDB multiplies rows
            spacing[i] = matrix(i, i);
            straight =
                straight && std::isfinite(origin[i]) && spacing[i] > 0 && std::isfinite(spacing[i]);
            for (int j = 0; j < 3; ++j) straight = straight && (i == j || matrix(i, j) == 0);
        }
    }
    if (!straight)
        throw std::runtime_error(
            "the grid is turned, sheared, mirrored or in perspective: resample "
            "it along the axes, as by Houdini's `VDB Resample`, and turn the "
            "shape by `rotate`");
}

constexpr rlim_t most_seconds = 10; // of processor time, whatever the file says

// Where answers go. OpenVDB's warnings go to the standard output, which is another file then.
std::FILE *answers = nullptr;

bool say(const void *bytes, std::size_t count) {
    return std::fwrite(bytes, 1, count, answers) == count;
}

// One layer after the other, so that a box is never held whole here.
template <class Grid> void put(const Grid &grid) {
    openvdb::Vec3d origin, spacing;
    read_place(grid, origin, spacing);
    openvdb::CoordBBox voxels = grid.evalActiveVoxelBoundingBox();
    if (voxels.empty()) throw std::runtime_error("the grid has no voxels");
    constexpr int farthest = 1 << 30;
    if (voxels.min().x() < -farthest || voxels.min().y() < -farthest ||
        voxels.min().z() < -farthest || voxels.max().x() > farthest ||
        voxels.max().y() > farthest || voxels.max().z() > farthest)
        throw std::runtime_error("a voxel is farther than 1,073,741,824 voxels from the first");
    voxels.expand(1);
    FathomVdbBox box{};
    for (int i = 0; i < 3; ++i) {
        const double first = voxels.min()[i], last = voxels.max()[i];
        box.size[i] = static_cast<std::uint64_t>(last - first) + 1;
        box.lo[i] = origin[i] + first * spacing[i];
        box.hi[i] = origin[i] + last * spacing[i];
        if (!std::isfinite(box.lo[i]) || !std::isfinite(box.hi[i]) || !(box.lo[i] < box.hi[i]))
            throw std::runtime_error("the grid's place is no place of finite numbers");
    }
    const FathomVdbAnswer answer{1, box};
    if (!say(&answer, sizeof answer)) return;
    std::vector<float> layer;
    for (int z = voxels.min().z(); z <= voxels.max().z(); ++z) {
        const openvdb::CoordBBox flat(Coord(voxels.min().x(), voxels.min().y(), z),
                                      Coord(voxels.max().x(), voxels.max().y(), z));
        layer.resize(box.size[0] * box.size[1]);
        openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(flat, layer.data());
        openvdb::tools::copyToDense(grid, dense, /*serial=*/true);
        if (!say(layer.data(), layer.size() * sizeof(float))) return; // nobody wants it
    }
}

template <class Resource> void limit(Resource what, rlim_t most) {
    const rlimit both{most, most};
    setrlimit(what, &both);
}

void refuse(const char *why) {
    const FathomVdbAnswer answer{};
    if (say(&answer, sizeof answer)) std::fputs(why, answers);
}

} // namespace

int main(int count, char **arguments) {
    const unsigned long long most = count > 1 ? std::strtoull(arguments[1], nullptr, 10) : 0;
    answers = fdopen(dup(1), "wb");
    if (!answers || dup2(2, 1) < 0) return 1;
    limit(RLIMIT_CORE, 0);
    if (most > 0) limit(RLIMIT_AS, most);
    limit(RLIMIT_CPU, most_seconds);
    try {
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        openvdb::initialize();
        std::ios::sync_with_stdio(false);
        const openvdb::GridPtrVec grids =
            grids_in({std::istreambuf_iterator<char>(std::cin), std::istreambuf_iterator<char>()});
        const GridBase &grid = wanted(grids, count > 2 ? arguments[2] : "");
        if (grid.isType<openvdb::FloatGrid>())
            put(static_cast<const openvdb::FloatGrid &>(grid));
        else
            put(static_cast<const openvdb::DoubleGrid &>(grid));
    } catch (const std::bad_alloc &) {
        refuse("the file is broken, or takes more memory than is left");
    } catch (const std::exception &error) {
        refuse(error.what());
    }
    return std::fflush(answers) == 0 ? 0 : 1;
}
