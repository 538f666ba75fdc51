#include "api/impl.h"

#include "driver/pages.h"
#include "lang/vocabulary.h"

namespace fathom::v1 {
namespace {

std::vector<std::string> strings(const std::vector<std::string_view> &words) {
    return {words.begin(), words.end()};
}

// What `make` makes, or nothing of it where there is no memory.
template <class Make> auto whole_or_empty(Make make) noexcept {
    return guarded(make, [](const Diagnostic &) { return decltype(make())(); });
}

} // namespace

Vocabulary vocabulary() {
    return whole_or_empty([] {
        const lang::Vocabulary words = lang::vocabulary();
        return Vocabulary{strings(words.keywords), strings(words.keywords_in_place),
                          strings(words.types), strings(words.units), strings(words.signs)};
    });
}

std::vector<LibraryConstant> library_constants() {
    return whole_or_empty([] {
        std::vector<LibraryConstant> all;
        for (typecheck::LibraryConstant &constant : typecheck::library_constants())
            all.push_back({std::move(constant.name), std::move(constant.type), constant.rgb});
        return all;
    });
}

std::vector<LibraryText> library_texts() {
    return whole_or_empty([] {
        std::vector<LibraryText> all;
        for (const typecheck::LibraryFile &file : driver::standard_library())
            all.push_back({std::string(file.name), std::string(file.text)});
        return all;
    });
}

std::vector<DiagnosticCode> diagnostic_codes() {
    return whole_or_empty([] {
        std::vector<DiagnosticCode> all;
        for (const Code code : all_codes()) {
            DiagnosticCode entry{std::string(code_name(code)), std::string(code_summary(code)), "",
                                 severity_of(code_severity(code))};
            for (const auto &[file, text] : driver::diagnostic_pages())
                if (file == entry.name + ".md") entry.page = text;
            all.push_back(std::move(entry));
        }
        return all;
    });
}

} // namespace fathom::v1
