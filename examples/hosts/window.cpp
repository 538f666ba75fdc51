// A window on a scene, by the library, GLFW and GL: window SCENE.sdf [TARGET] [PICTURE.ppm]
// TARGET: glsl330, glsl450, whose large tables are a buffer, or es300. With PICTURE.ppm one frame is written there and
// nothing is shown. Drag to turn, wheel to go nearer; up and down choose a param, left and right move it.
#include "host.h"

int main(int count, char **arguments) {
    if (count < 2 || count > 4) fail("usage: window SCENE.sdf [TARGET] [PICTURE.ppm]");
    const bool still = count == 4;
    fathom::ShaderOptions options;
    options.target = count > 2 ? arguments[2] : "glsl330";
    options.buffers = options.target == "glsl450";
    const auto [scene, shader] = compiled(arguments[1], options);

    // Desktop GL takes es300 from 4.3 on.
    const bool newer = options.target != "glsl330";
    GLFWwindow *window = open_window(arguments[1], newer ? 4 : 3, newer ? 5 : 3, !still);
    const GLuint program = program_of(shader.text);
    glUseProgram(program);
    bind(program, data_of(shader));
    // Texts of es300 give uniforms no values; the scene's own are here.
    for (const fathom::ShaderInput &input : shader.inputs)
        set(program, input.type, input.name, input.value);

    State state = first_state(scene, shader);
    listen(window, state);
    const double end = scene.facts().time_end;
    do {
        int width = 0, height = 0;
        glfwGetFramebufferSize(window, &width, &height);
        glViewport(0, 0, width, height);
        set(program, "vec2", "fathom_resolution",
            {static_cast<double>(width), static_cast<double>(height)});
        set_params(program, state);
        if (!still) {
            set_view(program, state.view);
            set(program, "float", "fathom_time", {end > 0 ? std::fmod(glfwGetTime(), end) : 0.0});
        }
        glDrawArrays(GL_TRIANGLES, 0, 3);
        if (still) {
            write_frame(window, arguments[3]);
            break;
        }
        glfwSwapBuffers(window);
        glfwPollEvents();
    } while (!glfwWindowShouldClose(window));
    glfwTerminate();
    return 0;
}
