// A shader in a context of the host's own (fathom::GlShader), against the pictures of GlPainter.
#include <catch2/catch.hpp>

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <fathom/files.h>
#include <fathom/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <unistd.h>

namespace {

constexpr int width = 96, height = 64;

// A host's context, with a framebuffer of its own bound that is larger than what is drawn.
class Host {
  public:
    explicit Host(EGLenum api = EGL_OPENGL_API) {
        display_ =
            eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        REQUIRE((eglInitialize(display_, nullptr, nullptr) && eglBindAPI(api)));
        const EGLint newer[] = {EGL_CONTEXT_MAJOR_VERSION, api == EGL_OPENGL_API ? 4 : 3,
                                EGL_CONTEXT_MINOR_VERSION, api == EGL_OPENGL_API ? 5 : 0, EGL_NONE};
        context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, newer);
        REQUIRE(eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_));
        glGenFramebuffers(1, &framebuffer_);
        glGenRenderbuffers(1, &color_);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
        glBindRenderbuffer(GL_RENDERBUFFER, color_);
        glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width + 8, height + 8);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color_);
        clear();
    }
    ~Host() {
        leave();
        eglDestroyContext(display_, context_);
        eglBindAPI(EGL_OPENGL_API);
    }
    Host(const Host &) = delete;
    Host &operator=(const Host &) = delete;

    void leave() { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }

    void clear() {
        glClearColor(0, 1, 0, 1); // of no scene here
        glClear(GL_COLOR_BUFFER_BIT);
    }

    // What was drawn, rows from the top; and nothing was drawn beside it.
    fathom::Picture shown() {
        std::vector<std::uint8_t> all(std::size_t{4} * (width + 8) * (height + 8));
        glReadPixels(0, 0, width + 8, height + 8, GL_RGBA, GL_UNSIGNED_BYTE, all.data());
        fathom::Picture picture;
        picture.width = width;
        picture.height = height;
        int beside = 0;
        for (int y = height + 8; y-- > 0;)
            for (int x = 0; x < width + 8; ++x) {
                const std::uint8_t *pixel = &all[4 * static_cast<std::size_t>(y * (width + 8) + x)];
                if (x < width && y < height)
                    picture.rgba.insert(picture.rgba.end(), pixel, pixel + 4);
                else
                    beside += pixel[0] != 0 || pixel[1] != 255;
            }
        CHECK(beside == 0);
        return picture;
    }

    fathom::Picture drawn(fathom::GlShader &shader) {
        clear();
        REQUIRE(shader.draw(width, height));
        CHECK(glGetError() == GL_NO_ERROR);
        return shown();
    }

  private:
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
    GLuint framebuffer_ = 0, color_ = 0;
};

fathom::Scene hosted(const std::string &text) {
    const fathom::CompileResult result = fathom::compile_text("scene.sdf", text);
    REQUIRE(result);
    return *result.scene;
}

fathom::Shader made(const fathom::Scene &scene, const char *target, bool noise_cache = false) {
    fathom::ShaderOptions options;
    options.target = target;
    options.buffers = options.target == "glsl450";
    options.noise_cache = noise_cache;
    const auto shader = fathom::make_shader(scene, options);
    REQUIRE(shader);
    return *shader;
}

fathom::Picture painted(const fathom::Scene &scene, double time = 0) {
    fathom::GlPainter painter;
    REQUIRE((painter.open().empty() && painter.use(scene).empty()));
    fathom::PictureOptions options;
    options.width = width;
    options.height = height;
    options.samples = 1;
    options.time = time;
    return painter.draw(options);
}

// Of all numbers, those that are more than `by` of 255 apart.
int apart(const fathom::Picture &a, const fathom::Picture &b, int by = 2) {
    REQUIRE(a.rgba.size() == b.rgba.size());
    int count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        if (i % 4 != 3) count += std::abs(a.rgba[i] - b.rgba[i]) > by;
    return count;
}

// Their mean difference, in 255ths. Cached values show facets of their cells.
double unlike(const fathom::Picture &a, const fathom::Picture &b) {
    REQUIRE(a.rgba.size() == b.rgba.size());
    double sum = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) sum += std::abs(a.rgba[i] - b.rgba[i]);
    return sum / static_cast<double>(a.rgba.size());
}

constexpr int few = width * height * 3 / 1000;

constexpr const char *slider = "param r = 0.5 in 0.2..2\n"
                               "sphere(r).translate(x: 0.3 * sin(time)).paint(orange)\n"
                               "camera(at: [0, 1, 4])\nrender(time: 4)\n";

constexpr const char *bumpy =
    "param depth = 0.2 in 0.02..0.6\n"
    "let bumps = cached(p => depth * (1 + fbm(0.7 * p, octaves: 8)), cell: 0.12)\n"
    "sphere(1).displace(bumps).paint(orange)\n"
    "camera(at: [0, 0, 4], look_at: [0, 0, 0])\n";

} // namespace

TEST_CASE("a host's context shows a scene by any target whose uniforms hosts set") {
    const fathom::Scene scene = hosted(slider);
    for (const char *target : {"glsl330", "glsl450", "es300"}) {
        INFO(target);
        Host host;
        fathom::GlShader shader;
        REQUIRE(shader.load(made(scene, target)) == "");
        CHECK(apart(host.drawn(shader), painted(scene)) < few);
        shader.set(
            {{"float", "fathom_time", {2}}, {"float", "param_r", {1.2}}, {"int", "none", {1}}});
        const auto larger = scene.with({{"r", {1.2}}});
        REQUIRE(larger);
        const fathom::Picture wanted = painted(*larger.scene, 2);
        CHECK(apart(host.drawn(shader), wanted) < few);
        CHECK(apart(host.drawn(shader), wanted) < few); // values stay
        CHECK(shader.cached_share() == 0);
    }
}

TEST_CASE("OpenGL ES shows es300 and says why it does not show another") {
    const fathom::Scene scene = hosted(slider);
    Host host(EGL_OPENGL_ES_API);
    fathom::GlShader shader;
    CHECK(shader.load(made(scene, "glsl330")) != "");
    CHECK_FALSE(shader.draw(width, height));
    REQUIRE(shader.load(made(scene, "es300")) == "");
    const fathom::Picture shown = host.drawn(shader);
    host.leave();
    CHECK(apart(shown, painted(scene)) < few);
}

TEST_CASE("tables, images and grids are bound by reflection") {
    // 400 rows of random numbers: a buffer for glsl450, a texture for none.
    const fathom::Scene many = hosted(
        "for i in 0..400 { sphere(0.1 + 0.1 * random(i)).translate([4 * random(i + 1000) - 2, "
        "4 * random(i + 2000) - 2, 4 * random(i + 3000) - 2]) }\n");
    const fathom::Shader with_tables = made(many, "glsl450");
    CHECK(with_tables.tables.size() >= 400);
    const auto garden =
        fathom::compile_file(std::string(FATHOM_SOURCE_DIR) + "/examples/tiled_garden.sdf");
    REQUIRE(garden);
    const fathom::Shader with_images = made(*garden.scene, "glsl330");
    CHECK_FALSE(with_images.textures.empty());

    const auto folder =
        std::filesystem::temp_directory_path() / ("gl_shader_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    std::string grid = "NRRD0004\ntype: float\ndimension: 3\nsizes: 8 8 8\nencoding: raw\n"
                       "endian: little\n\n";
    for (int i = 0; i < 512; ++i) {
        const float x = static_cast<float>(i % 8) / 7 - 0.5f,
                    y = static_cast<float>(i / 8 % 8) / 7 - 0.5f,
                    z = static_cast<float>(i / 64) / 7 - 0.5f;
        const float value = std::max({std::fabs(x), std::fabs(y), std::fabs(z)}) - 0.3f;
        grid.append(reinterpret_cast<const char *>(&value), sizeof value);
    }
    REQUIRE(fathom::write_file((folder / "cube.nrrd").string(), grid) == "");
    REQUIRE(fathom::write_file((folder / "scene.sdf").string(), "distance_grid(\"cube.nrrd\")\n") ==
            "");
    const auto cube = fathom::compile_file((folder / "scene.sdf").string());
    std::filesystem::remove_all(folder);
    REQUIRE(cube);
    const fathom::Shader with_grid = made(*cube.scene, "es300");
    REQUIRE(with_grid.textures.size() == 1);
    CHECK(with_grid.textures[0].grid);

    Host host;
    fathom::GlShader shader; // takes one after the other
    REQUIRE(shader.load(with_tables) == "");
    CHECK(apart(host.drawn(shader), painted(many)) < few);
    REQUIRE(shader.load(with_images) == "");
    CHECK(apart(host.drawn(shader), painted(*garden.scene)) < 4 * few);
    REQUIRE(shader.load(with_grid) == "");
    CHECK(apart(host.drawn(shader), painted(*cube.scene)) < few);
}

TEST_CASE("what a host's context is set to disturbs no picture, and is so again") {
    const fathom::Scene scene = hosted(bumpy);
    for (const bool noise_cache : {false, true}) {
        INFO(noise_cache);
        Host host;
        const fathom::Picture wanted = painted(scene);
        std::array<GLuint, 2> buffers{};
        glGenBuffers(2, buffers.data());
        glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffers[0]);
        glBindBuffer(GL_PIXEL_PACK_BUFFER, buffers[1]);
        GLuint sampler = 0, vertices = 0;
        glGenSamplers(1, &sampler);
        glSamplerParameteri(sampler, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
        for (GLuint unit = 0; unit < 16; ++unit) glBindSampler(unit, sampler);
        glGenVertexArrays(1, &vertices);
        glBindVertexArray(vertices);
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 3);
        glPixelStorei(GL_UNPACK_SKIP_PIXELS, 1);
        glPixelStorei(GL_PACK_ROW_LENGTH, 7);
        const std::array on{GL_BLEND,
                            GL_SCISSOR_TEST,
                            GL_CULL_FACE,
                            GL_DEPTH_TEST,
                            GL_STENCIL_TEST,
                            GL_DITHER,
                            GL_FRAMEBUFFER_SRGB,
                            GL_COLOR_LOGIC_OP,
                            GL_RASTERIZER_DISCARD};
        for (const int what : on) glEnable(static_cast<GLenum>(what));
        glBlendFunc(GL_ZERO, GL_ONE);
        glScissor(3, 3, 5, 5);
        glCullFace(GL_FRONT_AND_BACK);
        glDepthFunc(GL_NEVER);
        glDepthMask(GL_FALSE);
        glColorMask(GL_TRUE, GL_FALSE, GL_FALSE, GL_TRUE);
        glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
        glViewport(1, 2, 3, 4);
        glActiveTexture(GL_TEXTURE5);

        fathom::GlShader shader;
        REQUIRE(shader.load(made(scene, "glsl450", noise_cache)) == "");
        for (int frame = 0; frame < 6; ++frame) REQUIRE(shader.draw(width, height));
        CHECK((shader.cached_share() > 0.8) == noise_cache);
        CHECK(glGetError() == GL_NO_ERROR);

        const auto integer = [](GLenum what) {
            std::array<GLint, 4> value{};
            glGetIntegerv(what, value.data());
            return value;
        };
        for (const int what : on) CHECK(glIsEnabled(static_cast<GLenum>(what)));
        CHECK(integer(GL_VIEWPORT) == std::array<GLint, 4>{1, 2, 3, 4});
        CHECK(integer(GL_DEPTH_FUNC)[0] == GL_NEVER);
        CHECK(integer(GL_DEPTH_WRITEMASK)[0] == 0);
        CHECK(integer(GL_COLOR_WRITEMASK) == std::array<GLint, 4>{1, 0, 0, 1});
        CHECK(integer(GL_POLYGON_MODE)[0] == GL_LINE);
        CHECK(integer(GL_ACTIVE_TEXTURE)[0] == GL_TEXTURE5);
        CHECK(integer(GL_CURRENT_PROGRAM)[0] == 0);
        CHECK(integer(GL_VERTEX_ARRAY_BINDING)[0] == static_cast<GLint>(vertices));
        CHECK(integer(GL_PIXEL_UNPACK_BUFFER_BINDING)[0] == static_cast<GLint>(buffers[0]));
        CHECK(integer(GL_PIXEL_PACK_BUFFER_BINDING)[0] == static_cast<GLint>(buffers[1]));
        CHECK(integer(GL_UNPACK_ROW_LENGTH)[0] == 3);
        CHECK(integer(GL_UNPACK_SKIP_PIXELS)[0] == 1);
        CHECK(integer(GL_PACK_ROW_LENGTH)[0] == 7);

        glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
        glPixelStorei(GL_PACK_ROW_LENGTH, 0);
        CHECK(unlike(host.shown(), wanted) < (noise_cache ? 3 : 0.1));
    }
}

TEST_CASE("without a context, and with a text that draws nothing, the reason is said") {
    const fathom::Scene scene = hosted(slider);
    const fathom::Shader good = made(scene, "glsl330");
    fathom::GlShader shader;
    CHECK(shader.load(good).find("no context") != std::string::npos);
    CHECK_FALSE(shader.draw(width, height));
    CHECK(shader.cached_share() == 0);
    shader.set(good.inputs);
    {
        Host host;
        REQUIRE(shader.load(good) == "");
        const fathom::Picture first = host.drawn(shader);
        fathom::ShaderOptions field;
        field.field_only = true;
        for (const char *target : {"spirv", "shadertoy", "glslviewer"})
            CHECK(shader.load(made(scene, target)).find("draws no picture") != std::string::npos);
        CHECK(shader.load(*fathom::make_shader(scene, field)).find("draws no picture") !=
              std::string::npos);
        fathom::Shader broken = good;
        broken.text += "\nnonsense\n";
        CHECK(shader.load(broken).find("driver refuses") != std::string::npos);
        broken = good;
        broken.textures.push_back({"huge", false, 1 << 20, 1, 1, {}});
        CHECK(shader.load(broken).find("1048576 on a side") != std::string::npos);
        for (const auto &[w, h] : {std::pair{0, 5}, std::pair{5, -1}, std::pair{1 << 20, 5}})
            CHECK_FALSE(shader.draw(w, h));
        CHECK(host.drawn(shader).rgba == first.rgba); // what was loaded stays

        fathom::GlShader other = std::move(shader);
        CHECK_FALSE(shader.draw(width, height));
        CHECK(host.drawn(other).rgba == first.rgba);
        shader = std::move(other);
        host.leave();
        CHECK_FALSE(shader.draw(width, height));
    } // the context ends before what was made in it
}

TEST_CASE("a shader with the noise cache is drawn by cached values, which follow its params") {
    const fathom::Scene scene = hosted(bumpy);
    const fathom::Shader cached = made(scene, "glsl450", true);
    REQUIRE(cached.cache.fields.size() == 1);
    CHECK(cached.cache.fields[0].params == std::vector<std::string>{"depth"});
    CHECK_FALSE(cached.cache.fields[0].wide);
    CHECK(
        (cached.cache.fields[0].cost > 0 && cached.cache.scene_cost > cached.cache.fields[0].cost));
    const fathom::Shader again = made(hosted(std::string(bumpy) + "box(0.1)"), "glsl450", true);
    CHECK(again.cache.fields[0].meaning == cached.cache.fields[0].meaning);

    Host host;
    fathom::GlShader shader;
    REQUIRE(shader.load(cached) == "");
    const auto share = [&](int frames) {
        for (int i = 0; i < frames; ++i) host.drawn(shader);
        return shader.cached_share();
    };
    const double alone = share(1); // of the background, which reads no value
    CHECK(alone < 0.7);
    CHECK(share(5) > 0.9);
    const fathom::Picture first = painted(scene);
    CHECK(unlike(host.drawn(shader), first) < 3);

    shader.set({{"float", "param_depth", {0.6}}});
    CHECK(share(1) < 0.7); // what was cached is of another depth
    CHECK(share(8) > 0.9);
    const auto deep = scene.with({{"depth", {0.6}}});
    REQUIRE(deep);
    const fathom::Picture wanted = painted(*deep.scene);
    const fathom::Picture shown = host.drawn(shader);
    CHECK(unlike(shown, wanted) < unlike(shown, first) / 2);

    // Another view is drawn through the same cells, and another scene with the same field.
    shader.set(turned_camera(cached, 0.02, 0));
    CHECK(share(1) > 0.8);
    REQUIRE(shader.load(again) == "");
    shader.set({{"float", "param_depth", {0.6}}});
    CHECK(share(1) > 0.8);
    REQUIRE(shader.load(made(scene, "glsl450")) == "");
    CHECK(share(1) == 0);
    CHECK(apart(host.drawn(shader), painted(scene)) < few);
}
