// Pictures of the library, whole and in parts, by the CPU and by GL.
#include <catch2/catch.hpp>

#include <epoxy/egl.h>
#include <fathom/gl.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <thread>

namespace {

fathom::Scene compiled(const char *text) {
    const fathom::CompileResult result = fathom::compile_text("scene.sdf", text);
    REQUIRE(result);
    return *result.scene;
}

// Turns once in 4 seconds.
fathom::Scene moving() {
    return compiled("box([1.5, 0.4, 0.4]).rotate(90deg * time, axis: Y).paint(#ff8000)\n"
                    "background(#000000)\nrender(time: 4)\n");
}

fathom::PictureOptions sized(int width, int height) {
    fathom::PictureOptions options;
    options.width = width;
    options.height = height;
    options.samples = 1;
    return options;
}

int differing(const fathom::Picture &a, const fathom::Picture &b, int by) {
    REQUIRE(a.rgba.size() == b.rgba.size());
    int count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) count += std::abs(a.rgba[i] - b.rgba[i]) > by;
    return count;
}

} // namespace

TEST_CASE("a picture is drawn, and can be given up") {
    const fathom::Scene scene = compiled("sphere(1).paint(#ff0000)\nbackground(#000000)");
    fathom::PictureOptions options = sized(40, 30);
    options.samples = 0;
    const fathom::Picture picture = fathom::draw(scene, options);
    REQUIRE(picture.complete);
    REQUIRE(picture.rgba.size() == std::size_t{4} * 40 * 30);
    const std::size_t middle = 4 * (15 * 40 + 20);
    CHECK(picture.rgba[middle] > 50);
    CHECK(picture.rgba[middle + 1] < picture.rgba[middle]);
    CHECK(picture.rgba[0] == 0);
    CHECK(picture.rays > 40 * 30);
    CHECK(picture.evaluations > picture.steps);

    options.progress = [](double) { return false; };
    options.samples = 4;
    CHECK_FALSE(fathom::draw(scene, options).complete);
    options.width = 0;
    CHECK_FALSE(fathom::draw(scene, options).complete);
}

TEST_CASE("a part of a picture is that part of the whole, to the byte") {
    const fathom::Scene scene = moving();
    fathom::PictureOptions options = sized(40, 30);
    const fathom::Picture whole = fathom::draw(scene, options);
    options.region = {7, 5, 20, 11};
    std::vector<std::uint8_t> seen(std::size_t{4} * 20 * 11);
    options.drawn = [&](const fathom::Region &part, const std::vector<std::uint8_t> &rgba) {
        REQUIRE(rgba.size() == seen.size());
        for (int y = part.y; y < part.y + part.height; ++y)
            std::copy_n(rgba.begin() + 4 * (20 * y + part.x), 4 * part.width,
                        seen.begin() + 4 * (20 * y + part.x));
    };
    const fathom::Picture part = fathom::draw(scene, options);
    REQUIRE((part.width == 20 && part.height == 11));
    for (int y = 0; y < 11; ++y)
        CHECK(std::equal(part.rgba.begin() + 4 * 20 * y, part.rgba.begin() + 4 * 20 * (y + 1),
                         whole.rgba.begin() + 4 * (40 * (5 + y) + 7)));
    CHECK(seen == part.rgba);
    for (const fathom::Region &none :
         {fathom::Region{0, 0, 0, 5}, fathom::Region{-1, 0, 5, 5}, fathom::Region{21, 0, 20, 5},
          fathom::Region{0, 30, 5, 1}, fathom::Region{2147483647, 0, 2147483647, 5}}) {
        options.region = none;
        CHECK(fathom::draw(scene, options).rgba.empty());
    }
}

TEST_CASE("samples drawn apart add to the picture of all, with an open shutter too") {
    const fathom::Scene scene = moving();
    for (const double shutter : {0.0, 1.5}) {
        fathom::PictureOptions options = sized(40, 30);
        options.samples = 5;
        options.shutter = shutter;
        options.linear = true;
        const fathom::Picture whole = fathom::draw(scene, options);
        REQUIRE(whole.complete);
        CHECK(whole.linear.size() == std::size_t{4} * 40 * 30);
        CHECK(whole.sums.empty());
        std::vector<double> sums(std::size_t{3} * 40 * 30);
        options.linear = false;
        options.sums = true;
        for (const auto &[first, samples] : {std::pair(3, 2), std::pair(0, 3)}) {
            options.first_sample = first;
            options.samples = samples;
            const fathom::Picture part = fathom::draw(scene, options);
            REQUIRE(part.sums.size() == sums.size());
            CHECK(part.linear.empty());
            for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += part.sums[i];
        }
        const fathom::Picture joined = fathom::picture_of_sums(40, 30, sums, 5);
        CHECK(joined.complete);
        CHECK(joined.rgba == whole.rgba);
    }
    CHECK(fathom::picture_of_sums(40, 30, std::vector<double>(12), 5).rgba.empty());
    CHECK(fathom::picture_of_sums(2, 2, std::vector<double>(12), 0).rgba.empty());

    fathom::PictureOptions options = sized(40, 30);
    const fathom::Picture sharp = fathom::draw(scene, options);
    options.shutter = 1.5;
    options.samples = 4;
    CHECK(differing(fathom::draw(scene, options), sharp, 20) > 50);
    options.samples = 0; // which moments would those be?
    CHECK(fathom::draw(scene, options).rgba.empty());
}

TEST_CASE("a picture without a background has the alpha of what it shows") {
    const fathom::Scene scene = compiled("sphere(1)\nbackground(#ffffff)\n");
    fathom::PictureOptions options = sized(40, 30);
    options.alpha = true;
    const fathom::Picture picture = fathom::draw(scene, options);
    CHECK(picture.rgba[3] == 0);
    CHECK(picture.rgba[4 * (15 * 40 + 20) + 3] == 255);
}

TEST_CASE("the camera goes around what it looks at") {
    const fathom::Scene scene = compiled("box([3, 1, 1])\nsphere(0.4).translate(x: 2, y: 1)\n"
                                         "camera(at: [0, 0, 9], look_at: [0, 0, 0])\n");
    const fathom::Picture front = fathom::draw(scene, sized(40, 30));
    fathom::PictureOptions options = sized(40, 30);
    options.turned = 2 * 3.14159265358979;
    CHECK(differing(fathom::draw(scene, options), front, 2) < 8);
    options.turned /= 4;
    CHECK(differing(fathom::draw(scene, options), front, 20) > 100);
}

TEST_CASE("what rays take is counted ray by ray") {
    const fathom::Scene scene = compiled("sphere(1)");
    const std::vector<int> steps = fathom::eye_steps(scene, sized(40, 30));
    REQUIRE(steps.size() == 40 * 30);
    std::uint64_t sum = 0;
    for (const int count : steps) sum += static_cast<std::uint64_t>(count);
    CHECK(sum == fathom::draw(scene, sized(40, 30)).steps);
    CHECK(fathom::eye_steps(scene, sized(0, 30)).empty());
}

TEST_CASE("a picture is a file of either kind, or none") {
    const fathom::Picture picture = fathom::draw(compiled("sphere(1)"), sized(40, 30));
    const std::string png = fathom::encode_png(picture, "what it is"),
                      jpeg = fathom::encode_jpeg(picture, 80);
    CHECK(png.starts_with("\x89PNG\r\n"));
    CHECK(png.find("what it is") != png.npos);
    CHECK(jpeg.starts_with("\xff\xd8\xff"));
    fathom::Picture wrong = picture;
    wrong.height = 31; // more than it has pixels for
    CHECK(fathom::encode_png(wrong).empty());
    CHECK(fathom::encode_jpeg(wrong).empty());
    CHECK(fathom::encode_jpeg(picture, 0).empty());
    CHECK(fathom::encode_png({}).empty());
}

TEST_CASE("a picture that there cannot be is empty and says why") {
    const fathom::Scene moves = moving(), rests = compiled("sphere(1)");
    constexpr double infinite = std::numeric_limits<double>::infinity();
    const auto with = [](auto change) {
        fathom::PictureOptions options = sized(8, 6);
        change(options);
        return options;
    };
    fathom::GlPainter gl;
    REQUIRE(gl.open().empty());
    const auto refused = [&](const fathom::Scene &scene, const fathom::PictureOptions &options,
                             const char *why) {
        INFO(why);
        const fathom::Picture none = fathom::draw(scene, options);
        CHECK((!none.complete && none.rgba.empty() && none.width == 0));
        CHECK(none.remark.find(why) != std::string::npos);
        CHECK(fathom::eye_steps(scene, options).empty());
        REQUIRE(gl.use(scene).empty());
        CHECK_FALSE(gl.draw(options).complete);
        CHECK_FALSE(gl.draw(options).remark.empty());
    };
    using Options = fathom::PictureOptions;
    for (const int side : {0, -1, 65537, std::numeric_limits<int>::min()}) {
        refused(rests, with([&](Options &o) { o.width = side; }), "pixels wide");
        refused(rests, with([&](Options &o) { o.height = side; }), "pixels wide");
    }
    refused(rests, with([](Options &o) { o.samples = -1; }), "samples");
    refused(rests, with([](Options &o) { o.first_sample = -1; }), "samples");
    refused(rests, with([](Options &o) { o.sums = true, o.samples = 0; }), "1 to 256 samples");
    for (const double number : {infinite, -infinite, std::nan("")}) {
        refused(rests, with([&](Options &o) { o.turned = number; }), "finite angle");
        refused(moves, with([&](Options &o) { o.time = number; }), "is proved from 0 to");
        refused(rests, with([&](Options &o) { o.time = number; }), "is proved from 0 to");
    }
    refused(moves, with([](Options &o) { o.time = -0.1; }), "is proved from 0 to");
    refused(moves, with([](Options &o) {
                o.time = 3599.5;
                o.shutter = 1;
                o.samples = 2;
            }),
            "is proved from 0 to");
    for (const double open : {-1.0, std::nan("")})
        refused(rests, with([&](Options &o) { o.shutter = open; }), "shutter");
    constexpr int most = std::numeric_limits<int>::max();
    for (const fathom::Region part :
         {fathom::Region{0, 0, 0, 0}, fathom::Region{-1, 0, 2, 2}, fathom::Region{7, 5, 2, 1},
          fathom::Region{1, 1, most, most}, fathom::Region{most, 0, most, 1}})
        refused(rests, with([&](Options &o) { o.region = part; }), "part");
    CHECK(fathom::draw(rests, with([](Options &o) { o.time = -5; })).complete); // nothing moves
}

TEST_CASE("GL draws what the CPU draws, and says what it does not draw") {
    const fathom::Scene scene = moving();
    fathom::GlPainter gl;
    CHECK_FALSE(gl.is_open());
    REQUIRE(gl.use(scene).size() == 1);
    CHECK_FALSE(gl.draw(sized(40, 30)).complete);
    CHECK(gl.largest_side() == 0);
    INFO(gl.open());
    REQUIRE(gl.is_open());
    CHECK(gl.open().empty()); // it is
    CHECK_FALSE(gl.describe().empty());
    CHECK_FALSE(gl.draw(sized(40, 30)).remark.empty()); // no scene yet
    REQUIRE(gl.use(scene).empty());
    CHECK(gl.text(scene).find("#version 330") == 0);

    fathom::PictureOptions options = sized(40, 30);
    options.time = 1.25;
    options.linear = true;
    const fathom::Picture drawn = gl.draw(options), traced = fathom::draw(scene, options);
    REQUIRE(drawn.complete);
    CHECK(drawn.remark.empty());
    CHECK(drawn.linear.size() == traced.linear.size());
    CHECK(drawn.rays == traced.rays);
    CHECK(differing(drawn, traced, 8) < 20);
    CHECK(gl.draw_for_nothing(options));

    fathom::GlPainter taken = std::move(gl);
    CHECK_FALSE(gl.is_open()); // NOLINT: what is left is a painter that is not open
    CHECK(taken.draw(options).rgba == drawn.rgba);
    CHECK(taken.lists().side == 0); // of nothing that has rows
    taken.remake_lists();

    fathom::PictureOptions part = options, open = options, alpha = options, large = options;
    part.region = {0, 0, 5, 5};
    open.shutter = 1;
    alpha.alpha = true;
    large.width = taken.largest_side() + 1;
    for (const fathom::PictureOptions &beyond : {part, open, alpha, large}) {
        const fathom::Picture none = taken.draw(beyond);
        CHECK_FALSE(none.complete);
        CHECK_FALSE(none.remark.empty());
        CHECK_FALSE(taken.draw_for_nothing(beyond));
    }
    options.progress = [](double) { return false; };
    CHECK_FALSE(taken.draw(options).complete);
}

// A chain of capsules whose ends are computed anew at each point: a loop with a dear body, which no
// driver writes out.
std::string chain(int links) {
    const std::string n = std::to_string(links);
    return "fn at(t: float) -> vec3 = vec3(cos(3 * t + 0.7), cos(2 * t + 0.2), 0.8 * cos(7 * t))\n"
           "fn seg(p: vec3, a: vec3, b: vec3) -> float {\n"
           "  let h = clamp(dot(p - a, b - a) / dot(b - a, b - a), 0, 1)\n"
           "  length(p - a - (b - a) * h)\n}\n"
           "fn knot(p: vec3) -> float {\n  var d = 10.0\n  for i in 0.." +
           n + " { d = min(d, seg(p, at(i * tau / " + n + "), at((i + 1) * tau / " + n +
           "))) }\n  d - 0.09\n}\nimplicit(knot, within: ball(2))\n"
           "camera(at: [1.5, 2, 5], fov: 38deg)\n";
}

TEST_CASE("long loops whose turns are dear are drawn whole by GL, or said not to be") {
    fathom::GlPainter gl;
    REQUIRE(gl.open().empty());
    for (const int links : {31, 37, 72, 150, 1500}) {
        INFO(links);
        const fathom::Scene scene = compiled(chain(links).c_str());
        const int size = links < 1000 ? 96 : 32;
        REQUIRE(gl.use(scene).empty());
        const fathom::Picture drawn = gl.draw(sized(size, size)),
                              traced = fathom::draw(scene, sized(size, size));
        const int wrong = differing(drawn, traced, 16);
        CHECK(traced.undecided == 0);
        CHECK((wrong == 0) == (links < 1000));
        CHECK((drawn.undecided == 0) == (links < 1000));
    }
}

TEST_CASE("painters do not disturb each other, nor who has a context of EGL") {
    const fathom::Scene ball = compiled("sphere(1)"), cube = compiled("box(2)");
    fathom::GlPainter first, second;
    REQUIRE((first.open().empty() && first.use(ball).empty()));
    const std::vector<std::uint8_t> of_ball = first.draw(sized(40, 30)).rgba;
    REQUIRE((second.open().empty() && second.use(cube).empty()));
    const std::vector<std::uint8_t> of_cube = second.draw(sized(40, 30)).rgba;
    REQUIRE(of_ball != of_cube);
    CHECK(first.draw(sized(40, 30)).rgba == of_ball);
    {
        fathom::GlPainter third;
        REQUIRE((third.open().empty() && third.use(cube).empty()));
        second = std::move(third); // what `second` had is deleted, and nothing of `first`
    }
    CHECK(second.draw(sized(40, 30)).rgba == of_cube);
    CHECK(first.draw(sized(40, 30)).rgba == of_ball);

    // On another thread, and there while a context of somebody else's is current.
    const EGLDisplay display =
        eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    REQUIRE((eglInitialize(display, nullptr, nullptr) && eglBindAPI(EGL_OPENGL_API)));
    const EGLContext theirs = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, nullptr);
    REQUIRE(eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, theirs));
    CHECK(first.draw(sized(40, 30)).rgba == of_ball);
    second = fathom::GlPainter();
    CHECK(eglGetCurrentContext() == theirs);
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, theirs);
    std::vector<std::uint8_t> elsewhere;
    std::thread([&] { elsewhere = first.draw(sized(40, 30)).rgba; }).join();
    CHECK(elsewhere == of_ball);
    std::vector<std::thread> threads;
    std::atomic<int> right = 0;
    for (int i = 0; i < 3; ++i)
        threads.emplace_back([&] {
            fathom::GlPainter own;
            if (own.open().empty() && own.use(cube).empty())
                for (int k = 0; k < 3; ++k) right += own.draw(sized(40, 30)).rgba == of_cube;
        });
    for (std::thread &thread : threads) thread.join();
    CHECK(right == 9);

    // What the thread that draws has current is no other's meanwhile.
    fathom::PictureOptions slow = sized(40, 30);
    std::string told;
    slow.progress = [&](double) {
        std::thread([&] { told = first.draw(sized(4, 3)).remark; }).join();
        return false;
    };
    CHECK(first.draw(slow).remark == "cancelled");
    CHECK(told == "the painter draws on another thread");
}

TEST_CASE("one painter draws one scene after another, with limits of their own") {
    fathom::GlPainter gl;
    REQUIRE(gl.open().empty());
    const fathom::Scene ball = compiled("sphere(1)"), cube = compiled("box(2)");
    REQUIRE(gl.use(ball).empty());
    const fathom::Picture first = gl.draw(sized(40, 30));
    REQUIRE(gl.use(cube, {.max_steps = 1}).empty());
    CHECK(gl.draw(sized(40, 30)).undecided > 0);
    REQUIRE(gl.use(ball, {.noise_cache = true}).empty());
    CHECK_FALSE(gl.is_cached());
    CHECK(gl.exact_because() == "no field of this scene is worth keeping");
    CHECK(gl.draw(sized(40, 30)).rgba == first.rgba);
}
