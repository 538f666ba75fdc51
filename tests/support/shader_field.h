// A scene's field by the shader that is emitted for it, at points of the caller's: the same program
// for all values of params and all moments. Needs a GL context (gl_context.h).
#pragma once

#include "tests/unit/render_gl/harness.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace fathom::test {

class ShaderField {
  public:
    explicit ShaderField(const ir::Scene &scene) {
        require_context();
        Diagnostics diagnostics;
        output_ = glsl::emit(scene,
                             {.target = glsl::Target::Glsl330, .field_only = true, .buffers = true},
                             diagnostics);
        for (const Diagnostic &one : diagnostics.items()) UNSCOPED_INFO(one.message);
        REQUIRE_FALSE(diagnostics.has_errors());
        link_field(harness_, output_,
                   "\nuniform sampler2D points_of_test;\nout vec4 value;\nvoid main() {\n    value "
                   "= vec4(sdf(texelFetch(points_of_test, ivec2(gl_FragCoord.xy), 0).xyz));\n}\n");
        glUseProgram(harness_.program);
        bind_data(harness_, output_, &scene);
        glGenTextures(1, &points_);
        harness_.samplers.push_back(points_);
    }

    // With the params as they stand in the scene.
    std::vector<float> values(const ir::Scene &scene, double time,
                              const std::vector<std::array<double, 3>> &points) {
        constexpr int across = 1024;
        const int rows = int((points.size() + across - 1) / across);
        std::vector<float> numbers(std::size_t(rows) * across * 4);
        for (std::size_t i = 0; i < points.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k) numbers[4 * i + k] = float(points[i][k]);
        const auto unit = GLint(harness_.samplers.size());
        aim(harness_, across, rows);
        glActiveTexture(GL_TEXTURE0 + GLenum(unit));
        glBindTexture(GL_TEXTURE_2D, points_);
        for (GLenum side : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
            glTexParameteri(GL_TEXTURE_2D, side, GL_NEAREST);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, across, rows, 0, GL_RGBA, GL_FLOAT,
                     numbers.data());
        glUniform1i(place("points_of_test"), unit);
        if (output_.reads_time) glUniform1f(place("fathom_time"), float(time));
        for (const glsl::Uniform &uniform : output_.uniforms) set(uniform, scene);
        std::vector<float> out = drawn(across, rows);
        out.resize(points.size());
        return out;
    }

  private:
    GLint place(const std::string &name) const {
        return glGetUniformLocation(harness_.program, name.c_str());
    }

    void set(const glsl::Uniform &uniform, const ir::Scene &scene) const {
        const auto &value = scene.params[uniform.param].value;
        const GLint at = place(uniform.name);
        std::array<float, 4> x{};
        std::ranges::transform(value, x.begin(), [](double number) { return float(number); });
        switch (ir::components(uniform.type)) {
        case 1:
            if (uniform.type == ir::Type::Float)
                glUniform1f(at, x[0]);
            else
                glUniform1i(at, GLint(value[0]));
            break;
        case 2: glUniform2fv(at, 1, x.data()); break;
        case 3: glUniform3fv(at, 1, x.data()); break;
        default: glUniform4fv(at, 1, x.data()); break;
        }
    }

    Harness harness_;
    glsl::Output output_;
    GLuint points_ = 0;
};

} // namespace fathom::test
