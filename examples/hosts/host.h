// What the hosts of this folder share: programs, uniforms, data, the view, and what keys and the mouse change.
#pragma once

#include <fathom/shader.h>

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

[[noreturn]] inline void fail(const char *why) {
    std::fprintf(stderr, "%s\n", why);
    std::exit(1);
}

inline void attach(GLuint program, GLenum kind, const std::string &text) {
    const GLuint shader = glCreateShader(kind);
    const char *bytes = text.c_str();
    glShaderSource(shader, 1, &bytes, nullptr);
    glCompileShader(shader);
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    char log[4096] = "";
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    if (!good) fail(log);
    glAttachShader(program, shader);
}

// A triangle over the picture, and the text behind it. Both have the version that the text begins with.
inline GLuint program_of(const std::string &text) {
    const GLuint program = glCreateProgram();
    attach(program, GL_VERTEX_SHADER,
           text.substr(0, text.find('\n')) +
               "\nvoid main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 "
               ": -1, 0, 1); }");
    attach(program, GL_FRAGMENT_SHADER, text);
    glLinkProgram(program);
    GLint good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (!good) fail("the program does not link");
    return program;
}

// A uniform of the program in use. What the program does not read is passed over by GL.
inline void set(GLuint program, const std::string &type, const std::string &name,
                const std::vector<double> &value) {
    const GLint at = glGetUniformLocation(program, name.c_str());
    std::array<float, 4> v{};
    for (std::size_t i = 0; i < value.size() && i < 4; ++i) v[i] = static_cast<float>(value[i]);
    if (type == "int" || type == "bool") glUniform1i(at, static_cast<int>(v[0]));
    if (type == "float") glUniform1f(at, v[0]);
    if (type == "vec2") glUniform2fv(at, 1, v.data());
    if (type == "vec3") glUniform3fv(at, 1, v.data());
    if (type == "vec4") glUniform4fv(at, 1, v.data());
}

// A texture and the uniform that it goes by: a sampler or, with `format`, an image as well.
struct Bound {
    std::string name;
    GLenum kind;
    GLuint texture;
    GLenum format = GL_NONE;
};

// Gives the program in use those that it reads, each on a unit of its own.
inline void bind(GLuint program, const std::vector<Bound> &all) {
    GLuint unit = 0, image = 0;
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

// A buffer that shaders read as a texture.
inline GLuint buffer_texture(GLenum format, GLsizeiptr bytes, const void *data,
                             GLuint *buffer = nullptr) {
    std::array<GLuint, 2> made{};
    glGenBuffers(1, &made[0]);
    glBindBuffer(GL_TEXTURE_BUFFER, made[0]);
    glBufferData(GL_TEXTURE_BUFFER, bytes, data, GL_DYNAMIC_COPY);
    glGenTextures(1, &made[1]);
    glBindTexture(GL_TEXTURE_BUFFER, made[1]);
    glTexBuffer(GL_TEXTURE_BUFFER, format, made[0]);
    if (buffer) *buffer = made[0];
    return made[1];
}

// Images, grids and the buffer of tables.
inline std::vector<Bound> data_of(const fathom::Shader &shader) {
    std::vector<Bound> all;
    for (const fathom::Texture &texture : shader.textures) {
        const GLenum kind = texture.grid ? GL_TEXTURE_3D : GL_TEXTURE_2D;
        GLuint name = 0;
        glGenTextures(1, &name);
        glBindTexture(kind, name);
        if (texture.grid)
            glTexImage3D(kind, 0, GL_R32F, texture.width, texture.height, texture.depth, 0, GL_RED,
                         GL_FLOAT, texture.values.data());
        else
            glTexImage2D(kind, 0, GL_RGBA32F, texture.width, texture.height, 0, GL_RGBA, GL_FLOAT,
                         texture.values.data());
        for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
            glTexParameteri(kind, filter, GL_LINEAR);
        for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
            glTexParameteri(kind, wrap, texture.grid ? GL_CLAMP_TO_EDGE : GL_REPEAT);
        all.push_back({texture.name, kind, name});
    }
    if (!shader.tables.empty())
        all.push_back({"fathom_tables", GL_TEXTURE_BUFFER,
                       buffer_texture(GL_RGBA32F,
                                      static_cast<GLsizeiptr>(shader.tables.size() * sizeof(float)),
                                      shader.tables.data())});
    return all;
}

// The view: where it looks from, about what, and how the mouse has turned it.
struct View {
    std::vector<double> target;
    double around = 0, above = 0, focus = 1;
};

inline const std::vector<double> &value_of(const fathom::Shader &shader, const char *name) {
    for (const fathom::ShaderInput &input : shader.inputs)
        if (input.name == name) return input.value;
    fail("the shader lacks an input of every picture");
}

inline View first_view(const fathom::Shader &shader) {
    const auto &origin = value_of(shader, "fathom_origin"),
               &forward = value_of(shader, "fathom_forward");
    View view;
    view.focus = value_of(shader, "fathom_focus")[0];
    view.around = std::atan2(-forward[0], -forward[2]);
    view.above = std::asin(std::clamp(-forward[1], -1.0, 1.0));
    for (std::size_t i = 0; i < 3; ++i) view.target.push_back(origin[i] + view.focus * forward[i]);
    return view;
}

inline void set_view(GLuint program, const View &view) {
    const double ca = std::cos(view.around), sa = std::sin(view.around), cb = std::cos(view.above),
                 sb = std::sin(view.above);
    const std::vector<double> back{cb * sa, sb, cb * ca};
    std::vector<double> origin = view.target;
    for (std::size_t i = 0; i < 3; ++i) origin[i] += view.focus * back[i];
    set(program, "vec3", "fathom_origin", origin);
    set(program, "vec3", "fathom_right", {ca, 0, -sa});
    set(program, "vec3", "fathom_up", {-sb * sa, cb, -sb * ca});
    set(program, "vec3", "fathom_forward", {-back[0], -back[1], -back[2]});
    set(program, "float", "fathom_focus", {view.focus});
}

// What the window shows, as a PPM file.
inline void write_frame(GLFWwindow *window, const char *file) {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    std::vector<unsigned char> rgb(static_cast<std::size_t>(3 * width * height));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, rgb.data());
    std::FILE *out = std::fopen(file, "wb");
    if (!out) fail("the picture cannot be written");
    std::fprintf(out, "P6 %d %d 255\n", width, height);
    for (int y = height; y-- > 0;)
        std::fwrite(&rgb[static_cast<std::size_t>(3 * width * y)], 3,
                    static_cast<std::size_t>(width), out);
    std::fclose(out);
}

// What the keys and the mouse act on.
struct State {
    const fathom::Scene *scene = nullptr;
    std::vector<fathom::ShaderInput> params; // with their present values
    std::size_t chosen = 0;
    bool moved = false; // a param, since somebody looked
    View view;
    double x = 0, y = 0;
};

inline State first_state(const fathom::Scene &scene, const fathom::Shader &shader) {
    State state;
    state.scene = &scene;
    for (const fathom::ShaderInput &input : shader.inputs)
        if (!input.param.empty()) state.params.push_back(input);
    state.view = first_view(shader);
    return state;
}

inline void set_params(GLuint program, const State &state) {
    for (const fathom::ShaderInput &param : state.params)
        set(program, param.type, param.name, param.value);
}

inline State &state_of(GLFWwindow *window) {
    return *static_cast<State *>(glfwGetWindowUserPointer(window));
}

// Up and down choose a param, left and right move it.
inline void on_key(GLFWwindow *window, int key, int, int action, int) {
    State &s = state_of(window);
    if (action == GLFW_RELEASE || s.params.empty()) return;
    const std::size_t count = s.params.size();
    if (key == GLFW_KEY_DOWN) s.chosen = (s.chosen + 1) % count;
    if (key == GLFW_KEY_UP) s.chosen = (s.chosen + count - 1) % count;
    const int way = (key == GLFW_KEY_RIGHT) - (key == GLFW_KEY_LEFT);
    s.moved = s.moved || way != 0;
    fathom::ShaderInput &chosen = s.params[s.chosen];
    for (const fathom::Param &param : s.scene->params()) {
        if (param.name != chosen.param) continue;
        const bool whole =
            param.type == fathom::Param::Type::Int || param.type == fathom::Param::Type::Bool;
        for (std::size_t i = 0; i < chosen.value.size(); ++i) {
            double &value = chosen.value[i];
            const double step = whole ? 1 : param.ranged ? (param.hi[i] - param.lo[i]) / 50 : 0.05;
            value = std::clamp(value + way * step, param.lo[i], param.hi[i]);
            if (param.type == fathom::Param::Type::Bool) value = std::clamp(value, 0.0, 1.0);
        }
        glfwSetWindowTitle(window, (param.name + " = " + std::to_string(chosen.value[0])).c_str());
    }
}

// A drag turns the view.
inline void on_move(GLFWwindow *window, double x, double y) {
    State &s = state_of(window);
    if (glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS) {
        s.view.around -= 0.008 * (x - s.x);
        s.view.above = std::clamp(s.view.above + 0.008 * (y - s.y), -1.57, 1.57);
    }
    s.x = x, s.y = y;
}

// The wheel goes nearer.
inline void on_scroll(GLFWwindow *window, double, double by) {
    state_of(window).view.focus *= std::exp(-0.1 * by);
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
    glfwSwapInterval(1);
    GLuint vertices = 0; // none: the triangle's corners are their numbers
    glGenVertexArrays(1, &vertices);
    glBindVertexArray(vertices);
    return window;
}

inline void listen(GLFWwindow *window, State &state) {
    glfwSetWindowUserPointer(window, &state);
    glfwSetKeyCallback(window, on_key);
    glfwSetCursorPosCallback(window, on_move);
    glfwSetScrollCallback(window, on_scroll);
}

// A scene and its shader; what is to be said of them goes to standard error.
struct Compiled {
    fathom::Scene scene;
    fathom::Shader shader;
};

inline Compiled compiled(const char *file, const fathom::ShaderOptions &options) {
    fathom::CompileResult result = fathom::compile_file(file);
    std::optional<fathom::Shader> shader;
    if (result) shader = fathom::make_shader(*result.scene, options, &result.diagnostics);
    for (const fathom::Diagnostic &d : result.diagnostics)
        std::fputs(fathom::printed(d, result.texts).c_str(), stderr);
    if (!shader) std::exit(1);
    return {*result.scene, *shader};
}
