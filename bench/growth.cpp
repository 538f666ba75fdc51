// How a picture's cost grows with the number of shapes, 10 to 100,000, of five kinds of scene, by
// the CPU: processor time of a check, and of the picture with all that is made for it.
#include "bench/measure.h"

#include "backend-cpu/trace/march.h"

#include <cmath>
#include <fmt/format.h>
#include <random>

namespace fathom::bench {

namespace {

// Where small solids are scattered: in a cube that grows, so that each has as much room.
class Scattered {
  public:
    explicit Scattered(int count) : half_(0.5 * std::cbrt(count)) {}
    std::string place() {
        const double x = coordinate(), y = coordinate(), z = coordinate();
        return fmt::format(".translate([{:.3f}, {:.3f}, {:.3f}])", x, y, z);
    }
    double size() { return 0.1 + 0.1 * part_(random_); }

  private:
    double coordinate() { return half_ * (2 * part_(random_) - 1); }
    double half_;
    std::mt19937 random_{3};
    std::uniform_real_distribution<double> part_{0, 1};
};

std::string spheres(const std::string &head, int count) {
    Scattered scattered(count);
    std::string text = head + " {\n";
    for (int i = 0; i < count; ++i)
        text += fmt::format("  sphere({:.3f}){}\n", scattered.size(), scattered.place());
    return text + "}\n";
}

std::string four_kinds(int count) {
    Scattered scattered(count);
    std::string text = "union {\n";
    for (int i = 0; i < count; ++i) {
        const double a = scattered.size(), b = scattered.size();
        switch (i % 4) {
        case 0: text += fmt::format("  sphere({:.3f})", a); break;
        case 1: text += fmt::format("  box([{:.3f}, {:.3f}, {:.3f}])", a, b, a); break;
        case 2: text += fmt::format("  cylinder({:.3f}, {:.3f})", a, b); break;
        case 3: text += fmt::format("  torus({:.3f}, {:.3f})", a, b / 3); break;
        }
        text += scattered.place() + "\n";
    }
    return text + "}\n";
}

std::string of_a_loop(int count) {
    return fmt::format("smooth_union(0.05) {{\n  for i in 0..{} {{\n"
                       "    sphere(0.1 + 0.1 * hash(i)).translate({:.3f} * (vec3(hash(3 * i + 1), "
                       "hash(3 * i + 2), hash(3 * i + 3)) - 0.5))\n  }}\n}}\n",
                       count, std::cbrt(count));
}

std::string cut_out(int count) {
    return fmt::format("box({:.3f}) - ", std::cbrt(count)) + spheres("union", count);
}

void measure(Table &table, const char *kind, int count, const std::string &text) {
    const std::string what = fmt::format("{}, {} shapes", kind, count);
    const double begin = processor_seconds();
    const driver::Compilation made = compiled_text("growth.sdf", text);
    const double checked = processor_seconds();
    if (!made.good()) return table.push_back({.what = what, .missing = complaint(made)});
    constexpr int width = 320, height = 240;
    const cpu::Stage stage = cpu::prepare(
        made.scene, ir::view_of(made.scene, 0, double(width) / height), width, height, 0);
    cpu::PictureOptions one_thread;
    one_thread.jobs = 1;
    cpu::render(stage, one_thread);
    table.push_back({.what = what + ": check", .value = (checked - begin) * 1e3, .unit = "ms"});
    table.push_back({.what = "  picture 320x240",
                     .value = (processor_seconds() - checked) * 1e3,
                     .unit = "ms"});
}

} // namespace

void measure_growth(Table &table) {
    for (int count = 10; count <= 100000; count *= 10) {
        measure(table, "union of spheres", count, spheres("union", count));
        measure(table, "smooth union of spheres", count, spheres("smooth_union(0.05)", count));
        measure(table, "union of four kinds", count, four_kinds(count));
        measure(table, "smooth union by a loop", count, of_a_loop(count));
        measure(table, "box less spheres", count, cut_out(count));
    }
}

} // namespace fathom::bench
