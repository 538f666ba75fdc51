#include "backend-glsl/validate.h"

#include "backend-glsl/small_tables.h"
#include "base/text.h"

#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>

#include <memory>
#include <string_view>

namespace fathom::glsl {

namespace {

// glslang keeps tables of its own for as long as a process lives. Its C interface is used: that of C++
// holds containers, whose form is that of the standard library that glslang was built with.
struct Glslang {
    Glslang() { glslang_initialize_process(); }
    ~Glslang() { glslang_finalize_process(); }
};
void start_glslang() { static const Glslang instance; }

// "ERROR: 0:12: 'x' : undeclared identifier": the first line that says so, and its place.
Complaint first_complaint(std::string_view log) {
    Complaint complaint;
    while (!log.empty()) {
        const std::size_t end = std::min(log.find('\n'), log.size());
        std::string_view line = log.substr(0, end);
        log.remove_prefix(std::min(end + 1, log.size()));
        constexpr std::string_view start = "ERROR: ";
        if (!line.starts_with(start)) continue;
        line.remove_prefix(start.size());
        const std::size_t first = line.find(':');
        const std::size_t second =
            first == std::string_view::npos ? first : line.find(':', first + 1);
        if (second != std::string_view::npos)
            if (const auto number = parse_number(line.substr(first + 1, second - first - 1))) {
                complaint.line = static_cast<int>(*number);
                line.remove_prefix(std::min(second + 2, line.size()));
            }
        complaint.message = line;
        return complaint;
    }
    complaint.message = "the validator refuses the shader without saying why";
    return complaint;
}

struct Delete {
    void operator()(glslang_shader_t *shader) const { glslang_shader_delete(shader); }
    void operator()(glslang_program_t *program) const { glslang_program_delete(program); }
};

// A text that was read and linked, or why it could not be.
struct Linked {
    std::unique_ptr<glslang_shader_t, Delete> shader;
    std::unique_ptr<glslang_program_t, Delete> program;
    std::optional<Complaint> complaint;
};

Linked link(const glslang_input_t &input) {
    start_glslang();
    Linked result;
    result.shader.reset(glslang_shader_create(&input));
    if (!glslang_shader_preprocess(result.shader.get(), &input) ||
        !glslang_shader_parse(result.shader.get(), &input)) {
        result.complaint = first_complaint(glslang_shader_get_info_log(result.shader.get()));
        return result;
    }
    result.program.reset(glslang_program_create());
    glslang_program_add_shader(result.program.get(), result.shader.get());
    if (!glslang_program_link(result.program.get(), input.messages))
        result.complaint = first_complaint(glslang_program_get_info_log(result.program.get()));
    return result;
}

// Of a text that names its version itself.
glslang_input_t input_of(const std::string &text, glslang_stage_t stage) {
    glslang_input_t input{};
    input.language = GLSLANG_SOURCE_GLSL;
    input.stage = stage;
    input.client = GLSLANG_CLIENT_NONE;
    input.target_language = GLSLANG_TARGET_NONE;
    input.code = text.c_str();
    input.default_version = 330;
    input.default_profile = GLSLANG_NO_PROFILE;
    input.messages = GLSLANG_MSG_DEFAULT_BIT;
    input.resource = glslang_default_resource();
    return input;
}

} // namespace

std::optional<Complaint> validate(const std::string &text, Stage stage, Tables tables) {
    if (stage == Stage::Fragment && tables == Tables::AsNeeded)
        if (const std::optional<std::string> same = for_small_tables(text))
            if (!link(input_of(*same, GLSLANG_STAGE_FRAGMENT)).complaint) return std::nullopt;
    return link(input_of(text,
                         stage == Stage::Compute ? GLSLANG_STAGE_COMPUTE : GLSLANG_STAGE_FRAGMENT))
        .complaint;
}

SpirV to_spirv(const std::string &text) {
    glslang_input_t input = input_of(text, GLSLANG_STAGE_FRAGMENT);
    input.client = GLSLANG_CLIENT_OPENGL;
    input.client_version = GLSLANG_TARGET_OPENGL_450;
    input.target_language = GLSLANG_TARGET_SPV;
    input.target_language_version = GLSLANG_TARGET_SPV_1_0;
    input.default_version = 450;
    input.messages = GLSLANG_MSG_SPV_RULES_BIT;
    SpirV result;
    const Linked linked = link(input);
    result.complaint = linked.complaint;
    if (result.complaint) return result;
    glslang_program_SPIRV_generate(linked.program.get(), GLSLANG_STAGE_FRAGMENT);
    result.words.resize(glslang_program_SPIRV_get_size(linked.program.get()));
    glslang_program_SPIRV_get(linked.program.get(), result.words.data());
    return result;
}

} // namespace fathom::glsl
