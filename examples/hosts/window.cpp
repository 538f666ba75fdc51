// A window on a scene, by the library, GLFW and GL: window SCENE.sdf [TARGET [PICTURE.ppm]]
// TARGET: glsl330; es300; or glsl450, whose large tables are a buffer, and whose cached fields are read through the noise
// cache. Drag to turn, up and down to go nearer and farther; a digit chooses a param, left and right move it. With
// PICTURE.ppm nothing is shown: the frame is written there, after some that fill the cache.
#include <fathom/files.h>
#include <fathom/gl.h>

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>
#include <algorithm>
#include <cmath>

namespace {

[[noreturn]] void fail(const std::string &why) {
    std::fputs((why + "\n").c_str(), stderr);
    std::exit(1);
}

// What there is to say of a scene and its shader goes to standard error.
std::pair<fathom::Scene, fathom::Shader> compile(const char *file, const char *target) {
    fathom::ShaderOptions options;
    options.target = target;
    for (const fathom::ShaderTarget &known : fathom::shader_target_table())
        if (known.name == options.target) {
            options.buffers = known.buffers;
            options.noise_cache = known.noise_cache;
        }
    const fathom::CompileResult result = fathom::compile_file(file);
    std::vector<fathom::Diagnostic> said = result.diagnostics, more;
    const auto shader = result ? fathom::make_shader(*result.scene, options, &more) : std::nullopt;
    said.insert(said.end(), more.begin(), more.end());
    for (const auto &d : said) std::fputs(fathom::printed(d, result.texts).c_str(), stderr);
    if (!shader) fail("nothing to show");
    return {*result.scene, *shader};
}

// Drivers give a newer context than is asked for, where they have one: glsl450 and es300 want it.
GLFWwindow *open_window(const char *title, bool visible) {
    if (!glfwInit()) fail("there is no display");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_VISIBLE, visible);
    GLFWwindow *window = glfwCreateWindow(640, 360, title, nullptr, nullptr);
    if (!window) fail("there is no OpenGL 3.3");
    glfwMakeContextCurrent(window);
    glfwSetInputMode(window, GLFW_STICKY_KEYS, GLFW_TRUE); // for keys pressed between two frames
    return window;
}

// What the keys and the mouse change.
struct Controls {
    std::vector<fathom::ShaderInput> params; // with their present values
    std::size_t chosen = 0;
    double x = 0, y = 0, around = 0, above = 0, distance = 1;
    bool held = false; // the mouse's button
};

void turn(GLFWwindow *window, Controls &c) {
    const double x = c.x, y = c.y;
    glfwGetCursorPos(window, &c.x, &c.y);
    const bool held = c.held; // since the frame before
    c.held = glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS;
    if (held && c.held) {
        c.around -= 0.008 * (c.x - x);
        c.above += 0.008 * (c.y - y);
    }
    if (glfwGetKey(window, GLFW_KEY_UP) == GLFW_PRESS) c.distance /= 1.02;
    if (glfwGetKey(window, GLFW_KEY_DOWN) == GLFW_PRESS) c.distance *= 1.02;
}

// The chosen param goes by a two hundredth of its range.
void move_param(GLFWwindow *window, const fathom::Scene &scene, Controls &c) {
    for (std::size_t i = 0; i < std::min<std::size_t>(c.params.size(), 9); ++i)
        if (glfwGetKey(window, GLFW_KEY_1 + static_cast<int>(i)) == GLFW_PRESS) c.chosen = i;
    const int way = (glfwGetKey(window, GLFW_KEY_RIGHT) == GLFW_PRESS ? 1 : 0) -
                    (glfwGetKey(window, GLFW_KEY_LEFT) == GLFW_PRESS ? 1 : 0);
    if (way == 0 || c.params.empty()) return;
    fathom::ShaderInput &input = c.params[c.chosen];
    for (const fathom::Param &param : scene.params())
        for (std::size_t i = 0; param.name == input.param && i < input.value.size(); ++i) {
            const double step = param.ranged ? (param.hi[i] - param.lo[i]) / 200 : 0.01;
            input.value[i] = std::clamp(input.value[i] + way * step, param.lo[i], param.hi[i]);
        }
    glfwSetWindowTitle(window, (input.param + " = " + std::to_string(input.value[0])).c_str());
}

// What the window shows, as a PPM file.
void write_frame(int width, int height, const char *file) {
    const auto row = 3 * static_cast<std::size_t>(width);
    std::string rgb(row * static_cast<std::size_t>(height), '\0');
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, rgb.data());
    std::string bytes = "P6 " + std::to_string(width) + " " + std::to_string(height) + " 255\n";
    for (std::size_t at = rgb.size(); at > 0; at -= row) bytes.append(rgb, at - row, row);
    if (const std::string why = fathom::write_file(file, bytes); !why.empty()) fail(why);
}

} // namespace

int main(int count, char **arguments) {
    if (count < 2 || count > 4) fail("usage: window SCENE.sdf [TARGET [PICTURE.ppm]]");
    const char *picture = count > 3 ? arguments[3] : nullptr;
    const auto [scene, shader] = compile(arguments[1], count > 2 ? arguments[2] : "glsl330");
    GLFWwindow *window = open_window(arguments[1], !picture);
    {
        fathom::GlShader drawn;
        if (const std::string why = drawn.load(shader); !why.empty()) fail(why);
        Controls controls;
        for (const fathom::ShaderInput &input : shader.inputs)
            if (!input.param.empty()) controls.params.push_back(input);
        const double end = scene.facts().time_end;
        const int last = shader.cache.fill.empty() ? 1 : 8; // of the frames for a picture
        for (int frame = 1; !glfwWindowShouldClose(window); ++frame) {
            glfwPollEvents();
            turn(window, controls);
            move_param(window, scene, controls);
            const double now = picture || end <= 0 ? 0 : std::fmod(glfwGetTime(), end);
            drawn.set({{"float", "fathom_time", {now}}});
            drawn.set(controls.params);
            drawn.set(turned_camera(shader, controls.around, controls.above, controls.distance));
            int width = 0, height = 0;
            glfwGetFramebufferSize(window, &width, &height);
            if (width > 0 && !drawn.draw(width, height)) fail("this size cannot be drawn");
            if (picture && frame == last) {
                std::printf("%.0f %% by cached values\n", 100 * drawn.cached_share());
                write_frame(width, height, picture);
                break;
            }
            glfwSwapBuffers(window);
        }
    } // while the context is there
    glfwTerminate();
    return 0;
}
