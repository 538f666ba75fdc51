// Every example goes out to a save file and comes back the same: the marched distance at random
// points, the picture, the parameters and all settings. What a plain 0.3 reader cannot see is said.
#include "tests/unit/save/support.h"

#include "backend-cpu/march.h"
#include "backend-cpu/tape.h"
#include "driver/compile.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
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

// The largest difference of two scenes' marched distances; of those above 1, which are no more
// exact than float32 has them, as a part of the distance.
double field_difference(const ir::Scene &a, const ir::Scene &b, double time) {
    const Coordinates at = random_points(a);
    const std::vector<float> x = marched(a, at, time), y = marched(b, at, time);
    double worst = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double off =
            std::abs(double(x[i]) - double(y[i])) / std::max(1.0, std::abs(double(x[i])));
        if (!(off <= worst)) worst = off;
    }
    return worst;
}

std::vector<std::uint8_t> picture(const ir::Scene &scene, double time) {
    const ir::View view =
        ir::view_of(scene, time, static_cast<double>(picture_width) / picture_height);
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
    }
    return 100.0 * differ / (picture_width * picture_height);
}

struct Trip {
    std::string exported, labelled, imported, errors, sdf;
    driver::Compilation back;
};

Trip there_and_back(const driver::Compilation &first, const driver::CompileOptions &options) {
    Trip trip;
    Diagnostics diagnostics;
    const std::string yaml = save::export_yaml(first.scene, diagnostics);
    for (const Diagnostic &d : diagnostics.items()) {
        if (d.severity == Severity::Note)
            trip.labelled += d.message + "\n";
        else
            trip.exported += d.message + "\n";
    }
    const Imported imported = import_text(yaml);
    trip.imported = imported.said();
    trip.sdf = imported.result.sdf;
    trip.back = driver::compile_text("back.sdf", trip.sdf, FATHOM_SOURCE_DIR "/examples", options);
    for (const Diagnostic &d : trip.back.diagnostics.items())
        if (d.severity != Severity::Note)
            trip.errors += to_text(d, trip.back.sources, false).substr(0, 600) + "\n";
    return trip;
}

// Parameters moved off their values, each a third of the way up: what follows them has to come back
// too.
std::vector<driver::Override> moved_params(const ir::Scene &scene) {
    std::vector<driver::Override> moved;
    for (const ir::Param &param : scene.params)
        if (param.has_range && param.type == ir::Type::Float && !param.structural)
            moved.push_back(
                {param.name, std::to_string(param.lo[0] + (param.hi[0] - param.lo[0]) / 3)});
    return moved;
}

} // namespace

TEST_CASE("every example comes back from a save file with its field and its picture",
          "[save][examples]") {
    std::vector<std::filesystem::path> files;
    for (const auto &entry : std::filesystem::directory_iterator(FATHOM_SOURCE_DIR "/examples"))
        if (entry.path().extension() == ".sdf") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    CHECK(files.size() >= 40);
    std::size_t moving = 0, following = 0;
    for (const std::filesystem::path &file : files) {
        const std::string name = file.stem().string();
        CAPTURE(name);
        const driver::Compilation first = driver::compile_file(file, {});
        REQUIRE(first.good());
        const Trip trip = there_and_back(first, {});
        CAPTURE(trip.labelled);
        // the only thing that a file cannot hold: the other scenes that a loop's count stands for
        CHECK(trip.exported == (name == "folded_fractal"
                                    ? "`detail` decides what shapes there are: the file has those "
                                      "of its present value\n"
                                    : ""));
        CHECK(trip.imported == "");
        CHECK(trip.errors == "");
        if (!trip.back.good()) continue;
        CHECK(field_difference(first.scene, trip.back.scene, 0) <= 1e-6);
        CHECK(picture_difference(first.scene, trip.back.scene, 0) <= 0.5);

        const ir::Scene &a = first.scene, &b = trip.back.scene;
        CHECK(a.params.size() == b.params.size());
        for (std::size_t i = 0; i < a.params.size() && i < b.params.size(); ++i) {
            CHECK(a.params[i].name == b.params[i].name);
            CHECK(a.params[i].label == b.params[i].label);
            CHECK(a.params[i].type == b.params[i].type);
            CHECK(a.params[i].value == b.params[i].value);
            CHECK(a.params[i].lo == b.params[i].lo);
            CHECK(a.params[i].hi == b.params[i].hi);
        }
        CHECK(a.render.far == b.render.far);
        CHECK(a.render.epsilon == b.render.epsilon);
        CHECK(a.render.max_steps == b.render.max_steps);
        CHECK(a.render.time_end == b.render.time_end);
        CHECK(a.graph.cache_count() == b.graph.cache_count());
        if (trip.labelled.find("motion") != std::string::npos) {
            ++moving;
            CHECK(field_difference(a, b, 1.3) <= 1e-6);
        }
        driver::CompileOptions options;
        options.overrides = moved_params(a);
        if (options.overrides.empty()) continue;
        ++following;
        const driver::Compilation there = driver::compile_file(file, options),
                                  back = driver::compile_text(
                                      "back.sdf", trip.sdf, FATHOM_SOURCE_DIR "/examples", options);
        REQUIRE(there.good());
        REQUIRE(back.good());
        CHECK(field_difference(there.scene, back.scene, 0.7) <= 1e-6);
    }
    CHECK(moving >= 4);
    CHECK(following >= 8);
}
