// Runs an emitted field in a shader at chosen points and reads the values back as they are.
#pragma once

#include "backend-glsl/emit.h"
#include "tests/support/gl_context.h"

#include <catch2/catch.hpp>
#include <epoxy/gl.h>

#include <vector>

namespace fathom {

struct Harness {
    GLuint program = 0, framebuffer = 0, texture = 0, vertex_array = 0, buffer = 0,
           buffer_texture = 0;
    std::vector<GLuint> samplers;
    ~Harness() {
        glDeleteProgram(program);
        glDeleteFramebuffers(1, &framebuffer);
        glDeleteTextures(1, &texture);
        glDeleteTextures(1, &buffer_texture);
        glDeleteTextures(static_cast<GLsizei>(samplers.size()), samplers.data());
        glDeleteBuffers(1, &buffer);
        glDeleteVertexArrays(1, &vertex_array);
    }
};

// Compiles and links the field's text with this `main` behind it.
inline void link_field(Harness &h, const glsl::Output &output, const std::string &main) {
    const std::string fragment = output.text + main;
    const char *vertex = "#version 330 core\nvoid main() { gl_Position = vec4(gl_VertexID == 1 ? "
                         "3.0 : -1.0, gl_VertexID == "
                         "2 ? 3.0 : -1.0, 0.0, 1.0); }\n";
    h.program = glCreateProgram();
    for (const auto &[kind, text] :
         {std::pair{GL_VERTEX_SHADER, vertex}, std::pair{GL_FRAGMENT_SHADER, fragment.c_str()}}) {
        const GLuint shader = glCreateShader(static_cast<GLenum>(kind));
        glShaderSource(shader, 1, &text, nullptr);
        glCompileShader(shader);
        glAttachShader(h.program, shader);
        glDeleteShader(shader);
    }
    glLinkProgram(h.program);
    GLint good = 0;
    glGetProgramiv(h.program, GL_LINK_STATUS, &good);
    if (!good) {
        char log[2000] = "";
        glGetProgramInfoLog(h.program, sizeof log, nullptr, log);
        FAIL(log << "\n" << fragment);
    }
}

// What is drawn goes to `width` times `height` values. The program is in use from here on.
inline void aim(Harness &h, int width, int height) {
    glDeleteFramebuffers(1, &h.framebuffer); // of an earlier drawing
    glDeleteTextures(1, &h.texture);
    glDeleteVertexArrays(1, &h.vertex_array);
    glActiveTexture(GL_TEXTURE0);
    glGenTextures(1, &h.texture);
    glBindTexture(GL_TEXTURE_2D, h.texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, nullptr);
    glGenFramebuffers(1, &h.framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, h.framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, h.texture, 0);
    glGenVertexArrays(1, &h.vertex_array);
    glBindVertexArray(h.vertex_array);
    glUseProgram(h.program);
}

// The tables, images and grids that the field reads, the latter of `scene`.
inline void bind_data(Harness &h, const glsl::Output &output, const ir::Scene *scene) {
    if (!output.tables.empty()) {
        glGenBuffers(1, &h.buffer);
        glBindBuffer(GL_TEXTURE_BUFFER, h.buffer);
        glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(output.tables.size() * 4),
                     output.tables.data(), GL_STATIC_DRAW);
        glGenTextures(1, &h.buffer_texture);
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_BUFFER, h.buffer_texture);
        glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, h.buffer);
        glUniform1i(glGetUniformLocation(h.program, "fathom_tables"), 0);
    }
    const auto bind = [&](GLenum kind, const glsl::Sampler &sampler) {
        GLuint texture = 0;
        glGenTextures(1, &texture);
        h.samplers.push_back(texture);
        const auto unit = static_cast<GLint>(h.samplers.size());
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
        glBindTexture(kind, texture);
        for (GLenum side : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
            glTexParameteri(kind, side, GL_NEAREST);
        glUniform1i(glGetUniformLocation(h.program, sampler.name.c_str()), unit);
    };
    for (const glsl::Sampler &sampler : output.images) {
        bind(GL_TEXTURE_2D, sampler);
        const ir::ImageData &image = scene->images.at(sampler.index);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, image.width, image.height, 0, GL_RGBA, GL_FLOAT,
                     image.rgba.data());
    }
    for (const glsl::Sampler &sampler : output.grids) {
        bind(GL_TEXTURE_3D, sampler);
        const ir::GridData &grid = scene->grids.at(sampler.index);
        glTexImage3D(GL_TEXTURE_3D, 0, GL_R32F, grid.size[0], grid.size[1], grid.size[2], 0, GL_RED,
                     GL_FLOAT, grid.values.data());
    }
}

inline std::vector<float> drawn(int width, int height) {
    glViewport(0, 0, width, height);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    std::vector<float> rgba(static_cast<std::size_t>(width * height * 4)), result;
    glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, rgba.data());
    for (std::size_t i = 0; i < rgba.size(); i += 4) result.push_back(rgba[i]);
    return result;
}

// `sdf(vec3(row, component, 0))` of an emitted field for rows 0 … count-1 and `components`
// components. Where the field reads images or grids, they are those of `scene`.
inline std::vector<float> run_shader(const glsl::Output &output, int count, int components,
                                     const ir::Scene *scene = nullptr) {
    Harness h;
    link_field(h, output,
               "\nout vec4 value;\nvoid main() {\n    value = "
               "vec4(sdf(vec3(gl_FragCoord.xy - 0.5, 0.0)));\n}\n");
    aim(h, count, components);
    bind_data(h, output, scene);
    return drawn(count, components);
}

} // namespace fathom
