#include "render-gl/pruning.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>

namespace fathom::gl {

namespace {

constexpr std::size_t max_entries = std::size_t(1) << 26; // of lists: 256 MB

// Cells along an axis, level by level: finer for more rows, and coarser where a processor makes the
// lists, which takes as long as many pictures there.
std::vector<int> sides_for(int rows) {
    const bool software = is_software();
    if (rows < (software ? 40000 : 1000)) return {2, 8, 32};
    if (rows < (software ? 1000000 : 40000)) return {4, 16, 64};
    return {2, 8, 32, 128};
}

int max_rows(const glsl::Pruning &pruning) {
    int maximum = 0;
    for (const glsl::PruneKernel &kernel : pruning.kernels)
        maximum = std::max(maximum, kernel.rows);
    return maximum;
}

unsigned buffer_of(std::size_t bytes, const void *data) {
    GLuint name = 0;
    glGenBuffers(1, &name);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, name);
    glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(bytes), data, GL_DYNAMIC_COPY);
    return name;
}

void drop(unsigned &buffer) {
    if (buffer) glDeleteBuffers(1, &buffer);
    buffer = 0;
}

// The lists' kernels, then that of the far cells.
std::vector<const glsl::PruneKernel *> sources_of(const glsl::Pruning &pruning) {
    std::vector<const glsl::PruneKernel *> sources;
    for (const glsl::PruneKernel &kernel : pruning.kernels) sources.push_back(&kernel);
    if (!pruning.far.text.empty()) sources.push_back(&pruning.far);
    return sources;
}

void set_grid(unsigned program, const glsl::Pruning &pruning, int side) {
    const auto vector = [&](const char *name, double x, double y, double z) {
        glUniform3f(glGetUniformLocation(program, name), static_cast<float>(x),
                    static_cast<float>(y), static_cast<float>(z));
    };
    const auto &lo = pruning.lo, &hi = pruning.hi;
    vector("fathom_grid_lo", lo[0], lo[1], lo[2]);
    vector("fathom_grid_size", hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]);
    glUniform1i(glGetUniformLocation(program, "fathom_grid_side"), side);
}

} // namespace

bool is_software() {
    const GLubyte *name = glGetString(GL_RENDERER);
    const std::string_view renderer = name ? reinterpret_cast<const char *>(name) : "";
    for (const char *known : {"llvmpipe", "softpipe", "SwiftShader"})
        if (renderer.find(known) != renderer.npos) return true;
    return false;
}

bool can_prune() {
    if (epoxy_gl_version() < 43) return false;
    GLint blocks = 0;
    glGetIntegerv(GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS, &blocks);
    return blocks >= 3;
}

std::optional<ProgramError> Pruning::compile(Kernel &kernel, const glsl::PruneKernel &source) {
    if (kernel.program) glDeleteProgram(kernel.program);
    kernel = {};
    if (auto error = link(kernel.program, {{GL_COMPUTE_SHADER, source.text}})) return error;
    glUseProgram(kernel.program);
    glUniform1i(glGetUniformLocation(kernel.program, "fathom_tables"), 0);
    return kernel.tables.fill(source.tables);
}

std::variant<std::unique_ptr<Pruning>, ProgramError> Pruning::build(const glsl::Pruning &pruning) {
    std::unique_ptr<Pruning> result(new Pruning);
    result->source_ = pruning;
    for (const glsl::PruneKernel *source : sources_of(result->source_))
        if (auto error = compile(result->kernels_.emplace_back(), *source)) return *error;
    return result;
}

// A kernel's text that is new here is a part of the picture's own, which has passed.
void Pruning::adopt(const glsl::Pruning &pruning) {
    const glsl::Pruning before = std::exchange(source_, pruning);
    const auto fresh = sources_of(source_), old = sources_of(before);
    stale_ |= source_.lo != before.lo || source_.hi != before.hi || fresh.size() != old.size();
    for (std::size_t i = fresh.size(); i < kernels_.size(); ++i)
        glDeleteProgram(kernels_[i].program);
    kernels_.resize(fresh.size());
    for (std::size_t i = 0; i < fresh.size(); ++i) {
        const bool same = i < old.size() && fresh[i]->text == old[i]->text;
        if (same && fresh[i]->tables == old[i]->tables) continue;
        stale_ = true;
        if (same && fresh[i]->tables.size() == old[i]->tables.size())
            kernels_[i].tables.replace(fresh[i]->tables);
        else
            compile(kernels_[i], *fresh[i]);
    }
}

void Pruning::prepare(const std::vector<ir::Param> &params, double time) {
    const auto sources = sources_of(source_);
    bool far_stale = false;
    for (std::size_t i = 0; i < sources.size(); ++i) {
        std::vector<double> values;
        for (const glsl::Uniform &uniform : sources[i]->uniforms)
            values.insert(values.end(), params[uniform.param].value.begin(),
                          params[uniform.param].value.end());
        if (sources[i]->reads_time) values.push_back(time);
        const bool changed = values != kernels_[i].values;
        (i < source_.kernels.size() ? stale_ : far_stale) |= changed;
        kernels_[i].values = std::move(values);
    }
    if (stale_) make_lists(params, time);
    if (stale_ || far_stale) make_far(params, time);
    stale_ = false;
}

void Pruning::remake(const std::vector<ir::Param> &params, double time) {
    make_lists(params, time);
    make_far(params, time);
}

// A level that has no room for its lists is made again with as much as it needs; where that is
// too much, the level before has to do.
void Pruning::make_lists(const std::vector<ir::Param> &params, double time) {
    const auto rows = static_cast<std::size_t>(max_rows(source_));
    std::vector<std::uint32_t> every(rows);
    std::iota(every.begin(), every.end(), 0u);
    drop(cells_), drop(rows_);
    side_ = 0;
    cells_ = buffer_of(2 * sizeof(std::uint32_t), nullptr);
    rows_ = buffer_of(rows * sizeof(std::uint32_t), every.data());
    for (int side : sides_for(static_cast<int>(rows))) {
        const std::size_t cells = static_cast<std::size_t>(side) * static_cast<std::size_t>(side) *
                                  static_cast<std::size_t>(side) * source_.kernels.size();
        next_cells_ = buffer_of(cells * 2 * sizeof(std::uint32_t), nullptr);
        // A list is at most as long as its parent's; most are much shorter.
        const double mean =
            side_ ? 0.6 * tally_.rows / static_cast<double>(source_.kernels.size()) : 48;
        auto wanted = static_cast<std::uint32_t>(
            rows + std::min(static_cast<std::size_t>(mean * static_cast<double>(cells)) + 65536,
                            max_entries - rows));
        bool good = false;
        for (int attempt = 0; attempt < 2 && !good && wanted <= max_entries; ++attempt) {
            const std::uint32_t room = wanted;
            drop(next_rows_);
            next_rows_ = buffer_of(room * sizeof(std::uint32_t), nullptr);
            glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0,
                            static_cast<GLsizeiptr>(rows * sizeof(std::uint32_t)), every.data());
            const auto begin = static_cast<std::uint32_t>(rows);
            drop(total_);
            total_ = buffer_of(sizeof begin, &begin);
            level(side, side_, room, params, time);
            glBindBuffer(GL_SHADER_STORAGE_BUFFER, total_);
            glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof wanted, &wanted);
            good = wanted <= room;
        }
        if (!good) break;
        std::swap(cells_, next_cells_);
        std::swap(rows_, next_rows_);
        drop(next_cells_), drop(next_rows_);
        side_ = side;
        tally_ = {side,
                  static_cast<double>(wanted - rows) * static_cast<double>(source_.kernels.size()) /
                      static_cast<double>(cells),
                  0};
        for (const glsl::PruneKernel &kernel : source_.kernels) tally_.all += kernel.rows;
    }
    drop(next_cells_), drop(next_rows_);
}

void Pruning::make_far(const std::vector<ir::Param> &params, double time) {
    if (source_.far.text.empty()) return;
    drop(far_cells_);
    const int cells = side_ * side_ * side_;
    far_cells_ = buffer_of(std::max<std::size_t>(cells, 1) * sizeof(float), nullptr);
    const Kernel &kernel = kernels_.back();
    glUseProgram(kernel.program);
    bind(kernel.program);
    glUniform1f(glGetUniformLocation(kernel.program, "fathom_time"), static_cast<GLfloat>(time));
    set_params(kernel.program, source_.far.uniforms, params);
    kernel.tables.bind();
    glDispatchCompute(static_cast<GLuint>((cells + 63) / 64), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

std::vector<float> Pruning::far_cells() const {
    std::vector<float> values(static_cast<std::size_t>(far_cells_ ? side_ * side_ * side_ : 0));
    if (values.empty()) return values;
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, far_cells_);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0,
                       static_cast<GLsizeiptr>(values.size() * sizeof(float)), values.data());
    return values;
}

void Pruning::level(int side, int parent_side, std::size_t room,
                    const std::vector<ir::Param> &params, double time) {
    const unsigned buffers[] = {cells_, rows_, next_cells_, next_rows_, total_};
    for (unsigned i = 0; i < 5; ++i) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, buffers[i]);
    const int cells = side * side * side;
    for (std::size_t i = 0; i < source_.kernels.size(); ++i) {
        const unsigned program = kernels_[i].program;
        glUseProgram(program);
        set_grid(program, source_, side);
        glUniform1i(glGetUniformLocation(program, "fathom_grid"), static_cast<GLint>(i));
        glUniform1i(glGetUniformLocation(program, "fathom_parent_side"), parent_side);
        glUniform1ui(glGetUniformLocation(program, "fathom_room"), static_cast<GLuint>(room));
        glUniform1f(glGetUniformLocation(program, "fathom_time"), static_cast<GLfloat>(time));
        set_params(program, source_.kernels[i].uniforms, params);
        kernels_[i].tables.bind();
        glDispatchCompute(static_cast<GLuint>((cells + 63) / 64), 1, 1);
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void Pruning::bind(unsigned program) const {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, cells_);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, rows_);
    if (far_cells_) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, far_cells_);
    set_grid(program, source_, side_);
}

Pruning::~Pruning() {
    for (unsigned *buffer : {&cells_, &rows_, &far_cells_, &next_cells_, &next_rows_, &total_})
        drop(*buffer);
    for (Kernel &kernel : kernels_)
        if (kernel.program) glDeleteProgram(kernel.program);
}

} // namespace fathom::gl
