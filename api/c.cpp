// The C interface, over the C++ one alone.
#include <fathom/c.h>
#include <fathom/fathom.h>

#include <algorithm>
#include <cstring>
#include <limits>
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

int status_of(bool done) { return done ? FATHOM_OK : FATHOM_NO_MEMORY; }

} // namespace

int fathom_c_version(void) { return FATHOM_C_VERSION; }

fathom_result *fathom_compile_text(const char *name, const char *text, size_t length) {
    if (!name || (!text && length > 0)) return nullptr;
    return without_throwing(
        [&] { return result_of(compile_text(name, std::string_view(text ? text : "", length))); });
}

fathom_result *fathom_compile_file(const char *path) {
    if (!path) return nullptr;
    return without_throwing([&] { return result_of(compile_file(path)); });
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

size_t fathom_scene_param_count(const fathom_scene *scene) {
    return scene ? scene->value.params().size() : 0;
}
const char *fathom_scene_param_name(const fathom_scene *scene, size_t index) {
    const Param *param = param_at(scene, index);
    return param ? param->name.c_str() : "";
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

fathom_text *fathom_scene_shader(const fathom_scene *scene, const char *target) {
    if (!scene || !target) return nullptr;
    return without_throwing([&]() -> fathom_text * {
        ShaderOptions options;
        options.target = target;
        std::optional<Shader> shader = make_shader(scene->value, options);
        if (!shader) return nullptr;
        if (shader->words.empty()) return new fathom_text{std::move(shader->text)};
        std::string bytes(shader->words.size() * sizeof(shader->words[0]), '\0');
        std::memcpy(bytes.data(), shader->words.data(), bytes.size());
        return new fathom_text{std::move(bytes)};
    });
}
fathom_text *fathom_scene_yaml(const fathom_scene *scene) {
    if (!scene) return nullptr;
    return without_throwing([&] { return new fathom_text{export_yaml(scene->value)}; });
}
const char *fathom_text_bytes(const fathom_text *text) { return text ? text->value.c_str() : ""; }
size_t fathom_text_length(const fathom_text *text) { return text ? text->value.size() : 0; }
void fathom_text_free(fathom_text *text) { delete text; }

int fathom_scene_draw(const fathom_scene *scene, int width, int height, int samples, double time,
                      unsigned char *rgba) {
    if (!scene || !rgba || width < 1 || height < 1 || samples < 0) return FATHOM_BAD_ARGUMENT;
    try {
        PictureOptions options;
        options.width = width;
        options.height = height;
        options.samples = samples;
        options.time = time;
        const Picture picture = draw(scene->value, options);
        if (!picture.complete) return FATHOM_NO_MEMORY;
        std::ranges::copy(picture.rgba, rgba);
        return FATHOM_OK;
    } catch (const std::exception &) {
        return FATHOM_NO_MEMORY;
    }
}
