// libFuzzer: whatever the bytes are, an import ends, gives text, and says a broken structure as an
// error.
#include "save-format/save_format.h"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const unsigned char *data, std::size_t size) {
    using namespace fathom;
    Sources sources;
    const SourceId id =
        sources.add("fuzz.yaml", std::string(reinterpret_cast<const char *>(data), size));
    Diagnostics diagnostics;
    const save::ImportResult result = save::import_yaml(sources, id, diagnostics);
    if (result.structural_error != diagnostics.has_errors()) std::abort();
    if (result.sdf.find("import \"dfmodel\" as dfmodel") == std::string::npos) std::abort();
    // what is kept is written once: the text grows with the file, not faster
    if (result.sdf.size() > 4096 + 200 * size) std::abort();
    const auto &reports = diagnostics.items();
    if (!reports.empty()) to_text(reports[size % reports.size()], sources, false);
    return 0;
}
