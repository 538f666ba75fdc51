// A looser proof never changes a picture: each example drawn by the CPU with all its bounds as they
// were proved and 2, 4 and 16 times as large. Rays take more steps; colours stay, but for one pixel in
// a thousand and rays that are undecided.
#include "backend-cpu/trace/march.h"
#include "driver/compile.h"
#include "ir/lower/lower.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>

using namespace fathom;
namespace fs = std::filesystem;

namespace {

// FATHOM_BOUNDS=1 draws four times the pixels and tries 2, 4 and 16 times the bounds: minutes.
const bool all = std::getenv("FATHOM_BOUNDS") != nullptr;
const int width = all ? 200 : 100, height = all ? 150 : 75;
constexpr int visible = 2; // of 255
constexpr double a_thousandth = 0.001;

void loosen(ir::Scene &scene, double times) {
    for (ir::ShapeFact &fact : scene.facts) {
        if (fact.lipschitz)
            fact.lipschitz = scene.graph.mul(fact.lipschitz, scene.graph.number(times));
        fact.lipschitz_sup *= times;
        for (ir::PartialSum &sum : fact.partial) sum.slope *= times;
    }
    for (auto &[shape, cells] : scene.cells)
        for (double &bound : cells.lipschitz) bound *= times;
    const ir::Box framed = scene.framed; // which is found after lowering
    const std::vector<double> reach = scene.framed_reach;
    ir::lower(scene);
    scene.framed = framed;
    scene.framed_reach = reach;
}

cpu::Picture drawn(const ir::Scene &scene) {
    const cpu::Stage stage = cpu::prepare(
        scene, ir::view_of(scene, 0, static_cast<double>(width) / height), width, height, 0);
    return cpu::render(stage, {});
}

int different(const cpu::Picture &a, const cpu::Picture &b) {
    int count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
        int most = 0;
        for (std::size_t c = 0; c < 3; ++c)
            most = std::max(most, std::abs(int(a.rgba[i + c]) - int(b.rgba[i + c])));
        count += most > visible;
    }
    return count;
}

} // namespace

TEST_CASE("looser bounds change no picture") {
    std::vector<fs::path> files;
    const char *other = std::getenv("FATHOM_SCENES"); // a folder in place of the examples'
    const fs::path folder = other ? fs::path(other) : fs::path(FATHOM_SOURCE_DIR) / "examples";
    for (const auto &entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".sdf") files.push_back(entry.path());
    std::ranges::sort(files);
    const char *only = std::getenv("FATHOM_ONLY");
    for (const fs::path &file : files) {
        const std::string name = file.stem().string();
        if (only && name != only) continue;
        driver::Compilation proved = driver::compile_file(file.string(), {});
        REQUIRE(!proved.diagnostics.has_errors());
        const cpu::Picture right = drawn(proved.scene);
        std::string line = fmt::format("{}: undecided {};", name, right.work.undecided);
        for (const double times : all ? std::vector{2.0, 4.0, 16.0} : std::vector{4.0}) {
            driver::Compilation loose = driver::compile_file(file.string(), {});
            loosen(loose.scene, times);
            const cpu::Picture picture = drawn(loose.scene);
            const int differs = different(right, picture);
            line += fmt::format(" x{} {} ({:.1f} times the work, {} undecided)", times, differs,
                                double(picture.work.evaluations) / double(right.work.evaluations),
                                picture.work.undecided);
            INFO(name << ", bounds times " << times);
            CHECK(differs <= a_thousandth * width * height + double(picture.work.undecided));
        }
        if (all || only) fmt::print("{}\n", line);
    }
}
