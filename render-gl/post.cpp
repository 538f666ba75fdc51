#include "render-gl/post.h"

#include "backend-glsl/template.h"
#include "render-gl/fxaa.h"
#include "render-gl/program.h"
#include "render-gl/shaders.h"

#include <epoxy/gl.h>

#include <cassert>
#include <string>

namespace fathom::gl {

namespace {

// Behind the template `encode`, which has the colours (backend-glsl/template.h).
constexpr const char *resolve_text = R"(
uniform sampler2D sums;
uniform sampler2D picks;
uniform sampler2D probes;
uniform int look;
uniform float share;      // one over the samples
uniform float max_steps;
uniform float isolines;
out vec4 color;

// The distance a pixel away, at most: how thick a line of one pixel is.
float change(ivec2 at) {
    ivec2 most = textureSize(probes, 0) - 1;
    vec4 e = texelFetch(probes, min(at + ivec2(1, 0), most), 0);
    vec4 n = texelFetch(probes, min(at + ivec2(0, 1), most), 0);
    float d = texelFetch(probes, at, 0).x;
    return max(length(vec2(e.w > 0.0 ? e.x - d : 0.0, n.w > 0.0 ? n.x - d : 0.0)), 1e-7);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 picture = fathom_srgb(share * texelFetch(sums, at, 0).rgb);
    if (look == 0) picture += fathom_dither(ivec2(at.x, textureSize(sums, 0).y - 1 - at.y));
    vec3 gray = vec3(0.35 * dot(picture, vec3(0.299, 0.587, 0.114)) + 0.12);
    vec4 pick = texelFetch(picks, at, 0);   // part, t, steps, slope
    if (look == 1) picture = fathom_ramp(log2(1.0 + pick.z) / log2(1.0 + max_steps));
    if (look == 2) {
        // A field that rises by s a unit makes rays step 1/s times too often: blue is 1, red 32.
        picture = pick.y < 0.0 ? gray : fathom_ramp(clamp(-0.2 * log2(max(pick.w, 1e-6)), 0.0, 1.0)) * (0.55 + 0.45 * picture);
    }
    if (look == 3) {
        vec4 probe = texelFetch(probes, at, 0);   // distance, t, -, there is one
        if (probe.w > 0.0) {
            bool hidden = pick.y >= 0.0 && probe.y > pick.y * 1.001;
            float d = probe.x;
            vec3 tint = d < 0.0 ? vec3(0.93, 0.62, 0.33) : vec3(0.42, 0.62, 0.88);
            float turn = d / isolines;
            float width = change(at) / isolines;
            float line = 1.0 - smoothstep(0.6 * width, 1.6 * width, abs(fract(turn + 0.5) - 0.5));
            line *= clamp(0.35 / width, 0.0, 1.0);
            float surface = 1.0 - smoothstep(1.0 * width, 2.5 * width, abs(turn));
            tint *= 0.75 + 0.25 * exp(-abs(turn) * 0.25);
            tint = mix(tint, vec3(0.1), 0.75 * line);
            tint = mix(tint, vec3(1.0), surface);
            picture = mix(picture, tint, hidden ? 0.5 : 0.88);
        }
    }
    if ((look == 1 || look == 2) && pick.w < 0.0) picture = vec3(1.0, 0.0, 1.0); // undecided
    if (look == 4) {
        float verdict = texelFetch(probes, at, 0).x;
        picture = verdict == 1.0 ? vec3(1.0, 0.1, 0.1) : verdict == 2.0 ? vec3(1.0, 0.85, 0.1)
                : verdict == 3.0 ? vec3(0.9, 0.2, 0.9) : gray;
    }
    color = vec4(picture, 1.0);
}
)";

constexpr const char *finish_head = R"(#version 330 core
uniform sampler2D picture;
uniform sampler2D picks;
uniform bool fxaa;
uniform int outlined;
uniform int hovered;
uniform int thickness;
out vec4 color;
)";

constexpr const char *finish_main = R"(
// Whether a part ends within `thickness` pixels of here.
bool borders(ivec2 at, int part, int thickness) {
    if (part == 0) return false;
    ivec2 most = textureSize(picks, 0) - 1;
    bool inside = int(texelFetch(picks, at, 0).x) == part;
    for (int y = -thickness; y <= thickness; ++y)
        for (int x = -thickness; x <= thickness; ++x)
            if ((int(texelFetch(picks, clamp(at + ivec2(x, y), ivec2(0), most), 0).x) == part) != inside) return true;
    return false;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    color = vec4(fxaa ? smoothed(picture, at) : texelFetch(picture, at, 0).rgb, 1.0);
    if (borders(at, hovered, 1)) color.rgb = mix(color.rgb, vec3(1.0), 0.6);
    if (borders(at, outlined, thickness)) color.rgb = vec3(1.0, 0.6, 0.1);
}
)";

GLuint compiled(GLenum kind, const char *text) {
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    return shader;
}

// Our own fixed texts: that they build is for the tests to see.
GLuint linked(const std::string &fragment) {
    const GLuint shaders[] = {compiled(GL_VERTEX_SHADER, covering_triangle),
                              compiled(GL_FRAGMENT_SHADER, fragment.c_str())};
    const GLuint program = glCreateProgram();
    for (GLuint shader : shaders) glAttachShader(program, shader);
    glLinkProgram(program);
    for (GLuint shader : shaders) glDeleteShader(shader);
    [[maybe_unused]] GLint good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    assert(good);
    return program;
}

void bind(GLenum unit, GLuint texture) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, texture);
}

} // namespace

Post::~Post() {
    if (resolve_) glDeleteProgram(resolve_);
    if (finish_) glDeleteProgram(finish_);
    if (framebuffer_) glDeleteFramebuffers(1, &framebuffer_);
    if (texture_) glDeleteTextures(1, &texture_);
}

bool Post::prepare(int width, int height) {
    if (!resolve_)
        resolve_ = linked("#version 330 core\n" + glsl::expand("encode", {}) + resolve_text);
    if (!finish_) finish_ = linked(std::string(finish_head) + fxaa_text + finish_main);
    if (size_ == std::array{width, height}) return true;
    if (!texture_) glGenTextures(1, &texture_);
    if (!framebuffer_) glGenFramebuffers(1, &framebuffer_);
    bind(0, texture_);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
    size_ = {width, height};
    return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

bool Post::run(const PostSettings &settings, unsigned sum, int samples, unsigned picks,
               unsigned probe, unsigned out, int width, int height) {
    if (!prepare(width, height)) return false;
    glViewport(0, 0, width, height);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_DEPTH_TEST);
    const auto place = [](GLuint program, const char *name) {
        return glGetUniformLocation(program, name);
    };

    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glUseProgram(resolve_);
    bind(0, sum);
    bind(1, picks);
    bind(2, probe ? probe : picks);
    glUniform1i(place(resolve_, "sums"), 0);
    glUniform1i(place(resolve_, "picks"), 1);
    glUniform1i(place(resolve_, "probes"), 2);
    const bool probed = settings.look == Look::Slice || settings.look == Look::Check;
    glUniform1i(place(resolve_, "look"), probed && !probe ? 0 : static_cast<GLint>(settings.look));
    glUniform1f(place(resolve_, "share"), 1.0f / static_cast<float>(samples));
    glUniform1f(place(resolve_, "max_steps"), static_cast<float>(settings.max_steps));
    glUniform1f(place(resolve_, "isolines"), static_cast<float>(settings.isolines));
    draw_triangle();

    glBindFramebuffer(GL_FRAMEBUFFER, out);
    glUseProgram(finish_);
    bind(0, texture_);
    glUniform1i(place(finish_, "picture"), 0);
    glUniform1i(place(finish_, "picks"), 1);
    glUniform1i(place(finish_, "fxaa"),
                settings.fxaa && samples == 1 && settings.look == Look::Picture ? 1 : 0);
    glUniform1i(place(finish_, "outlined"), settings.outlined);
    glUniform1i(place(finish_, "hovered"), settings.hovered);
    glUniform1i(place(finish_, "thickness"), settings.thickness);
    draw_triangle();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return true;
}

} // namespace fathom::gl
