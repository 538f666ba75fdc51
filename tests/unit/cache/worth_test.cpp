// When counted work says that look-ups pay, and what the renderer makes of it.
#include "ir/passes/cost.h"
#include "render-gl/cache_worth.h"
#include "tests/unit/cache/scenes.h"

#include <functional>

namespace fathom {

namespace {

constexpr gl::CachePrices fbm{.field = 20, .whole = 30};
constexpr gl::CacheWork all_found{.paid = 200, .steps = 30, .learnt = false};
constexpr gl::CacheWork all_missed{.left = 1, .steps = 30, .learnt = true};

// How many of so many frames look values up, where each says what it counted.
int kept_of(int frames, const std::function<gl::CacheWork(int)> &work, gl::CacheWorth worth = {}) {
    int cached = 0;
    for (int frame = 0; frame < frames; ++frame) {
        if (!gl::looks_up_next(worth)) {
            gl::drew_exactly(worth);
            continue;
        }
        ++cached;
        gl::drew_cached(worth);
        gl::judged(worth, work(frame), fbm);
    }
    return cached;
}

} // namespace

TEST_CASE("look-ups pay by what they save, less what was in vain") {
    CHECK(gl::pays(all_found, fbm));
    CHECK(!gl::pays(all_missed, fbm));
    CHECK(!gl::pays({.steps = 30}, fbm));                // the field was not asked
    CHECK(!gl::pays(all_found, {ir::look_up_cost, 30})); // it costs no more than the look-up
    CHECK(!gl::pays(all_found, {12, 2000})); // it is little beside the rest of the scene
    CHECK(gl::pays({.paid = 180, .left = 0.1, .steps = 30}, fbm));
    CHECK(!gl::pays({.paid = 20, .wasted = 80, .left = 0.9, .steps = 30}, fbm));
}

TEST_CASE("a cache that pays after it has learnt is cached") {
    const auto learns = [](int frame) { return frame < 10 ? all_missed : all_found; };
    CHECK(kept_of(200, learns) == 200);
    // Frames now and then that do not pay change nothing.
    CHECK(kept_of(200, [](int frame) { return frame % 12 > 2 ? all_missed : all_found; }) == 200);
}

TEST_CASE("a cache that never pays costs few frames, one that pays again is taken up") {
    CHECK(kept_of(2000, [](int) { return all_missed; }) < 60);
    // Cells that are narrower than pixels: nothing is learnt, which is clear at once.
    gl::CacheWork narrow = all_missed;
    narrow.learnt = false;
    CHECK(kept_of(2000, [&](int) { return narrow; }) <= 6);
    const auto slower = [](int frame) { return frame < 500 ? all_missed : all_found; };
    CHECK(kept_of(2000, slower) > 1000);
}

TEST_CASE("a cache that keeps nothing for long is too small, one that gives up a little is not") {
    gl::CacheGrowth growth;
    CHECK(!gl::too_small(growth, 100, 1024));
    CHECK(gl::too_small(growth, 100, 1024));
    growth = {};
    for (int frame = 0; frame < 100; ++frame) {
        CHECK(!gl::too_small(growth, 20, 1024));
        CHECK(!gl::too_small(growth, frame % 2 ? 1000 : 0, 1024)); // a jump now and then
    }
}

TEST_CASE("a view whose cells are narrower than pixels is drawn exactly, a nearer one is not") {
    require_context();
    const driver::Compilation c = compiled(rock);
    gl::CachedView view;
    use(view, c.scene);
    const gl::FrameInputs far = frame_of(c.scene, 24); // pixels of about 0.1, cells of 0.05
    for (int frame = 0; frame < 4; ++frame) view.draw(far, c.scene.params, {});
    CHECK(!view.looked_up());
    CHECK(view.read_tally().computed == 24 * 24);
    CHECK(view.read_tally().misses == 0);
    CHECK(view.read_pixels().rgba == exact(c.scene, 24, gl::Mode::Linear).rgba);
    CHECK(gl::occupancy(view.store().dump(false)).keys == 0);

    gl::FrameInputs near = far;
    near.view.extent *= 0.1;
    int frames = 0, cached = 0;
    for (; frames < 120; ++frames) {
        view.draw(near, c.scene.params, {});
        cached += view.looked_up();
    }
    CHECK(view.looked_up());
    CHECK(cached > 40);
    CHECK(view.read_tally().misses == 0);
    CHECK(view.read_tally().hits > 1000);
    for (int frame = 0; frame < 20; ++frame) view.draw(far, c.scene.params, {});
    CHECK(!view.looked_up());
    CHECK(gl::check_cache(view.store().dump(false)) == "");
}

TEST_CASE("two runs look values up in the same frames") {
    require_context();
    const driver::Compilation c = compiled(rock);
    std::string runs[2];
    for (std::string &run : runs) {
        gl::CachedView view;
        use(view, c.scene);
        for (int frame = 0; frame < 100; ++frame) {
            gl::FrameInputs inputs = frame_of(c.scene, 16, frame < 60 ? 0.4 * frame : 0);
            inputs.view.extent *= 0.25;
            view.draw(inputs, c.scene.params, {});
            run += view.looked_up() ? '1' : '0';
        }
    }
    CHECK(runs[0] == runs[1]);
    CHECK(runs[0].front() == '1');
}

TEST_CASE("what cached values leave over is drawn as if there were none, to the last bit") {
    require_context();
    // It goes on where the picture of cached values first asked for one.
    const driver::Compilation c = compiled(rock);
    for (const gl::Mode mode : {gl::Mode::Linear, gl::Mode::Heat, gl::Mode::Numbers}) {
        gl::CachedView view;
        use(view, c.scene);
        const gl::FrameInputs inputs = frame_of(c.scene, 32, 0, mode);
        const gl::Pixels wanted = exact(c.scene, 32, mode);
        for (int frame = 0; frame < 3; ++frame) {
            view.draw(inputs, c.scene.params, all_cells);
            const gl::Pixels got = view.read_pixels();
            const std::vector<gl::PixelState> states = view.read_states();
            int computed = 0;
            for (std::size_t i = 0; i < states.size(); ++i) {
                if (states[i] == gl::PixelState::Finished) continue;
                ++computed;
                for (std::size_t k = 0; k < 4; ++k)
                    REQUIRE(got.rgba[4 * i + k] == wanted.rgba[4 * i + k]);
            }
            CHECK(computed > 100);
        }
    }
}

} // namespace fathom
