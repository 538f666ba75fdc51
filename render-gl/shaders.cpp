#include "render-gl/shaders.h"

#include "base/text.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace fathom::gl {

namespace {

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

} // namespace

std::optional<ProgramError> link(unsigned &program,
                                 const std::vector<std::pair<unsigned, std::string>> &shaders) {
    program = glCreateProgram();
    for (const auto &[kind, text] : shaders) {
        const Shader shader(kind);
        if (auto error = compile(shader.name, text)) return error;
        glAttachShader(program, shader.name); // lives on with the program
    }
    glLinkProgram(program);
    GLint good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (good) return std::nullopt;
    GLint length = 0;
    glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    glGetProgramInfoLog(program, length, nullptr, log.data());
    return read_log(log, shaders.back().second);
}

void set_params(unsigned program, const std::vector<glsl::Uniform> &uniforms,
                const std::vector<ir::Param> &params) {
    for (const glsl::Uniform &uniform : uniforms) {
        const std::array<double, 4> &v = params[uniform.param].value;
        const std::array<float, 4> f{static_cast<float>(v[0]), static_cast<float>(v[1]),
                                     static_cast<float>(v[2]), static_cast<float>(v[3])};
        const int at = glGetUniformLocation(program, uniform.name.c_str());
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
}

std::optional<ProgramError> TableData::fill(const std::vector<float> &texels) {
    if (texels.empty()) return std::nullopt;
    GLint maximum = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &maximum);
    if (texels.size() / 4 > static_cast<std::size_t>(maximum))
        return ProgramError{0,
                            fmt::format("the scene's tables have {} entries, and this GL holds {}",
                                        texels.size() / 4, maximum),
                            ""};
    glGenBuffers(1, &buffer_);
    glBindBuffer(GL_TEXTURE_BUFFER, buffer_);
    glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(texels.size() * sizeof(float)),
                 texels.data(), GL_DYNAMIC_DRAW);
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_BUFFER, texture_);
    glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, buffer_);
    return std::nullopt;
}

void TableData::replace(const std::vector<float> &texels) const {
    if (!buffer_) return;
    glBindBuffer(GL_TEXTURE_BUFFER, buffer_);
    glBufferSubData(GL_TEXTURE_BUFFER, 0, static_cast<GLsizeiptr>(texels.size() * sizeof(float)),
                    texels.data());
}

void TableData::bind() const {
    if (!texture_) return;
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_BUFFER, texture_);
}

TableData::TableData(TableData &&other) noexcept { *this = std::move(other); }
TableData &TableData::operator=(TableData &&other) noexcept {
    std::swap(buffer_, other.buffer_);
    std::swap(texture_, other.texture_);
    return *this;
}
TableData::~TableData() {
    if (texture_) glDeleteTextures(1, &texture_);
    if (buffer_) glDeleteBuffers(1, &buffer_);
}

} // namespace fathom::gl
