// What a host does by hand that leaves nothing to the library but the shader: a window, a program with its uniforms and
// data by reflection, keys and the mouse. (fathom::GlShader does the GL of it: window.cpp.)
#pragma once

#include <fathom/files.h>
#include <fathom/shader.h>

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>
#include <algorithm>
#include <cmath>

[[noreturn]] inline void fail(const std::string &why) {
    std::fputs((why + "\n").c_str(), stderr);
    std::exit(1);
}

// What there is to say of a scene and its shader goes to standard error.
inline std::pair<fathom::Scene, fathom::Shader> compile(const char *file,
                                                        const fathom::ShaderOptions &options) {
    const fathom::CompileResult result = fathom::compile_file(file);
    std::vector<fathom::Diagnostic> said = result.diagnostics, more;
    const auto shader = result ? fathom::make_shader(*result.scene, options, &more) : std::nullopt;
    said.insert(said.end(), more.begin(), more.end());
    for (const auto &d : said) std::fputs(fathom::printed(d, result.texts).c_str(), stderr);
    if (!shader) fail("nothing to show");
    return {*result.scene, *shader};
}

// A window with a core context of a version, which is current then.
inline GLFWwindow *open_window(const char *title, int major, int minor, bool visible) {
    if (!glfwInit()) fail("there is no display");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, major);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, minor);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_VISIBLE, visible);
    GLFWwindow *window = glfwCreateWindow(640, 360, title, nullptr, nullptr);
    if (!window) fail("there is no context of this version");
    glfwMakeContextCurrent(window);
    glfwSetInputMode(window, GLFW_STICKY_KEYS, GLFW_TRUE); // for keys pressed between two frames
    GLuint vertices = 0; // none: the triangle's corners are their numbers
    glGenVertexArrays(1, &vertices);
    glBindVertexArray(vertices);
    return window;
}

// A triangle over the picture, and the text behind it; both are of the version in the text's first line. Then in use.
inline GLuint program_of(const std::string &text) {
    const std::string corners = text.substr(0, text.find('\n')) +
                                "\nvoid main() { gl_Position = vec4(gl_VertexID == 1 ? 3 "
                                ": -1, gl_VertexID == 2 ? 3 : -1, 0, 1); }";
    const GLuint program = glCreateProgram();
    for (const GLenum kind : {GL_VERTEX_SHADER, GL_FRAGMENT_SHADER}) {
        const GLuint shader = glCreateShader(kind);
        const char *bytes = kind == GL_VERTEX_SHADER ? corners.c_str() : text.c_str();
        glShaderSource(shader, 1, &bytes, nullptr);
        glCompileShader(shader);
        char log[4096] = "";
        glGetShaderInfoLog(shader, sizeof log, nullptr, log);
        std::fputs(log, stderr);
        glAttachShader(program, shader);
    }
    glLinkProgram(program);
    GLint good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (!good) fail("the program does not link");
    glUseProgram(program);
    return program;
}

// Uniforms of the program in use; GL passes over those that it does not read.
inline void set(GLuint program, const std::vector<fathom::ShaderInput> &inputs) {
    for (const auto &[type, name, value, meaning, param, place] : inputs) {
        const GLint at = glGetUniformLocation(program, name.c_str());
        const std::vector<float> v(value.begin(), value.end()); // empty of a sampler
        if (v.empty()) continue;
        if (type == "int" || type == "bool") glUniform1i(at, static_cast<int>(std::lround(v[0])));
        if (type == "float") glUniform1fv(at, 1, v.data());
        if (type == "vec2") glUniform2fv(at, 1, v.data());
        if (type == "vec3") glUniform3fv(at, 1, v.data());
        if (type == "vec4") glUniform4fv(at, 1, v.data());
    }
}

// A buffer that shaders read as a texture, bound to the active unit; and that texture.
inline std::pair<GLuint, GLuint> buffer_texture(GLenum format, std::size_t bytes,
                                                const void *data) {
    GLuint buffer = 0, texture = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_TEXTURE_BUFFER, buffer);
    glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(bytes), data, GL_DYNAMIC_COPY);
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_BUFFER, texture);
    glTexBuffer(GL_TEXTURE_BUFFER, format, buffer);
    return {buffer, texture};
}

// Images, grids and the buffer of tables, each on a unit; the units as uniforms.
inline std::vector<fathom::ShaderInput> bind_data(const fathom::Shader &shader) {
    std::vector<fathom::ShaderInput> units;
    const auto next = [&](const std::string &name) {
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(units.size()));
        units.push_back({"int", name, {static_cast<double>(units.size())}, "", ""});
    };
    for (const auto &[name, grid, width, height, depth, values] : shader.textures) {
        next(name);
        const GLenum kind = grid ? GL_TEXTURE_3D : GL_TEXTURE_2D;
        const GLint wrap = grid ? GL_CLAMP_TO_EDGE : GL_REPEAT;
        GLuint texture = 0;
        glGenTextures(1, &texture);
        glBindTexture(kind, texture);
        if (grid)
            glTexImage3D(kind, 0, GL_R32F, width, height, depth, 0, GL_RED, GL_FLOAT,
                         values.data());
        else
            glTexImage2D(kind, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, values.data());
        glTexParameteri(kind, GL_TEXTURE_MIN_FILTER, GL_LINEAR); // without smaller copies
        for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
            glTexParameteri(kind, axis, wrap);
    }
    if (!shader.tables.empty()) {
        next("fathom_tables");
        buffer_texture(GL_RGBA32F, shader.tables.size() * sizeof(float), shader.tables.data());
    }
    return units;
}

// What the keys and the mouse change: the view by a drag, up and down, and params, of which a digit chooses one and left
// and right move it.
struct Controls {
    fathom::Scene scene;
    std::vector<fathom::ShaderInput> params{}; // with their present values
    std::size_t chosen = 0;
    double x = 0, y = 0, around = 0, above = 0, distance = 1;
};

inline Controls controls_of(const fathom::Scene &scene, const fathom::Shader &shader) {
    Controls controls{scene};
    for (const fathom::ShaderInput &input : shader.inputs)
        if (!input.param.empty()) controls.params.push_back(input);
    return controls;
}

// To be called once a frame. Whether a param moved.
inline bool poll(GLFWwindow *window, Controls &c) {
    glfwPollEvents();
    const auto down = [&](int key) { return glfwGetKey(window, key) == GLFW_PRESS ? 1 : 0; };
    const double x = c.x, y = c.y;
    glfwGetCursorPos(window, &c.x, &c.y);
    if (glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS) {
        c.around -= 0.008 * (c.x - x);
        c.above += 0.008 * (c.y - y);
    }
    c.distance *= std::exp(0.02 * (down(GLFW_KEY_DOWN) - down(GLFW_KEY_UP)));
    for (std::size_t i = 0; i < std::min<std::size_t>(c.params.size(), 9); ++i)
        if (down(GLFW_KEY_1 + static_cast<int>(i))) c.chosen = i;
    const int way = down(GLFW_KEY_RIGHT) - down(GLFW_KEY_LEFT);
    if (way == 0 || c.params.empty()) return false;
    fathom::ShaderInput &input = c.params[c.chosen];
    for (const fathom::Param &param : c.scene.params())
        for (std::size_t i = 0; param.name == input.param && i < input.value.size(); ++i) {
            const double step = param.ranged ? (param.hi[i] - param.lo[i]) / 200 : 0.01;
            input.value[i] = std::clamp(input.value[i] + way * step, param.lo[i], param.hi[i]);
        }
    glfwSetWindowTitle(window, (input.param + " = " + std::to_string(input.value[0])).c_str());
    return true;
}

// What the window shows, as a PPM file.
inline void write_frame(GLFWwindow *window, const char *file) {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    const auto row = 3 * static_cast<std::size_t>(width);
    std::string rgb(row * static_cast<std::size_t>(height), '\0');
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, rgb.data());
    std::string bytes = "P6 " + std::to_string(width) + " " + std::to_string(height) + " 255\n";
    for (std::size_t at = rgb.size(); at > 0; at -= row) bytes.append(rgb, at - row, row);
    if (const std::string why = fathom::write_file(file, bytes); !why.empty()) fail(why);
}
