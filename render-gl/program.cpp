#include "render-gl/program.h"

#include "render-gl/passes.h"
#include "render-gl/pruning.h"
#include "render-gl/shaders.h"
#include "render-gl/subroutines.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <fmt/format.h>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

namespace fathom::gl {

namespace {

// Mesa's llvmpipe ends a shader after 65,536 turns of all its loops. Beside the steps that are
// counted a ray takes some for its place, its normal and its penumbras.
constexpr double most_loop_turns = 50000;
constexpr int kept_textures = static_cast<int>(std::tuple_size_v<decltype(Pass::kept)>);
constexpr int places_textures = 1;                 // behind them
constexpr const char *kept_name = "fathom_kept_0"; // stands in texts by passes
constexpr int uncounted_steps = 240, fewest_turns = 16, most_turns = 1024;
// Of a text that begins rays alone, which says itself where loops were ended (entry.glsl).
constexpr int most_at_first = 4096;
constexpr double loops_of_march = 2; // a step's own

int turns_within(double loops_a_step) {
    const double steps = most_loop_turns / (loops_of_march + loops_a_step) - uncounted_steps;
    return static_cast<int>(std::clamp(steps, double{fewest_turns}, double{most_turns}));
}

// The text of a program that begins rays, of which none goes on.
std::string text_that_begins(const std::string &text) {
    const std::size_t line = text.find('\n') + 1; // after the version
    return text.substr(0, line) + "#define FATHOM_BEGINS\n" + text.substr(line);
}

void unfiltered(GLenum target) {
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, 0);
}

// The text of ES links with one of ES alone.
std::string triangle_for(const std::string &text) {
    const std::string triangle = covering_triangle, version = text.substr(0, text.find('\n'));
    return version.ends_with(" es") ? version + triangle.substr(triangle.find('\n')) : triangle;
}

std::optional<ProgramError> too_large(GLenum limit, std::span<const int> sides) {
    GLint largest = 0;
    glGetIntegerv(limit, &largest);
    if (std::ranges::max(sides) <= largest) return std::nullopt;
    return ProgramError{
        0,
        fmt::format("the scene has an image or a grid of {} on a side, and this GL holds {}",
                    std::ranges::max(sides), largest),
        ""};
}

} // namespace

std::variant<Program, ProgramError> Program::build(const glsl::Output &output,
                                                   const ir::Scene &scene) {
    Program result;
    result.uniforms_ = output.uniforms;
    result.budget_ = output.budget;
    const bool software = is_software(), passes = output.text.find(kept_name) != std::string::npos;
    result.most_turns_ = turns_within(software ? output.turns.all : output.turns.written_out);
    std::string text = output.text;
    if (software && passes) {
        result.keeping_text_ = text;
        text = text_that_begins(text);
    }
    if (wants_subroutines()) text = with_subroutines(text);
    if (auto error = link(result.program_,
                          {{GL_VERTEX_SHADER, triangle_for(text)}, {GL_FRAGMENT_SHADER, text}}))
        return *error;
    result.subroutines_ = subroutines_of(result.program_);
    if (auto error = result.tables_.fill(output.tables)) return *error;
    for (const glsl::Sampler &sampler : output.images) {
        const ir::ImageData &image = scene.images[sampler.index];
        if (auto error = too_large(GL_MAX_TEXTURE_SIZE, std::array{image.width, image.height}))
            return *error;
        GLuint texture = 0;
        glGenTextures(1, &texture);
        glBindTexture(GL_TEXTURE_2D, texture);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, image.width, image.height, 0, GL_RGBA, GL_FLOAT,
                     image.rgba.data());
        unfiltered(GL_TEXTURE_2D);
        result.textures_.push_back({GL_TEXTURE_2D, texture, sampler.name});
    }
    for (const glsl::Sampler &sampler : output.grids) {
        const ir::GridData &grid = scene.grids[sampler.index];
        if (auto error = too_large(GL_MAX_3D_TEXTURE_SIZE, grid.size)) return *error;
        GLuint texture = 0;
        glGenTextures(1, &texture);
        glBindTexture(GL_TEXTURE_3D, texture);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
        glTexImage3D(GL_TEXTURE_3D, 0, GL_R32F, grid.size[0], grid.size[1], grid.size[2], 0, GL_RED,
                     GL_FLOAT, grid.values.data());
        unfiltered(GL_TEXTURE_3D);
        result.textures_.push_back({GL_TEXTURE_3D, texture, sampler.name});
    }
    if (passes) {
        GLint units = 16;
        glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &units);
        result.first_kept_unit_ = units - kept_textures - places_textures;
        if (auto error = link(result.marks_, {{GL_VERTEX_SHADER, covering_triangle},
                                              {GL_FRAGMENT_SHADER, Passes::marks_text}}))
            return *error;
        const int textures = static_cast<int>(result.textures_.size());
        if (textures >= result.first_kept_unit_)
            return ProgramError{
                0,
                fmt::format("the scene has {} images and grids, and this GL holds {}", textures,
                            result.first_kept_unit_ - 1),
                ""};
    }
    result.name_units(result.program_);
    if (!output.pruning.kernels.empty()) {
        auto pruning = Pruning::build(output.pruning);
        if (const auto *error = std::get_if<ProgramError>(&pruning)) return *error;
        result.pruning_ = std::move(std::get<std::unique_ptr<Pruning>>(pruning));
    }
    return result;
}

void Program::name_units(unsigned program) const {
    glUseProgram(program);
    const auto name = [&](const std::string &sampler, int unit) {
        glUniform1i(glGetUniformLocation(program, sampler.c_str()), unit);
    };
    name("fathom_tables", 0);
    for (std::size_t i = 0; i < textures_.size(); ++i)
        name(textures_[i].sampler, 1 + static_cast<int>(i));
    for (int i = 0; by_passes() && i < kept_textures; ++i)
        name(fmt::format("fathom_kept_{}", i), first_kept_unit_ + i);
    if (by_passes()) name("fathom_places", first_kept_unit_ + kept_textures);
}

int Program::first_turns() const { return keeping_text_.empty() ? most_turns_ : most_at_first; }

bool Program::prepare_to_keep() const {
    if (keeping_text_.empty() || keeping_) return true;
    if (link(keeping_, {{GL_VERTEX_SHADER, triangle_for(keeping_text_)},
                        {GL_FRAGMENT_SHADER, keeping_text_}}))
        return false;
    name_units(keeping_);
    return true;
}

void Program::draw(const FrameInputs &in, const std::vector<ir::Param> &params) const {
    if (pruning_) pruning_->prepare(params, in.time);
    const unsigned program = in.pass.keeps && keeping_ ? keeping_ : program_;
    glUseProgram(program);
    if (!subroutines_.empty())
        glUniformSubroutinesuiv(GL_FRAGMENT_SHADER, static_cast<GLsizei>(subroutines_.size()),
                                subroutines_.data());
    const auto location = [&](const char *name) { return glGetUniformLocation(program, name); };
    const auto vector = [&](const char *name, const glm::dvec3 &v) {
        glUniform3f(location(name), static_cast<float>(v[0]), static_cast<float>(v[1]),
                    static_cast<float>(v[2]));
    };
    glUniform2f(location("fathom_resolution"), static_cast<float>(in.width),
                static_cast<float>(in.height));
    glUniform2f(location("fathom_offset"), static_cast<float>(in.offset[0]),
                static_cast<float>(in.offset[1]));
    vector("fathom_origin", in.view.origin);
    vector("fathom_right", in.view.right);
    vector("fathom_up", in.view.up);
    vector("fathom_forward", in.view.forward);
    vector("fathom_sun", in.sun);
    glUniform1f(location("fathom_extent"), static_cast<float>(in.view.extent));
    glUniform1f(location("fathom_focus"), static_cast<float>(in.view.focus));
    glUniform1i(location("fathom_orthographic"), in.view.orthographic ? 1 : 0);
    glUniform1i(location("fathom_mode"), static_cast<GLint>(in.mode));
    glUniform1f(location("fathom_time"), static_cast<float>(in.time));
    glUniform4f(location("fathom_plane"), static_cast<float>(in.plane[0]),
                static_cast<float>(in.plane[1]), static_cast<float>(in.plane[2]),
                static_cast<float>(in.plane[3]));
    if (!edited_.empty())
        glUniform1fv(location("fathom_edited"), static_cast<GLsizei>(edited_.size()),
                     edited_.data());

    if (by_passes()) {
        const int budget = in.budget > 0 ? in.budget : budget_;
        glUniform1i(location("fathom_budget"), budget);
        glUniform1i(location("fathom_turns"), in.pass.turns > 0 ? in.pass.turns : budget);
        glUniform1i(location("fathom_resumed"), in.pass.resumed ? 1 : 0);
        for (std::size_t i = 0; i < in.pass.kept.size(); ++i) {
            glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(first_kept_unit_) +
                            static_cast<GLenum>(i));
            glBindTexture(GL_TEXTURE_2D, in.pass.kept[i]);
        }
        glUniform1i(location("fathom_listed"), in.places ? 1 : 0);
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(first_kept_unit_ + kept_textures));
        glBindTexture(GL_TEXTURE_2D, in.places);
    }

    set_params(program, uniforms_, params);
    tables_.bind();
    if (pruning_) pruning_->bind(program);
    for (std::size_t i = 0; i < textures_.size(); ++i) {
        glActiveTexture(GL_TEXTURE1 + static_cast<GLenum>(i));
        glBindTexture(textures_[i].target, textures_[i].name);
    }
    draw_triangle();
}

Pruning *Program::pruning() const { return pruning_.get(); }

void Program::use() const { glUseProgram(program_); }

void draw_triangle() {
    GLuint array = 0;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    glDeleteVertexArrays(1, &array);
}

void Program::warm_up(const std::vector<ir::Param> &params) const {
    constexpr int side = 8;
    GLint before = 0, viewport[4];
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &before);
    glGetIntegerv(GL_VIEWPORT, viewport);
    GLuint framebuffer = 0, textures[2] = {0, 0};
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glGenTextures(2, textures);
    glActiveTexture(GL_TEXTURE0);
    for (GLuint i = 0; i < 2; ++i) {
        glBindTexture(GL_TEXTURE_2D, textures[i]);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, side, side, 0, GL_RGBA, GL_FLOAT, nullptr);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + i, GL_TEXTURE_2D, textures[i],
                               0);
    }
    const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glDrawBuffers(2, both);
    glViewport(0, 0, side, side);
    FrameInputs inputs;
    inputs.width = inputs.height = side;
    inputs.mode = Mode::Linear;
    Passes passes; // what is put off is put off for each kind of target
    if (by_passes() && passes.use({textures[0], textures[1], side, side})) {
        passes.begin(*this, 0, side, 1);
        passes.draw(*this, [&](const Pass &pass) {
            inputs.pass = pass;
            inputs.pass.turns = inputs.budget = 1;
            glViewport(0, 0, side, side);
            glDisable(GL_SCISSOR_TEST);
            draw(inputs, params);
        });
    } else {
        draw(inputs, params);
    }
    glFinish();
    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(before));
    glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteTextures(2, textures);
}

void Program::adopt(const glsl::Output &output) {
    uniforms_ = output.uniforms;
    budget_ = output.budget;
    tables_.replace(output.tables);
    if (pruning_) pruning_->adopt(output.pruning);
}

void Program::release() {
    for (const Texture &texture : textures_) glDeleteTextures(1, &texture.name);
    for (unsigned program : {program_, keeping_, marks_})
        if (program) glDeleteProgram(program);
    textures_.clear();
    program_ = keeping_ = marks_ = 0;
}

Program::Program() = default;
Program::Program(Program &&other) noexcept { *this = std::move(other); }

Program &Program::operator=(Program &&other) noexcept {
    std::swap(program_, other.program_);
    std::swap(marks_, other.marks_);
    std::swap(keeping_text_, other.keeping_text_);
    std::swap(keeping_, other.keeping_);
    std::swap(subroutines_, other.subroutines_);
    std::swap(budget_, other.budget_);
    std::swap(most_turns_, other.most_turns_);
    std::swap(first_kept_unit_, other.first_kept_unit_);
    std::swap(tables_, other.tables_);
    std::swap(pruning_, other.pruning_);
    std::swap(textures_, other.textures_);
    std::swap(uniforms_, other.uniforms_);
    std::swap(edited_, other.edited_);
    return *this;
}

Program::~Program() { release(); }

} // namespace fathom::gl
