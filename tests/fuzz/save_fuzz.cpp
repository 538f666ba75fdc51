// libFuzzer target of the way from a save file to text and back: whatever the bytes are, what a
// scene exports is a scene, and exports to the same bytes from the second time on.
#include "save-format/save_format.h"
#include "support/whole.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>

using namespace fathom;

namespace {

struct Trip {
    bool scene = false;
    std::string said, sdf, yaml; // what was said of the import and of its text; what came back
};

Trip there_and_back(const std::string &yaml) {
    Trip trip;
    Sources sources;
    Diagnostics importing, checking, exporting;
    const SourceId id = sources.add("a.yaml", yaml);
    save::ImportResult imported = save::import_yaml(sources, id, importing);
    trip.sdf = std::move(imported.sdf);
    for (const Diagnostic &d : importing.items())
        if (d.severity != Severity::Note) trip.said += to_text(d, sources, false);
    if (imported.structural_error) return trip;
    typecheck::Options options;
    options.limits.work = 200'000;
    options.limits.memory = 32;
    const typecheck::Checked checked = typecheck::check(
        sources, sources.add("a.sdf", trip.sdf), "a.sdf", driver::standard_library(),
        test::loader_without_files(true), options, checking);
    for (const Diagnostic &d : checking.items())
        if (d.severity == Severity::Error) trip.said += to_text(d, sources, false);
    if (checking.has_errors()) return trip;
    trip.scene = true;
    trip.yaml = save::export_yaml(checked.scene, exporting);
    return trip;
}

[[noreturn]] void wrong(const char *what, const Trip &first, const Trip &second) {
    std::fprintf(stderr,
                 "save_fuzz: %s\n--- exported\n%s--- its text\n%s--- again\n%s--- said\n%s\n", what,
                 first.yaml.c_str(), second.sdf.c_str(), second.yaml.c_str(), second.said.c_str());
    std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const Trip first = there_and_back(std::string(reinterpret_cast<const char *>(data), size));
    if (!first.scene) return 0; // yaml_fuzz watches what is said then
    const Trip second =
        there_and_back(first.yaml); // what stood twice in a file has found its place
    if (!second.scene) wrong("what was exported is no scene", first, second);
    const Trip third = there_and_back(second.yaml);
    if (!third.scene) wrong("what was exported again is no scene", second, third);
    if (third.yaml != second.yaml) wrong("a third export differs from the second", second, third);
    return 0;
}
