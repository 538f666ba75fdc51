#include "backend-glsl/validate.h"

#include "base/text.h"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <string_view>

namespace fathom::glsl {

namespace {

// glslang keeps tables of its own for as long as a process lives.
struct Glslang {
    Glslang() { glslang::InitializeProcess(); }
    ~Glslang() { glslang::FinalizeProcess(); }
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

} // namespace

std::optional<Complaint> validate(const std::string &text, Stage stage) {
    start_glslang();
    glslang::TShader shader(stage == Stage::Compute ? EShLangCompute : EShLangFragment);
    const char *texts[] = {text.c_str()};
    const int lengths[] = {static_cast<int>(text.size())};
    shader.setStringsWithLengths(texts, lengths, 1);
    if (!shader.parse(GetDefaultResources(), 330, false, EShMsgDefault))
        return first_complaint(shader.getInfoLog());
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(EShMsgDefault)) return first_complaint(program.getInfoLog());
    return std::nullopt;
}

SpirV to_spirv(const std::string &text) {
    start_glslang();
    SpirV result;
    glslang::TShader shader(EShLangFragment);
    const char *texts[] = {text.c_str()};
    const int lengths[] = {static_cast<int>(text.size())};
    shader.setStringsWithLengths(texts, lengths, 1);
    shader.setEnvInput(glslang::EShSourceGlsl, EShLangFragment, glslang::EShClientOpenGL, 100);
    shader.setEnvClient(glslang::EShClientOpenGL, glslang::EShTargetOpenGL_450);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_0);
    const auto messages = static_cast<EShMessages>(EShMsgSpvRules);
    if (!shader.parse(GetDefaultResources(), 450, false, messages)) {
        result.complaint = first_complaint(shader.getInfoLog());
        return result;
    }
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(messages)) {
        result.complaint = first_complaint(program.getInfoLog());
        return result;
    }
    std::vector<unsigned int> words;
    glslang::GlslangToSpv(*program.getIntermediate(EShLangFragment), words);
    result.words.assign(words.begin(), words.end());
    return result;
}

} // namespace fathom::glsl
