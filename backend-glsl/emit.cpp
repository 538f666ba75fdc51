// Puts the parts together for each target, has the result checked, and says what a host must set.
#include "backend-glsl/emit.h"

#include "backend-glsl/assemble.h"
#include "backend-glsl/html.h"
#include "backend-glsl/marcher.h"
#include "backend-glsl/params.h"
#include "backend-glsl/prune.h"
#include "backend-glsl/roll.h"
#include "backend-glsl/template.h"
#include "backend-glsl/validate.h"
#include "base/encode.h"
#include "base/text.h"
#include "ir/lower/lower.h"
#include "ir/passes/operations.h"
#include "ir/view.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fathom::glsl {

namespace {

constexpr std::array<std::pair<Target, const char *>, 7> targets{
    {{Target::Glsl450, "glsl450"},
     {Target::Glsl330, "glsl330"},
     {Target::Es300, "es300"},
     {Target::Shadertoy, "shadertoy"},
     {Target::GlslViewer, "glslviewer"},
     {Target::Spirv, "spirv"},
     {Target::Html, "html"}}};

constexpr double cheap_field = 150; // operations

bool is_es(Target t) { return t == Target::Es300 || t == Target::Html || t == Target::Shadertoy; }

// Whether uniforms are set by a host of ours or a kindred one, or everything stands in the text.
bool is_hosted(Target t) { return t != Target::Shadertoy && t != Target::GlslViewer; }

std::string vector_text(const ir::Triple &v) {
    std::string text = "vec3(";
    for (std::size_t i = 0; i < 3; ++i)
        text += (i ? ", " : "") + float_literal(static_cast<float>(v[i]));
    return text + ")";
}

std::string param_value(const ir::Param &param) {
    return literal({param.type, {param.value[0], param.value[1], param.value[2], param.value[3]}});
}

class Emitter {
  public:
    Emitter(const ir::Scene &scene, const std::optional<Rolled> &loops, const Options &options,
            Diagnostics &diagnostics)
        : scene_(loops ? loops->scene : scene), options_(options),
          diagnostics_(diagnostics), module_{scene_, options} {
        if (loops) module_.results = loops->results;
    }

    Emitter(const ir::Scene &scene, const std::map<std::uint32_t, ir::NodeId> &results,
            const Options &options, Diagnostics &diagnostics)
        : Emitter(scene, std::nullopt, options, diagnostics) {
        module_.results = results;
    }

    void use(const PrunePlan &plan) { module_.pruned = plan.loops; }
    void use_far_cells() { far_cells_ = true; }
    void ask_less_outside() { module_.around = static_cast<bool>(scene_.endless); }

    // What lists the rows of one grid's cells.
    PruneKernel run_kernel(const PrunedLoop &loop) {
        const std::vector<ir::FunctionId> wanted{loop.value, loop.start, loop.joined, loop.radius};
        const SceneText scene = assemble_functions(module_, wanted);
        const auto name = [&](ir::FunctionId id) { return module_.functions.at(id.index); };
        Output output = gathered();
        PruneKernel kernel{"", output.tables, output.uniforms, loop.rows, output.reads_time};
        const std::string text = "#version 430 core\n" + written_by() + "\n" + scene_inputs() +
                                 scene.tables + scene.functions +
                                 prune_kernel(loop, {name(loop.value), name(loop.start),
                                                     name(loop.joined), name(loop.radius)});
        if (check(text, output, Stage::Compute)) kernel.text = text;
        return kernel;
    }

    // What makes the far cells of a scene that reads nothing but tables, params and the time.
    PruneKernel run_far() {
        const SceneText scene = assemble_functions(module_, {&scene_.distance, 1});
        Output output = gathered();
        if (!output.images.empty() || !output.grids.empty()) return {};
        PruneKernel kernel{"", output.tables, output.uniforms, 0, output.reads_time};
        const std::string text = "#version 430 core\n" + written_by() + "\n" + scene_inputs() +
                                 prune_look_up(scene_.bounds) + scene.tables + scene.functions +
                                 far_kernel(module_.functions.at(scene_.distance.index));
        if (check(text, output, Stage::Compute)) kernel.text = text;
        return kernel;
    }

    // The fields that a text with the noise cache keeps, as a text of their own that ends in
    // `tail`.
    Output run_fields(const std::vector<std::uint32_t> &caches) {
        std::vector<ir::FunctionId> fields;
        for (std::uint32_t id : caches) fields.push_back(scene_.graph.cache(ir::CacheId{id}).field);
        const SceneText scene = assemble_functions(module_, fields);
        std::vector<KeptText> kept;
        for (std::size_t i = 0; i < caches.size(); ++i)
            kept.push_back({module_.functions.at(fields[i].index),
                            scene_.graph[scene_.graph.function(fields[i]).result].type,
                            scene_.graph.cache(ir::CacheId{caches[i]}).cell,
                            scene_.caches[caches[i]].slope});
        Output output = gathered();
        output.text = "#version 420 core\n" + written_by() + "\n" + scene_inputs() + scene.tables +
                      scene.functions + cache_fill(kept);
        if (!check(output.text, output)) return {};
        return output;
    }

    Output run() {
        const SceneText scene =
            assemble(module_, !options_.field_only && options_.instruments != Instruments::Probe);
        Output output = gathered();
        for (const auto &[id, field] : module_.kept) output.kept.push_back(kept_field(id));
        const Target target = options_.target;
        if ((!module_.images.empty() || !module_.grids.empty()) &&
            (!is_hosted(target) || target == Target::Html)) {
            diagnostics_.add(Code::Unsupported, {},
                             std::string("images and grids cannot be put into a text for `") +
                                 target_name(target) + "`");
            return {};
        }

        std::string text = options_.field_only ? field_text(scene) : picture_text(scene);
        if (!check(text, output)) return {};
        if (!module_.kept.empty() &&
            (!check(with_cache(text), output) || !check(with_cache(text, cache_learns), output)))
            return {};
        if (target == Target::Spirv) {
            output.text.clear();
        } else if (target == Target::Html && !options_.field_only) {
            output.text = html_page(scene_, options_, output.uniforms, text);
        } else {
            output.text = std::move(text);
        }
        return output;
    }

  private:
    Output gathered() const {
        Output output;
        output.tables = module_.texels;
        output.reads_time = module_.reads_time;
        for (const auto &[index, name] : module_.params)
            if (!is_fixed(scene_.params[index]))
                output.uniforms.push_back({name, scene_.params[index].type, index, -1});
        for (const auto &[index, name] : module_.images) output.images.push_back({name, index});
        for (const auto &[index, name] : module_.grids) output.grids.push_back({name, index});
        return output;
    }

    // A field's meaning is all that its own text says, and the data that the text only names.
    KeptField kept_field(std::uint32_t id) const {
        Options plain;
        Module alone{scene_, plain};
        alone.results = module_.results;
        const ir::FunctionId field = scene_.graph.cache(ir::CacheId{id}).field;
        const SceneText text = assemble_functions(alone, {&field, 1});
        KeptField kept;
        kept.cache = id;
        kept.wide = module_.kept.at(id).type != ir::Type::Float;
        kept.meaning = 14695981039346656037u; // FNV-1a, 64 bits
        const auto mix = [&](const void *data, std::size_t size) {
            for (std::size_t i = 0; i < size; ++i)
                kept.meaning =
                    (kept.meaning ^ static_cast<const unsigned char *>(data)[i]) * 1099511628211u;
        };
        mix(text.tables.data(), text.tables.size());
        mix(text.functions.data(), text.functions.size());
        mix(&module_.kept.at(id).cell, sizeof(double));
        for (const auto &[index, name] : alone.images) {
            const ir::ImageData &image = scene_.images[index];
            mix(&image.width, sizeof image.width);
            mix(image.rgba.data(), image.rgba.size() * sizeof(float));
        }
        for (const auto &[index, name] : alone.grids) {
            const ir::GridData &grid = scene_.grids[index];
            mix(grid.size.data(), sizeof grid.size);
            mix(grid.values.data(), grid.values.size() * sizeof(float));
        }
        for (const auto &[index, name] : alone.params) kept.params.push_back(index);
        return kept;
    }

    // -- a whole picture
    // -----------------------------------------------------------------------------------------------

    std::string picture_text(const SceneText &scene) {
        const ir::View view = ir::view_of(scene_, options_.time, 16.0 / 9.0);
        const ir::Frame frame = ir::frame_of(scene_, view, 1080);
        MarcherOptions marcher;
        marcher.boxed = frame.boxed;
        marcher.steep = frame.steep;
        marcher.reaches = frame.steep && scene_.reach;
        marcher.cheap =
            scene_.distance &&
            ir::operations(scene_.graph, module_.result_of(scene_.distance)) <= cheap_field;
        marcher.skip_shading = scene_.lighting.skip;
        marcher.local_normals = scene.local_normals;
        marcher.lights = scene.lights;
        marcher.max_steps = scene_.render.max_steps;
        marcher.epsilon = scene_.render.epsilon;
        marcher.far = scene_.render.far;
        marcher.radius = frame.radius;
        marcher.center = vector_text(frame.center);
        marcher.lo = vector_text(frame.lo);
        marcher.hi = vector_text(frame.hi);
        marcher.zero = zero();
        marcher.pick = options_.instruments == Instruments::Pick;
        marcher.kept = !module_.kept.empty();
        marcher.far_cells = far_cells_;
        marcher.around = module_.around;
        const std::string declared = inputs(view);
        std::string before = head() + defaults() + declared;
        if (!module_.pruned.empty()) before += prune_look_up(scene_.bounds);
        before += scene.tables + scene.functions;
        if (far_cells_) before += far_look_up(marcher.boxed ? "fathom_off(p)" : "0.0");
        if (options_.instruments == Instruments::Probe) return before + probe_text(marcher);
        return before + hit_function() + scene.looks + marcher_text(marcher) + entry(view);
    }

    std::string hit_function() const {
        if (scene_.hit && options_.part_stride > 0)
            return fill(
                "\nint fathom_part;\n\n"
                "// A marked hit's paint is code + stride * part; the last code is no paint.\n"
                "Hit fathom_hit(vec3 p) {\n    Hit s = fathom_marked_hit(p);\n"
                "    fathom_part = s.paint < 0 ? 0 : s.paint / $STRIDE;\n"
                "    s.paint = s.paint < 0 ? -1 : s.paint - fathom_part * $STRIDE;\n"
                "    if (s.paint == $STRIDE - 1) s.paint = -1;\n"
                "    return s;\n}\n",
                {{"STRIDE", std::to_string(options_.part_stride)}});
        if (options_.instruments == Instruments::Pick && scene_.hit)
            return "\nconst int fathom_part = 0;\n";
        if (scene_.hit) return "";
        const std::string part =
            options_.instruments == Instruments::Pick ? "\nconst int fathom_part = 0;\n" : "";
        return part + "\nHit fathom_hit(vec3 p) {\n    return Hit(sdf(p), -1, p, vec4(0.0));\n}\n";
    }

    // An int that is 0 whenever the shader runs, though the compiler does not know.
    std::string zero() const {
        switch (options_.target) {
        case Target::Shadertoy: return "min(iFrame, 0)";
        case Target::GlslViewer: return "int(min(u_time, 0.0))";
        case Target::Glsl450:
        case Target::Glsl330:
        case Target::Es300:
        case Target::Spirv:
        case Target::Html: break;
        }
        return "min(fathom_mode, 0)";
    }

    std::string written_by() const { return comment(options_.title + ": written by fathom."); }

    std::string head() const {
        std::string text;
        switch (options_.target) {
        case Target::Glsl450:
        case Target::Glsl330:
        case Target::GlslViewer:
            text = !module_.pruned.empty() ? "#version 430 core\n"
                   : module_.kept.empty()  ? "#version 330 core\n"
                                           : "#version 420 core\n";
            break;
        case Target::Es300:
        case Target::Html: text = "#version 300 es\n"; break;
        case Target::Spirv: text = "#version 450 core\n"; break;
        case Target::Shadertoy: break;
        }
        text += written_by();
        if (options_.field_only) {
            text += "// For a renderer of one's own: a step of sdf(p) never passes a surface.\n";
        } else if (options_.target == Target::Shadertoy) {
            text += "// For shadertoy.com: paste it into the Image tab. Drag to look around.\n";
        } else if (options_.target == Target::GlslViewer) {
            text += "// For glslViewer: glslViewer FILE.frag. Drag to look around.\n";
        } else if (options_.target == Target::Html) {
            text += "// The page around this text draws one triangle, and sets the uniforms.\n";
        } else if (options_.target == Target::Es300) {
            text += "// Draw one triangle over the picture.\n";
        } else {
            text += "// Draw one triangle over the picture. The uniforms' defaults show the "
                    "scene's first view.\n";
        }
        if (options_.instruments == Instruments::None)
            text += fixed_params_comment(scene_, [&](Span span) {
                return options_.place ? for_comment(options_.place(span)) : std::string();
            });
        if (options_.target == Target::Es300 || options_.target == Target::Html)
            text += "precision highp float;\nprecision highp int;\nprecision highp "
                    "sampler2D;\nprecision highp sampler3D;\n";
        return text;
    }

    // A host of ours makes the text anew where such a param moves; any other keeps this one.
    bool is_fixed(const ir::Param &param) const {
        return param.structural && options_.instruments == Instruments::None;
    }

    // Of the uniforms declared so far, where the declarations cannot say it.
    std::string defaults() const {
        return options_.target == Target::Es300 && options_.instruments == Instruments::None
                   ? defaults_comment(declared_)
                   : "";
    }

    std::string uniform(const std::string &type, const std::string &name, const std::string &value,
                        const std::string &range = "") {
        declared_.push_back({type, name, value, range});
        if (options_.target == Target::Spirv)
            return "layout(location = " + std::to_string(location_++) + ") uniform " + type + " " +
                   name + ";\n";
        const bool es = is_es(options_.target) || options_.instruments != Instruments::None;
        return "uniform " + type + " " + name + (es || value.empty() ? "" : " = " + value) + ";\n";
    }

    std::string sampler(const std::string &type, const std::string &name) {
        if (options_.target == Target::Spirv)
            return "layout(binding = " + std::to_string(binding_++) + ") uniform " + type + " " +
                   name + ";\n";
        return "uniform " + type + " " + name + ";\n";
    }

    // What does not belong to the camera: data that the scene's functions read.
    std::string scene_inputs() {
        std::string text;
        if (options_.target == Target::Shadertoy || options_.target == Target::GlslViewer) {
            if (module_.reads_time && options_.field_only && options_.target == Target::GlslViewer)
                text += "uniform float u_time;\n"; // which a picture's inputs declare
            if (module_.reads_time)
                text += std::string("#define fathom_time ") +
                        (options_.target == Target::Shadertoy ? "iTime\n" : "u_time\n");
        } else if (module_.reads_time || !options_.field_only) {
            text += uniform("float", "fathom_time", float_literal(options_.time));
        }
        for (const auto &[index, name] : module_.params) {
            const ir::Param &param = scene_.params[index];
            const std::string value = param_value(param), type = glsl_type(param.type);
            if (!param.label.empty() && options_.instruments == Instruments::None)
                text += comment(param.label);
            if (is_hosted(options_.target) && !is_fixed(param))
                text += uniform(type, name, value, range_text(param));
            else
                text += "const " + type + " " + name + " = " + value + ";\n";
        }
        if (!module_.texels.empty())
            text += "// A texture buffer of RGBA32F texels: the file written beside this text.\n" +
                    sampler("samplerBuffer", "fathom_tables");
        for (const auto &[index, name] : module_.images) text += sampler("sampler2D", name);
        for (const auto &[index, name] : module_.grids) text += sampler("sampler3D", name);
        return text;
    }

    std::string inputs(const ir::View &view) {
        const ir::Triple sun = scene_.lights.empty()
                                   ? ir::lights_of(scene_, options_.time, view)[0].position
                                   : ir::Triple{0, 1, 0};
        std::string text = "\n";
        struct Input {
            const char *type, *name;
            std::string value;
        };
        const Input all[] = {{"vec2", "fathom_resolution", "vec2(1280.0, 720.0)"},
                             {"vec2", "fathom_offset", "vec2(0.5)"},
                             {"vec3", "fathom_origin", vector_text(view.origin)},
                             {"vec3", "fathom_right", vector_text(view.right)},
                             {"vec3", "fathom_up", vector_text(view.up)},
                             {"vec3", "fathom_forward", vector_text(view.forward)},
                             {"float", "fathom_extent", float_literal(view.extent)},
                             {"float", "fathom_focus", float_literal(view.focus)},
                             {"int", "fathom_orthographic", view.orthographic ? "1" : "0"},
                             {"vec3", "fathom_sun", vector_text(sun)},
                             {"int", "fathom_mode", "0"}};
        if (is_hosted(options_.target)) {
            for (const Input &i : all) text += uniform(i.type, i.name, i.value);
            return text + scene_inputs();
        }
        if (options_.target == Target::GlslViewer)
            text += "uniform vec2 u_resolution;\nuniform vec3 u_camera;\nuniform float u_time;\n\n";
        // The scene's camera may be turned about its target; these are set before anything is
        // drawn.
        for (const Input &i : all) {
            const std::string name = i.name;
            const bool fixed = name == "fathom_extent" || name == "fathom_focus" ||
                               name == "fathom_orthographic" || name == "fathom_sun" ||
                               name == "fathom_mode";
            if (fixed)
                text += std::string("const ") + i.type + " " + name + " = " + i.value + ";\n";
            else if (name != "fathom_offset")
                text += std::string(i.type) + " " + name + ";\n";
        }
        return text + scene_inputs();
    }

    // Sets the camera to look along `back` (reversed) at the first view's target; GLSL.
    static std::string turned_camera(const ir::View &view, const std::string &back) {
        ir::Triple target;
        for (std::size_t i = 0; i < 3; ++i)
            target[i] = view.origin[i] + view.focus * view.forward[i];
        return "    vec3 back = " + back +
               ";\n    fathom_forward = -back;\n"
               "    fathom_right = normalize(vec3(back.z, 0.0, -back.x));\n"
               "    fathom_up = cross(fathom_right, fathom_forward);\n"
               "    fathom_origin = " +
               vector_text(target) + " + fathom_focus * back;\n";
    }

    std::string entry(const ir::View &view) const {
        const std::string first = "    fathom_origin = " + vector_text(view.origin) +
                                  ";\n    fathom_right = " + vector_text(view.right) +
                                  ";\n    fathom_up = " + vector_text(view.up) +
                                  ";\n    fathom_forward = " + vector_text(view.forward) + ";\n";
        ir::Triple away = view.forward;
        for (double &c : away) c = -c;
        if (options_.target == Target::Shadertoy) {
            return "\nvoid mainImage(out vec4 fragColor, in vec2 fragCoord) {\n"
                   "    fathom_resolution = iResolution.xy;\n" +
                   first +
                   "    if (iMouse.x > 0.0) {\n"
                   "    vec2 turn = (iMouse.xy / iResolution.xy - 0.5) * vec2(6.2831853, 3.0);\n"
                   "    float around = atan(" +
                   float_literal(away[0]) + ", " + float_literal(away[2]) +
                   ") - turn.x;\n"
                   "    float above = clamp(-turn.y, -1.5, 1.5);\n" +
                   turned_camera(
                       view,
                       "vec3(cos(above) * sin(around), sin(above), cos(above) * cos(around))") +
                   "    }\n"
                   "    fragColor = fathom_picture(vec2(fragCoord.x, iResolution.y - "
                   "fragCoord.y));\n}\n";
        }
        if (options_.target == Target::GlslViewer) {
            return "\nout vec4 fathom_color;\n\nvoid main() {\n"
                   "    fathom_resolution = u_resolution;\n" +
                   first + "    if (length(u_camera.xz) > 0.0) {\n" +
                   turned_camera(view, "normalize(u_camera)") +
                   "    }\n"
                   "    fathom_color = fathom_picture(vec2(gl_FragCoord.x, u_resolution.y - "
                   "gl_FragCoord.y));\n}\n";
        }
        const bool kept = !module_.kept.empty();
        return std::string("\n") +
               (options_.target == Target::Spirv || options_.instruments == Instruments::Pick ||
                        kept
                    ? "layout(location = 0) "
                    : "") +
               "out vec4 fathom_color;\n" + (kept ? cache_outputs() : "") +
               "\nvoid main() {\n"
               "    vec2 place = vec2(gl_FragCoord.x, fathom_resolution.y - gl_FragCoord.y);\n"
               "    fathom_color = fathom_picture(place + fathom_offset - 0.5);\n" +
               (kept ? cache_output() : "") + "}\n";
    }

    // -- the field alone
    // -----------------------------------------------------------------------------------------------

    std::string field_text(const SceneText &scene) {
        double bound = 0;
        for (const ir::TopLevel &top : scene_.top_level)
            if (top.shape.index < scene_.facts.size())
                bound = std::max(bound, scene_.facts[top.shape.index].lipschitz_sup);
        const std::string declared = scene_inputs();
        std::string text = head() + defaults() + "\n" + declared;
        text += "\n// The largest slope of a shape's field before it was divided by it; that of "
                "sdf is at most 1.\n"
                "const float sdf_lipschitz = " +
                float_literal(bound > 0 ? bound : 1) + ";\n";
        text += scene.tables + scene.functions + hit_function() + scene.looks;
        text += "\n// What p, on or near a surface with that normal, is made of.\n"
                "fathom_Material material(vec3 p, vec3 normal) {\n    return "
                "fathom_material(fathom_hit(p), normal);\n}\n";
        return text;
    }

    // -- the check
    // -------------------------------------------------------------------------------------------------------

    bool check(const std::string &text, Output &output, Stage stage = Stage::Fragment) {
        std::string before, after;
        if (options_.target == Target::Shadertoy)
            before = "#version 300 es\nprecision highp float;\nprecision highp int;\nuniform vec3 "
                     "iResolution;\nuniform float iTime;\n"
                     "uniform vec4 iMouse;\nuniform int iFrame;\n";
        if (options_.field_only) {
            after = "\nout vec4 fathom_color;\nvoid main() {\n    fathom_color = "
                    "vec4(material(vec3(sdf(vec3(0.0))), vec3(1.0)).diffuse, 1.0);\n}\n";
            if (options_.target == Target::Spirv) after.replace(1, 3, "layout(location = 0) out");
        } else if (options_.target == Target::Shadertoy) {
            after = "\nout vec4 fathom_color;\nvoid main() {\n    mainImage(fathom_color, "
                    "gl_FragCoord.xy);\n}\n";
        }
        const std::string whole = before + text + after;
        std::optional<Complaint> complaint;
        if (options_.target == Target::Spirv) {
            SpirV spirv = to_spirv(whole);
            output.words = std::move(spirv.words);
            complaint = spirv.complaint;
        } else {
            complaint = validate(whole, stage);
        }
        if (!complaint) return true;
        Diagnostic &d = diagnostics_.add(Code::ShaderInvalid, {},
                                         "the `" + std::string(target_name(options_.target)) +
                                             "` text is not valid: " + complaint->message);
        const int line = complaint->line - static_cast<int>(std::ranges::count(before, '\n'));
        if (line > 0)
            d.note("line " + std::to_string(line) + " of the text: " + nth_line(text, line));
        d.note("this is a fault of the compiler, not of the scene");
        return false;
    }

    static std::string nth_line(const std::string &text, int line) {
        std::size_t begin = 0;
        for (int i = 1; i < line && begin != std::string::npos; ++i)
            begin = text.find('\n', begin) + 1;
        return text.substr(begin, text.find('\n', begin) - begin);
    }

    const ir::Scene &scene_;
    const Options &options_;
    Diagnostics &diagnostics_;
    Module module_;
    std::vector<Default> declared_; // uniforms, in order
    int location_ = 0, binding_ = 0;
    bool far_cells_ = false;
};

// The box of a scene's cells: larger than its bounds by what shading looks around.
Pruning grid_of(const ir::Scene &scene) {
    Pruning grid;
    double diagonal = 0;
    for (std::size_t i = 0; i < 3; ++i)
        diagonal +=
            (scene.bounds.hi[i] - scene.bounds.lo[i]) * (scene.bounds.hi[i] - scene.bounds.lo[i]);
    const double by = 0.05 * std::sqrt(diagonal); // occlusion: 0.08 of half the diagonal
    for (std::size_t i = 0; i < 3; ++i) {
        grid.lo[i] = scene.bounds.lo[i] - by;
        grid.hi[i] = scene.bounds.hi[i] + by;
    }
    return grid;
}

} // namespace

std::optional<Target> target_by_name(std::string_view name) {
    for (const auto &[target, text] : targets)
        if (name == text) return target;
    return std::nullopt;
}

const char *target_name(Target target) {
    for (const auto &[known, text] : targets)
        if (known == target) return text;
    return "";
}

CachePasses emit_cache_passes(const ir::Scene &scene, const Options &options,
                              Diagnostics &diagnostics) {
    std::vector<std::uint32_t> caches;
    for (const KeptField &field : emit(scene, options, diagnostics).kept)
        caches.push_back(field.cache);
    if (caches.empty()) return {};
    Options direct = options;
    direct.noise_cache = false;
    const std::optional<Rolled> loops = rolled(scene);
    return {cache_reserve(), cache_publish(), cache_sweep(), cache_tint(),
            Emitter(scene, loops, direct, diagnostics).run_fields(caches)};
}

std::vector<int> prunable_rows(const ir::Scene &scene) {
    const std::optional<Rolled> loops = rolled(scene);
    const auto plan = loops ? plan_pruning(loops->scene, loops->results) : plan_pruning(scene, {});
    std::vector<int> rows;
    if (plan)
        for (const PrunedLoop &loop : plan->grids) rows.push_back(loop.rows);
    return rows;
}

Output emit(const ir::Scene &scene, const Options &options, Diagnostics &diagnostics) {
    std::optional<Rolled> loops = rolled(scene);
    if (loops) loops->scene.reach = {}; // it would have the lists in full
    const std::map<std::uint32_t, ir::NodeId> results =
        loops ? loops->results : std::map<std::uint32_t, ir::NodeId>{};
    std::optional<PrunePlan> plan =
        options.pruning ? plan_pruning(loops ? loops->scene : scene, results) : std::nullopt;
    if (plan) plan->scene.reach = {};
    if (!plan) return Emitter(scene, loops, options, diagnostics).run();
    Pruning pruning = grid_of(scene);
    Options direct = options;
    direct.noise_cache = false;
    for (const PrunedLoop &loop : plan->grids) {
        pruning.kernels.push_back(
            Emitter(plan->scene, results, direct, diagnostics).run_kernel(loop));
        if (pruning.kernels.back().text.empty()) return {};
    }
    if (options.far_cells) {
        Emitter cells(plan->scene, results, direct, diagnostics);
        cells.use(*plan);
        pruning.far = cells.run_far();
    }
    if (diagnostics.has_errors()) return {};
    Emitter picture(plan->scene, results, options, diagnostics);
    picture.use(*plan);
    if (options.far_cells) picture.ask_less_outside();
    if (!pruning.far.text.empty()) picture.use_far_cells();
    Output output = picture.run();
    if (!output.text.empty()) output.pruning = std::move(pruning);
    return output;
}

} // namespace fathom::glsl
