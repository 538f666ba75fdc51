// A window on a scene, by the library, GLFW and GL: window SCENE.sdf [TARGET] [PICTURE.ppm]
// TARGET: glsl330, or glsl450, whose large tables are a buffer. With PICTURE.ppm one frame is written there and nothing
// is shown. Drag to turn, wheel to go nearer; up and down choose a param, left and right move it.
#include <fathom/shader.h>

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace {

[[noreturn]] void fail(const char *why) {
    std::fprintf(stderr, "window: %s\n", why);
    std::exit(1);
}

GLuint part(GLuint program, GLenum kind, const std::string &text) {
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
    return shader;
}

GLuint program_of(const fathom::Shader &shader) {
    const GLuint program = glCreateProgram();
    part(program, GL_VERTEX_SHADER,
         "#version 330\nvoid main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == "
         "2 ? 3 : -1, 0, 1); }");
    part(program, GL_FRAGMENT_SHADER, shader.text);
    glLinkProgram(program);
    GLint good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (!good) fail("the program does not link");
    glUseProgram(program);
    return program;
}

void set(GLuint program, const std::string &type, const std::string &name,
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

// Images, grids and the buffer of tables, each on a unit of its own.
void bind_data(GLuint program, const fathom::Shader &shader) {
    int unit = 0;
    for (const fathom::Texture &texture : shader.textures) {
        const GLenum kind = texture.grid ? GL_TEXTURE_3D : GL_TEXTURE_2D;
        GLuint name = 0;
        glGenTextures(1, &name);
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
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
        glUniform1i(glGetUniformLocation(program, texture.name.c_str()), unit++);
    }
    if (shader.tables.empty()) return;
    GLuint buffer = 0, name = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_TEXTURE_BUFFER, buffer);
    glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(shader.tables.size() * sizeof(float)),
                 shader.tables.data(), GL_STATIC_DRAW);
    glGenTextures(1, &name);
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_BUFFER, name);
    glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, buffer);
    glUniform1i(glGetUniformLocation(program, "fathom_tables"), unit);
}

// The view: where it looks from, about what, and how the mouse has turned it.
struct View {
    std::vector<double> target;
    double around = 0, above = 0, focus = 1;
};

const std::vector<double> &value_of(const fathom::Shader &shader, const char *name) {
    for (const fathom::ShaderInput &input : shader.inputs)
        if (input.name == name) return input.value;
    fail("the shader lacks an input of every picture");
}

View first_view(const fathom::Shader &shader) {
    const auto &origin = value_of(shader, "fathom_origin"),
               &forward = value_of(shader, "fathom_forward");
    View view;
    view.focus = value_of(shader, "fathom_focus")[0];
    view.around = std::atan2(-forward[0], -forward[2]);
    view.above = std::asin(std::clamp(-forward[1], -1.0, 1.0));
    for (std::size_t i = 0; i < 3; ++i) view.target.push_back(origin[i] + view.focus * forward[i]);
    return view;
}

void set_view(GLuint program, const View &view) {
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

void write_frame(GLFWwindow *window, const char *file) {
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
    View view;
    double x = 0, y = 0;
};

State &state_of(GLFWwindow *window) {
    return *static_cast<State *>(glfwGetWindowUserPointer(window));
}

void on_key(GLFWwindow *window, int key, int, int action, int) {
    State &s = state_of(window);
    if (action == GLFW_RELEASE || s.params.empty()) return;
    const std::size_t count = s.params.size();
    if (key == GLFW_KEY_DOWN) s.chosen = (s.chosen + 1) % count;
    if (key == GLFW_KEY_UP) s.chosen = (s.chosen + count - 1) % count;
    const int way = (key == GLFW_KEY_RIGHT) - (key == GLFW_KEY_LEFT);
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

void on_move(GLFWwindow *window, double x, double y) {
    State &s = state_of(window);
    if (glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS) {
        s.view.around -= 0.008 * (x - s.x);
        s.view.above = std::clamp(s.view.above + 0.008 * (y - s.y), -1.57, 1.57);
    }
    s.x = x, s.y = y;
}

} // namespace

int main(int count, char **arguments) {
    if (count < 2 || count > 4) fail("usage: window SCENE.sdf [TARGET] [PICTURE.ppm]");
    const auto result = fathom::compile_file(arguments[1]);
    for (const fathom::Diagnostic &d : result.diagnostics)
        std::fprintf(stderr, "%s:%d: %s\n", d.at.file.c_str(), d.at.line, d.message.c_str());
    if (!result) return 1;
    fathom::ShaderOptions options;
    options.target = count > 2 ? arguments[2] : "glsl330";
    options.buffers = options.target == "glsl450";
    const auto shader = fathom::make_shader(*result.scene, options);
    if (!shader) fail("the scene cannot be said in this target");

    if (!glfwInit()) fail("there is no display");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, options.buffers ? 4 : 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, options.buffers ? 5 : 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_VISIBLE, count < 4);
    GLFWwindow *window = glfwCreateWindow(640, 360, arguments[1], nullptr, nullptr);
    if (!window) fail("there is no context for this target");
    glfwMakeContextCurrent(window);
    glfwSwapInterval(1);
    GLuint triangle = 0;
    glGenVertexArrays(1, &triangle);
    glBindVertexArray(triangle);
    const GLuint program = program_of(*shader);
    bind_data(program, *shader);
    for (const fathom::ShaderInput &input : shader->inputs)
        set(program, input.type, input.name, input.value);

    State state{&*result.scene, {}, 0, first_view(*shader), 0, 0};
    for (const fathom::ShaderInput &input : shader->inputs)
        if (!input.param.empty()) state.params.push_back(input);
    glfwSetWindowUserPointer(window, &state);
    glfwSetKeyCallback(window, on_key);
    glfwSetCursorPosCallback(window, on_move);
    glfwSetScrollCallback(window, [](GLFWwindow *w, double, double by) {
        state_of(w).view.focus *= std::exp(-0.1 * by);
    });
    const double end = result.scene->facts().time_end;
    do {
        int width = 0, height = 0;
        glfwGetFramebufferSize(window, &width, &height);
        glViewport(0, 0, width, height);
        set(program, "vec2", "fathom_resolution",
            {static_cast<double>(width), static_cast<double>(height)});
        if (count < 4) {
            set_view(program, state.view);
            set(program, "float", "fathom_time", {end > 0 ? std::fmod(glfwGetTime(), end) : 0.0});
        }
        for (const fathom::ShaderInput &param : state.params)
            set(program, param.type, param.name, param.value);
        glDrawArrays(GL_TRIANGLES, 0, 3);
        if (count == 4) {
            write_frame(window, arguments[3]);
            break;
        }
        glfwSwapBuffers(window);
        glfwPollEvents();
    } while (!glfwWindowShouldClose(window));
    glfwTerminate();
    return 0;
}
