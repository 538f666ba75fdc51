#include "render-gl/cache_passes.h"

#include "ir/passes/cost.h"
#include "render-gl/pruning.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <utility>

namespace fathom::gl {

namespace {

void set(const Program &program, const char *name, int value) {
    glUniform1i(glGetUniformLocation(program.name(), name), value);
}

void set_unsigned(const Program &program, const char *name, unsigned value) {
    glUniform1ui(glGetUniformLocation(program.name(), name), value);
}

void bind_image(const Program &program, const char *name, int unit, GLuint texture, GLenum format,
                GLenum access) {
    glBindImageTexture(static_cast<GLuint>(unit), texture, 0, GL_TRUE, 0, access, format);
    set(program, name, unit);
}

void bind_2d(int unit, GLuint texture) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, texture);
}

std::string refusal(const ProgramError &error) {
    return "the graphics driver refuses the noise cache's shader: " + error.message;
}

CachePrices prices_of(const ir::Scene &scene, const std::vector<glsl::CachedField> &fields) {
    const ir::Graph &graph = scene.graph;
    const auto cost = [&](ir::FunctionId f) {
        return ir::cost_of(graph, graph.function(f).result);
    };
    CachePrices prices;
    for (const glsl::CachedField &field : fields) {
        const double own = cost(graph.cache(ir::CacheId{field.cache}).field);
        prices.field = prices.field > 0 ? std::min(prices.field, own) : own;
    }
    if (scene.distance) prices.whole = cost(scene.distance);
    prices.whole = std::max(prices.whole, prices.field);
    return prices;
}

} // namespace

std::string cache_unavailable() {
    const int version = epoxy_gl_version();
    if (version < 42)
        return fmt::format("the noise cache needs OpenGL 4.2, this driver has {}.{}", version / 10,
                           version % 10);
    GLint images = 0;
    glGetIntegerv(GL_MAX_FRAGMENT_IMAGE_UNIFORMS, &images);
    if (images < 4)
        return "the noise cache needs images in fragment shaders, which this driver has none of";
    return "";
}

std::variant<CachePrograms, std::string> build_cache_programs(const ir::Scene &scene,
                                                              const CacheOptions &options,
                                                              Diagnostics &diagnostics) {
    if (std::string why = cache_unavailable(); !why.empty()) return why;
    glsl::Options target;
    target.target = glsl::Target::Glsl450;
    target.buffers = true;
    target.noise_cache = true;
    target.pruning = can_prune();
    target.part_stride = options.part_stride;
    if (options.pick) target.instruments = glsl::Instruments::Pick;
    const glsl::Output picture = glsl::emit(scene, target, diagnostics);
    if (picture.text.empty()) return "the shader with the noise cache cannot be made";
    if (picture.cached.empty()) return "no field of this scene is worth keeping";
    glsl::Options direct = target;
    direct.noise_cache = false;
    direct.passes = true; // for its budget: it is drawn in one
    const glsl::Output exact = glsl::emit(scene, direct, diagnostics);
    if (exact.text.empty()) return "the shader cannot be made";
    target.instruments = glsl::Instruments::None;
    const glsl::CachePasses passes = glsl::emit_cache_passes(scene, target, diagnostics);
    if (passes.fill.text.empty()) return "the noise cache's shaders cannot be made";
    GLint units = 16;
    glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &units);
    if (static_cast<int>(1 + picture.images.size() + picture.grids.size()) > units - 3)
        return "the scene has too many images to leave room for the noise cache";

    glsl::Output cached = picture, rest = picture;
    cached.text = glsl::with_cache(picture.text);
    rest.text = glsl::with_cache(picture.text, glsl::cache_learns);
    std::vector<Program> built;
    for (const glsl::Output *output :
         {&std::as_const(cached), &std::as_const(rest), &exact, &passes.fill}) {
        auto program = Program::build(*output, scene);
        if (const auto *error = std::get_if<ProgramError>(&program)) return refusal(*error);
        built.push_back(std::move(std::get<Program>(program)));
    }
    return CachePrograms{std::move(built[0]), std::move(built[1]), std::move(built[2]),
                         std::move(built[3]), picture.cached,      prices_of(scene, picture.cached),
                         options.pick};
}

CachedView::~CachedView() {
    if (sweep_framebuffer_) glDeleteFramebuffers(1, &sweep_framebuffer_);
    if (sweep_target_) glDeleteTextures(1, &sweep_target_);
    if (changed_) glDeleteQueries(1, &changed_);
}

// The programs that are the same for every scene.
std::string CachedView::build_passes() {
    const std::pair<std::optional<Program> *, std::string> passes[] = {
        {&reserve_, glsl::cache_reserve()},
        {&publish_, glsl::cache_publish()},
        {&sweep_, glsl::cache_sweep()},
        {&tint_, glsl::cache_tint()}};
    for (const auto &[into, text] : passes) {
        if (*into) continue;
        glsl::Output alone;
        alone.text = text;
        auto program = Program::build(alone, {});
        if (const auto *error = std::get_if<ProgramError>(&program)) return refusal(*error);
        into->emplace(std::move(std::get<Program>(program)));
    }
    return "";
}

// A field that the cache knows keeps its number; others get one that nobody has.
void CachedView::number_fields() {
    const std::vector<glsl::CachedField> &fields = programs_->fields;
    numbers_.assign(fields.size(), -1);
    const auto means = [](const std::vector<double> &known, std::uint64_t meaning) {
        std::uint64_t first = 0;
        std::memcpy(&first, known.data(), sizeof first);
        return first == meaning;
    };
    std::vector<bool> taken(glsl::max_cache_fields, false);
    for (std::size_t i = 0; i < fields.size(); ++i)
        for (const auto &[number, known] : meanings_)
            if (!taken[static_cast<std::size_t>(number)] && means(known, fields[i].meaning)) {
                numbers_[i] = number;
                taken[static_cast<std::size_t>(number)] = true;
                break;
            }
    for (int &number : numbers_)
        if (number < 0) {
            // Better one that was never used than one whose cells have to be given up.
            const auto unused = [&](bool new_ones) {
                for (int n = 0; n < glsl::max_cache_fields; ++n)
                    if (!taken[static_cast<std::size_t>(n)] &&
                        (!new_ones || !meanings_.contains(n)))
                        return n;
                return -1;
            };
            number = unused(true);
            if (number < 0) number = unused(false);
            taken[static_cast<std::size_t>(number)] = true;
        }
}

std::string CachedView::use(CachePrograms programs, const CacheSize &size) {
    programs_.reset();
    GLint units = 16;
    glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &units);
    first_unit_ = units - 3;
    CacheSize wanted = size;
    for (const glsl::CachedField &field : programs.fields) wanted.wide |= field.wide;
    const int bits = store_.size().bits;
    const bool fits = bits == wanted.bits || (bits > wanted.bits && bits <= wanted.max_bits);
    if (!store_.hash() || !fits || (wanted.wide && !store_.size().wide)) {
        if (store_.hash() && fits) wanted.bits = bits;
        meanings_.clear();
        if (!store_.make(wanted)) return "the graphics card has no memory for the noise cache";
    }
    if (std::string why = build_passes(); !why.empty()) return why;
    programs_ = std::move(programs);
    number_fields();
    read_.clear();
    weigh_anew();
    return "";
}

std::string CachedView::use(const ir::Scene &scene, const CacheSize &size, Diagnostics &diagnostics,
                            const CacheOptions &options) {
    programs_.reset();
    auto built = build_cache_programs(scene, options, diagnostics);
    if (std::string *why = std::get_if<std::string>(&built)) return *why;
    return use(std::move(std::get<CachePrograms>(built)), size);
}

int CachedView::number_of(std::uint32_t cache) const {
    for (std::size_t i = 0; programs_ && i < programs_->fields.size(); ++i)
        if (programs_->fields[i].cache == cache) return numbers_[i];
    return -1;
}

void CachedView::set_fields(const Program &program) const {
    glUniform1iv(glGetUniformLocation(program.name(), "fathom_cache_fields"),
                 static_cast<GLsizei>(numbers_.size()), numbers_.data());
    set(program, "fathom_cache_bits", store_.size().bits);
}

// Whether a cached field reads other values than in the frame before.
bool CachedView::edited(const std::vector<ir::Param> &params) {
    std::vector<double> now;
    for (const glsl::CachedField &field : programs_->fields)
        for (std::uint32_t param : field.params)
            now.insert(now.end(), params[param].value.begin(), params[param].value.end());
    const bool other = now.size() == read_.size() && now != read_;
    read_ = std::move(now);
    return other;
}

// Gives up what was filled with other values of the params, or by what had the number before.
void CachedView::renew(const std::vector<ir::Param> &params, int ages) {
    bool swept = ages < ages_;
    ages_ = ages;
    if (swept) sweep(-2);
    for (std::size_t i = 0; i < programs_->fields.size(); ++i) {
        const glsl::CachedField &field = programs_->fields[i];
        std::vector<double> now(1);
        std::memcpy(now.data(), &field.meaning, sizeof field.meaning);
        for (std::uint32_t param : field.params)
            now.insert(now.end(), params[param].value.begin(), params[param].value.end());
        const auto known = meanings_.find(numbers_[i]);
        const bool same =
            known != meanings_.end() && known->second.size() == now.size() &&
            std::memcmp(known->second.data(), now.data(), now.size() * sizeof(double)) == 0;
        if (same) continue;
        if (known != meanings_.end()) {
            sweep(numbers_[i]);
            swept = true;
        }
        meanings_[numbers_[i]] = std::move(now);
    }
    if (swept) publish();
}

void CachedView::publish() {
    publish_->use();
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_3D, store_.hash());
    set(*publish_, "fathom_cache_hash", 0);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_3D, store_.keys());
    set(*publish_, "fathom_cache_keys", 1);
    glActiveTexture(GL_TEXTURE2);
    glBindTexture(GL_TEXTURE_3D, store_.changed());
    set(*publish_, "fathom_cache_changed", 2);
    set(*publish_, "fathom_cache_bits", store_.size().bits);
    set(*publish_, "fathom_cache_width", targets_.width);
    set(*publish_, "fathom_cache_height", targets_.height);
    bind_image(*publish_, "fathom_cache_counts", 0, store_.counts(), GL_R32UI, GL_READ_ONLY);
    bind_image(*publish_, "fathom_cache_index", 1, store_.index(), GL_RG32UI, GL_WRITE_ONLY);
    glBindFramebuffer(GL_FRAMEBUFFER, targets_.picture); // any; nothing is drawn
    glViewport(0, 0, targets_.width, targets_.height);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    draw_triangle();
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

// One invocation a cell of the cache.
void CachedView::sweep(int field) {
    sweep_->use();
    set(*sweep_, "fathom_cache_gone", field);
    set(*sweep_, "fathom_cache_ages", ages_);
    bind_image(*sweep_, "fathom_cache_hash", 0, store_.hash(), GL_R32UI, GL_READ_WRITE);
    bind_image(*sweep_, "fathom_cache_keys", 1, store_.keys(), GL_RGBA32I, GL_READ_ONLY);
    bind_image(*sweep_, "fathom_cache_free", 2, store_.free(), GL_R32UI, GL_READ_WRITE);
    bind_image(*sweep_, "fathom_cache_counts", 3, store_.counts(), GL_R32UI, GL_READ_WRITE);
    bind_image(*sweep_, "fathom_cache_changed", 4, store_.changed(), GL_R32UI, GL_WRITE_ONLY);
    const int width = 1 << (3 * store_.size().bits + 1) / 2,
              height = static_cast<int>(store_.cells()) / width;
    if (sweep_cells_ != store_.cells()) {
        if (!sweep_framebuffer_) glGenFramebuffers(1, &sweep_framebuffer_);
        if (sweep_target_) glDeleteTextures(1, &sweep_target_);
        sweep_cells_ = store_.cells();
        sweep_target_ = target_2d(GL_R8, width, height, sweep_framebuffer_, GL_COLOR_ATTACHMENT0);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, sweep_framebuffer_);
    glViewport(0, 0, width, height);
    set(*sweep_, "fathom_cache_bits", store_.size().bits);
    set(*sweep_, "fathom_cache_width", width);
    draw_triangle();
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

void CachedView::begin_picture() const {
    glBindFramebuffer(GL_FRAMEBUFFER, targets_.picture);
    glViewport(0, 0, targets_.width, targets_.height);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_DEPTH_TEST);
}

// The picture from cached values alone; a pixel that wants an absent one keeps its depth of 1.
// Those are drawn by computing all: the card skips the others before it shades them.
void CachedView::draw_cached_frame(const FrameInputs &inputs, const std::vector<ir::Param> &params,
                                   const CacheSettings &settings) {
    const Program &cached = programs_->cached;
    begin_picture();
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glDepthMask(GL_TRUE);
    cached.use();
    set_fields(cached);
    set(cached, "fathom_cache_ages", ages_);
    glUniform1f(glGetUniformLocation(cached.name(), "fathom_cache_least"),
                static_cast<float>(settings.min_pixels));
    const char *const samplers[] = {"fathom_cache_index", "fathom_cache_pool", "fathom_cache_wide"};
    for (int i = 0; i < 3; ++i) set(cached, samplers[i], first_unit_ + i);
    store_.bind_textures(first_unit_);
    cached.draw(inputs, params);

    glBindFramebuffer(GL_FRAMEBUFFER, targets_.rest);
    glDepthFunc(GL_LESS); // the triangle lies at 0.5
    glDepthMask(GL_FALSE);
    const Program &rest = programs_->rest;
    rest.use();
    set_fields(rest);
    set_unsigned(rest, "fathom_cache_frame", frame_);
    glUniform1f(glGetUniformLocation(rest.name(), "fathom_cache_least"),
                static_cast<float>(settings.min_pixels));
    set(rest, "fathom_cache_ages", ages_);
    set(rest, "fathom_cache_index", first_unit_); // still bound there
    set(rest, "fathom_cache_starts", first_unit_ + 1);
    bind_2d(first_unit_ + 1, targets_.starts);
    rest.draw(inputs, params);
    glDepthMask(GL_TRUE);
    glDisable(GL_DEPTH_TEST);
}

// A place for each cell that was missed; the query tells the card whether there was any.
void CachedView::reserve(int ages) {
    if (!changed_) glGenQueries(1, &changed_);
    glBindFramebuffer(GL_FRAMEBUFFER, targets_.reserved);
    constexpr GLuint none = glsl::cache_nowhere;
    const GLuint nowhere[] = {none, none, none, none};
    glClearBufferuiv(GL_COLOR, 0, nowhere);
    reserve_->use();
    set(*reserve_, "fathom_cache_bits", store_.size().bits);
    set(*reserve_, "fathom_cache_ages", ages);
    set_unsigned(*reserve_, "fathom_cache_frame", frame_);
    set(*reserve_, "fathom_cache_misses", 0);
    set(*reserve_, "fathom_cache_wishes", 1);
    set(*reserve_, "fathom_cache_tally", 2);
    set(*reserve_, "fathom_cache_index", 3);
    bind_2d(0, targets_.misses);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D_ARRAY, targets_.wishes);
    bind_2d(2, targets_.tally);
    glActiveTexture(GL_TEXTURE3);
    glBindTexture(GL_TEXTURE_3D, store_.index());
    bind_image(*reserve_, "fathom_cache_hash", 0, store_.hash(), GL_R32UI, GL_READ_WRITE);
    bind_image(*reserve_, "fathom_cache_keys", 1, store_.keys(), GL_RGBA32I, GL_READ_WRITE);
    bind_image(*reserve_, "fathom_cache_free", 2, store_.free(), GL_R32UI, GL_READ_WRITE);
    bind_image(*reserve_, "fathom_cache_counts", 3, store_.counts(), GL_R32UI, GL_READ_WRITE);
    bind_image(*reserve_, "fathom_cache_changed", 4, store_.changed(), GL_R32UI, GL_WRITE_ONLY);
    glBeginQuery(GL_ANY_SAMPLES_PASSED, changed_);
    draw_triangle();
    glEndQuery(GL_ANY_SAMPLES_PASSED);
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

// The corners of what was reserved. Nothing is drawn; the framebuffer is any of the size.
void CachedView::fill(const FrameInputs &inputs, const std::vector<ir::Param> &params) {
    const Program &program = programs_->fill;
    begin_picture();
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    targets_.draw_into(false);
    program.use();
    set_fields(program);
    set(program, "fathom_cache_places", first_unit_);
    bind_2d(first_unit_, targets_.places);
    bind_image(program, "fathom_cache_keys", 0, store_.keys(), GL_RGBA32I, GL_READ_WRITE);
    bind_image(program, "fathom_cache_pool", 1, store_.pool(), GL_R32F, GL_WRITE_ONLY);
    if (store_.wide())
        bind_image(program, "fathom_cache_wide", 2, store_.wide(), GL_RGBA32F, GL_WRITE_ONLY);
    program.draw(inputs, params);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    targets_.draw_into(true);
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

void CachedView::tint() {
    begin_picture();
    targets_.draw_into(false);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    tint_->use();
    set(*tint_, "fathom_cache_misses", 0);
    bind_2d(0, targets_.misses);
    draw_triangle();
    glDisable(GL_BLEND);
    targets_.draw_into(true);
}

// What the frame before the last one says of the next.
void CachedView::judge(bool weigh) {
    const std::optional<CacheCounts> counts = store_.counts_before();
    if (!counts) return;
    const double lost =
        static_cast<double>(counts->deleted) + counts->crowded + static_cast<double>(counts->full);
    too_small_ = too_small(growth_, lost, static_cast<double>(store_.cells())) &&
                 store_.size().bits < store_.size().max_bits;
    if (!weigh) return;
    judged(worth_,
           {static_cast<double>(counts->paid), static_cast<double>(counts->wasted),
            static_cast<double>(counts->left), static_cast<double>(counts->steps),
            counts->inserted > 0},
           programs_->prices);
    if (worth_.exact) store_.forget_counts(); // what the frames since then counted is of no use
}

// Twice as many cells an axis, and empty: it learns anew. Where there is no memory for that it
// stays as it was.
bool CachedView::grow() {
    CacheSize size = store_.size();
    ++size.bits;
    too_small_ = false;
    growth_ = {};
    worth_ = {};
    if (store_.make(size)) return true;
    size.max_bits = --size.bits;
    return store_.make(size);
}

bool CachedView::draw(const FrameInputs &inputs, const std::vector<ir::Param> &params,
                      const CacheSettings &settings) {
    if (!programs_ || !targets_.resize(inputs.width, inputs.height, programs_->pick)) return false;
    const bool stale = edited(params);
    looked_up_ = !settings.weigh || (!stale && looks_up_next(worth_));
    if (!looked_up_) {
        drew_exactly(worth_);
        targets_.clear_counts();
        store_.begin_frame();
        return draw_exactly(inputs, params);
    }
    if (too_small_ && !grow()) return drop(), false;
    const int ages = std::clamp(settings.max_age, 1, glsl::cache_ages);
    ++frame_;
    store_.begin_frame();
    begin_picture();
    renew(params, ages);
    draw_cached_frame(inputs, params, settings);
    reserve(ages);
    glBeginConditionalRender(changed_, GL_QUERY_WAIT); // the card waits, not this program
    fill(inputs, params);
    publish(); // the index that the next frame looks up in
    glEndConditionalRender();
    if (settings.weigh) drew_cached(worth_);
    store_.set_counts_aside();
    judge(settings.weigh);
    if (settings.show_misses) tint();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return true;
}

bool CachedView::draw_exactly(const FrameInputs &inputs, const std::vector<ir::Param> &params) {
    if (!programs_ || !targets_.resize(inputs.width, inputs.height, programs_->pick)) return false;
    begin_picture();
    targets_.draw_into(false);
    FrameInputs at_once = inputs;
    at_once.pass.turns = at_once.budget = programs_->exact.most_turns();
    programs_->exact.draw(at_once, params);
    targets_.draw_into(true);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return true;
}

void CachedView::forget() {
    if (store_.hash()) store_.clear();
    meanings_.clear();
}

} // namespace fathom::gl
