// Every example goes out to a save file and comes back the same: the marched distance at random
// points, the picture, the parameters and all settings. What a plain 0.3 reader cannot see is said.
#include "tests/unit/save/support.h"

#include "backend-cpu/march.h"
#include "backend-cpu/tape.h"
#include "driver/compile.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>

using namespace save_test;

namespace {

constexpr int picture_width = 80, picture_height = 60, asked_points = 1000;

using Coordinates = std::array<std::vector<float>, 3>;

Coordinates random_points(const ir::Scene &scene) {
    std::mt19937 random(7);
    Coordinates made;
    for (int i = 0; i < asked_points; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const double lo = std::max(scene.bounds.empty() ? -2 : scene.bounds.lo[k] - 0.5, -8.0),
                         hi = std::min(scene.bounds.empty() ? 2 : scene.bounds.hi[k] + 0.5, 8.0);
            made[k].push_back(static_cast<float>(lo + (hi - lo) * (random() / 4294967296.0)));
        }
    return made;
}

std::vector<float> marched(const ir::Scene &scene, const Coordinates &at, double time) {
    const cpu::Program program = cpu::compile(scene, scene.distance);
    cpu::Scratch scratch = cpu::make_scratch(program, cpu::inputs_of(scene, time));
    std::vector<float> result(at[0].size());
    const float *in[] = {at[0].data(), at[1].data(), at[2].data()};
    float *out[] = {result.data()};
    cpu::evaluate(program, scratch, in, out, result.size());
    return result;
}

// The largest difference of two scenes' marched distances.
double field_difference(const ir::Scene &a, const ir::Scene &b, double time) {
    const Coordinates at = random_points(a);
    const std::vector<float> x = marched(a, at, time), y = marched(b, at, time);
    double worst = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double off = std::abs(double(x[i]) - double(y[i])) / std::max(1.0, std::abs(double(x[i])));
        if (!(off <= worst)) worst = off;
    }
    return worst;
}

std::vector<std::uint8_t> picture(const ir::Scene &scene, double time) {
    const ir::View view = ir::view_of(scene, time, static_cast<double>(picture_width) / picture_height);
    return cpu::render(cpu::prepare(scene, view, picture_width, picture_height, time), {}).rgba;
}

// Of 100 pixels.
double picture_difference(const ir::Scene &a, const ir::Scene &b, double time) {
    const std::vector<std::uint8_t> x = picture(a, time), y = picture(b, time);
    int differ = 0;
    for (std::size_t i = 0; i < x.size(); i += 4) {
        int most = 0;
        for (std::size_t c = i; c < i + 3; ++c) most = std::max(most, std::abs(x[c] - y[c]));
        differ += most > 1;
        if (std::getenv("FATHOM_DUMP") && most > 1) printf("(%d,%d):%d ", int(i/4)%picture_width, int(i/4)/picture_width, most);
    }
    return 100.0 * differ / (picture_width * picture_height);
}

struct Trip {
    std::string exported, labelled, imported, errors;
    driver::Compilation back;
};

Trip there_and_back(const driver::Compilation &first) {
    Trip trip;
    Diagnostics diagnostics;
    const std::string yaml = save::export_yaml(first.scene, diagnostics);
    for (const Diagnostic &d : diagnostics.items()) {
        if (d.severity == Severity::Note) trip.labelled += d.message + "\n";
        else trip.exported += d.message + "\n";
    }
    const Imported imported = import_text(yaml);
    trip.imported = imported.said();
    trip.back = driver::compile_text("back.sdf", imported.result.sdf,
                                     FATHOM_SOURCE_DIR "/examples", {});
    for (const Diagnostic &d : trip.back.diagnostics.items())
        if (d.severity != Severity::Note)
            trip.errors += to_text(d, trip.back.sources, false).substr(0, 600) + "\n";
    return trip;
}

} // namespace

TEST_CASE("every example comes back from a save file with its field and its picture",
          "[save][examples]") {
    const char *only = std::getenv("FATHOM_EXAMPLE");
    std::vector<std::filesystem::path> files;
    for (const auto &entry : std::filesystem::directory_iterator(FATHOM_SOURCE_DIR "/examples"))
        if (entry.path().extension() == ".sdf") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    CHECK(files.size() >= 40);
    for (const std::filesystem::path &file : files) {
        const std::string name = file.stem().string();
        if (only && name != only) continue;
        CAPTURE(name);
        auto t0 = std::chrono::steady_clock::now();
        const driver::Compilation first = driver::compile_file(file, {});
        REQUIRE(first.good());
        if (std::getenv("FATHOM_DUMP")) { Diagnostics d; puts(save::export_yaml(first.scene, d).c_str()); puts(import_text(save::export_yaml(first.scene, d)).result.sdf.c_str()); }
        const Trip trip = there_and_back(first);
        CHECK(trip.imported == "");
        CHECK(trip.errors == "");
        auto t1 = std::chrono::steady_clock::now();
        if (std::getenv("FATHOM_DUMP")) for (const ir::Scene *sc : {&first.scene, &trip.back.scene}) { for (std::size_t k = 0; k < sc->facts.size(); ++k) printf("%s %.9g [%g]\n", ir::shape_kind_name(sc->shapes[ir::ShapeId{k}].kind), sc->facts[k].lipschitz_sup, sc->graph.as_number(sc->facts[k].lipschitz).value_or(-1)); puts("----"); }
        if (!trip.back.good()) { printf("%-24s BAD\n", name.c_str()); continue; }
        const double field = field_difference(first.scene, trip.back.scene, 0),
                     pixels = picture_difference(first.scene, trip.back.scene, 0);
        auto t2 = std::chrono::steady_clock::now();
        CHECK(field <= 1e-6);
        CHECK(pixels <= 0.5);
        printf("%-24s %9.2g %7.2f %%  %.2f %.2f s  %s\n", name.c_str(), field, pixels, std::chrono::duration<double>(t1-t0).count(), std::chrono::duration<double>(t2-t1).count(), (trip.exported+trip.labelled).c_str());
    }
}
