#include "render-gl/program.h"

#include "base/text.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace fathom::gl {

namespace {

// One triangle that covers the picture, without any vertex data.
constexpr const char *vertex_text = R"(#version 330 core
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

std::string nth_line(const std::string &text, int n) {
    std::size_t begin = 0;
    for (int i = 1; i < n; ++i) {
        begin = text.find('\n', begin);
        if (begin == std::string::npos) return "";
        ++begin;
    }
    return text.substr(begin, text.find('\n', begin) - begin);
}

// Drivers write "0:12(5): error: …" (Mesa), "0(12) : error …" (NVIDIA) or "ERROR: 0:12: …"
// (others): the line is the first number that follows "0:" or "0(".
ProgramError read_log(const std::string &log, const std::string &text) {
    ProgramError error;
    error.message = log.substr(0, log.find('\n'));
    for (std::size_t at = 0; at + 1 < log.size(); ++at) {
        const bool starts = at == 0 || !(log[at - 1] >= '0' && log[at - 1] <= '9');
        if (!starts || log[at] != '0' || (log[at + 1] != ':' && log[at + 1] != '(')) continue;
        std::size_t end = at + 2;
        while (end < log.size() && log[end] >= '0' && log[end] <= '9') ++end;
        if (const auto line = parse_number(log.substr(at + 2, end - at - 2))) {
            error.line = static_cast<int>(*line);
            error.source_line = nth_line(text, error.line);
            break;
        }
    }
    if (error.message.empty()) error.message = "the driver refuses the shader without saying why";
    return error;
}

struct Shader {
    GLuint name;
    explicit Shader(GLenum kind) : name(glCreateShader(kind)) {}
    ~Shader() { glDeleteShader(name); }
    Shader(const Shader &) = delete;
    Shader &operator=(const Shader &) = delete;
};

std::optional<ProgramError> compile(GLuint shader, const std::string &text) {
    const char *data = text.c_str();
    const auto size = static_cast<GLint>(text.size());
    glShaderSource(shader, 1, &data, &size);
    glCompileShader(shader);
    GLint good = 0, length = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good) return std::nullopt;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    glGetShaderInfoLog(shader, length, nullptr, log.data());
    return read_log(log, text);
}

void unfiltered(GLenum target) {
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, 0);
}

} // namespace

std::variant<Program, ProgramError> Program::build(const glsl::Output &output,
                                                   const ir::Scene &scene) {
    Program result;
    result.uniforms_ = output.uniforms;
    Shader vertex(GL_VERTEX_SHADER), fragment(GL_FRAGMENT_SHADER);
    if (auto error = compile(vertex.name, vertex_text)) return *error;
    if (auto error = compile(fragment.name, output.text)) return *error;
    result.program_ = glCreateProgram();
    glAttachShader(result.program_, vertex.name);
    glAttachShader(result.program_, fragment.name);
    glLinkProgram(result.program_);
    glDetachShader(result.program_, vertex.name);
    glDetachShader(result.program_, fragment.name);
    GLint good = 0;
    glGetProgramiv(result.program_, GL_LINK_STATUS, &good);
    if (!good) {
        GLint length = 0;
        glGetProgramiv(result.program_, GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
        glGetProgramInfoLog(result.program_, length, nullptr, log.data());
        return read_log(log, output.text);
    }
    glUseProgram(result.program_);

    if (!output.tables.empty()) {
        glGenBuffers(1, &result.table_buffer_);
        glBindBuffer(GL_TEXTURE_BUFFER, result.table_buffer_);
        glBufferData(GL_TEXTURE_BUFFER,
                     static_cast<GLsizeiptr>(output.tables.size() * sizeof(float)),
                     output.tables.data(), GL_DYNAMIC_DRAW);
        glGenTextures(1, &result.table_texture_);
        glBindTexture(GL_TEXTURE_BUFFER, result.table_texture_);
        glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, result.table_buffer_);
        glUniform1i(result.location("fathom_tables"), 0);
    }
    GLint unit = 1;
    for (const glsl::Sampler &sampler : output.images) {
        const ir::ImageData &image = scene.images[sampler.index];
        GLuint texture = 0;
        glGenTextures(1, &texture);
        glBindTexture(GL_TEXTURE_2D, texture);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, image.width, image.height, 0, GL_RGBA, GL_FLOAT,
                     image.rgba.data());
        unfiltered(GL_TEXTURE_2D);
        result.textures_.emplace_back(GL_TEXTURE_2D, texture);
        glUniform1i(result.location(sampler.name.c_str()), unit++);
    }
    for (const glsl::Sampler &sampler : output.grids) {
        const ir::GridData &grid = scene.grids[sampler.index];
        GLuint texture = 0;
        glGenTextures(1, &texture);
        glBindTexture(GL_TEXTURE_3D, texture);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
        glTexImage3D(GL_TEXTURE_3D, 0, GL_R32F, grid.size[0], grid.size[1], grid.size[2], 0, GL_RED,
                     GL_FLOAT, grid.values.data());
        unfiltered(GL_TEXTURE_3D);
        result.textures_.emplace_back(GL_TEXTURE_3D, texture);
        glUniform1i(result.location(sampler.name.c_str()), unit++);
    }
    return result;
}

int Program::location(const char *name) const { return glGetUniformLocation(program_, name); }

void Program::draw(const FrameInputs &in, const std::vector<ir::Param> &params) const {
    glUseProgram(program_);
    const auto vector = [&](const char *name, const ir::Triple &v) {
        glUniform3f(location(name), static_cast<float>(v[0]), static_cast<float>(v[1]),
                    static_cast<float>(v[2]));
    };
    glUniform2f(location("fathom_resolution"), static_cast<float>(in.width),
                static_cast<float>(in.height));
    glUniform2f(location("fathom_offset"), static_cast<float>(in.offset[0]),
                static_cast<float>(in.offset[1]));
    vector("fathom_origin", in.view.origin);
    vector("fathom_right", in.view.right);
    vector("fathom_up", in.view.up);
    vector("fathom_forward", in.view.forward);
    vector("fathom_sun", in.sun);
    glUniform1f(location("fathom_extent"), static_cast<float>(in.view.extent));
    glUniform1f(location("fathom_focus"), static_cast<float>(in.view.focus));
    glUniform1i(location("fathom_orthographic"), in.view.orthographic ? 1 : 0);
    glUniform1i(location("fathom_mode"), static_cast<GLint>(in.mode));
    glUniform1f(location("fathom_time"), static_cast<float>(in.time));
    glUniform4f(location("fathom_plane"), static_cast<float>(in.plane[0]),
                static_cast<float>(in.plane[1]), static_cast<float>(in.plane[2]),
                static_cast<float>(in.plane[3]));
    if (!edited_.empty())
        glUniform1fv(location("fathom_edited"), static_cast<GLsizei>(edited_.size()),
                     edited_.data());

    for (const glsl::Uniform &uniform : uniforms_) {
        const std::array<double, 4> &v = params[uniform.param].value;
        const std::array<float, 4> f{static_cast<float>(v[0]), static_cast<float>(v[1]),
                                     static_cast<float>(v[2]), static_cast<float>(v[3])};
        const int at = location(uniform.name.c_str());
        switch (uniform.type) {
        case ir::Type::Bool:
        case ir::Type::Int: glUniform1i(at, static_cast<GLint>(v[0])); break;
        case ir::Type::Float: glUniform1fv(at, 1, f.data()); break;
        case ir::Type::Vec2: glUniform2fv(at, 1, f.data()); break;
        case ir::Type::Vec3: glUniform3fv(at, 1, f.data()); break;
        case ir::Type::Vec4: glUniform4fv(at, 1, f.data()); break;
        case ir::Type::Mat2:
        case ir::Type::Mat3:
        case ir::Type::Mat4:
        case ir::Type::Hit: break; // no such params
        }
    }
    if (table_texture_) {
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_BUFFER, table_texture_);
    }
    for (std::size_t i = 0; i < textures_.size(); ++i) {
        glActiveTexture(GL_TEXTURE1 + static_cast<GLenum>(i));
        glBindTexture(textures_[i].first, textures_[i].second);
    }
    draw_triangle();
}

void Program::use() const { glUseProgram(program_); }

void draw_triangle() {
    GLuint array = 0;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    glDeleteVertexArrays(1, &array);
}

void Program::warm_up(const std::vector<ir::Param> &params) const {
    constexpr int side = 8;
    GLint before = 0, viewport[4];
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &before);
    glGetIntegerv(GL_VIEWPORT, viewport);
    GLuint framebuffer = 0, textures[2] = {0, 0};
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glGenTextures(2, textures);
    glActiveTexture(GL_TEXTURE0);
    for (GLuint i = 0; i < 2; ++i) {
        glBindTexture(GL_TEXTURE_2D, textures[i]);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, side, side, 0, GL_RGBA, GL_FLOAT, nullptr);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + i, GL_TEXTURE_2D, textures[i],
                               0);
    }
    const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glDrawBuffers(2, both);
    glViewport(0, 0, side, side);
    FrameInputs inputs;
    inputs.width = inputs.height = side;
    inputs.mode = Mode::Linear;
    draw(inputs, params);
    glFinish();
    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(before));
    glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteTextures(2, textures);
}

void Program::upload_tables(const std::vector<float> &texels) const {
    if (!table_buffer_) return;
    glBindBuffer(GL_TEXTURE_BUFFER, table_buffer_);
    glBufferSubData(GL_TEXTURE_BUFFER, 0, static_cast<GLsizeiptr>(texels.size() * sizeof(float)),
                    texels.data());
}

void Program::adopt(const glsl::Output &output) {
    uniforms_ = output.uniforms;
    upload_tables(output.tables);
}

void Program::release() {
    for (const auto &[target, name] : textures_) glDeleteTextures(1, &name);
    if (table_texture_) glDeleteTextures(1, &table_texture_);
    if (table_buffer_) glDeleteBuffers(1, &table_buffer_);
    if (program_) glDeleteProgram(program_);
    textures_.clear();
    program_ = table_buffer_ = table_texture_ = 0;
}

Program::Program(Program &&other) noexcept { *this = std::move(other); }

Program &Program::operator=(Program &&other) noexcept {
    std::swap(program_, other.program_);
    std::swap(table_buffer_, other.table_buffer_);
    std::swap(table_texture_, other.table_texture_);
    std::swap(textures_, other.textures_);
    std::swap(uniforms_, other.uniforms_);
    std::swap(edited_, other.edited_);
    return *this;
}

Program::~Program() { release(); }

} // namespace fathom::gl
