// A host that knows the exported texts and docs/noise-cache.md, and nothing of render-gl's passes:
// what the page says is enough. Its pictures are compared with ours.
#include "backend-glsl/emit.h"
#include "tests/unit/cache/scenes.h"

#include <epoxy/gl.h>

#include <numeric>

namespace fathom {

namespace {

constexpr int bits = 6, side = 1 << bits, cells = side * side * side;
constexpr int size = 48; // of the picture

// "Each is drawn as one triangle over its target."
GLuint program(const std::string &fragment) {
    const char *vertex = "#version 330 core\nvoid main() {\n    gl_Position = "
                         "vec4(float(gl_VertexID & 1) * 4.0 - 1.0, float(gl_VertexID >> 1) * 4.0 - "
                         "1.0, 0.0, 1.0);\n}\n";
    const GLuint name = glCreateProgram();
    for (const auto &[kind, text] :
         {std::pair<GLenum, const char *>{GL_VERTEX_SHADER, vertex},
          std::pair<GLenum, const char *>{GL_FRAGMENT_SHADER, fragment.c_str()}}) {
        const GLuint shader = glCreateShader(kind);
        glShaderSource(shader, 1, &text, nullptr);
        glCompileShader(shader);
        glAttachShader(name, shader);
        glDeleteShader(shader);
    }
    glLinkProgram(name);
    GLint good = 0;
    glGetProgramiv(name, GL_LINK_STATUS, &good);
    REQUIRE(good);
    return name;
}

GLuint texture(GLenum target, GLint format, int edge, GLenum layout, GLenum type,
               const void *data = nullptr) {
    GLuint name = 0;
    glGenTextures(1, &name);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(target, name);
    if (target == GL_TEXTURE_3D)
        glTexImage3D(target, 0, format, edge, edge, edge, 0, layout, type, data);
    else
        glTexImage2D(target, 0, format, edge, edge, 0, layout, type, data);
    const bool linear = format == GL_R32F && target == GL_TEXTURE_3D;
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, linear ? GL_LINEAR : GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, linear ? GL_LINEAR : GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, 0);
    return name;
}

GLint at(GLuint program, const char *name) { return glGetUniformLocation(program, name); }
void number(GLuint program, const char *name, int value) { glUniform1i(at(program, name), value); }

void sampler(GLuint program, const char *name, int unit, GLenum target, GLuint texture) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(target, texture);
    number(program, name, unit);
}

void image(GLuint program, const char *name, GLuint unit, GLuint texture, GLenum format) {
    glBindImageTexture(unit, texture, 0, GL_TRUE, 0, GL_READ_WRITE, format);
    number(program, name, static_cast<int>(unit));
}

struct Host {
    GLuint rest, cached, reserve, fill, publish;
    GLuint hash, keys, pool, wide, index, ring, changed, buffer, counts;
    GLuint color, misses, wishes, hits, starts, places, depth, picture, learning, reserved,
        vertices;
    unsigned frame = 0;

    Host(const std::string &text, const glsl::CachePasses &passes)
        : reserve(program(passes.reserve)), fill(program(passes.fill.text)),
          publish(program(passes.publish)) {
        const std::size_t line = text.find('\n') + 1;
        cached = program(text.substr(0, line) + "#define FATHOM_CACHE\n" + text.substr(line));
        rest = program(text.substr(0, line) + "#define FATHOM_CACHE_LEARN\n" + text.substr(line));
        const std::vector<std::uint32_t> ones(2 * cells, 0xffffffffu);
        std::vector<std::uint32_t> numbers(cells);
        std::iota(numbers.begin(), numbers.end(), 0u);
        const auto words = [&](GLint format, GLenum layout, const void *data) {
            return texture(GL_TEXTURE_3D, format, side, layout, GL_UNSIGNED_INT, data);
        };
        hash = words(GL_R32UI, GL_RED_INTEGER, ones.data());
        index = words(GL_RG32UI, GL_RG_INTEGER, ones.data());
        ring = words(GL_R32UI, GL_RED_INTEGER, numbers.data());
        changed = words(GL_R32UI, GL_RED_INTEGER, nullptr);
        keys = texture(GL_TEXTURE_3D, GL_RGBA32I, side, GL_RGBA_INTEGER, GL_INT);
        pool = texture(GL_TEXTURE_3D, GL_R32F, 2 * side, GL_RED, GL_FLOAT);
        wide = texture(GL_TEXTURE_3D, GL_RGBA32F, 2, GL_RGBA, GL_FLOAT); // no field is a vector
        std::array<std::uint32_t, 14> start{};
        start[1] = cells;
        glGenBuffers(1, &buffer);
        glBindBuffer(GL_TEXTURE_BUFFER, buffer);
        glBufferData(GL_TEXTURE_BUFFER, sizeof start, start.data(), GL_DYNAMIC_COPY);
        glGenTextures(1, &counts);
        glBindTexture(GL_TEXTURE_BUFFER, counts);
        glTexBuffer(GL_TEXTURE_BUFFER, GL_R32UI, buffer);

        color = texture(GL_TEXTURE_2D, GL_RGBA32F, size, GL_RGBA, GL_FLOAT);
        misses = texture(GL_TEXTURE_2D, GL_RGBA32I, size, GL_RGBA_INTEGER, GL_INT);
        glGenTextures(1, &wishes);
        glBindTexture(GL_TEXTURE_2D_ARRAY, wishes);
        glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA32I, size, size, 4, 0, GL_RGBA_INTEGER, GL_INT,
                     nullptr);
        glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        starts = texture(GL_TEXTURE_2D, GL_RGBA32F, size, GL_RGBA, GL_FLOAT);
        hits = texture(GL_TEXTURE_2D, GL_RG32UI, size, GL_RG_INTEGER, GL_UNSIGNED_INT);
        places = texture(GL_TEXTURE_2D, GL_RGBA32UI, size, GL_RGBA_INTEGER, GL_UNSIGNED_INT);
        glGenRenderbuffers(1, &depth);
        glBindRenderbuffer(GL_RENDERBUFFER, depth);
        glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, size, size);
        glGenFramebuffers(1, &picture);
        glBindFramebuffer(GL_FRAMEBUFFER, picture);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color, 0);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT2, GL_TEXTURE_2D, misses, 0);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT3, GL_TEXTURE_2D, hits, 0);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT4, GL_TEXTURE_2D, starts, 0);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
        glGenFramebuffers(1, &learning);
        glBindFramebuffer(GL_FRAMEBUFFER, learning);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color, 0);
        for (int i = 0; i < 4; ++i)
            glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT2 + static_cast<GLenum>(i),
                                      wishes, 0, i);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
        glGenFramebuffers(1, &reserved);
        glBindFramebuffer(GL_FRAMEBUFFER, reserved);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, places, 0);
        glGenVertexArrays(1, &vertices);
    }
    ~Host() {
        for (GLuint name : {rest, cached, reserve, fill, publish}) glDeleteProgram(name);
        for (GLuint name : {hash, keys, pool, wide, index, ring, changed, counts, color, misses,
                            wishes, hits, starts, places})
            glDeleteTextures(1, &name);
        for (GLuint name : {picture, learning, reserved}) glDeleteFramebuffers(1, &name);
        glDeleteRenderbuffers(1, &depth);
        glDeleteBuffers(1, &buffer);
        glDeleteVertexArrays(1, &vertices);
    }
    Host(const Host &) = delete;
    Host &operator=(const Host &) = delete;

    void triangle() const { glDrawArrays(GL_TRIANGLES, 0, 3); }
    void targets(bool all) const {
        const GLenum outputs[] = {GL_COLOR_ATTACHMENT0, GL_NONE, GL_COLOR_ATTACHMENT2,
                                  GL_COLOR_ATTACHMENT3, GL_COLOR_ATTACHMENT4};
        glDrawBuffers(all ? 5 : 1, outputs);
    }
    void use(GLuint program) const {
        glUseProgram(program);
        number(program, "fathom_cache_bits", bits);
        number(program, "fathom_cache_fields", 0);
        number(program, "fathom_cache_ages", 4);
        glUniform2f(at(program, "fathom_resolution"), size, size);
        number(program, "fathom_mode", 3); // linear light
    }

    void draw() {
        glBindVertexArray(vertices);
        glViewport(0, 0, size, size);
        glDisable(GL_BLEND);
        glDisable(GL_CULL_FACE);
        glBindBuffer(GL_COPY_READ_BUFFER, buffer);
        glBindBuffer(GL_COPY_WRITE_BUFFER, buffer);
        glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 4, 8, 4);
        const std::array<std::uint32_t, 11> zeros{};
        glBufferSubData(GL_COPY_WRITE_BUFFER, 12, sizeof zeros, zeros.data());

        glBindFramebuffer(GL_FRAMEBUFFER, picture);
        targets(true);
        glEnable(GL_DEPTH_TEST);
        glDepthMask(GL_TRUE);
        glDepthFunc(GL_ALWAYS);
        use(cached);
        glUniform1f(at(cached, "fathom_cache_least"), 0.0f);
        sampler(cached, "fathom_cache_index", 0, GL_TEXTURE_3D, index);
        sampler(cached, "fathom_cache_pool", 1, GL_TEXTURE_3D, pool);
        sampler(cached, "fathom_cache_wide", 2, GL_TEXTURE_3D, wide);
        triangle();

        glBindFramebuffer(GL_FRAMEBUFFER, learning);
        const GLenum learns[] = {GL_COLOR_ATTACHMENT0, GL_NONE,
                                 GL_COLOR_ATTACHMENT2, GL_COLOR_ATTACHMENT3,
                                 GL_COLOR_ATTACHMENT4, GL_COLOR_ATTACHMENT5};
        glDrawBuffers(6, learns);
        glDepthMask(GL_FALSE);
        glDepthFunc(GL_LESS);
        use(rest);
        glUniform1f(at(rest, "fathom_cache_least"), 0.0f);
        glUniform1ui(at(rest, "fathom_cache_frame"), frame);
        sampler(rest, "fathom_cache_index", 0, GL_TEXTURE_3D, index);
        sampler(rest, "fathom_cache_starts", 1, GL_TEXTURE_2D, starts);
        triangle();
        glDisable(GL_DEPTH_TEST);
        glDepthMask(GL_TRUE);

        glBindFramebuffer(GL_FRAMEBUFFER, reserved);
        const GLuint ones[] = {0xffffffffu, 0xffffffffu, 0xffffffffu, 0xffffffffu};
        glClearBufferuiv(GL_COLOR, 0, ones);
        use(reserve);
        glUniform1ui(at(reserve, "fathom_cache_frame"), ++frame);
        sampler(reserve, "fathom_cache_misses", 0, GL_TEXTURE_2D, misses);
        sampler(reserve, "fathom_cache_wishes", 1, GL_TEXTURE_2D_ARRAY, wishes);
        sampler(reserve, "fathom_cache_tally", 2, GL_TEXTURE_2D, hits);
        sampler(reserve, "fathom_cache_index", 3, GL_TEXTURE_3D, index);
        image(reserve, "fathom_cache_hash", 0, hash, GL_R32UI);
        image(reserve, "fathom_cache_keys", 1, keys, GL_RGBA32I);
        image(reserve, "fathom_cache_free", 2, ring, GL_R32UI);
        image(reserve, "fathom_cache_changed", 3, changed, GL_R32UI);
        image(reserve, "fathom_cache_counts", 4, counts, GL_R32UI);
        triangle();
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);

        glBindFramebuffer(GL_FRAMEBUFFER, picture);
        targets(false);
        glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        use(fill);
        sampler(fill, "fathom_cache_places", 0, GL_TEXTURE_2D, places);
        image(fill, "fathom_cache_keys", 0, keys, GL_RGBA32I);
        image(fill, "fathom_cache_pool", 1, pool, GL_R32F);
        image(fill, "fathom_cache_wide", 2, wide, GL_RGBA32F);
        triangle();
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);

        use(publish);
        number(publish, "fathom_cache_width", size);
        number(publish, "fathom_cache_height", size);
        sampler(publish, "fathom_cache_hash", 0, GL_TEXTURE_3D, hash);
        sampler(publish, "fathom_cache_keys", 1, GL_TEXTURE_3D, keys);
        sampler(publish, "fathom_cache_changed", 2, GL_TEXTURE_3D, changed);
        image(publish, "fathom_cache_counts", 0, counts, GL_R32UI);
        image(publish, "fathom_cache_index", 1, index, GL_RG32UI);
        triangle();
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        glBindVertexArray(0);
        REQUIRE(glGetError() == GL_NO_ERROR);
    }

    std::vector<float> colors() const { // from the bottom
        std::vector<float> result(4 * size * size);
        glBindFramebuffer(GL_FRAMEBUFFER, picture);
        glReadBuffer(GL_COLOR_ATTACHMENT0);
        glReadPixels(0, 0, size, size, GL_RGBA, GL_FLOAT, result.data());
        return result;
    }
    int unfinished() const {
        std::vector<std::uint32_t> words(2 * size * size);
        glBindFramebuffer(GL_FRAMEBUFFER, picture);
        glReadBuffer(GL_COLOR_ATTACHMENT3);
        glReadPixels(0, 0, size, size, GL_RG_INTEGER, GL_UNSIGNED_INT, words.data());
        int count = 0;
        for (std::size_t i = 1; i < words.size(); i += 2) count += (words[i] & 3) != 0;
        return count;
    }
};

// How far two pictures are apart, one from the top and one from the bottom: the mean over all.
double apart(const std::vector<float> &top, const std::vector<float> &bottom) {
    double sum = 0;
    for (std::size_t y = 0; y < size; ++y)
        for (std::size_t i = 0; i < 4 * size; ++i)
            sum += static_cast<double>(
                std::abs(top[y * 4 * size + i] - bottom[(size - 1 - y) * 4 * size + i]));
    return sum / static_cast<double>(top.size());
}

} // namespace

TEST_CASE("a host that follows the page draws what ours draws") {
    require_context();
    const driver::Compilation c = compiled(rock);
    Diagnostics diagnostics;
    const glsl::Options exported{.computed = true, .noise_cache = true};
    const std::string text = glsl::emit(c.scene, exported, diagnostics).text;
    Host host(text, glsl::emit_cache_passes(c.scene, exported, diagnostics));

    gl::CachedView view;
    use(view, c.scene, {.bits = bits});
    const gl::FrameInputs inputs = frame_of(c.scene, size);
    host.draw();
    view.draw(inputs, c.scene.params, all_cells);
    const std::vector<float> exact_colors = exact(c.scene, size, gl::Mode::Linear).rgba;
    CHECK(apart(exact_colors, host.colors()) < 1e-6); // nothing is known yet
    CHECK(host.unfinished() > 400);
    int frames = 1;
    while (host.unfinished() > 0 && frames < 80) host.draw(), ++frames;
    CHECK(frames < 80);
    CHECK(frames > 3);
    warm(view, inputs, c.scene, 80);
    // two texts, in which a driver computes `exp` a little differently
    CHECK(apart(view.read_pixels().rgba, host.colors()) < 1e-5);
    CHECK(apart(exact_colors, host.colors()) > 1e-4); // it is the cached one
}

} // namespace fathom
