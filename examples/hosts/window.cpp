// A window on a scene, by the library, GLFW and GL: window SCENE.sdf [TARGET] [PICTURE.ppm]
// TARGET: glsl330, glsl450, whose large tables are a buffer, or es300. With PICTURE.ppm one frame is written there and
// nothing is shown. Drag to turn, up and down to go nearer and farther; a digit chooses a param, left and right move it.
#include "host.h"

int main(int count, char **arguments) {
    if (count < 2 || count > 4) fail("usage: window SCENE.sdf [TARGET] [PICTURE.ppm]");
    const bool still = count == 4;
    fathom::ShaderOptions options;
    options.target = count > 2 ? arguments[2] : "glsl330";
    options.buffers = options.target == "glsl450";
    const auto [scene, shader] = compile(arguments[1], options);

    // Desktop GL takes es300 from 4.3 on.
    const bool newer = options.target != "glsl330";
    GLFWwindow *window = open_window(arguments[1], newer ? 4 : 3, newer ? 5 : 3, !still);
    const GLuint program = program_of(shader.text);
    set(program, shader.inputs); // texts of es300 give uniforms no values
    set(program, bind_data(shader));

    Controls controls = controls_of(scene, shader);
    const double end = scene.facts().time_end;
    while (!glfwWindowShouldClose(window)) {
        poll(window, controls);
        int width = 0, height = 0;
        glfwGetFramebufferSize(window, &width, &height);
        glViewport(0, 0, width, height);
        const double now = still || end <= 0 ? 0 : std::fmod(glfwGetTime(), end);
        set(program, {{"float", "fathom_time", {now}},
                      {"vec2", "fathom_resolution", {1.0 * width, 1.0 * height}}});
        set(program, controls.params);
        set(program, turned_camera(shader, controls.around, controls.above, controls.distance));
        glDrawArrays(GL_TRIANGLES, 0, 3);
        if (still) {
            write_frame(window, arguments[3]);
            break;
        }
        glfwSwapBuffers(window);
    }
    glfwTerminate();
    return 0;
}
