#include "api/impl.h"

#include "save-format/save_format.h"

namespace fathom::v1 {

Imported import_yaml(std::string_view name, std::string_view yaml, const ImportOptions &options) {
    return guarded(
        [&] {
            Sources sources;
            Diagnostics diagnostics;
            const SourceId source = sources.add(std::string(name), std::string(yaml));
            save::ImportOptions to;
            to.strict = options.strict;
            to.asset_prefix = options.asset_prefix;
            if (!options.scene.empty())
                driver::leave_out_unusable(sources[source].name, sources[source].text,
                                           options.scene, to);
            save::ImportResult result = save::import_yaml(sources, source, diagnostics, to);
            Imported imported{std::move(result.sdf), !result.structural_error,
                              translated(diagnostics, sources), diagnostics.dropped(),
                              result.nodes};
            imported.texts = texts_of(std::move(sources));
            return imported;
        },
        [](Diagnostic why) {
            return Imported{"", false, {std::move(why)}};
        });
}

Imported import_yaml(std::string_view name, std::string_view yaml, bool strict) {
    ImportOptions options;
    options.strict = strict;
    return import_yaml(name, yaml, options);
}

namespace {

// The file as seen from the folder of `out`, both as the system has them.
std::string path_from(const std::filesystem::path &out, const std::string &file) {
    namespace fs = std::filesystem;
    std::error_code error;
    const auto folder_of = [&](const fs::path &path) {
        return fs::weakly_canonical(fs::absolute(path, error).parent_path(), error);
    };
    const fs::path from = folder_of(out), to = folder_of(file) / fs::path(file).filename();
    return error ? "" : to.lexically_relative(from).generic_string();
}

} // namespace

std::string export_yaml(const Scene &scene, std::vector<Diagnostic> *diagnostics) {
    return export_yaml(scene, ExportOptions{}, diagnostics);
}

std::string export_yaml(const Scene &scene, const ExportOptions &options,
                        std::vector<Diagnostic> *diagnostics) {
    std::vector<Diagnostic> said;
    std::string yaml = guarded(
        [&] {
            Diagnostics found;
            save::ExportOptions to;
            if (!options.out.empty())
                to.path_of = [&](const std::string &file) { return path_from(options.out, file); };
            for (const auto &[name, value] : scene.impl().origin->options.limits)
                (void)set_limit(to.limits,
                                name + "=" + value); // it was good when the scene was read
            std::string text = save::export_yaml(ir_of(scene), found, to);
            said = translated(found, scene.impl().compilation->sources);
            return text;
        },
        [&](Diagnostic why) {
            said.push_back(std::move(why));
            return std::string();
        });
    if (diagnostics) *diagnostics = std::move(said);
    return yaml;
}

} // namespace fathom::v1
