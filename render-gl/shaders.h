// Texts to linked GL programs, params and tables to where these read them: what pictures' programs
// and compute programs share. Needs a current context.
#pragma once

#include "backend-glsl/emit.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fathom::gl {

// What the driver says against a shader, with the line of our text.
struct ProgramError {
    int line = 0; // 0: of no line
    std::string message, source_line;
};

// Links shaders of these kinds (GL_FRAGMENT_SHADER …) into a new program.
std::optional<ProgramError> link(unsigned &program,
                                 const std::vector<std::pair<unsigned, std::string>> &shaders);

// The vertex shader of every pass: one triangle that covers the picture, without any vertex data.
constexpr const char *covering_triangle = R"(#version 330 core
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

// Of the current program.
void set_params(unsigned program, const std::vector<glsl::Uniform> &uniforms,
                const std::vector<ir::Param> &params);

// The texture buffer `fathom_tables`.
class TableData {
  public:
    // RGBA32F texels; an error where there are more than this GL can have.
    std::optional<ProgramError> fill(const std::vector<float> &texels);
    void replace(const std::vector<float> &texels) const; // as many
    void bind() const;                                    // to unit 0

    TableData() = default;
    TableData(TableData &&other) noexcept;
    TableData &operator=(TableData &&other) noexcept;
    ~TableData();

  private:
    unsigned buffer_ = 0, texture_ = 0;
};

} // namespace fathom::gl
