// The C interface, over the C++ one alone.
#include <fathom/c.h>
#include <fathom/fathom.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <new>

using namespace fathom::v1;

// A handle is the value that it stands for.
struct fathom_scene {
    Scene value;
};
struct fathom_result {
    std::vector<Diagnostic> diagnostics;
    std::optional<fathom_scene> scene;
};
struct fathom_field {
    Field value;
};
struct fathom_text {
    std::string value;
};
struct fathom_mesh {
    Mesh value;
};
struct fathom_options {
    CompileOptions value;
};
struct fathom_cache {
    ProofCache value;
};

static_assert(sizeof(Point) == 3 * sizeof(float) && sizeof(Box) == 6 * sizeof(float) &&
              sizeof(Interval) == 2 * sizeof(float)); // so arrays of floats are arrays of these

namespace {

// What `make` makes, or null where there is no memory for it.
template <class Make> auto without_throwing(Make make) noexcept -> decltype(make()) {
    try {
        return make();
    } catch (const std::exception &) {
        return nullptr;
    }
}

fathom_result *result_of(CompileResult made) {
    auto result = std::make_unique<fathom_result>();
    result->diagnostics = std::move(made.diagnostics);
    if (made.scene) result->scene.emplace(fathom_scene{std::move(*made.scene)});
    return result.release();
}

const Diagnostic *diagnostic_at(const fathom_result *result, size_t index) {
    return result && index < result->diagnostics.size() ? &result->diagnostics[index] : nullptr;
}

const Param *param_at(const fathom_scene *scene, size_t index) {
    return scene && index < scene->value.params().size() ? &scene->value.params()[index] : nullptr;
}

// What `work` comes to where it may have no memory.
template <class Work> int guarded_status(Work work) noexcept {
    try {
        work();
        return FATHOM_OK;
    } catch (const std::exception &) {
        return FATHOM_NO_MEMORY;
    }
}

std::function<bool(double)> progress_of(fathom_progress progress, void *own) {
    if (!progress) return {};
    return [=](double done) { return progress(done, own) != 0; };
}

const CompileOptions &options_of(const fathom_options *options) {
    static const CompileOptions none;
    return options ? options->value : none;
}

std::optional<Shader> shader_of(const fathom_scene *scene, const char *target) {
    ShaderOptions options;
    options.target = target;
    return make_shader(scene->value, options);
}

int status_of(bool done) { return done ? FATHOM_OK : FATHOM_NO_MEMORY; }

} // namespace

int fathom_c_version(void) { return FATHOM_C_VERSION; }

const char *fathom_version(void) {
    static const std::string text(version());
    return text.c_str();
}

fathom_options *fathom_options_make(void) {
    return without_throwing([] { return new fathom_options; });
}
void fathom_options_free(fathom_options *options) { delete options; }
int fathom_options_define(fathom_options *options, const char *name, const char *text) {
    if (!options || !name || !text) return FATHOM_BAD_ARGUMENT;
    return guarded_status([&] { options->value.definitions[name] = text; });
}
int fathom_options_include(fathom_options *options, const char *folder) {
    if (!options || !folder) return FATHOM_BAD_ARGUMENT;
    return guarded_status([&] { options->value.include_folders.emplace_back(folder); });
}
int fathom_options_limit(fathom_options *options, const char *name, const char *value) {
    if (!options || !name || !value) return FATHOM_BAD_ARGUMENT;
    return guarded_status([&] { options->value.limits[name] = value; });
}
int fathom_options_files(fathom_options *options, fathom_file_provider provider, void *own) {
    if (!options || !provider) return FATHOM_BAD_ARGUMENT;
    return guarded_status([&] {
        options->value.files = [=](const std::string &path) -> std::optional<std::string> {
            const std::unique_ptr<fathom_text> text(provider(path.c_str(), own));
            if (!text) return std::nullopt;
            return std::move(text->value);
        };
    });
}

fathom_cache *fathom_cache_make(size_t most_bytes) {
    return without_throwing([&] {
        return new fathom_cache{most_bytes > 0 ? ProofCache::of_bytes(most_bytes)
                                               : ProofCache::of_bytes()};
    });
}
void fathom_cache_free(fathom_cache *cache) { delete cache; }
size_t fathom_cache_searches(const fathom_cache *cache) {
    return cache ? cache->value.searches() : 0;
}
size_t fathom_cache_bytes(const fathom_cache *cache) { return cache ? cache->value.bytes() : 0; }
int fathom_options_cache(fathom_options *options, const fathom_cache *cache) {
    if (!options || !cache) return FATHOM_BAD_ARGUMENT;
    options->value.cache = cache->value;
    return FATHOM_OK;
}
int fathom_options_cancel(fathom_options *options, fathom_cancelled cancelled, void *own) {
    if (!options || !cancelled) return FATHOM_BAD_ARGUMENT;
    return guarded_status([&] { options->value.cancelled = [=] { return cancelled(own) != 0; }; });
}
int fathom_options_entered(fathom_options *options, fathom_entered entered, void *own) {
    if (!options || !entered) return FATHOM_BAD_ARGUMENT;
    return guarded_status([&] {
        options->value.entered = [=](Phase phase) { entered(static_cast<int>(phase), own); };
    });
}

fathom_result *fathom_compile_text_with(const char *name, const char *text, size_t length,
                                        const fathom_options *options) {
    if (!name || (!text && length > 0)) return nullptr;
    return without_throwing([&] {
        return result_of(
            compile_text(name, std::string_view(text ? text : "", length), options_of(options)));
    });
}
fathom_result *fathom_compile_file_with(const char *path, const fathom_options *options) {
    if (!path) return nullptr;
    return without_throwing([&] { return result_of(compile_file(path, options_of(options))); });
}
fathom_result *fathom_compile_text(const char *name, const char *text, size_t length) {
    return fathom_compile_text_with(name, text, length, nullptr);
}
fathom_result *fathom_compile_file(const char *path) {
    return fathom_compile_file_with(path, nullptr);
}

void fathom_result_free(fathom_result *result) { delete result; }

const fathom_scene *fathom_result_scene(const fathom_result *result) {
    return result && result->scene ? &*result->scene : nullptr;
}

size_t fathom_result_count(const fathom_result *result) {
    return result ? result->diagnostics.size() : 0;
}
int fathom_result_severity(const fathom_result *result, size_t index) {
    const Diagnostic *d = diagnostic_at(result, index);
    return d ? static_cast<int>(d->severity) : 0;
}
const char *fathom_result_code(const fathom_result *result, size_t index) {
    const Diagnostic *d = diagnostic_at(result, index);
    return d ? d->code.c_str() : "";
}
const char *fathom_result_message(const fathom_result *result, size_t index) {
    const Diagnostic *d = diagnostic_at(result, index);
    return d ? d->message.c_str() : "";
}
const char *fathom_result_help(const fathom_result *result, size_t index) {
    const Diagnostic *d = diagnostic_at(result, index);
    return d ? d->help.c_str() : "";
}
const char *fathom_result_file(const fathom_result *result, size_t index) {
    const Diagnostic *d = diagnostic_at(result, index);
    return d ? d->at.file.c_str() : "";
}
int fathom_result_line(const fathom_result *result, size_t index) {
    const Diagnostic *d = diagnostic_at(result, index);
    return d ? d->at.line : 0;
}
int fathom_result_column(const fathom_result *result, size_t index) {
    const Diagnostic *d = diagnostic_at(result, index);
    return d ? d->at.column : 0;
}

double fathom_scene_lipschitz(const fathom_scene *scene) {
    const double none = std::numeric_limits<double>::infinity();
    return scene ? scene->value.facts().lipschitz.value_or(none) : none;
}
int fathom_scene_proof(const fathom_scene *scene) {
    return static_cast<int>(scene ? scene->value.facts().status : Status::Estimated);
}
int fathom_scene_exact(const fathom_scene *scene) { return scene && scene->value.facts().exact; }
int fathom_scene_bounds(const fathom_scene *scene, float lo[3], float hi[3]) {
    if (!scene || !scene->value.facts().bounds) return 0;
    const Box &box = *scene->value.facts().bounds;
    std::ranges::copy(box.lo, lo);
    std::ranges::copy(box.hi, hi);
    return 1;
}

size_t fathom_scene_axiom_count(const fathom_scene *scene) {
    return scene ? scene->value.facts().axioms.size() : 0;
}
const char *fathom_scene_axiom(const fathom_scene *scene, size_t index) {
    return index < fathom_scene_axiom_count(scene) ? scene->value.facts().axioms[index].c_str()
                                                   : "";
}
double fathom_scene_time_end(const fathom_scene *scene) {
    return scene ? scene->value.facts().time_end : 0;
}

size_t fathom_scene_param_count(const fathom_scene *scene) {
    return scene ? scene->value.params().size() : 0;
}
const char *fathom_scene_param_name(const fathom_scene *scene, size_t index) {
    const Param *param = param_at(scene, index);
    return param ? param->name.c_str() : "";
}
const char *fathom_scene_param_label(const fathom_scene *scene, size_t index) {
    const Param *param = param_at(scene, index);
    return param ? param->label.c_str() : "";
}
int fathom_scene_param_type(const fathom_scene *scene, size_t index) {
    const Param *param = param_at(scene, index);
    return param ? static_cast<int>(param->type) : 0;
}
int fathom_scene_param_structural(const fathom_scene *scene, size_t index) {
    const Param *param = param_at(scene, index);
    return param && param->structural;
}
int fathom_scene_param_components(const fathom_scene *scene, size_t index) {
    const Param *param = param_at(scene, index);
    return param ? components(param->type) : 0;
}
void fathom_scene_param_value(const fathom_scene *scene, size_t index, double value[4]) {
    const Param *param = param_at(scene, index);
    std::ranges::copy(param ? param->value : std::array<double, 4>{}, value);
}
void fathom_scene_param_range(const fathom_scene *scene, size_t index, double lo[4], double hi[4]) {
    const Param *param = param_at(scene, index);
    std::ranges::copy(param ? param->lo : std::array<double, 4>{}, lo);
    std::ranges::copy(param ? param->hi : std::array<double, 4>{}, hi);
}
fathom_result *fathom_scene_with(const fathom_scene *scene, const char *name, const double *value,
                                 int components) {
    if (!scene || !name || !value || components < 1 || components > 4) return nullptr;
    return without_throwing([&] {
        return result_of(
            scene->value.with({{name, std::vector<double>(value, value + components)}}));
    });
}

fathom_field *fathom_field_make(const fathom_scene *scene, double time) {
    if (!scene) return nullptr;
    return without_throwing([&]() -> fathom_field * {
        std::optional<Field> field = make_field(scene->value, time);
        return field ? new fathom_field{std::move(*field)} : nullptr;
    });
}
void fathom_field_free(fathom_field *field) { delete field; }

int fathom_field_distances(const fathom_field *field, const float *points, size_t count,
                           float *distances) {
    if (!field || !points || !distances) return FATHOM_BAD_ARGUMENT;
    return status_of(field->value.distances({reinterpret_cast<const Point *>(points), count},
                                            {distances, count}));
}
int fathom_field_gradients(const fathom_field *field, const float *points, size_t count,
                           float *distances, float *gradients) {
    if (!field || !points || !distances || !gradients) return FATHOM_BAD_ARGUMENT;
    return status_of(field->value.gradients({reinterpret_cast<const Point *>(points), count},
                                            {distances, count},
                                            {reinterpret_cast<Point *>(gradients), count}));
}
int fathom_field_intervals(const fathom_field *field, const float *boxes, size_t count,
                           float *intervals) {
    if (!field || !boxes || !intervals) return FATHOM_BAD_ARGUMENT;
    return status_of(field->value.intervals({reinterpret_cast<const Box *>(boxes), count},
                                            {reinterpret_cast<Interval *>(intervals), count}));
}

int fathom_field_volume(const fathom_field *field, const float lo[3], const float hi[3],
                        const size_t counts[3], float *distances) {
    if (!field || !lo || !hi || !counts || !distances) return FATHOM_BAD_ARGUMENT;
    const Box box{{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
    std::size_t all = 1;
    for (int axis = 0; axis < 3; ++axis) {
        if (counts[axis] < 2 || all > std::numeric_limits<std::size_t>::max() / counts[axis] ||
            !(std::isfinite(lo[axis]) && std::isfinite(hi[axis]) && lo[axis] < hi[axis]))
            return FATHOM_BAD_ARGUMENT;
        all *= counts[axis];
    }
    return status_of(field->value.volume(box, {counts[0], counts[1], counts[2]}, {distances, all}));
}

fathom_text *fathom_scene_shader(const fathom_scene *scene, const char *target) {
    if (!scene || !target) return nullptr;
    return without_throwing([&]() -> fathom_text * {
        std::optional<Shader> shader = shader_of(scene, target);
        if (!shader) return nullptr;
        if (shader->words.empty()) return new fathom_text{std::move(shader->text)};
        std::string bytes(shader->words.size() * sizeof(shader->words[0]), '\0');
        std::memcpy(bytes.data(), shader->words.data(), bytes.size());
        return new fathom_text{std::move(bytes)};
    });
}
fathom_text *fathom_scene_reflection(const fathom_scene *scene, const char *target) {
    if (!scene || !target) return nullptr;
    return without_throwing([&]() -> fathom_text * {
        std::optional<Shader> shader = shader_of(scene, target);
        return shader ? new fathom_text{std::move(shader->reflection)} : nullptr;
    });
}
fathom_text *fathom_scene_yaml(const fathom_scene *scene) {
    if (!scene) return nullptr;
    return without_throwing([&] { return new fathom_text{export_yaml(scene->value)}; });
}
fathom_text *fathom_text_make(const char *bytes, size_t length) {
    if (!bytes && length > 0) return nullptr;
    return without_throwing(
        [&] { return new fathom_text{std::string(bytes ? bytes : "", length)}; });
}
const char *fathom_text_bytes(const fathom_text *text) { return text ? text->value.c_str() : ""; }
size_t fathom_text_length(const fathom_text *text) { return text ? text->value.size() : 0; }
void fathom_text_free(fathom_text *text) { delete text; }

int fathom_scene_draw_with(const fathom_scene *scene, int width, int height, int samples,
                           double time, fathom_progress progress, void *own, unsigned char *rgba) {
    constexpr int max_side = 65536;
    if (!scene || !rgba || width < 1 || height < 1 || width > max_side || height > max_side ||
        samples < 0 || !hold_at(scene->value.facts(), time))
        return FATHOM_BAD_ARGUMENT;
    bool cancelled = false;
    int status = FATHOM_OK;
    const int memory = guarded_status([&] {
        PictureOptions options;
        options.width = width;
        options.height = height;
        options.samples = samples;
        options.time = time;
        if (progress)
            options.progress = [&](double done) {
                cancelled = progress(done, own) == 0;
                return !cancelled;
            };
        const Picture picture = draw(scene->value, options);
        if (picture.complete)
            std::ranges::copy(picture.rgba, rgba);
        else
            status = cancelled ? FATHOM_CANCELLED : FATHOM_NO_MEMORY;
    });
    return memory != FATHOM_OK ? memory : status;
}
int fathom_scene_draw(const fathom_scene *scene, int width, int height, int samples, double time,
                      unsigned char *rgba) {
    return fathom_scene_draw_with(scene, width, height, samples, time, nullptr, nullptr, rgba);
}

fathom_mesh *fathom_scene_mesh(const fathom_scene *scene, double tolerance, int resolution,
                               double time, fathom_progress progress, void *own) {
    if (!scene) return nullptr;
    return without_throwing([&] {
        MeshOptions options;
        options.tolerance = tolerance;
        options.resolution = resolution;
        options.time = time;
        options.progress = progress_of(progress, own);
        return new fathom_mesh{make_mesh(scene->value, options)};
    });
}
void fathom_mesh_free(fathom_mesh *mesh) { delete mesh; }
int fathom_mesh_status(const fathom_mesh *mesh) {
    return static_cast<int>(mesh ? mesh->value.status : MeshStatus::Empty);
}
const char *fathom_mesh_message(const fathom_mesh *mesh) {
    return mesh ? mesh->value.message.c_str() : "";
}
size_t fathom_mesh_vertex_count(const fathom_mesh *mesh) {
    return mesh ? mesh->value.vertices.size() : 0;
}
const float *fathom_mesh_vertices(const fathom_mesh *mesh) {
    return mesh && !mesh->value.vertices.empty() ? mesh->value.vertices[0].data() : nullptr;
}
const float *fathom_mesh_normals(const fathom_mesh *mesh) {
    return mesh && !mesh->value.normals.empty() ? mesh->value.normals[0].data() : nullptr;
}
size_t fathom_mesh_triangle_count(const fathom_mesh *mesh) {
    return mesh ? mesh->value.triangles.size() : 0;
}
const uint32_t *fathom_mesh_triangles(const fathom_mesh *mesh) {
    return mesh && !mesh->value.triangles.empty() ? mesh->value.triangles[0].data() : nullptr;
}
size_t fathom_mesh_undecided(const fathom_mesh *mesh) {
    return mesh ? mesh->value.undecided_cells : 0;
}
fathom_text *fathom_mesh_file(const fathom_mesh *mesh, const char *suffix) {
    if (!mesh || !suffix) return nullptr;
    return without_throwing([&]() -> fathom_text * {
        const std::optional<MeshFormat> format = mesh_format(std::string("mesh") + suffix);
        if (!format) return nullptr;
        std::string bytes = mesh_file(mesh->value, *format);
        return bytes.empty() ? nullptr : new fathom_text{std::move(bytes)};
    });
}
