// See subroutines.h.
#include "render-gl/subroutines.h"

#include <epoxy/gl.h>

#include <fmt/format.h>
#include <string_view>

namespace fathom::gl {

namespace {

constexpr std::string_view own = "fathom_own_"; // begins the name of what a uniform stands for

} // namespace

bool wants_subroutines() {
    const GLubyte *vendor = glGetString(GL_VENDOR);
    return vendor &&
           reinterpret_cast<const char *>(vendor) == std::string_view("NVIDIA Corporation") &&
           epoxy_is_desktop_gl() && epoxy_gl_version() >= 40;
}

std::string with_subroutines(const std::string &text) {
    std::string result = text;
    for (const auto &[type, name] :
         {std::pair{"float", "sdf"}, {"vec2", "fathom_safe_radius"}, {"float", "fathom_shaded"}}) {
        const std::string head = fmt::format("\n{} {}(vec3 p) {{\n", type, name);
        if (const std::size_t at = result.find(head); at != std::string::npos)
            result.replace(at, head.size(),
                           fmt::format("\nsubroutine {0} fathom_type_of_{1}(vec3 p);\n"
                                       "subroutine uniform fathom_type_of_{1} {1};\n"
                                       "subroutine(fathom_type_of_{1}) {0} {2}{1}(vec3 p) {{\n",
                                       type, name, own));
    }
    const std::size_t line = result.find('\n') + 1; // after the version
    return result.insert(line, "#extension GL_ARB_shader_subroutine : require\n");
}

std::vector<unsigned> subroutines_of(unsigned program) {
    if (!epoxy_is_desktop_gl() || epoxy_gl_version() < 40) return {};
    GLint locations = 0, uniforms = 0, longest = 0;
    const auto ask = [&](GLenum what, GLint &answer) {
        glGetProgramStageiv(program, GL_FRAGMENT_SHADER, what, &answer);
    };
    ask(GL_ACTIVE_SUBROUTINE_UNIFORM_LOCATIONS, locations);
    ask(GL_ACTIVE_SUBROUTINE_UNIFORMS, uniforms);
    ask(GL_ACTIVE_SUBROUTINE_UNIFORM_MAX_LENGTH, longest);
    std::vector<unsigned> result(static_cast<std::size_t>(locations), 0);
    for (GLuint i = 0; i < static_cast<GLuint>(uniforms); ++i) {
        std::string name(static_cast<std::size_t>(longest), '\0');
        GLsizei size = 0;
        glGetActiveSubroutineUniformName(program, GL_FRAGMENT_SHADER, i, longest, &size,
                                         name.data());
        name.resize(static_cast<std::size_t>(size));
        const GLint at = glGetSubroutineUniformLocation(program, GL_FRAGMENT_SHADER, name.c_str());
        name.insert(0, own);
        result.at(static_cast<std::size_t>(at)) =
            glGetSubroutineIndex(program, GL_FRAGMENT_SHADER, name.c_str());
    }
    return result;
}

} // namespace fathom::gl
