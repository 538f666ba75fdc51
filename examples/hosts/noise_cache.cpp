// The noise cache by hand (docs/noise-cache.md): noise_cache SCENE.sdf [PICTURE.ppm [PARAM=VALUE]]
// For engines and APIs of one's own; in OpenGL fathom::GlShader does all of it (window.cpp).
// Shows a scene that has `cached(…)`, turning, and prints how many pixels of each frame missed a value and how many cells
// were filled for the next ones. With PICTURE.ppm the view stands still, frames are drawn until next to no pixel misses,
// and the last is written there; nothing is shown. With PARAM=VALUE all of that is done first, and again with that value.
#include "host.h"

#include <cstring>
#include <numeric>

namespace {

// Cells along an edge: 2^6, and 2^7 for views that need more. Of 64³ all textures take 50 MB, 18 without the pool of
// vectors and colours.
constexpr int least_bits = 6, most_bits = 7;
constexpr int ages = 4; // a cell is looked for in so many places at most

// The words of the counts (docs/noise-cache.md) that a host reads or writes.
constexpr int ring_end = 1, ring_limit = 2, inserted = 3, dropped = 5, full = 7, words = 14;

GLuint texture(GLenum kind, GLenum format, int width, int height, int depth, GLint filter) {
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(kind, name);
    if (kind == GL_TEXTURE_2D)
        glTexStorage2D(kind, 1, format, width, height);
    else
        glTexStorage3D(kind, 1, format, width, height, depth);
    glTexParameteri(kind, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(kind, GL_TEXTURE_MAG_FILTER, filter);
    return name;
}

// A texture and the uniform that it goes by: a sampler or, with `format`, an image as well.
struct Bound {
    std::string name;
    GLenum kind;
    GLuint texture;
    GLenum format = GL_NONE;
};

// Gives the program in use those that it reads, each on a unit of its own, from `unit` on.
void bind(GLuint program, const std::vector<Bound> &all, GLuint unit) {
    GLuint image = 0;
    for (const Bound &one : all) {
        const char *name = one.name.c_str();
        GLuint index = 0;
        glGetUniformIndices(program, 1, &name, &index);
        if (index == GL_INVALID_INDEX) continue;
        GLint type = 0;
        glGetActiveUniformsiv(program, 1, &index, GL_UNIFORM_TYPE, &type);
        const GLint at = glGetUniformLocation(program, name);
        if (type >= GL_IMAGE_1D && type <= GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY) {
            glBindImageTexture(image, one.texture, 0, GL_TRUE, 0, GL_READ_WRITE, one.format);
            glUniform1i(at, static_cast<GLint>(image++));
        } else {
            glActiveTexture(GL_TEXTURE0 + unit);
            glBindTexture(one.kind, one.texture);
            glUniform1i(at, static_cast<GLint>(unit++));
        }
    }
}

// What lives from frame to frame.
struct Cache {
    std::vector<Bound> bound;
    int bits = 0, side = 0, cells = 0;
    GLuint counts = 0; // the buffer
    GLuint sweep = 0;  // a framebuffer with a pixel for each cell, side * side wide
};

Cache make_cache(int bits) {
    const int side = 1 << bits, cells = side * side * side;
    Cache cache;
    cache.bits = bits;
    cache.side = side;
    cache.cells = cells;
    const auto cube = [&](const char *name, GLenum format, int edge, GLint filter) {
        cache.bound.push_back({name, GL_TEXTURE_3D,
                               texture(GL_TEXTURE_3D, format, edge, edge, edge, filter), format});
    };
    const auto fill = [&](GLenum layout, const std::vector<GLuint> &values) {
        glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, 0, side, side, side, layout, GL_UNSIGNED_INT,
                        values.data());
    };
    const std::vector<GLuint> ones(2 * static_cast<std::size_t>(cells), 0xffffffff);
    std::vector<GLuint> numbers(static_cast<std::size_t>(cells));
    std::iota(numbers.begin(), numbers.end(), 0);
    cube("fathom_cache_hash", GL_R32UI, side, GL_NEAREST);
    fill(GL_RED_INTEGER, ones);
    cube("fathom_cache_index", GL_RG32UI, side, GL_NEAREST);
    fill(GL_RG_INTEGER, ones);
    cube("fathom_cache_free", GL_R32UI, side, GL_NEAREST);
    fill(GL_RED_INTEGER, numbers);
    cube("fathom_cache_keys", GL_RGBA32I, side, GL_NEAREST);
    cube("fathom_cache_changed", GL_R32UI, side, GL_NEAREST);
    cube("fathom_cache_pool", GL_R32F, 2 * side, GL_LINEAR);
    cube("fathom_cache_wide", GL_RGBA32F, 2 * side, GL_LINEAR);
    std::array<GLuint, words> counts{};
    counts[ring_end] = static_cast<GLuint>(cells);
    const auto [buffer, name] = buffer_texture(GL_R32UI, sizeof counts, counts.data());
    cache.counts = buffer;
    cache.bound.push_back({"fathom_cache_counts", GL_TEXTURE_BUFFER, name, GL_R32UI});
    const GLuint pixels = texture(GL_TEXTURE_2D, GL_R8, side * side, side, 1, GL_NEAREST);
    glGenFramebuffers(1, &cache.sweep);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, cache.sweep);
    glFramebufferTexture(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, pixels, 0);
    return cache;
}

// What lives as long as the size of the picture: what the passes of one frame tell each other.
struct Targets {
    int width = 0, height = 0;
    std::vector<Bound> bound;
    GLuint picture = 0, rest = 0, reserved = 0; // framebuffers
};

Targets make_targets(int width, int height) {
    Targets t{width, height, {}};
    const auto plane = [&](GLenum kind, GLenum format, int depth, const char *name) {
        const GLuint made = texture(kind, format, width, height, depth, GL_NEAREST);
        if (name) t.bound.push_back({name, kind, made});
        return made;
    };
    const GLuint color = plane(GL_TEXTURE_2D, GL_RGBA8, 1, nullptr),
                 depth = plane(GL_TEXTURE_2D, GL_DEPTH_COMPONENT24, 1, nullptr),
                 misses = plane(GL_TEXTURE_2D, GL_RGBA32I, 1, "fathom_cache_misses"),
                 tally = plane(GL_TEXTURE_2D, GL_RG32UI, 1, "fathom_cache_tally"),
                 starts = plane(GL_TEXTURE_2D, GL_RGBA32F, 1, "fathom_cache_starts"),
                 wishes = plane(GL_TEXTURE_2D_ARRAY, GL_RGBA32I, 4, "fathom_cache_wishes"),
                 places = plane(GL_TEXTURE_2D, GL_RGBA32UI, 1, "fathom_cache_places");
    const auto framebuffer = [](GLuint &name, const std::vector<GLenum> &outputs) {
        glGenFramebuffers(1, &name);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name);
        glDrawBuffers(static_cast<GLsizei>(outputs.size()), outputs.data());
    };
    const auto attach_to = [](GLenum place, GLuint name) {
        glFramebufferTexture(GL_DRAW_FRAMEBUFFER, place, name, 0);
    };
    // A text's outputs are the attachments of their numbers; there is no output 1.
    framebuffer(t.picture, {GL_COLOR_ATTACHMENT0, GL_NONE, GL_COLOR_ATTACHMENT2,
                            GL_COLOR_ATTACHMENT3, GL_COLOR_ATTACHMENT4});
    attach_to(GL_COLOR_ATTACHMENT0, color);
    attach_to(GL_COLOR_ATTACHMENT2, misses);
    attach_to(GL_COLOR_ATTACHMENT3, tally);
    attach_to(GL_COLOR_ATTACHMENT4, starts);
    attach_to(GL_DEPTH_ATTACHMENT, depth);
    framebuffer(t.rest, {GL_COLOR_ATTACHMENT0, GL_NONE, GL_COLOR_ATTACHMENT2, GL_COLOR_ATTACHMENT3,
                         GL_COLOR_ATTACHMENT4, GL_COLOR_ATTACHMENT5});
    attach_to(GL_COLOR_ATTACHMENT0, color);
    for (int i = 0; i < 4; ++i)
        glFramebufferTextureLayer(GL_DRAW_FRAMEBUFFER,
                                  GL_COLOR_ATTACHMENT2 + static_cast<GLenum>(i), wishes, 0, i);
    attach_to(GL_DEPTH_ATTACHMENT, depth);
    framebuffer(t.reserved, {GL_COLOR_ATTACHMENT0});
    attach_to(GL_COLOR_ATTACHMENT0, places);
    return t;
}

struct Programs {
    GLuint cached, computed, reserve, fill, publish, sweep;
};

Programs make_programs(const fathom::Shader &shader) {
    // The picture's text behind its first line, `#version`, and what is defined there.
    const std::size_t line = shader.text.find('\n') + 1;
    const std::string version = shader.text.substr(0, line), text = shader.text.substr(line);
    return {program_of(version + "#define FATHOM_CACHE\n" + text),
            program_of(version + "#define FATHOM_CACHE_LEARN\n" + text),
            program_of(shader.cache.reserve),
            program_of(shader.cache.fill),
            program_of(shader.cache.publish),
            program_of(shader.cache.sweep)};
}

struct Host {
    Programs programs;
    Cache cache;
    Targets targets;
    std::vector<fathom::ShaderInput> data; // the units of the scene's own textures
    unsigned frame = 0;
    int crowded = 0; // frames one after another whose cells lacked places
};

void use(const Host &host, GLuint program) {
    glUseProgram(program);
    std::vector<Bound> all = host.cache.bound;
    all.insert(all.end(), host.targets.bound.begin(), host.targets.bound.end());
    bind(program, all, static_cast<GLuint>(host.data.size()));
    set(program, host.data);
    const double width = host.targets.width, height = host.targets.height;
    set(program, {{"vec2", "fathom_resolution", {width, height}},
                  {"int", "fathom_cache_width", {width}},
                  {"int", "fathom_cache_height", {height}},
                  {"int", "fathom_cache_bits", {1.0 * host.cache.bits}},
                  {"int", "fathom_cache_ages", {ages}}});
    glUniform1ui(glGetUniformLocation(program, "fathom_cache_frame"), host.frame);
    // A number for each cached field: its own. More than there are do no harm.
    std::array<GLint, 256> fields{};
    std::iota(fields.begin(), fields.end(), 0);
    glUniform1iv(glGetUniformLocation(program, "fathom_cache_fields"), 256, fields.data());
}

constexpr GLbitfield images_written =
    GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT;

void draw(GLbitfield barriers = 0) {
    glDrawArrays(GL_TRIANGLES, 0, 3);
    if (barriers != 0) glMemoryBarrier(barriers);
}

void publish(const Host &host) {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, host.targets.reserved); // any of the picture's size
    glViewport(0, 0, host.targets.width, host.targets.height);
    use(host, host.programs.publish);
    draw(images_written);
}

// The counts of a frame: the ring's end is its limit, and all else is 0.
void reset_counts(const Host &host) {
    glBindBuffer(GL_COPY_READ_BUFFER, host.cache.counts);
    glBindBuffer(GL_COPY_WRITE_BUFFER, host.cache.counts);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 4 * ring_end, 4 * ring_limit, 4);
    const std::array<GLuint, words - inserted> zeros{};
    glBufferSubData(GL_COPY_WRITE_BUFFER, 4 * inserted, sizeof zeros, zeros.data());
}

// Forgets all cells: a param moved, and which fields read it is not worth finding out here.
void forget(const Host &host) {
    const GLuint program = host.programs.sweep;
    reset_counts(host);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, host.cache.sweep);
    glViewport(0, 0, host.cache.side * host.cache.side, host.cache.side);
    use(host, program);
    set(program, {{"int", "fathom_cache_width", {1.0 * host.cache.side * host.cache.side}},
                  {"int", "fathom_cache_gone", {-1}}});
    draw(images_written);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    publish(host);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

// What a frame shows.
struct Seen {
    std::vector<fathom::ShaderInput> params, camera;
};

// A picture, and the cells of it for the next ones.
void draw_frame(Host &host, const Seen &seen) {
    const Programs &programs = host.programs;
    const Targets &targets = host.targets;
    glViewport(0, 0, targets.width, targets.height);
    reset_counts(host);

    // By cached values. A pixel that is finished has a depth of 0, one that missed a value 1.
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, targets.picture);
    use(host, programs.cached);
    set(programs.cached, seen.params);
    set(programs.cached, seen.camera);
    draw();

    // The pixels that missed, computed: the triangle lies at a depth between.
    glDepthFunc(GL_LESS);
    glDepthMask(GL_FALSE);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, targets.rest);
    use(host, programs.computed);
    set(programs.computed, seen.params);
    set(programs.computed, seen.camera);
    draw();
    glDepthMask(GL_TRUE);
    glDisable(GL_DEPTH_TEST);

    // A place for each cell that they wish for, its values, and the index by which it is found.
    ++host.frame;
    const GLuint none[] = {0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff};
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, targets.reserved);
    glClearBufferuiv(GL_COLOR, 0, none);
    use(host, programs.reserve);
    draw(images_written);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE); // the others write images alone
    use(host, programs.fill);
    set(programs.fill, seen.params);
    draw(images_written);
    publish(host);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

// What became of a frame. Who neither prints it nor lets the cache grow need not wait for the card.
struct Tally {
    int missed = 0;            // pixels that missed a value
    GLuint filled = 0;         // cells
    bool lacks_places = false; // more cells were wished for than have a place
};

Tally tally_of(const Host &host) {
    const Targets &targets = host.targets;
    Tally tally;
    std::vector<GLuint> pixels(2 * static_cast<std::size_t>(targets.width * targets.height));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, targets.picture);
    glReadBuffer(GL_COLOR_ATTACHMENT3);
    glReadPixels(0, 0, targets.width, targets.height, GL_RG_INTEGER, GL_UNSIGNED_INT,
                 pixels.data());
    for (std::size_t i = 1; i < pixels.size(); i += 2) tally.missed += (pixels[i] & 3) != 0;
    std::array<GLuint, words> counts{};
    glBindBuffer(GL_COPY_READ_BUFFER, host.cache.counts);
    glGetBufferSubData(GL_COPY_READ_BUFFER, 0, sizeof counts, counts.data());
    tally.filled = counts[inserted];
    const GLuint lost = std::accumulate(&counts[dropped], &counts[full] + 1, GLuint{0});
    tally.lacks_places = lost > static_cast<GLuint>(host.cache.cells / 32);
    return tally;
}

void show(const Host &host) {
    const int width = host.targets.width, height = host.targets.height;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, host.targets.picture);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

Tally draw_and_tell(Host &host, const Seen &seen) {
    draw_frame(host, seen);
    const Tally tally = tally_of(host);
    std::printf("frame %u: %d of %d pixels missed a value, %u cells were filled\n", host.frame,
                tally.missed, host.targets.width * host.targets.height, tally.filled);
    // Once may be the begin; twice the view needs more cells than there are.
    host.crowded = tally.lacks_places ? host.crowded + 1 : 0;
    if (host.crowded == 2 && host.cache.bits < most_bits) {
        for (const Bound &one : host.cache.bound) glDeleteTextures(1, &one.texture);
        host.cache = make_cache(host.cache.bits + 1);
        host.crowded = 0;
        std::printf("the cache has %d cells now\n", host.cache.cells);
    }
    show(host);
    return tally;
}

// Until next to no pixel misses; some views never come so far.
void draw_still(Host &host, const Seen &seen) {
    const int few = host.targets.width * host.targets.height / 1000;
    for (int frame = 0; frame < 40; ++frame)
        if (draw_and_tell(host, seen).missed <= few) return;
}

// "name=1.5": false where there is no such param of one number.
bool set_param(Controls &controls, const char *words) {
    const char *value = std::strchr(words, '=');
    if (!value) return false;
    for (fathom::ShaderInput &param : controls.params)
        if (param.param == std::string(words, value) && param.value.size() == 1) {
            param.value[0] = std::atof(value + 1);
            return true;
        }
    return false;
}

} // namespace

int main(int count, char **arguments) {
    if (count < 2 || count > 4) fail("usage: noise_cache SCENE.sdf [PICTURE.ppm [PARAM=VALUE]]");
    const bool still = count > 2;
    fathom::ShaderOptions options;
    options.target = "glsl450";
    options.noise_cache = true;
    const auto [scene, shader] = compile(arguments[1], options);
    if (shader.cache.fill.empty()) fail("no field of this scene is worth keeping");

    GLFWwindow *window = open_window(arguments[1], 4, 2, !still);
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    Host host{make_programs(shader), make_cache(least_bits), make_targets(width, height),
              bind_data(shader)};
    Controls controls = controls_of(scene, shader);
    const auto seen = [&, &picture = shader] {
        return Seen{controls.params,
                    turned_camera(picture, controls.around, controls.above, controls.distance)};
    };
    if (still) {
        draw_still(host, seen());
        if (count > 3) {
            if (!set_param(controls, arguments[3])) fail("there is no such param of one number");
            forget(host);
            draw_still(host, seen());
        }
        write_frame(window, arguments[2]);
    }
    while (!still && !glfwWindowShouldClose(window)) {
        controls.around += 0.005;
        draw_and_tell(host, seen());
        glfwSwapBuffers(window);
        if (poll(window, controls)) forget(host);
    }
    glfwTerminate();
    return 0;
}
