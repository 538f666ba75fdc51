// How far a picture through the cache is from the exact one: never more than stated, less with
// finer cells as theory has it, and in no mixture of present and absent cells is a surface passed.
#include "ir/passes/cost.h"
#include "tests/support/reference_eval.h"
#include "tests/unit/cache/scenes.h"

namespace fathom {

namespace {

struct Error {
    double maximum = 0, mean = 0; // of |f| at the hits, f the exact field before its division
    int hits = 0, only_one = 0;   // pixels that only one of the two pictures hits
};

// Where the picture's rays stopped, the exact field is 0, but for what interpolation and the
// march's tolerance change.
Error error_of(const gl::CachedView &view, const ir::Scene &scene, const gl::FrameInputs &in,
               const gl::Pixels &wanted) {
    const gl::Pixels got = view.read_pixels();
    test::Reference reference(scene);
    const ir::Cache &cache = scene.graph.cache(ir::CacheId{0});
    Error error;
    for (int y = 0; y < got.height; ++y)
        for (int x = 0; x < got.width; ++x) {
            const auto i = static_cast<std::size_t>(y * got.width + x) * 4;
            if ((got.rgba[i + 3] > 0) != (wanted.rgba[i + 3] > 0)) ++error.only_one;
            if (got.rgba[i + 3] == 0) continue;
            const double u = 2 * (x + 0.5) / got.width - 1, v = 1 - 2 * (y + 0.5) / got.height;
            const glm::dvec3 d = glm::normalize(
                in.view.forward + in.view.extent * (u * in.view.right + v * in.view.up));
            const glm::dvec3 p = in.view.origin + double(got.rgba[i + 1]) * d;
            const double f =
                glm::length(p) - 1 -
                reference.call(cache.field, {test::Reference::vec3({p.x, p.y, p.z})}).value[0];
            error.maximum = std::max(error.maximum, std::abs(f));
            error.mean += std::abs(f);
            ++error.hits;
        }
    error.mean /= std::max(error.hits, 1);
    return error;
}

// What the march alone leaves: its tolerance, over which it divides by at most the field's slope.
constexpr double tolerance = 0.02;

} // namespace

TEST_CASE(
    "every frame, from the first to the last miss, is within the stated bound of the exact field") {
    require_context();
    const driver::Compilation c = compiled(rock);
    const double bound = ir::cached_error(c.scene, ir::CacheId{0});
    CHECK(bound < 0.2);
    const gl::FrameInputs inputs = frame_of(c.scene, 32, 0, gl::Mode::Numbers);
    const gl::Pixels wanted = exact(c.scene, 32, gl::Mode::Numbers);
    gl::CachedView view;
    use(view, c.scene);
    for (int frame = 0; frame < 30; ++frame) {
        view.draw(inputs, c.scene.params, all_cells);
        const Error error = error_of(view, c.scene, inputs, wanted);
        INFO("frame " << frame);
        CHECK(error.hits > 300);
        CHECK(error.maximum <= bound + tolerance);
        CHECK(error.only_one <= 6); // at the outline, of about 400
        if (frame == 0) CHECK(error.only_one == 0);
    }
}

TEST_CASE("halving the cell of a smooth field divides its error by about four") {
    require_context();
    // Interpolation between the corners errs by cell^2/8 times the second derivatives.
    std::vector<double> means;
    for (const char *cell : {"0.2", "0.1", "0.05"}) {
        const driver::Compilation c = compiled(
            "let f = cached(p => 0.06 * fbm(1.2 * p, octaves: 3) + 0.05 * fbm(1.3 * p + 7, "
            "octaves: 2), cell: " +
            std::string(cell) +
            ")\nsphere(1).displace(f)\ncamera(at: [0, 0, 4], look_at: [0, 0, 0])\nrender(epsilon: "
            "1e-5)\n");
        gl::CachedView view;
        use(view, c.scene);
        const gl::FrameInputs inputs = frame_of(c.scene, 32, 0, gl::Mode::Numbers);
        CHECK(warm(view, inputs, c.scene, 80) < 80);
        means.push_back(
            error_of(view, c.scene, inputs, exact(c.scene, 32, gl::Mode::Numbers)).mean);
    }
    INFO(means[0] << " " << means[1] << " " << means[2]);
    CHECK(means[0] / means[1] > 2.5);
    CHECK(means[0] / means[1] < 6);
    CHECK(means[1] / means[2] > 2.5);
    CHECK(means[1] / means[2] < 6);
}

TEST_CASE("the shader with the cache's hooks and no cache draws the exact picture") {
    require_context();
    const driver::Compilation c = compiled(rock);
    Diagnostics diagnostics;
    const glsl::Output hooked =
        glsl::emit(c.scene, {.buffers = true, .noise_cache = true}, diagnostics);
    REQUIRE(hooked.cached.size() == 1);
    const auto program = gl::Program::build(hooked, c.scene);
    REQUIRE(std::holds_alternative<gl::Program>(program));
    gl::Request request;
    request.width = request.height = 32;
    const auto got = gl::draw(std::get<gl::Program>(program), c.scene, request, gl::Mode::Linear);
    REQUIRE(got);
    CHECK(got->rgba == exact(c.scene, 32, gl::Mode::Linear).rgba);
}

} // namespace fathom
