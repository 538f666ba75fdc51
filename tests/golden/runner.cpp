#include "golden/runner.h"

#include "backend-cpu/tape.h"
#include "backend-glsl/emit.h"
#include "base/text.h"
#include "driver/compile.h"
#include "driver/verdict.h"
#include "ir/passes/dump.h"
#include "lang/format.h"
#include "lang/parse.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <sstream>

namespace golden {
namespace {

using namespace fathom;
constexpr std::string_view marker = "//====";

std::vector<std::string> lines_of(std::string_view text) {
    std::vector<std::string> lines;
    while (!text.empty()) {
        std::size_t end = text.find('\n');
        lines.emplace_back(text.substr(0, end));
        text.remove_prefix(end == text.npos ? text.size() : end + 1);
    }
    return lines;
}

// Imported files are named by where they lie: a golden names them from the project's folder on.
std::string from_the_project(std::string text) {
    const std::string root = FATHOM_SOURCE_DIR "/";
    for (std::size_t at = text.find(root); at != text.npos; at = text.find(root, at))
        text.erase(at, root.size());
    return text;
}

std::string diagnostics_text(const Diagnostics &diagnostics, const Sources &sources) {
    std::string text;
    for (const Diagnostic &diagnostic : diagnostics.sorted()) {
        text += to_text(diagnostic, sources, false);
        if (!text.ends_with('\n')) text += '\n';
    }
    return from_the_project(std::move(text));
}

std::string number(double value) {
    if (value == std::numeric_limits<double>::infinity()) return "inf";
    if (value == -std::numeric_limits<double>::infinity()) return "-inf";
    return fmt::format("{:.6g}", value);
}

// A line for each name that the file declares.
std::string types_text(const driver::Compilation &compilation) {
    std::string text;
    for (const typecheck::NameFact &fact : compilation.names) {
        text += fmt::format("{}: {}, {}", fact.name, fact.type, typecheck::stage_name(fact.stage));
        for (const ir::Param &param : compilation.scene.params)
            if (param.name == fact.name) text += param.structural ? ", rebuilds" : ", uniform";
        text += "\n";
    }
    return text;
}

std::string_view kind_name(ir::FieldKind kind) {
    switch (kind) {
    case ir::FieldKind::Exact: return "exact";
    case ir::FieldKind::Bound: return "bound";
    case ir::FieldKind::Estimate: return "estimate";
    }
    return "";
}

// A line for each top-level shape: its bound, what it is worth, where it lies.
std::string bounds_text(const ir::Scene &scene) {
    std::string text;
    for (const ir::TopLevel &top : scene.top_level) {
        const ir::ShapeFact &fact = scene.facts[top.shape.index];
        std::string symmetric;
        for (std::size_t i = 0; i < 3; ++i)
            if (fact.symmetric[i]) symmetric += "xyz"[i];
        text += fmt::format("L {} {} {}", number(fact.lipschitz_sup),
                            driver::status_name(fact.status), kind_name(fact.kind));
        for (std::size_t i = 0; i < 3; ++i)
            text += fmt::format(" {}..{}", number(fact.bounds.lo[i]), number(fact.bounds.hi[i]));
        if (!symmetric.empty()) text += " symmetric " + symmetric;
        text += '\n';
    }
    return text;
}

std::string ir_text(const ir::Scene &scene) {
    return ir::dump(scene.graph, scene.shapes, scene.root) + "-- marched\n" +
           ir::dump(scene.graph, scene.graph.function(scene.distance).result);
}

std::string glsl_text(const ir::Scene &scene, const Sources &sources) {
    glsl::Options options;
    options.field_only = true;
    Diagnostics diagnostics;
    std::string text = glsl::emit(scene, options, diagnostics).text;
    return diagnostics.has_errors() ? diagnostics_text(diagnostics, sources) : text;
}

// `//==== eval 0,0,0 1,2,3`: a line a point, as the command prints it but to six digits, which hold
// on every machine.
std::string eval_text(const ir::Scene &scene, const std::string &arguments) {
    cpu::Program program = cpu::compile(scene, scene.distance);
    cpu::GradientScratch scratch = cpu::make_gradient_scratch(program, cpu::inputs_of(scene, 0));
    std::istringstream words(arguments);
    std::string text;
    for (std::string word; words >> word;) {
        std::array<float, 3> point{};
        std::replace(word.begin(), word.end(), ',', ' ');
        std::istringstream numbers(word);
        for (float &coordinate : point) numbers >> coordinate;
        std::array<const float *, 3> in{&point[0], &point[1], &point[2]};
        std::array<float, 4> result{};
        std::array<float *, 4> out{&result[0], &result[1], &result[2], &result[3]};
        cpu::evaluate_gradient(program, scratch, in.data(), out.data(), 1);
        text += fmt::format("{} -> {:.5g} {:.4f} {:.4f} {:.4f}\n", word, result[0],
                            result[1] + 0.0f, result[2] + 0.0f, result[3] + 0.0f);
    }
    return text;
}

std::string with_edits(std::string text, std::vector<Edit> edits) {
    std::stable_sort(edits.begin(), edits.end(),
                     [](const Edit &a, const Edit &b) { return a.span < b.span; });
    for (auto edit = edits.rbegin(); edit != edits.rend(); ++edit)
        text.replace(edit->span.begin, edit->span.end - edit->span.begin, edit->replacement);
    return text;
}

std::string section_text(const Section &section, const driver::Compilation &compilation) {
    if (section.stage == "diagnostics")
        return diagnostics_text(compilation.diagnostics, compilation.sources);
    if (section.stage == "fixed") return ""; // of the case as a whole
    if (section.stage == "json") return driver::verdict_json(compilation);
    if (section.stage == "ast" || section.stage == "format") {
        Diagnostics diagnostics;
        lang::Ast ast = lang::parse(compilation.sources, SourceId{0}, diagnostics);
        return section.stage == "ast" ? lang::dump(ast) : lang::format(compilation.sources, ast);
    }
    if (!compilation.good()) return "(the program has an error)\n";
    if (section.stage == "types") return types_text(compilation);
    if (section.stage == "bounds") return bounds_text(compilation.scene);
    if (section.stage == "ir") return ir_text(compilation.scene);
    if (section.stage == "glsl") return glsl_text(compilation.scene, compilation.sources);
    if (section.stage == "eval") return eval_text(compilation.scene, section.arguments);
    return fmt::format("(there is no stage `{}`)\n", section.stage);
}

std::string fixed_text(const Fixed &result) {
    return result.program + result.left +
           (result.stuck.empty() ? "" : "no fix: " + result.stuck + "\n");
}

// `found`: what the case's own program says.
Fixed apply_fixes(const Case &golden, std::vector<Diagnostic> found) {
    constexpr int max_fixes = 60;
    Fixed result{golden.program, "", ""};
    for (int i = 0; i < max_fixes; ++i) {
        const auto fixable = std::find_if(found.begin(), found.end(), [](const Diagnostic &d) {
            return d.fix && !d.fix->edits.empty();
        });
        if (fixable == found.end()) {
            for (const Diagnostic &d : found)
                if (d.severity != Severity::Note)
                    result.left += fmt::format("left: {}: {}\n", code_name(d.code), d.message);
            return result;
        }
        const std::string edited = with_edits(result.program, fixable->fix->edits);
        // The same thing said at the same place: the fix has changed nothing.
        const auto says_it = [&](const Diagnostic &d) {
            return d.code == fixable->code && d.message == fixable->message &&
                   d.primary.span.begin == fixable->primary.span.begin;
        };
        const driver::Compilation after =
            driver::compile_text(golden.file, edited, golden.folder, {});
        const auto &items = after.diagnostics.items();
        if (std::any_of(items.begin(), items.end(), says_it))
            result.stuck = fmt::format("{}: {}", code_name(fixable->code), fixable->message);
        if (!result.stuck.empty()) return result;
        result.program = edited;
        found = after.diagnostics.sorted();
    }
    result.stuck = "there is no end of fixes";
    return result;
}

} // namespace

Case read_case(const std::string &path) {
    Case result;
    std::filesystem::path file(path);
    result.file = file.filename().string();
    result.folder = file.parent_path().string();
    std::ifstream in(path, std::ios::binary);
    std::ostringstream bytes;
    bytes << in.rdbuf();
    bool in_program = true;
    std::size_t program_lines = 0;
    for (const std::string &line : lines_of(bytes.str())) {
        if (line.starts_with(marker)) {
            in_program = false;
            std::istringstream words(line.substr(marker.size()));
            Section section;
            words >> section.stage >> std::ws;
            std::getline(words, section.arguments);
            result.sections.push_back(section);
        } else if (in_program) {
            result.program += line + "\n";
            ++program_lines;
        } else if (line.starts_with("//")) {
            result.sections.back().text += line.substr(line.starts_with("// ") ? 3 : 2) + "\n";
        } else {
            result.error = "an expectation's line begins with `//`";
        }
    }
    if (result.sections.empty()) result.error = "no line begins with `//====`: it expects nothing";
    if (program_lines > 20) result.error = "more than 20 lines of program: one case, one thing";
    return result;
}

Outcome run_case(const Case &golden) {
    driver::Compilation compilation =
        driver::compile_text(golden.file, golden.program, golden.folder, {});
    Outcome outcome;
    outcome.fixed = apply_fixes(golden, compilation.diagnostics.sorted());
    outcome.has_errors = compilation.diagnostics.has_errors();
    for (const Diagnostic &diagnostic : compilation.diagnostics.items())
        outcome.codes.emplace_back(code_name(diagnostic.code));
    for (const Section &section : golden.sections)
        outcome.actual.push_back({section.stage, section.arguments,
                                  section.stage == "fixed" ? fixed_text(outcome.fixed)
                                                           : section_text(section, compilation)});
    return outcome;
}

std::string write_case(const Case &golden, const std::vector<Section> &sections) {
    std::string text = golden.program;
    for (const Section &section : sections) {
        text += fmt::format("{} {}{}{}\n", marker, section.stage,
                            section.arguments.empty() ? "" : " ", section.arguments);
        for (const std::string &line : lines_of(section.text))
            text += line.empty() ? "//\n" : "// " + line + "\n";
    }
    return text;
}

std::string difference(std::string_view expected, std::string_view actual) {
    std::vector<std::string> a = lines_of(expected), b = lines_of(actual);
    std::size_t first = 0;
    while (first < a.size() && first < b.size() && a[first] == b[first]) ++first;
    std::string text = fmt::format("first difference in line {}\n", first + 1);
    auto show = [&](std::string_view title, char sign, const std::vector<std::string> &lines) {
        text += fmt::format("  {}\n", title);
        if (first >= lines.size()) text += fmt::format("  {} (ends here)\n", sign);
        for (std::size_t i = first; i < std::min(first + 6, lines.size()); ++i)
            text += fmt::format("  {} {}\n", sign, lines[i]);
    };
    show("expected", '-', a);
    show("found", '+', b);
    return text;
}

} // namespace golden
