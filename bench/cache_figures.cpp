// fathom-bench figures SCENE: what the thesis measured of its cache (figures 8.2 to 8.6), of one
// scene. Times are ratios of two ways taken alternately in one run; where the CPU draws, its own
// time counts, since others may share the machine.
#include "bench/measure.h"

#include "ir/passes/cost.h"
#include "render-gl/cache_passes.h"
#include "render-gl/context.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fmt/format.h>
#define GLM_ENABLE_EXPERIMENTAL
#include <glm/gtx/rotate_vector.hpp>

namespace fathom::bench {
namespace {

constexpr double frame_time = 1.0 / 30;

struct Bench {
    const ir::Scene &scene;
    int width, height;
    bool software; // the CPU draws

    double now() const {
        if (software) return static_cast<double>(std::clock()) / CLOCKS_PER_SEC * 1000;
        const auto since = std::chrono::steady_clock::now().time_since_epoch();
        return std::chrono::duration<double, std::milli>(since).count();
    }
    void put(const std::string &row) const { // at once: the next one may take long
        std::fputs(row.c_str(), stdout);
        std::fflush(stdout);
    }
    std::uint64_t pixels() const {
        return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    }
    template <class Work> double time(Work work) const {
        const double begin = now();
        work();
        gl::finish();
        return now() - begin;
    }
};

// The scene's own view, turned about the height through what it looks at: as if the scene turned.
ir::View turned(const ir::Scene &scene, double aspect, double angle) {
    ir::View view = ir::view_of(scene, 0, aspect);
    const glm::dvec3 target = view.origin + view.focus * view.forward;
    const auto turn = [&](const glm::dvec3 &v) { return glm::rotateY(v, angle); };
    view.origin = target + turn(view.origin - target);
    view.right = turn(view.right);
    view.up = turn(view.up);
    view.forward = turn(view.forward);
    return view;
}

gl::FrameInputs inputs_of(const Bench &bench, double angle, gl::Mode mode = gl::Mode::Picture) {
    gl::FrameInputs inputs;
    const double aspect = static_cast<double>(bench.width) / bench.height;
    inputs.view = turned(bench.scene, aspect, angle);
    inputs.sun = ir::lights_of(bench.scene, 0, ir::view_of(bench.scene, 0, aspect))[0].position;
    inputs.width = bench.width;
    inputs.height = bench.height;
    inputs.mode = mode;
    return inputs;
}

struct Motion {
    double cached = 0, exact = 0;                                            // medians of a frame
    double misses = 0, computed = 0, inserted = 0, evicted = 0, deleted = 0; // means of a frame
    double hits = 0;
    gl::CacheOccupancy occupancy;
};

struct Move {
    double speed = 0; // radians a second; of a param: of the sine that moves it
    int settle = 0;   // frames before those that are measured
    int frames = 8;
    int age = 4;
    int param = -1;     // which is moved; none: the view turns
    bool weigh = false; // drawn exactly where that is quicker, by counted work
};

Motion move(const Bench &bench, gl::CachedView &view, const Move &how) {
    Motion motion;
    std::vector<double> cached, exact;
    std::vector<ir::Param> params = bench.scene.params;
    const auto add = [&](double &to, double value) { to += value / how.frames; };
    for (int frame = 0; frame < how.settle + how.frames; ++frame) {
        const double phase = how.speed * frame * frame_time;
        if (how.param >= 0) { // a quarter of its range, to where there is more room, and back
            ir::Param &p = params[static_cast<std::size_t>(how.param)];
            const double range = p.hi[0] - p.lo[0];
            const double way = p.initial[0] < p.lo[0] + range / 2 ? 1 : -1;
            p.value[0] = p.initial[0] + way * 0.25 * range * std::abs(std::sin(phase));
        }
        const gl::FrameInputs inputs = inputs_of(bench, how.param < 0 ? phase : 0);
        const double one = bench.time(
            [&] { view.draw(inputs, params, {.max_age = how.age, .weigh = how.weigh}); });
        if (frame < how.settle) continue;
        const gl::CacheTally tally = view.read_tally();
        const gl::CacheCounts counts = view.store().read_counts();
        cached.push_back(one);
        add(motion.hits, static_cast<double>(tally.hits));
        add(motion.misses, static_cast<double>(tally.misses));
        add(motion.computed, static_cast<double>(tally.computed));
        add(motion.inserted, counts.inserted);
        add(motion.evicted, counts.evicted);
        add(motion.deleted, counts.deleted);
        if ((frame - how.settle) % 2 == 0)
            exact.push_back(bench.time([&] { view.draw_exactly(inputs, params); }));
    }
    motion.cached = median(cached);
    motion.exact = median(exact);
    motion.occupancy = gl::occupancy(view.store().dump(false));
    return motion;
}

void print_fields(const Bench &bench) {
    const ir::Graph &graph = bench.scene.graph;
    for (std::size_t i = 0; i < graph.cache_count(); ++i) {
        const ir::CacheId id{i};
        const double cost = ir::cost_of(graph, graph.function(graph.cache(id).field).result);
        const char *verdict = "cached";
        switch (ir::cached(bench.scene, id)) {
        case ir::Cacheable::Yes: break;
        case ir::Cacheable::Cheap: verdict = "computed: cheaper than a look-up"; break;
        case ir::Cacheable::Moving: verdict = "computed: it moves with time"; break;
        case ir::Cacheable::Ridged: verdict = "computed: Worley noise alone, too few cells"; break;
        case ir::Cacheable::Steep: verdict = "computed: its slope has no bound"; break;
        }
        bench.put(fmt::format("field {}: cell {:g}, about {:.3g} ns against {:g} for a "
                              "look-up, error at most {:.3g}; {}\n",
                              i, graph.cache(id).cell, cost, ir::look_up_cost,
                              ir::cached_error(bench.scene, id), verdict));
    }
}

void print_difference(const Bench &bench, gl::CachedView &view) {
    view.forget();
    int frames = 0;
    const gl::FrameInputs inputs = inputs_of(bench, 0, gl::Mode::Numbers);
    std::vector<std::uint64_t> misses;
    do {
        view.draw(inputs, bench.scene.params, {.weigh = false});
        misses.push_back(view.read_tally().misses);
    } while (1000 * misses.back() > bench.pixels() && ++frames < 40);
    const gl::Pixels cached = view.read_pixels();
    view.draw_exactly(inputs, bench.scene.params);
    const gl::Pixels exact = view.read_pixels();
    double maximum = 0, sum = 0;
    std::size_t both = 0, one = 0;
    for (std::size_t i = 0; i < cached.rgba.size(); i += 4) {
        const bool here = cached.rgba[i + 3] > 0, there = exact.rgba[i + 3] > 0;
        if (here != there) ++one;
        if (!here || !there) continue;
        const double d = std::abs(cached.rgba[i + 1] - exact.rgba[i + 1]);
        maximum = std::max(maximum, d), sum += d, ++both;
    }
    bench.put(fmt::format("\ndifference from exact (figure 8.4), a still view after {} frames\n",
                          frames));
    bench.put(fmt::format(
        "  along the ray: mean {:.3g}, most {:.3g}; pixels that only one of them hits: {} of {}\n",
        sum / static_cast<double>(std::max<std::size_t>(both, 1)), maximum, one, both + one));
    bench.put("  misses by frame:");
    for (std::size_t i = 0; i < misses.size() && i < 12; ++i)
        bench.put(fmt::format(" {}", misses[i]));
    bench.put("\n");
}

void learn(const Bench &bench, gl::CachedView &view) {
    const gl::FrameInputs inputs = inputs_of(bench, 0);
    for (int frame = 0; frame < 40; ++frame) {
        view.draw(inputs, bench.scene.params, {.weigh = false});
        if (1000 * view.read_tally().misses <= bench.pixels()) return;
    }
}

void print_speeds(const Bench &bench, gl::CachedView &view, int frames) {
    bench.put("\nspeed-up against the speed of turning (figure 8.6)\n"
              "  rad/s   cached ms   exact ms   speed-up   misses a frame   pixels that "
              "miss   hits a frame\n");
    for (double speed : {0.0, 0.1, 0.5, 1.0, 2.0, 4.0}) {
        // A still view is learnt until it needs nothing new, a turning one settles to its own
        // share of misses.
        if (speed == 0) learn(bench, view);
        const Motion m = move(bench, view, {.speed = speed, .settle = frames, .frames = frames});
        bench.put(fmt::format(
            "  {:<5g} {:>11.1f} {:>10.1f} {:>10.2f} {:>16.0f} {:>18.0f} {:>14.0f}\n", speed,
            m.cached, m.exact, m.exact / m.cached, m.misses, m.computed, m.hits));
    }
}

void print_ages(const Bench &bench, gl::CachedView &view, int frames) {
    bench.put("\nmaximum age, turning at 2 rad/s (figure 8.2)\n"
              "  age   cached ms   inserted   evicted   deleted   misses a frame\n");
    Motion usual;
    for (int age : {1, 2, 4, glsl::cache_ages}) {
        view.forget();
        const Motion m =
            move(bench, view, {.speed = 2, .settle = frames, .frames = frames, .age = age});
        if (age == 4) usual = m;
        bench.put(fmt::format("  {:<3} {:>11.1f} {:>10.0f} {:>9.0f} {:>9.0f} {:>16.0f}\n", age,
                              m.cached, m.inserted, m.evicted, m.deleted, m.misses));
    }
    bench.put(fmt::format("\nages at 2 rad/s, {} keys in {} cells (figure 8.3)\n ",
                          usual.occupancy.keys, usual.occupancy.cells));
    for (std::size_t age = 0; age < 4; ++age)
        bench.put(fmt::format("  {}: {}", age, usual.occupancy.ages[age]));
    bench.put("\n");
}

// Each frame with another value: cached all the same, as a moving view is drawn, and exactly.
void print_edits(const Bench &bench, gl::CachedView &view, int frames) {
    bench.put("\nediting a param, another value each frame (figure 8.5)\n"
              "  param            read by a cached field   cached ms   as drawn ms   exact ms   "
              "speed-up   as drawn   pixels that miss\n");
    const std::vector<glsl::CachedField> &fields = view.fields();
    for (std::size_t i = 0; i < bench.scene.params.size(); ++i) {
        const ir::Param &p = bench.scene.params[i];
        if (p.structural || p.type != ir::Type::Float || !p.has_range) continue;
        const bool read = std::any_of(fields.begin(), fields.end(), [&](const auto &field) {
            return std::count(field.params.begin(), field.params.end(), i) > 0;
        });
        view.weigh_anew();
        learn(bench, view);
        Move how{.speed = 1, .settle = frames, .frames = frames, .param = static_cast<int>(i)};
        const Motion forced = move(bench, view, how);
        how.weigh = true;
        const Motion drawn = move(bench, view, how);
        bench.put(fmt::format("  {:<16} {:<20} {:>11.1f} {:>13.1f} {:>10.1f} {:>10.2f} {:>10.2f} "
                              "{:>18.0f}\n",
                              p.name, read ? "yes" : "no", forced.cached, drawn.cached,
                              forced.exact, forced.exact / forced.cached,
                              drawn.exact / drawn.cached, forced.misses));
    }
}

void measure(const Bench &bench, gl::CachedView &view, const FigureOptions &options) {
    const int side = view.store().side();
    const auto wanted = [&](const char *figure) {
        return options.figure.empty() || options.figure == figure;
    };
    // As many frames as take about three minutes in all, unless it was said.
    const gl::FrameInputs inputs = inputs_of(bench, 0);
    const double one = bench.time([&] { view.draw_exactly(inputs, bench.scene.params); });
    const int usual = std::clamp(static_cast<int>(2000 / std::max(one, 1.0)), 2, 24);
    const int frames = options.frames > 0 ? options.frames : usual;
    if (wanted("8.4")) print_difference(bench, view);
    if (wanted("8.6")) print_speeds(bench, view, frames);
    if (wanted("8.2") || wanted("8.3")) print_ages(bench, view, frames);
    if (wanted("8.5")) print_edits(bench, view, frames);
    if (view.store().side() > side)
        bench.put(fmt::format("\nthe cache has grown to {0}x{0}x{0} cells, {1:.3g} MB\n",
                              view.store().side(),
                              static_cast<double>(view.store().size().bytes()) / 1e6));
}

} // namespace

int measure_figures(const FigureOptions &options) {
    const driver::Compilation compilation = driver::compile_file(options.scene, {});
    if (!compilation.good()) {
        std::fprintf(stderr, "fathom-bench: %s: %s\n", options.scene.c_str(),
                     complaint(compilation).c_str());
        return 1;
    }
    const ir::Scene &scene = compilation.scene;
    auto context = gl::Context::make();
    if (const std::string *why = std::get_if<std::string>(&context)) {
        std::fprintf(stderr, "fathom-bench: no GL to measure with: %s\n", why->c_str());
        return 3;
    }
    const std::string driver = std::get<gl::Context>(context).describe();
    Diagnostics diagnostics;
    Bench bench{scene, options.width, options.height, driver.find("llvmpipe") != driver.npos};
    bench.put(fmt::format("GL {}; times are {}\n", driver,
                          bench.software ? "the processor's" : "on the clock"));
    print_fields(bench);
    gl::CachedView view;
    const gl::CacheSize size =
        options.cache_bits ? gl::CacheSize{.bits = options.cache_bits} : gl::usual_cache_size;
    const std::string why = view.use(scene, size, diagnostics);
    if (!why.empty()) {
        std::fprintf(stderr, "fathom-bench: drawn exactly: %s\n", why.c_str());
        return 0;
    }
    bench.put(fmt::format("cache: {0}x{0}x{0} cells, {1:.3g} MB\n", view.store().side(),
                          static_cast<double>(view.store().size().bytes()) / 1e6));
    measure(bench, view, options);
    return 0;
}

} // namespace fathom::bench
