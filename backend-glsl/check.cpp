#include "backend-glsl/check.h"

#include "backend-glsl/template.h"

#include <algorithm>
#include <fmt/format.h>

namespace fathom::glsl {

namespace {

std::string nth_line(const std::string &text, int line) {
    std::size_t begin = 0;
    for (int i = 1; i < line && begin != std::string::npos; ++i) begin = text.find('\n', begin) + 1;
    return text.substr(begin, text.find('\n', begin) - begin);
}

} // namespace

bool good_text(const std::string &text, Stage stage, const Options &options,
               std::vector<std::uint32_t> &words, Diagnostics &diagnostics) {
    const TargetTraits &target = traits_of(options.target);
    std::string whole = text;
    if (options.field_only)
        whole += expand("field_main", {{"LOCATIONS", target.locations ? "1" : ""}});
    if (*target.host)
        whole = expand(target.host, {{"TEXT", whole}, {"PICTURE", options.field_only ? "" : "1"}});
    std::optional<Complaint> complaint;
    if (target.form == Form::SpirV) {
        SpirV spirv = to_spirv(whole);
        words = std::move(spirv.words);
        complaint = spirv.complaint;
    } else {
        complaint = validate(whole, stage);
    }
    if (!complaint) return true;
    Diagnostic &d = diagnostics.add(Code::ShaderInvalid, {},
                                    std::string("the `") + target.name +
                                        "` text is not valid: " + complaint->message);
    const auto before = whole.begin() + static_cast<std::ptrdiff_t>(whole.find(text));
    const int line = complaint->line - static_cast<int>(std::count(whole.begin(), before, '\n'));
    if (line > 0) d.note(fmt::format("line {} of the text: {}", line, nth_line(text, line)));
    d.note("this is a fault of the compiler, not of the scene");
    return false;
}

} // namespace fathom::glsl
