// The whole compiler on any text, without a file: parse, check, prove, lower, emit. For fuzzers and
// their like: says what is wrong with the answer, or nothing. Work is limited, so that a hostile
// text is answered soon.
#pragma once

#include "backend-glsl/emit.h"
#include "driver/compile.h"
#include "ir/lower/lower.h"
#include "ir/passes/verify.h"
#include "proof/prove.h"
#include "typecheck/check.h"

#include <nlohmann/json.hpp>

#include <string>

namespace fathom::test {

struct Answer {
    std::string fault;   // of the compiler; empty where all is well
    bool checks = false; // the text is a scene
};

// There are no files but, where they are wanted, images and grids of any name, which are small.
inline typecheck::Loader loader_without_files(bool with_data = false) {
    const auto missing = [](const std::string &, const std::string &) {
        return typecheck::LoadError{typecheck::LoadError::Reason::NotFound, "no such file"};
    };
    typecheck::Loader loader;
    loader.text = missing;
    loader.identity = missing;
    loader.image = [=](const std::string &a, const std::string &b, typecheck::Room &) {
        return missing(a, b);
    };
    loader.grid = [=](const std::string &a, const std::string &b, typecheck::Room &,
                      const std::string &) { return missing(a, b); };
    if (!with_data) return loader;
    loader.identity = [](const std::string &name, const std::string &) { return name; };
    loader.image = [](const std::string &name, const std::string &, typecheck::Room &) {
        return ir::ImageData{name, 1, 1, {1, 1, 1, 1}};
    };
    loader.grid = [](const std::string &name, const std::string &, typecheck::Room &,
                     const std::string &) {
        return ir::GridData{name, {2, 2, 2}, {1, 1, 1, 1, 1, 1, 1, 1}};
    };
    return loader;
}

inline Answer whole_compiler(const std::string &text) {
    Sources sources;
    Diagnostics diagnostics;
    const SourceId root = sources.add("a.sdf", text);
    const typecheck::Loader loader = loader_without_files();
    typecheck::Options options;
    options.limits.work = 200'000;
    options.limits.memory = 32;
    typecheck::Checked checked = typecheck::check(
        sources, root, "a.sdf", driver::standard_library(), loader, options, diagnostics);
    proof::Options proof_options;
    proof_options.field_instructions = 5'000;
    proof_options.work = 250'000;
    // a quarter of the time, of what few scenes have: for some texts alone, chosen by their length
    proof_options.test_assumptions = text.size() % 8 == 0;
    proof::prove(checked.scene, diagnostics, proof_options);
    for (const Diagnostic &d : diagnostics.items()) {
        if (d.message.empty()) return {"a report without words"};
        if (d.code == Code::ShaderInvalid) return {"the shader is not valid: " + d.message};
        const Span span = d.primary.span;
        if (span.source && span.end > sources[span.source].text.size())
            return {"a place outside the text"};
    }
    // one is printed: garbage has dozens
    const std::vector<Diagnostic> &reports = diagnostics.items();
    if (!reports.empty()) {
        const Diagnostic &d = reports[text.size() % reports.size()];
        to_text(d, sources, true);
        to_json(d, sources);
    }
    if (diagnostics.has_errors()) return {};
    ir::lower(checked.scene);
    if (const std::string wrong = ir::verify(checked.scene); !wrong.empty())
        return {"the lowered scene: " + wrong};
    glsl::Options glsl_options;
    glsl_options.target = glsl::Target::Es300;
    glsl_options.field_only = true;
    Diagnostics complaints;
    glsl::emit(checked.scene, glsl_options, complaints);
    for (const Diagnostic &d : complaints.items())
        return {"the shader: " + d.message + (d.notes.empty() ? "" : "; " + d.notes[0])};
    return {"", true};
}

} // namespace fathom::test
