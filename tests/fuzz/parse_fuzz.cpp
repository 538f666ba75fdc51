// libFuzzer target of the parser and the formatter: any bytes give a whole tree and reports that
// print; a text without an error formats to one with the same tree that formats to itself.
#include "unit/lang/support.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

void demand(bool holds, const char *what) {
    if (holds) return;
    std::fprintf(stderr, "parse_fuzz: %s\n", what);
    std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const lang_test::Parsed parsed(std::string(reinterpret_cast<const char *>(data), size));
    demand(lang_test::defect(parsed).empty(), "the tree is not whole");
    const std::vector<fathom::Diagnostic> &reports = parsed.diagnostics.items();
    for (const fathom::Diagnostic &d : reports)
        demand(d.primary.span.end <= size, "a place outside the text");
    if (!reports.empty()) {
        // one: garbage has dozens, and printing all took two thirds of the time
        const fathom::Diagnostic &d = reports[size % reports.size()];
        demand(!to_text(d, parsed.sources, true).empty(), "a report without words");
        demand(!to_json(d, parsed.sources).empty(), "a report without JSON");
        return 0;
    }
    const lang_test::Parsed again(parsed.formatted());
    demand(again.diagnostics.items().empty(), "the formatted text has an error");
    demand(again.tree() == parsed.tree(), "formatting changed the tree");
    demand(again.formatted() == again.text(), "formatting is not idempotent");
    return 0;
}
