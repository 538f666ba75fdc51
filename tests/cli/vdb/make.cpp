// OpenVDB files that Fathom itself does not write, into the folder that is named: for vdb_test.cpp.
#include <openvdb/openvdb.h>

#include <algorithm>
#include <limits>
#include <string>

using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::math::Transform;

namespace {

// A ball of radius `r`, with all voxels of a cube about it, 0.1 apart; cut off at 0.15, as level sets
// are.
FloatGrid::Ptr ball(const char *name, float r) {
    auto grid = FloatGrid::create(0.15f);
    grid->setName(name);
    grid->setTransform(Transform::createLinearTransform(0.1));
    auto values = grid->getAccessor();
    for (int x = -12; x <= 12; ++x)
        for (int y = -12; y <= 12; ++y)
            for (int z = -12; z <= 12; ++z) {
                const openvdb::Vec3s at(0.1f * float(x), 0.1f * float(y), 0.1f * float(z));
                values.setValue(Coord(x, y, z), std::min(at.length() - r, 0.15f));
            }
    return grid;
}

FloatGrid::Ptr with(FloatGrid::Ptr grid, Transform::Ptr transform) {
    grid->setTransform(std::move(transform));
    return grid;
}

} // namespace

int main(int count, char **arguments) {
    if (count != 2) return 2;
    openvdb::initialize();
    const std::string folder = std::string(arguments[1]) + "/";
    const auto write = [&](const char *name, const openvdb::GridCPtrVec &grids) {
        openvdb::io::File file(folder + name);
        file.write(grids);
        file.close();
    };
    const auto mist = openvdb::Vec3SGrid::create();
    mist->setName("mist");
    write("two.vdb", {ball("density", 0.5f), ball("heat", 1), mist});
    write("alike.vdb", {ball("density", 0.5f), ball("density", 1)});

    auto turned = Transform::createLinearTransform(0.1);
    turned->postRotate(0.5, openvdb::math::Y_AXIS);
    write("turned.vdb", {with(ball("ball", 1), turned)});
    auto mirrored = Transform::createLinearTransform(0.1);
    mirrored->postScale({-1, 1, 1});
    write("mirrored.vdb", {with(ball("ball", 1), mirrored)});
    auto stretched = Transform::createLinearTransform(0.1);
    stretched->postScale({1, 2, 1});
    stretched->postTranslate({0, 5, 0});
    write("stretched.vdb", {with(ball("ball", 1), stretched)});
    const openvdb::BBoxd frustum({-12, -12, -12}, {12, 12, 12});
    write("perspective.vdb",
          {with(ball("ball", 1), Transform::createFrustumTransform(frustum, 0.5, 2, 0.1))});

    write("empty.vdb", {FloatGrid::create(-1)});
    const auto tile = ball("ball", 1);
    tile->fill({Coord(0, 0, 0), Coord(8191, 8191, 8191)}, -1.0f);
    write("tile.vdb", {tile});
    const auto broken = ball("ball", 1);
    broken->getAccessor().setValue(Coord(3, 3, 3), std::numeric_limits<float>::quiet_NaN());
    write("nan.vdb", {broken});
}
