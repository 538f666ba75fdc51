// fathom bench --noise-cache: what the thesis measured of its cache (figures 8.2 to 8.6), of one
// scene. Times are ratios of two ways taken in turn in one run; where the CPU draws, its own time
// counts, since others may share the machine.
#include "cli/bench.h"
#include "ir/cost.h"
#include "render-gl/cache_passes.h"
#include "render-gl/context.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <fmt/format.h>

namespace fathom::cli {
namespace {

constexpr double frame_time = 1.0 / 30;

struct Bench {
    const ir::Scene &scene;
    int width, height;
    bool software; // the CPU draws
    Terminal &terminal;

    double now() const {
        if (software) return static_cast<double>(std::clock()) / CLOCKS_PER_SEC * 1000;
        const auto since = std::chrono::steady_clock::now().time_since_epoch();
        return std::chrono::duration<double, std::milli>(since).count();
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
    const double c = std::cos(angle), s = std::sin(angle);
    ir::Triple target{};
    for (std::size_t i = 0; i < 3; ++i) target[i] = view.origin[i] + view.focus * view.forward[i];
    const auto turn = [&](const ir::Triple &v) {
        return ir::Triple{c * v[0] + s * v[2], v[1], c * v[2] - s * v[0]};
    };
    ir::Triple back = view.origin;
    for (std::size_t i = 0; i < 3; ++i) back[i] -= target[i];
    back = turn(back);
    for (std::size_t i = 0; i < 3; ++i) view.origin[i] = target[i] + back[i];
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
    int param = -1; // which is moved; none: the view turns
};

Motion move(const Bench &bench, gl::CachedView &view, const Move &how) {
    Motion motion;
    std::vector<double> cached, exact;
    std::vector<ir::Param> params = bench.scene.params;
    const auto add = [&](double &to, double value) { to += value / how.frames; };
    for (int frame = 0; frame < how.settle + how.frames; ++frame) {
        const double phase = how.speed * frame * frame_time;
        if (how.param >= 0) { // there and back over a quarter of its range
            ir::Param &p = params[static_cast<std::size_t>(how.param)];
            p.value[0] = std::clamp(p.initial[0] + 0.25 * (p.hi[0] - p.lo[0]) * std::sin(phase),
                                    p.lo[0], p.hi[0]);
        }
        const gl::FrameInputs inputs = inputs_of(bench, how.param < 0 ? phase : 0);
        const double one =
            bench.time([&] { view.draw(inputs, params, {.max_age = how.age, .weigh = false}); });
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
        const char *verdict = "kept";
        switch (ir::kept(bench.scene, id)) {
        case ir::Kept::Yes: break;
        case ir::Kept::Cheap: verdict = "computed: cheaper than a look-up"; break;
        case ir::Kept::Moving: verdict = "computed: it moves with time"; break;
        case ir::Kept::Ridged: verdict = "computed: Worley noise alone, too few cells"; break;
        case ir::Kept::Steep: verdict = "computed: its slope has no bound"; break;
        }
        bench.terminal.put(fmt::format("field {}: cell {:g}, about {:.3g} ns against {:g} for a "
                                       "look-up, error at most {:.3g}; {}\n",
                                       i, graph.cache(id).cell, cost, ir::look_up_cost,
                                       ir::kept_error(bench.scene, id), verdict));
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
    const gl::Pixels kept = view.read_pixels();
    view.draw_exactly(inputs, bench.scene.params);
    const gl::Pixels exact = view.read_pixels();
    double most = 0, sum = 0;
    std::size_t both = 0, one = 0;
    for (std::size_t i = 0; i < kept.rgba.size(); i += 4) {
        const bool here = kept.rgba[i + 3] > 0, there = exact.rgba[i + 3] > 0;
        if (here != there) ++one;
        if (!here || !there) continue;
        const double d = std::abs(kept.rgba[i + 1] - exact.rgba[i + 1]);
        most = std::max(most, d), sum += d, ++both;
    }
    bench.terminal.put(fmt::format(
        "\ndifference from exact (figure 8.4), a still view after {} frames\n", frames));
    bench.terminal.put(fmt::format(
        "  along the ray: mean {:.3g}, most {:.3g}; pixels that only one of them hits: {} of {}\n",
        sum / static_cast<double>(std::max<std::size_t>(both, 1)), most, one, both + one));
    bench.terminal.put("  misses by frame:");
    for (std::size_t i = 0; i < misses.size() && i < 12; ++i)
        bench.terminal.put(fmt::format(" {}", misses[i]));
    bench.terminal.put("\n");
}

void learn(const Bench &bench, gl::CachedView &view) {
    const gl::FrameInputs inputs = inputs_of(bench, 0);
    for (int frame = 0; frame < 40; ++frame) {
        view.draw(inputs, bench.scene.params, {.weigh = false});
        if (1000 * view.read_tally().misses <= bench.pixels()) return;
    }
}

void print_speeds(const Bench &bench, gl::CachedView &view, int frames) {
    bench.terminal.put("\nspeed-up against the speed of turning (figure 8.6)\n"
                       "  rad/s   cached ms   exact ms   speed-up   misses a frame   pixels that "
                       "miss   hits a frame\n");
    for (double speed : {0.0, 0.1, 0.5, 1.0, 2.0, 4.0}) {
        // A still view is learnt until it asks for nothing new, a turning one settles to its own
        // share of misses.
        if (speed == 0) learn(bench, view);
        const Motion m = move(bench, view, {.speed = speed, .settle = frames, .frames = frames});
        bench.terminal.put(fmt::format(
            "  {:<5g} {:>11.1f} {:>10.1f} {:>10.2f} {:>16.0f} {:>18.0f} {:>14.0f}\n", speed,
            m.cached, m.exact, m.exact / m.cached, m.misses, m.computed, m.hits));
        bench.terminal.flush();
    }
}

void print_ages(const Bench &bench, gl::CachedView &view, int frames) {
    bench.terminal.put("\nmaximum age, turning at 2 rad/s (figure 8.2)\n"
                       "  age   cached ms   inserted   evicted   deleted   misses a frame\n");
    Motion usual;
    for (int age : {1, 2, 4, glsl::cache_ages}) {
        view.forget();
        const Motion m =
            move(bench, view, {.speed = 2, .settle = frames, .frames = frames, .age = age});
        if (age == 4) usual = m;
        bench.terminal.put(fmt::format("  {:<3} {:>11.1f} {:>10.0f} {:>9.0f} {:>9.0f} {:>16.0f}\n",
                                       age, m.cached, m.inserted, m.evicted, m.deleted, m.misses));
        bench.terminal.flush();
    }
    bench.terminal.put(fmt::format("\nages at 2 rad/s, {} keys in {} cells (figure 8.3)\n ",
                                   usual.occupancy.keys, usual.occupancy.cells));
    for (std::size_t age = 0; age < 4; ++age)
        bench.terminal.put(fmt::format("  {}: {}", age, usual.occupancy.ages[age]));
    bench.terminal.put("\n");
}

void print_edits(const Bench &bench, gl::CachedView &view, int frames) {
    for (std::size_t i = 0; i < bench.scene.params.size(); ++i) {
        const ir::Param &p = bench.scene.params[i];
        if (p.structural || p.type != ir::Type::Float || !p.has_range) continue;
        const Motion m =
            move(bench, view,
                 {.speed = 1, .settle = frames, .frames = frames, .param = static_cast<int>(i)});
        bench.terminal.put(fmt::format("\nmoving `{}` (figure 8.5): cached {:.1f} ms, exact {:.1f} "
                                       "ms, speed-up {:.2f}, {:.0f} misses a frame\n",
                                       p.name, m.cached, m.exact, m.exact / m.cached, m.misses));
    }
}

void measure_all(const Bench &bench, gl::CachedView &view, int asked) {
    print_difference(bench, view);
    // As many frames as take about three minutes in all, unless it was said.
    const gl::FrameInputs inputs = inputs_of(bench, 0);
    const double one = bench.time([&] { view.draw_exactly(inputs, bench.scene.params); });
    const int usual = std::clamp(static_cast<int>(2000 / std::max(one, 1.0)), 2, 24);
    const int frames = asked > 0 ? asked : usual;
    print_speeds(bench, view, frames);
    print_ages(bench, view, frames);
    print_edits(bench, view, frames);
}

} // namespace

Exit bench_noise_cache(const BenchCommand &command, const ir::Scene &scene, Terminal &terminal) {
    auto context = gl::Context::make();
    if (const std::string *why = std::get_if<std::string>(&context)) {
        terminal.say(fmt::format("fathom: no GL to measure with: {}", *why));
        return device_error;
    }
    const std::string driver = std::get<gl::Context>(context).describe();
    Diagnostics diagnostics;
    Bench bench{scene, command.width, command.height, driver.find("llvmpipe") != driver.npos,
                terminal};
    terminal.put(fmt::format("GL {}; times are {}\n", driver,
                             bench.software ? "the processor's" : "on the clock"));
    print_fields(bench);
    gl::CachedView view;
    const gl::CacheSize size =
        command.cache_bits ? gl::CacheSize{.bits = command.cache_bits} : gl::usual_cache_size;
    const std::string why = view.use(scene, size, diagnostics);
    if (!why.empty()) {
        terminal.say(fmt::format("fathom: drawn exactly: {}", why));
        return done;
    }
    terminal.put(fmt::format("cache: {0}x{0}x{0} cells, {1:.3g} MB\n", view.store().side(),
                             static_cast<double>(view.store().size().bytes()) / 1e6));
    measure_all(bench, view, command.frames);
    return done;
}

} // namespace fathom::cli
