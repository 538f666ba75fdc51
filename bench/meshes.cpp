// Meshes: what scenes cost as triangles, without a certificate and with it, each in a process of its
// own, so that its memory is. `fathom-bench meshes FILE…` prints what the certificates of files say.
#include "bench/measure.h"

#include "mesh/mend.h"

#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fathom::bench {

namespace {

struct Measured {
    bool made = false, certified = false;
    double processor = 0, wall = 0, megabytes = 0; // at most at once
    std::size_t triangles = 0, crossed = 0, undecided = 0, unproved = 0, nodes = 0;
    double mesh_to_surface = 0, surface_to_mesh = 0, side = 0;
    int rounds = 0;
    mesh::Failure failure = mesh::Failure::None;
};

std::size_t crossed_cells(const mesh::Octree &octree) {
    std::size_t count = 0;
    for (const mesh::Cell &cell : open_leaves(octree))
        count += octree.nodes[static_cast<std::size_t>(cell.node)].crossed();
    return count;
}

Measured measured(const ir::Scene &scene, const mesh::Settings &settings, bool certify) {
    Measured result;
    mesh::Mended mended;
    const double begin = processor_seconds();
    result.wall = seconds([&] {
        if (certify)
            mended = make_certified_mesh(scene, settings);
        else
            mended.made = make_mesh(scene, settings);
    });
    result.processor = processor_seconds() - begin;
    result.failure = mended.made.failure;
    result.made = result.failure == mesh::Failure::None;
    result.triangles = mended.made.mesh.triangles.size();
    if (!result.made) return result;
    const mesh::Lattice &lattice = mended.made.octree.lattice;
    result.side = lattice.side(lattice.level);
    result.crossed = crossed_cells(mended.made.octree);
    result.nodes = mended.made.octree.nodes.size();
    result.undecided = certify ? mended.certificate.undecided.size() : 0;
    result.unproved = mended.certificate.unproved.size();
    result.certified = certify && mended.certificate.certified();
    result.mesh_to_surface = mended.certificate.mesh_to_surface;
    result.surface_to_mesh = mended.certificate.surface_to_mesh;
    result.rounds = mended.rounds;
    return result;
}

// The same in a process of its own.
Measured apart(const ir::Scene &scene, const mesh::Settings &settings, bool certify) {
    Measured result;
    int ends[2];
    if (pipe(ends) != 0) return result;
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        const Measured made = measured(scene, settings, certify);
        const auto written = write(ends[1], &made, sizeof made);
        _exit(written == static_cast<ssize_t>(sizeof made) ? 0 : 1);
    }
    close(ends[1]);
    if (child > 0) {
        const auto got = read(ends[0], &result, sizeof result);
        int status = 0;
        rusage used{};
        wait4(child, &status, 0, &used);
        if (got != static_cast<ssize_t>(sizeof result)) result = {};
        result.megabytes = static_cast<double>(used.ru_maxrss) / 1024;
    }
    close(ends[0]);
    return result;
}

} // namespace

int measure_meshes(const MeshFigureOptions &options) {
    std::printf("%s\n\n%-28s %9s %9s %8s %8s %9s %9s %7s %7s %6s\n", machine().c_str(), "scene",
                "triangles", "crossed", "undecid.", "unprov.", "off, s", "on, s", "ratio", "rounds",
                "MB");
    int exit = 0;
    for (const std::string &file : options.files) {
        const std::string name = std::filesystem::path(file).stem().string();
        const driver::Compilation compilation = driver::compile_file(file, {});
        if (!compilation.good()) {
            std::printf("%-28s %s\n", name.c_str(), complaint(compilation).c_str());
            exit = 1;
            continue;
        }
        mesh::Settings settings;
        settings.resolution = options.resolution;
        settings.threads = options.threads;
        Measured off = apart(compilation.scene, settings, false);
        if (off.failure == mesh::Failure::Endless && options.bounds.size() == 6) {
            const std::vector<double> &b = options.bounds;
            settings.bounds = ir::Box{{b[0], b[1], b[2]}, {b[3], b[4], b[5]}};
            off = apart(compilation.scene, settings, false);
        }
        if (!off.made) {
            std::printf("%-28s no mesh\n", name.c_str());
            exit = 1;
            continue;
        }
        const Measured on = apart(compilation.scene, settings, true);
        std::printf("%-28s %9zu %9zu %8zu %8zu %9.2f %9.2f %7.2f %7d %6.0f\n",
                    (name + (settings.bounds ? ", cut" : "")).c_str(), on.triangles, on.crossed,
                    on.undecided, on.unproved, off.processor, on.processor,
                    on.processor / off.processor, on.rounds, on.megabytes);
        std::fflush(stdout);
    }
    return exit;
}

} // namespace fathom::bench
