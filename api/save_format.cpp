#include "api/impl.h"

#include "save-format/save_format.h"

namespace fathom::v1 {

Imported import_yaml(std::string_view name, std::string_view yaml, bool strict) {
    return guarded(
        [&] {
            Sources sources;
            Diagnostics diagnostics;
            const SourceId source = sources.add(std::string(name), std::string(yaml));
            save::ImportOptions options;
            options.strict = strict;
            save::ImportResult result = save::import_yaml(sources, source, diagnostics, options);
            return Imported{std::move(result.sdf), !result.structural_error,
                            translated(diagnostics, sources)};
        },
        [](Diagnostic why) {
            return Imported{"", false, {std::move(why)}};
        });
}

std::string export_yaml(const Scene &scene, std::vector<Diagnostic> *diagnostics) {
    std::vector<Diagnostic> said;
    std::string yaml = guarded(
        [&] {
            Diagnostics found;
            std::string text = save::export_yaml(ir_of(scene), found);
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
