// The cache's passes on the context at hand: what is cached, found, moved and given up, and the
// rules that hold after every frame. The rules are the store's own reading of what lies on the card
// (gl::check_cache): the CPU's hash against the GPU's, each place owned once.
#include "ir/passes/cost.h"
#include "tests/support/reference_eval.h"
#include "tests/unit/cache/scenes.h"

#include <map>

namespace fathom {

namespace {

// Every cached cell's corners hold the field's own values there: `field` is Graph::caches' i-th.
void check_values(const gl::CachedView &view, const ir::Scene &scene, std::uint32_t field,
                  std::size_t maximum = 40) {
    const gl::CacheStore::Dump dump = view.store().dump(true);
    test::Reference reference(scene);
    const ir::Cache &cache = scene.graph.cache(ir::CacheId{field});
    const ir::Type type = scene.graph[scene.graph.function(cache.field).result].type;
    const int number = view.number_of(field), side = 2 << dump.bits, last = (1 << dump.bits) - 1;
    std::size_t checked = 0;
    for (std::uint32_t entry : dump.hash) {
        const std::uint32_t place = entry & ((1u << glsl::cache_place_bits) - 1);
        if (entry == glsl::cache_empty || dump.keys[place][3] != number || checked >= maximum)
            continue;
        ++checked;
        const int p = static_cast<int>(place);
        for (int i = 0; i < 8; ++i) {
            const std::array<int, 3> corner{i & 1, i >> 1 & 1, i >> 2};
            std::array<double, 3> at{};
            for (std::size_t a = 0; a < 3; ++a)
                at[a] = (dump.keys[place][a] + corner[a]) * cache.cell;
            const auto wanted = reference.call(cache.field, {test::Reference::vec3(at)});
            const int x = 2 * (p & last) + corner[0], y = 2 * (p >> dump.bits & last) + corner[1],
                      z = 2 * (p >> (2 * dump.bits)) + corner[2];
            const auto texel = static_cast<std::size_t>(x + side * (y + side * z));
            for (std::size_t c = 0; c < static_cast<std::size_t>(ir::components(type)); ++c) {
                const float got = type == ir::Type::Float ? dump.pool[texel] : dump.wide[texel][c];
                REQUIRE(got == Approx(wanted.value[c]).margin(2e-5));
            }
        }
    }
    CHECK(checked > 0);
}

} // namespace

TEST_CASE("a still view is learnt, and then nothing is missed any more") {
    require_context();
    const driver::Compilation c = compiled(rock);
    gl::CachedView view;
    use(view, c.scene);
    const gl::FrameInputs inputs = frame_of(c.scene, 32);
    view.draw(inputs, c.scene.params, all_cells);
    const gl::CacheTally first = view.read_tally();
    const gl::CacheCounts counts = view.store().read_counts();
    CHECK(first.hits == 0);
    CHECK(first.misses > 400); // every pixel of the ball
    CHECK(first.misses == first.computed);
    CHECK(counts.inserted > 100); // several pixels miss the same cell: one gets it in
    CHECK(counts.inserted <= glsl::cache_wishes * first.computed);
    CHECK(gl::occupancy(view.store().dump(false)).keys == counts.inserted);
    const int frames = warm(view, inputs, c.scene);
    CHECK(frames < 60);
    CHECK(view.read_tally().hits > 1000);
    CHECK(view.store().read_counts().inserted == 0);
    CHECK(gl::check_cache(view.store().dump(false)) == "");
    check_values(view, c.scene, 0);
    // half of the ball lies at negative x
    bool negative = false;
    for (const auto &key : view.store().dump(false).keys) negative |= key[0] < -5;
    CHECK(negative);
}

TEST_CASE("no place is lost and no value torn, however small the cache") {
    require_context();
    const driver::Compilation c = compiled(rock);
    for (const int age : {1, 4, glsl::cache_ages}) {
        gl::CachedView view;
        use(view, c.scene, {.bits = 2}); // 64 cells for thousands
        for (int frame = 0; frame < 40; ++frame) {
            view.draw(frame_of(c.scene, 16, 0.1 * frame), c.scene.params,
                      {.max_age = age, .min_pixels = 0, .weigh = false});
            REQUIRE(gl::check_cache(view.store().dump(false)) == "");
        }
        const gl::CacheOccupancy full = gl::occupancy(view.store().dump(false));
        CHECK(full.keys > full.cells * 3 / 4);
        CHECK(view.store().read_counts().deleted > 0); // it goes on learning
        check_values(view, c.scene, 0);
    }
}

TEST_CASE("a cache that is too small for a view grows, and then holds it") {
    require_context();
    const driver::Compilation c = compiled(rock);
    const gl::FrameInputs inputs = frame_of(c.scene, 24);
    gl::CachedView small, growing;
    use(small, c.scene, {.bits = 4}); // 4,096 cells, for more than 6,000
    use(growing, c.scene, {.bits = 4, .max_bits = 5});
    CHECK(warm(small, inputs, c.scene, 40) == 40);
    CHECK(small.store().size().bits == 4);
    CHECK(warm(growing, inputs, c.scene) < 60);
    CHECK(growing.store().size().bits == 5);
    CHECK(gl::check_cache(growing.store().dump(false)) == "");
    check_values(growing, c.scene, 0);
    // It stays so for the next text, and no larger than it may.
    use(growing, c.scene, {.bits = 4, .max_bits = 5});
    CHECK(growing.store().size().bits == 5);
    CHECK(warm(growing, inputs, c.scene, 1) == 0);
    CHECK(gl::CacheSize{.bits = 7}.bytes() == 8 * gl::CacheSize{.bits = 6}.bytes());
}

TEST_CASE("old keys move on, and are given up at the largest age") {
    require_context();
    const driver::Compilation c = compiled(rock);
    gl::CachedView view;
    use(view, c.scene, {.bits = 4});
    gl::CacheCounts all;
    for (int frame = 0; frame < 30; ++frame) {
        view.draw(frame_of(c.scene, 24, 0.05 * frame), c.scene.params,
                  {.max_age = 3, .min_pixels = 0, .weigh = false});
        const gl::CacheCounts counts = view.store().read_counts();
        all.inserted += counts.inserted, all.evicted += counts.evicted,
            all.deleted += counts.deleted;
        REQUIRE(gl::check_cache(view.store().dump(false)) == "");
    }
    const gl::CacheOccupancy there = gl::occupancy(view.store().dump(false));
    CHECK(all.evicted > 0);
    CHECK(all.deleted > 0);
    CHECK(all.inserted - all.deleted == there.keys); // what came and did not go is there
    CHECK(there.ages[0] > there.ages[1]); // a bias towards the young (thesis, figure 8.3)
    CHECK(there.ages[3] == 0);
}

TEST_CASE("a lower maximum age gives up what is older") {
    require_context();
    const driver::Compilation c = compiled(rock);
    gl::CachedView view;
    use(view, c.scene, {.bits = 3});
    for (int frame = 0; frame < 24; ++frame) {
        view.draw(frame_of(c.scene, 16, 0.05 * frame), c.scene.params,
                  {.max_age = frame < 12 ? 7 : 1 + frame % 3, .min_pixels = 0, .weigh = false});
        REQUIRE(gl::check_cache(view.store().dump(false)) == "");
    }
}

TEST_CASE("ten thousand frames", "[.soak]") {
    require_context();
    const driver::Compilation c = compiled(rock);
    gl::CachedView view;
    use(view, c.scene, {.bits = 3});
    for (int frame = 0; frame < 10000; ++frame) {
        view.draw(frame_of(c.scene, 12, 0.03 * frame), c.scene.params,
                  {.max_age = 1 + frame / 1000 % 7, .min_pixels = 0, .weigh = false});
        REQUIRE(gl::check_cache(view.store().dump(false)) == "");
        if (frame % 500 == 499) check_values(view, c.scene, 0);
    }
}

TEST_CASE("beyond the cells that can be counted, a field is computed") {
    require_context();
    const driver::Compilation c = compiled(R"(
let bumps = cached(p => 0.1 * fbm(2 * (p - [40000, 0, 0]), octaves: 5), cell: 0.05)
sphere(1).translate(x: 40000).displace(bumps)
camera(at: [40000, 0, 4], look_at: [40000, 0, 0])
)");
    gl::CachedView view;
    use(view, c.scene);
    gl::FrameInputs inputs = frame_of(c.scene, 24, 0, gl::Mode::Numbers);
    view.draw(inputs, c.scene.params, all_cells);
    CHECK(view.store().read_counts().inserted == 0);
    const gl::Pixels wanted = exact(c.scene, 24, gl::Mode::Numbers), got = view.read_pixels();
    int other = 0; // the same field, by steps of its own: float32 is coarse out there
    for (std::size_t i = 0; i < got.rgba.size(); i += 4)
        other += got.rgba[i + 3] != wanted.rgba[i + 3] ||
                 std::abs(got.rgba[i + 1] - wanted.rgba[i + 1]) > 0.05f;
    CHECK(other <= 2);
}

TEST_CASE("numbers and colours share one cache, told apart by their keys") {
    require_context();
    const driver::Compilation c = compiled(R"(
let bumps = cached(p => 0.1 * fbm(2 * p, octaves: 5), cell: 0.05)
let tint = cached(p => mix(#203040, #f0c080, saturate(0.5 + fbm(3 * p, octaves: 5))), cell: 0.05)
sphere(1).displace(bumps).paint(material(diffuse: p => tint(p)))
camera(at: [0, 0, 4], look_at: [0, 0, 0])
)");
    gl::CachedView view;
    use(view, c.scene);
    const gl::FrameInputs inputs = frame_of(c.scene, 24);
    CHECK(warm(view, inputs, c.scene) < 60);
    const gl::CacheStore::Dump dump = view.store().dump(false);
    CHECK(gl::check_cache(dump) == "");
    const gl::CacheOccupancy there = gl::occupancy(dump);
    REQUIRE(view.number_of(0) != view.number_of(1));
    CHECK(there.fields[static_cast<std::size_t>(view.number_of(0))] > 100);
    CHECK(there.fields[static_cast<std::size_t>(view.number_of(1))] > 100);
    check_values(view, c.scene, 0);
    check_values(view, c.scene, 1);
}

TEST_CASE("an edit invalidates the fields that it changes alone") {
    require_context();
    const auto text = [](const std::string &radius, const std::string &octaves) {
        return R"(
param depth = 0.1 in 0.05..0.2
param size = 1.0 in 0.8..1.2
let bumps = cached(p => depth * fbm(2 * p, octaves: 5), cell: 0.1)
let tint = cached(p => mix(#203040, #f0c080, saturate(0.5 + fbm(3 * p, octaves: )" +
               octaves + R"())), cell: 0.1)
sphere()" + radius +
               R"( * size).displace(bumps).paint(material(diffuse: p => tint(p)))
camera(at: [0, 0, 4], look_at: [0, 0, 0])
)";
    };
    driver::Compilation c = compiled(text("1", "5"));
    gl::CachedView view;
    use(view, c.scene);
    const gl::FrameInputs inputs = frame_of(c.scene, 24);
    CHECK(warm(view, inputs, c.scene) < 60);
    const int bumps = view.number_of(0), tint = view.number_of(1);
    const auto keys = [&](int number) {
        return gl::occupancy(view.store().dump(false)).fields[static_cast<std::size_t>(number)];
    };
    const std::size_t bumps_before = keys(bumps), tint_before = keys(tint);
    const auto set = [&](const char *name, double value) {
        for (ir::Param &p : c.scene.params)
            if (p.name == name) p.value[0] = value;
    };
    SECTION("a param that the field reads") {
        set("depth", 0.12);
        view.draw(inputs, c.scene.params, all_cells);
        CHECK(view.store().read_counts().swept == bumps_before);
        CHECK(keys(tint) >= tint_before);
        CHECK(warm(view, inputs, c.scene) < 60);
        check_values(view, c.scene, 0);
    }
    SECTION("a param that it does not read") {
        set("size", 1.01);
        view.draw(inputs, c.scene.params, all_cells);
        CHECK(view.store().read_counts().swept == 0);
        CHECK(view.read_tally().hits >
              10 * view.read_tally().misses); // most of it stays useful (figure 8.5)
    }
    SECTION("a param that the field reads, frame after frame") {
        constexpr gl::CacheSettings weighed{.min_pixels = 0};
        for (int frame = 1; frame < 5; ++frame) { // drawn exactly: it would find nothing
            set("depth", 0.1 + 0.01 * frame);
            view.draw(inputs, c.scene.params, weighed);
            CHECK(!view.looked_up());
        }
        view.draw(inputs, c.scene.params, weighed);
        CHECK(view.looked_up());
        CHECK(view.store().read_counts().swept == bumps_before);
        set("size", 1.01); // which no field reads
        view.draw(inputs, c.scene.params, weighed);
        CHECK(view.looked_up());
        set("depth", 0.11);
        view.draw(inputs, c.scene.params, all_cells); // cached all the same
        CHECK(view.looked_up());
    }
    SECTION("the text around the fields") {
        const driver::Compilation other = compiled(text("1.01", "5"));
        use(view, other.scene);
        CHECK(view.number_of(0) == bumps);
        CHECK(view.number_of(1) == tint);
        view.draw(inputs, other.scene.params, all_cells);
        CHECK(view.store().read_counts().swept == 0);
        CHECK(view.read_tally().hits > view.read_tally().misses);
    }
    SECTION("one field's text") {
        const driver::Compilation other = compiled(text("1", "6"));
        use(view, other.scene);
        CHECK(view.number_of(0) == bumps);
        CHECK(view.number_of(1) != tint);
        CHECK(keys(bumps) == bumps_before);
        CHECK(warm(view, inputs, other.scene) < 60);
        check_values(view, other.scene, 1);
    }
    CHECK(gl::check_cache(view.store().dump(false)) == "");
}

// The steepness of the interpolated field is greatest at a corner of its cell: that of the three
// edges that meet there.
double steepest(const gl::CacheStore::Dump &dump, std::uint32_t place, double cell) {
    const int side = 2 << dump.bits, last = (1 << dump.bits) - 1, p = static_cast<int>(place);
    std::array<double, 8> value{};
    for (int i = 0; i < 8; ++i) {
        const int x = 2 * (p & last) + (i & 1), y = 2 * (p >> dump.bits & last) + (i >> 1 & 1),
                  z = 2 * (p >> (2 * dump.bits)) + (i >> 2);
        value[static_cast<std::size_t>(i)] =
            static_cast<double>(dump.pool[static_cast<std::size_t>(x + side * (y + side * z))]);
    }
    double maximum = 0;
    for (std::size_t i = 0; i < 8; ++i)
        maximum = std::max(maximum, std::hypot(value[i] - value[i ^ 1], value[i] - value[i ^ 2],
                                               value[i] - value[i ^ 4]));
    return maximum / cell;
}

TEST_CASE("cells that are steeper than proved are not read") {
    require_context();
    // Worley noise is as steep as proved nearly everywhere, and has ridges; two of them seldom
    // meet.
    const driver::Compilation c = compiled(R"(
let cracks = cached(p => 0.1 * worley(2 * p) + 0.05 * worley(4 * p), cell: 0.05)
sphere(1).displace(cracks)
camera(at: [0, 0, 4], look_at: [0, 0, 0])
)");
    gl::CachedView view;
    use(view, c.scene);
    const gl::FrameInputs inputs = frame_of(c.scene, 32);
    CHECK(warm(view, inputs, c.scene) < 60);
    const gl::CacheTally tally = view.read_tally();
    CHECK(tally.hits > 1000);
    CHECK(tally.computed > 0);
    CHECK(tally.computed < 400);
    const gl::CacheStore::Dump dump = view.store().dump(true);
    const double slope = c.scene.caches[0].slope;
    int cached = 0, refused = 0;
    for (std::uint32_t entry : dump.hash) {
        if (entry == glsl::cache_empty) continue;
        const std::uint32_t place = entry & ((1u << glsl::cache_place_bits) - 1);
        const bool steep = steepest(dump, place, 0.05) > slope * (1 + 1e-4);
        const bool marked = dump.keys[place][3] >= glsl::cache_refused;
        if (steep) CHECK(marked);
        ++(marked ? refused : cached);
    }
    CHECK(cached > 1000);
    CHECK(refused > 0);
}

TEST_CASE("what reads a cached field is proved with its slope everywhere") {
    // The field's own text is far less steep where the ball is than far from it; interpolated, it
    // may be steeper than its text, and what the passes hold it to is its slope everywhere.
    const driver::Compilation c = compiled(R"(
let f = cached(p => 0.1 * smoothstep(0.0, 8.0, p.y) * fbm(3 * p, octaves: 6), cell: 0.05)
sphere(1).displace(f)
)");
    const double slope = c.scene.caches[0].slope;
    REQUIRE(std::isfinite(slope));
    REQUIRE(ir::cached(c.scene, ir::CacheId{0}) == ir::Cacheable::Yes);
    CHECK(c.scene.facts[c.scene.top_level[0].shape.index].lipschitz_sup >= 1 + 0.999 * slope);
}

TEST_CASE("misses are shown in red, and nothing else is") {
    require_context();
    const driver::Compilation c = compiled(rock);
    gl::CachedView view;
    use(view, c.scene);
    const gl::FrameInputs inputs = frame_of(c.scene, 32);
    const auto red = [&] {
        const gl::Pixels pixels = view.read_pixels();
        std::uint64_t count = 0;
        for (std::size_t i = 0; i < pixels.rgba.size(); i += 4)
            count += pixels.rgba[i] > 0.8f && pixels.rgba[i] > 2 * pixels.rgba[i + 2];
        return count;
    };
    const gl::CacheSettings shown{.min_pixels = 0, .show_misses = true, .weigh = false};
    for (int frame = 0; frame < 4; ++frame) {
        view.draw(inputs, c.scene.params, shown);
        CHECK(red() == view.read_tally().misses);
        if (frame == 0) CHECK(red() > 400);
    }
    warm(view, inputs, c.scene, 60, shown);
    CHECK(red() == 0);
}

TEST_CASE("cells that are narrower than a pixel are not looked for") {
    require_context();
    const driver::Compilation c = compiled(rock); // cells of 0.05, pixels of about 0.1
    gl::CachedView view;
    use(view, c.scene);
    const gl::FrameInputs inputs = frame_of(c.scene, 24);
    view.draw(inputs, c.scene.params, {.min_pixels = 1, .weigh = false});
    CHECK(view.read_tally().misses == 0);
    CHECK(view.read_tally().computed > 200);
    CHECK(view.store().read_counts().inserted == 0);
    CHECK(view.read_pixels().rgba == exact(c.scene, 24, gl::Mode::Linear).rgba);
    view.draw(inputs, c.scene.params, {.min_pixels = 0.25, .weigh = false});
    CHECK(view.read_tally().misses > 200);
}

TEST_CASE("a field that is cheap or moves is not cached") {
    require_context();
    for (const char *field :
         {"0.1 * noise(2 * p)", "0.1 * fbm(2 * p + [time, 0, 0], octaves: 6)"}) {
        const driver::Compilation c = compiled("let f = cached(p => " + std::string(field) +
                                               ", cell: 0.05)\nsphere(1).displace(f)\n");
        gl::CachedView view;
        Diagnostics diagnostics;
        CHECK(view.use(c.scene, {}, diagnostics) == "no field of this scene is worth keeping");
    }
}

} // namespace fathom
