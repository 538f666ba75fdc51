// Where the proof takes more work than is allowed: what the message names, by counted steps.
#include "driver/compile.h"

#include <catch2/catch.hpp>

using namespace fathom;

namespace {

// The error of a proof with so few steps, and the text that it stands at.
struct Said {
    Diagnostic error;
    std::string at;
};
Said said(const std::string &text, std::size_t steps) {
    driver::CompileOptions options;
    options.limits.proof = steps;
    const driver::Compilation c = driver::compile_text("scene.sdf", text, ".", options);
    Said out;
    for (const Diagnostic &d : c.diagnostics.items())
        if (d.severity == Severity::Error) {
            CHECK(d.code == Code::ProofLimit);
            const Span at = d.primary.span;
            out = {d, text.substr(at.begin, at.end - at.begin)};
        }
    CHECK(c.diagnostics.errors() == 1);
    return out;
}
bool says(const Said &said, const std::string &words) {
    for (const std::string &note : said.error.notes)
        if (note.find(words) != std::string::npos) return true;
    return said.error.message.find(words) != std::string::npos;
}

const std::string small = "implicit(p => length(p) - 1)\n";

} // namespace

TEST_CASE("a proof that takes too much work names the loop that most of it goes into") {
    const Said loop =
        said(small +
                 "implicit(p => {\n"
                 "  var q = p\n"
                 "  for k in 0..3 { q = abs(q) - 0.3 }\n"
                 "  var s = 0.0\n"
                 "  for i in 0..900 { s = sin((i + 1) * p.x + s) + cos(i * p.y + s) }\n"
                 "  length(q) - 1 + 0.0000001 * s\n}, within: ball(2))\n" +
                 small,
             20'000);
    CHECK(loop.at == "for i in 0..900");
    CHECK(says(loop, "whose body runs 900 times"));
    CHECK(says(loop, "most of it goes into this loop"));
}

TEST_CASE("an inner loop is named where an outer one was written out") {
    // for i = 0 the inner loop does not read the point
    const Said loop = said("implicit(p => {\n"
                           "  var s = 0.0\n"
                           "  for i in 0..20 { for j in 0..20 { s = s + sin(i * p.x + j) } }\n"
                           "  length(p) - 1 + 0.0000001 * s\n}, within: ball(2))\n",
                           1'000);
    CHECK(loop.at == "for j in 0..20");
    CHECK(says(loop, "whose body runs 380 times"));
}

TEST_CASE("a field without loops is named with its choices") {
    std::string field = "implicit(p => {\n  var s = p.x\n";
    for (int i = 0; i < 40; ++i)
        field +=
            "  if p.y > " + std::to_string(i) + " * 0.01 { s = s * 1.01 } else { s = s * p.z }\n";
    const Said all = said(small + field + "  s\n}, within: ball(2))\n", 2'000);
    CHECK(all.at.starts_with("implicit(p => {\n  var s"));
    CHECK(says(all, "most of it goes into this field"));
    CHECK(says(all, "40 steps and choices"));
}

TEST_CASE("where the work is spread the dearest shape is named") {
    std::string many;
    for (int i = 0; i < 12; ++i)
        many += "implicit(p => length(p - vec3(" + std::to_string(i) +
                ", 0, 0)) - 1 + 0.1 * sin(3 * p.x) * cos(2 * p.y), within: ball(20))\n";
    const Said all = said(many, 1'000'000);
    CHECK(all.at.starts_with("implicit"));
    CHECK(says(all, "of its shapes this field takes most"));
}
