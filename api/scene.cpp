#include "api/impl.h"

#include "base/text.h"
#include "driver/image.h"
#include "driver/verdict.h"
#include "lang/format.h"
#include "lang/parse.h"

#include <fathom/parts.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace fathom::v1 {
namespace {

Param::Type type_of(ir::Type type) {
    switch (ir::components(type)) {
    case 2: return Param::Type::Vec2;
    case 3: return Param::Type::Vec3;
    case 4: return Param::Type::Vec4;
    }
    if (type == ir::Type::Bool) return Param::Type::Bool;
    return type == ir::Type::Int ? Param::Type::Int : Param::Type::Float;
}

Status status_of(ir::ProofStatus status) {
    switch (status) {
    case ir::ProofStatus::Proved: return Status::Proved;
    case ir::ProofStatus::Assumed: return Status::Assumed;
    case ir::ProofStatus::Estimated: return Status::Estimated;
    }
    return Status::Estimated;
}

std::vector<Param> params_of(const ir::Scene &scene) {
    std::vector<Param> all;
    for (const ir::Param &from : scene.params) {
        Param to{from.name,       from.label, type_of(from.type), from.is_color, from.has_range,
                 from.structural, from.value, from.initial,       from.lo,       from.hi};
        if (!from.has_range) {
            to.lo.fill(-std::numeric_limits<double>::infinity());
            to.hi.fill(std::numeric_limits<double>::infinity());
        }
        all.push_back(std::move(to));
    }
    return all;
}

// A single-precision box that holds the box.
Box outward(const ir::Box &box) {
    Box out;
    for (std::size_t i = 0; i < 3; ++i) {
        const float infinity = std::numeric_limits<float>::infinity();
        out.lo[i] = static_cast<float>(box.lo[i]);
        out.hi[i] = static_cast<float>(box.hi[i]);
        if (out.lo[i] > box.lo[i]) out.lo[i] = std::nextafter(out.lo[i], -infinity);
        if (out.hi[i] < box.hi[i]) out.hi[i] = std::nextafter(out.hi[i], infinity);
    }
    return out;
}

// Standard input was read to its end, so that another compilation takes its text from the first.
std::shared_ptr<const Origin> repeatable(std::shared_ptr<const Origin> origin,
                                         const Sources &sources) {
    if (!origin->is_file || origin->file != "-") return origin;
    std::uint32_t at = 0;
    while (at < sources.size() && sources[SourceId{at}].name != "<stdin>") ++at;
    if (at == sources.size()) return origin;
    auto text = std::make_shared<Origin>(*origin);
    text->is_file = false;
    text->name = "<stdin>";
    text->text = sources[SourceId{at}].text;
    return text;
}

CompileResult result_of(driver::Compilation compilation, std::shared_ptr<const Origin> origin) {
    CompileResult result;
    result.diagnostics = translated(compilation.diagnostics, compilation.sources);
    for (const auto &[file, stamp] : compilation.files) result.files.push_back(file);
    if (!compilation.unreadable.empty())
        result.diagnostics.push_back(
            sentence("unreadable", fmt::format("cannot read `{}`: {}", origin->file.string(),
                                               compilation.unreadable)));
    for (const std::string &error : compilation.usage_errors)
        result.diagnostics.push_back(sentence("usage", error));
    if (compilation.cancelled)
        result.diagnostics.push_back(sentence("cancelled", "the compilation was cancelled"));
    for (const typecheck::NameFact &name : compilation.names)
        result.names.push_back(
            {name.name, name.type, place_of(name.declared, compilation.sources)});
    result.dropped = compilation.diagnostics.dropped();
    const auto whole = std::make_shared<const driver::Compilation>(std::move(compilation));
    auto texts = std::make_shared<Texts::Impl>();
    texts->compilation = whole;
    result.texts = Texts(std::move(texts));
    if (!whole->good()) return result;
    auto impl = std::make_shared<Scene::Impl>();
    impl->origin = repeatable(std::move(origin), whole->sources);
    impl->scene = {whole, &whole->scene};
    impl->params = params_of(whole->scene);
    impl->facts = facts_of(whole->scene, whole->sources);
    impl->compilation = whole;
    result.scene.emplace(std::move(impl));
    return result;
}

// `path` as seen from the file `from`, both relative to the scene's text; nothing where it leads
// out of that folder.
std::optional<std::string> inside(const std::string &path, const std::string &from) {
    const std::filesystem::path whole =
        (std::filesystem::path(from).parent_path() / path).lexically_normal();
    if (whole.is_absolute() || whole.empty() || *whole.begin() == "..") return std::nullopt;
    return whole.generic_string();
}

Phase phase_of(driver::Phase phase) {
    switch (phase) {
    case driver::Phase::Read: return Phase::Read;
    case driver::Phase::Check: return Phase::Check;
    case driver::Phase::Prove: return Phase::Prove;
    case driver::Phase::Lower: return Phase::Lower;
    case driver::Phase::Done: return Phase::Done;
    }
    return Phase::Done;
}

driver::CompileOptions driver_options(const CompileOptions &options) {
    driver::CompileOptions to;
    to.include_folders = options.include_folders;
    for (const auto &[name, text] : options.definitions) to.overrides.push_back({name, text});
    to.strict_proof = options.strict_proof;
    if (options.times) to.times = {(*options.times)[0], (*options.times)[1]};
    to.cells = options.cells;
    if (const auto &cut = options.section) to.section = {{cut->axis, cut->from, cut->to}};
    to.flat_thickness = options.flat_thickness;
    to.fields = options.fields;
    if (options.cache.impl()) to.bounds = &options.cache.impl()->bounds;
    to.cancelled = options.cancelled;
    if (options.entered)
        to.entered = [told = options.entered](driver::Phase phase) { told(phase_of(phase)); };
    return to;
}

CompileResult failed(Diagnostic diagnostic);

CompileResult compile(std::shared_ptr<const Origin> origin) {
    driver::CompileOptions options = driver_options(origin->options);
    {
        auto lasting = std::make_shared<Origin>(*origin); // whose callers' functions may not last
        lasting->options.cancelled = nullptr;
        lasting->options.entered = nullptr;
        origin = std::move(lasting);
    }
    for (const auto &[name, value] : origin->options.limits)
        if (const std::string wrong = set_limit(options.limits, name + "=" + value); !wrong.empty())
            return failed(sentence("usage", wrong));
    if (origin->is_file) return result_of(driver::compile_file(origin->file, options), origin);
    if (origin->options.files)
        return result_of(driver::compile_loaded(origin->name, origin->text,
                                                loader_of(origin->options.files), options),
                         origin);
    return result_of(driver::compile_text(origin->name, origin->text, "", options), origin);
}

CompileResult failed(Diagnostic why) {
    CompileResult result;
    result.diagnostics.push_back(std::move(why));
    return result;
}

// A value as an expression of the language, to the last bit.
std::string expression_of(const Param &param, const std::vector<double> &value) {
    if (param.type == Param::Type::Bool) return value[0] != 0 ? "true" : "false";
    std::string list;
    for (double number : value) list += (list.empty() ? "" : ", ") + format_shortest(number);
    return value.size() == 1 ? list : "[" + list + "]";
}

// Why a param cannot have a value, or an empty text.
std::string refusal(const Param &param, const std::vector<double> &value) {
    if (value.size() != static_cast<std::size_t>(components(param.type)))
        return fmt::format("`{}` takes {} numbers, not {}", param.name, components(param.type),
                           value.size());
    for (std::size_t i = 0; i < value.size(); ++i) {
        if (!std::isfinite(value[i])) return fmt::format("`{}` takes finite numbers", param.name);
        if (value[i] < param.lo[i] || value[i] > param.hi[i])
            return fmt::format("{} is outside of the range {}..{} of `{}`",
                               format_shortest(value[i]), format_shortest(param.lo[i]),
                               format_shortest(param.hi[i]), param.name);
        if (param.type == Param::Type::Int && value[i] != std::floor(value[i]))
            return fmt::format("`{}` takes whole numbers, not {}", param.name,
                               format_shortest(value[i]));
    }
    return "";
}

} // namespace

Facts facts_of(const ir::Scene &scene, const Sources &sources) {
    const driver::Verdict verdict = driver::judge(scene);
    Facts facts;
    facts.lipschitz = verdict.lipschitz;
    facts.status = status_of(verdict.status);
    facts.exact = verdict.exact;
    if (scene.bounds.finite()) facts.bounds = outward(scene.bounds);
    facts.time_end = scene.render.time_end;
    facts.reads_time = scene.graph.reads(scene.graph.function(scene.distance).result).time;
    for (const ir::Axiom &axiom : scene.axioms) facts.axioms.push_back(axiom.says);
    for (const ir::TopLevel &top : scene.top_level) {
        const ir::ShapeFact &fact = scene.facts[top.shape.index];
        facts.shapes.push_back({place_of(top.span, sources), fact.lipschitz_sup,
                                status_of(fact.status), fact.kind == ir::FieldKind::Exact});
    }
    return facts;
}

typecheck::Loader loader_of(const FileProvider &provider) {
    using typecheck::LoadError;
    const auto identity = [](const std::string &path,
                             const std::string &from) -> std::variant<std::string, LoadError> {
        std::optional<std::string> found = inside(path, from);
        if (!found) return LoadError{LoadError::Reason::Outside, "leads out of the scene's folder"};
        return std::move(*found);
    };
    const auto bytes_of =
        [provider](const std::string &file) -> std::variant<std::string, LoadError> {
        std::optional<std::string> bytes = provider(file);
        if (!bytes) return LoadError{LoadError::Reason::NotFound, "no such file"};
        return std::move(*bytes);
    };
    const auto text =
        [=](const std::string &path,
            const std::string &from) -> std::variant<typecheck::LoadedText, LoadError> {
        const auto file = identity(path, from);
        if (auto *error = std::get_if<LoadError>(&file)) return *error;
        const std::string &name = std::get<std::string>(file);
        auto bytes = bytes_of(name);
        if (auto *error = std::get_if<LoadError>(&bytes)) return *error;
        return typecheck::LoadedText{name, name, std::move(std::get<std::string>(bytes))};
    };
    const auto asset = [=]<class Data, class... More>(std::variant<Data, LoadError> (*decode)(
                           std::string_view, typecheck::Room &, const More &...)) {
        return [=](const std::string &path, const std::string &from, typecheck::Room &room,
                   const More &...more) -> std::variant<Data, LoadError> {
            const auto file = identity(path, from);
            if (auto *error = std::get_if<LoadError>(&file)) return *error;
            const auto bytes = bytes_of(std::get<std::string>(file));
            if (auto *error = std::get_if<LoadError>(&bytes)) return *error;
            std::variant<Data, LoadError> data =
                decode(std::get<std::string>(bytes), room, more...);
            if (auto *made = std::get_if<Data>(&data)) made->name = path;
            return data;
        };
    };
    return {identity, text, asset(driver::decode_image), asset(driver::decode_grid)};
}

Scene::Scene(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
const std::vector<Param> &Scene::params() const { return impl_->params; }
const Facts &Scene::facts() const { return impl_->facts; }

CompileResult Scene::with(const std::map<std::string, std::vector<double>> &values) const {
    const auto work = [&]() -> CompileResult {
        auto changed = std::make_shared<Impl>(*impl_);
        const auto scene = std::make_shared<ir::Scene>(*impl_->scene);
        changed->scene = scene;
        bool rebuild = false;
        for (const auto &[name, value] : values) {
            const auto param = std::ranges::find(changed->params, name, &Param::name);
            if (param == changed->params.end())
                return failed(sentence("usage", fmt::format("there is no param `{}`", name)));
            if (const std::string why = refusal(*param, value); !why.empty())
                return failed(sentence("usage", why));
            rebuild = rebuild || param->structural;
            std::ranges::copy(value, param->value.begin());
            scene->params[static_cast<std::size_t>(param - changed->params.begin())].value =
                param->value;
        }
        if (!rebuild) {
            CompileResult result;
            result.scene.emplace(std::move(changed));
            return result;
        }
        Origin origin = *impl_->origin;
        for (const Param &param : changed->params)
            if (param.value != param.initial)
                origin.options.definitions[param.name] = expression_of(
                    param, {param.value.begin(), param.value.begin() + components(param.type)});
        CompileResult result = compile(std::make_shared<const Origin>(std::move(origin)));
        if (changed->part.empty() || !result.scene) return result;
        result.scene = part_of(*result.scene, changed->part);
        if (!result.scene)
            return failed(sentence(
                "usage", fmt::format("with these values there is no part `{}`", changed->part)));
        return result;
    };
    return guarded(work, failed);
}

CompileResult compile_file(const std::filesystem::path &file, const CompileOptions &options) {
    return guarded(
        [&] {
            if (options.files) {
                const std::string name = file.generic_string();
                const std::optional<std::string> text = options.files(name);
                if (!text)
                    return failed(sentence("unreadable",
                                           fmt::format("cannot read `{}`: no such file", name)));
                return compile_text(name, *text, options);
            }
            return compile(std::make_shared<const Origin>(Origin{true, file, "", "", options}));
        },
        failed);
}

CompileResult compile_text(std::string_view name, std::string_view text,
                           const CompileOptions &options) {
    return guarded(
        [&] {
            return compile(std::make_shared<const Origin>(
                Origin{false, "", std::string(name), std::string(text), options}));
        },
        failed);
}

std::optional<std::string> format_text(std::string_view text) { return format_text("", text).text; }

Formatted format_text(std::string_view name, std::string_view text) {
    return guarded(
        [&] {
            Sources sources;
            Diagnostics diagnostics;
            const SourceId source = sources.add(std::string(name), std::string(text));
            const lang::Ast ast = lang::parse(sources, source, diagnostics);
            Formatted formatted;
            if (!diagnostics.has_errors()) formatted.text = lang::format(sources, ast);
            formatted.diagnostics = translated(diagnostics, sources);
            formatted.dropped = diagnostics.dropped();
            formatted.texts = texts_of(std::move(sources));
            return formatted;
        },
        [](Diagnostic why) {
            Formatted formatted;
            formatted.diagnostics.push_back(std::move(why));
            return formatted;
        });
}

std::string verdict_json(const CompileResult &result) {
    if (!result.texts.impl() || !result.texts.impl()->compilation) return "";
    return guarded([&] { return driver::verdict_json(*result.texts.impl()->compilation); },
                   [](const Diagnostic &) { return std::string(); });
}

std::vector<LibraryEntry> library_entries() {
    return guarded(
        [] {
            std::vector<LibraryEntry> entries;
            for (typecheck::LibraryEntry &entry :
                 typecheck::library_entries(driver::standard_library()))
                entries.push_back({std::move(entry.name), std::move(entry.signature),
                                   std::move(entry.doc), std::move(entry.module),
                                   std::move(entry.file)});
            return entries;
        },
        [](const Diagnostic &) { return std::vector<LibraryEntry>(); });
}

ProofCache ProofCache::of_bytes(std::size_t most) {
    ProofCache cache;
    cache.impl_ = std::make_shared<Impl>(most);
    return cache;
}
std::size_t ProofCache::searches() const { return impl_ ? impl_->bounds.searches() : 0; }
std::size_t ProofCache::bytes() const { return impl_ ? impl_->bounds.bytes() : 0; }

std::string_view version() { return FATHOM_VERSION; }

} // namespace fathom::v1
