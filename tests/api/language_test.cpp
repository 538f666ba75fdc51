// The language service as an editor of one's own would use it: paths, bytes and plain data.
#include <catch2/catch.hpp>

#include <fathom/language.h>
#include <fathom/reference.h>

#include <algorithm>
#include <string>

namespace {

using fathom::Outcome, fathom::Workspace;

std::string edited(std::string text, const std::vector<fathom::TextEdit> &edits) {
    std::vector<fathom::TextEdit> last_first = edits;
    std::ranges::sort(last_first,
                      [](const auto &a, const auto &b) { return a.at.begin > b.at.begin; });
    for (const fathom::TextEdit &edit : last_first)
        text.replace(edit.at.begin, edit.at.end - edit.at.begin, edit.text);
    return text;
}

template <class Items> auto named(const Items &items, const std::string &label) {
    return std::ranges::find(items, label, [](const auto &item) { return item.label; });
}

} // namespace

TEST_CASE("a half-typed text is known as far as it goes") {
    Workspace workspace;
    const std::string text = "param radius = 1.5 in 1..2\nlet ball = sphere(radius)\nball.tran";
    CHECK(workspace.set_text("a.sdf", text) == std::vector<std::string>{"a.sdf"});
    const auto said = workspace.diagnostics("a.sdf");
    REQUIRE(said);
    CHECK(std::ranges::any_of(said.value, [](const fathom::Diagnostic &d) {
        return d.severity == fathom::Severity::Error && d.at.line == 3;
    }));

    const auto items = workspace.completion("a.sdf", text.size(), true);
    REQUIRE(items);
    const auto translate = named(items.value, "translate");
    REQUIRE(translate != items.value.end());
    CHECK((translate->kind == fathom::CompletionItem::Kind::Method && translate->snippet &&
           translate->insert == "translate($0)"));
    CHECK(named(items.value, "perlin") == items.value.end()); // of no shape

    const auto hover = workspace.hover("a.sdf", text.find("radius)"));
    REQUIRE(hover);
    CHECK(hover.value.name.find("radius: float") != std::string::npos);
    CHECK(text.substr(hover.value.at.begin, hover.value.at.end - hover.value.at.begin) == "radius");
    const auto sphere = workspace.hover("a.sdf", text.find("sphere"));
    REQUIRE(!sphere.value.entries.empty());
    CHECK(sphere.value.entries[0].name == "sphere");
    CHECK(workspace.hover("a.sdf", 10000).outcome == Outcome::Answered);
    CHECK(workspace.explanation("a.sdf").outcome == Outcome::Refused);
    CHECK_FALSE(workspace.explanation("a.sdf").why.empty());

    const auto help = workspace.signature_help("a.sdf", text.find("radius)"));
    REQUIRE(help.value.forms.size() == 1);
    CHECK(help.value.forms[0].parameters.size() == 1);
    CHECK(workspace.signature_help("a.sdf", 0).value.forms.empty());
}

TEST_CASE("forms of a function are found and renamed together") {
    Workspace workspace;
    const std::string text = "fn f(a: float) = a\nfn f(a: vec2) = a.x\nsphere(f(1) + f([1, 2]))\n";
    workspace.set_text("/none/a.sdf", text);
    REQUIRE(workspace.diagnostics("/none/a.sdf").value.empty());
    for (const std::size_t at : {text.find("f("), text.find("f(a: vec2"), text.find("f([")}) {
        CHECK(workspace.references("/none/a.sdf", at).value.size() == 4);
        const auto changes = workspace.rename("/none/a.sdf", at, "g");
        REQUIRE(changes);
        CHECK(edited(text, changes.value.at("/none/a.sdf")) ==
              "fn g(a: float) = a\nfn g(a: vec2) = a.x\nsphere(g(1) + g([1, 2]))\n");
    }
}

TEST_CASE("names go through the texts that import each other") {
    Workspace workspace;
    const std::string part = "fn knob(radius) = sphere(radius)\n",
                      text = "import \"part.sdf\"\nknob(radius: 1)\n";
    workspace.set_text("/none/part.sdf", part);
    workspace.set_text("/none/a.sdf", text);
    REQUIRE(workspace.diagnostics("/none/a.sdf").value.empty());
    const std::size_t at = text.find("knob");
    const auto definition = workspace.definition("/none/a.sdf", at).value;
    REQUIRE(definition);
    CHECK((definition->path == "/none/part.sdf" && definition->at.begin == 3));
    CHECK(workspace.references("/none/a.sdf", at).value.size() == 2);
    CHECK(workspace.references("/none/a.sdf", at, false).value.size() == 1);
    const auto changes = workspace.rename("/none/a.sdf", at, "grip");
    REQUIRE(changes);
    CHECK(edited(part, changes.value.at("/none/part.sdf")) == "fn grip(radius) = sphere(radius)\n");
    CHECK(edited(text, changes.value.at("/none/a.sdf")) ==
          "import \"part.sdf\"\ngrip(radius: 1)\n");
    CHECK(workspace.rename("/none/a.sdf", at, "no name").outcome == Outcome::Refused);
    CHECK_FALSE(workspace.renamable("/none/a.sdf", text.find("import")).value);
    const auto moved = workspace.rename_files({{"/none/part.sdf", "/none/lib/part.sdf"}});
    CHECK(edited(text, moved.value.at("/none/a.sdf")) ==
          "import \"lib/part.sdf\"\nknob(radius: 1)\n");

    // Who imports a text is told of when that changes, and sees what it says now.
    CHECK(workspace.set_text("/none/part.sdf", "fn knob(radius) = box(radius)\n").size() == 2);
    CHECK(workspace.close("/none/part.sdf") == std::vector<std::string>{"/none/a.sdf"});
    CHECK_FALSE(workspace.diagnostics("/none/a.sdf").value.empty()); // there is no such file
    CHECK(workspace.close("/none/part.sdf").empty());

    const auto of_library = workspace.definition("/none/a.sdf", text.size()).value;
    CHECK_FALSE(of_library);
    workspace.set_text("b.sdf", "torus(1, 0.2)\n");
    const auto torus = workspace.definition("b.sdf", 2).value;
    REQUIRE((torus && torus->library));
    bool found = false;
    for (const fathom::LibraryText &file : fathom::library_texts())
        found |= file.file == torus->path && file.text.compare(torus->at.begin, 5, "torus") == 0;
    CHECK(found);
}

TEST_CASE("what a text looks like, and its one form") {
    Workspace workspace;
    const std::string text = "// a ball\nlet  r=1 // its radius\nsphere( r ).paint(#ff6347)\n";
    workspace.set_text("a.sdf", text);
    CHECK(edited(text, workspace.format("a.sdf", {0, text.size()}).value) ==
          "// a ball\nlet r = 1  // its radius\nsphere(r).paint(#ff6347)\n");
    CHECK(edited(text, workspace.format("a.sdf", {text.size() - 1, text.size() - 1}).value) ==
          "// a ball\nlet  r=1 // its radius\nsphere(r).paint(#ff6347)\n");
    std::string words;
    for (const fathom::SemanticToken &token : workspace.tokens("a.sdf", {0, text.size()}).value)
        if (token.meaning == fathom::SemanticToken::Meaning::Function ||
            token.meaning == fathom::SemanticToken::Meaning::Method)
            words += text.substr(token.at.begin, token.at.end - token.at.begin) + " ";
    CHECK(words == "sphere paint ");
    const auto colors = workspace.colors("a.sdf").value;
    REQUIRE(colors.size() == 1);
    CHECK(fathom::color_texts(colors[0].rgba) == std::vector<std::string>{"#ff6347", "tomato"});
    const auto grown = workspace.selections("a.sdf", text.find("r )")).value;
    REQUIRE(grown.size() > 2);
    CHECK((grown[0].begin == 0 && grown[0].end == text.size()));
    CHECK((grown.back().end - grown.back().begin == 1));
    CHECK(workspace.symbols("a.sdf").value.size() == 1);
    const auto bounds = workspace.bounds("a.sdf").value;
    REQUIRE(bounds.size() == 1);
    CHECK(bounds[0].lipschitz == 1);

    bool inlines = false;
    for (const fathom::CodeAction &action :
         workspace.actions("a.sdf", {text.find("r )"), text.find("r )")}).value)
        if (action.kind == fathom::CodeAction::Kind::Inline) {
            inlines = true;
            CHECK(edited(text, action.edits).find("sphere( 1 )") != std::string::npos);
        }
    CHECK(inlines);
    CHECK(workspace.actions("a.sdf", {0, text.size()}, {false, false, false, false}).value.empty());
    CHECK(fathom::moved_params("param r = 1 in 0..2\nsphere(r)\n",
                               "param r = 1.5 in 0..2\nsphere(r)\n") ==
          std::vector<std::pair<std::string, double>>{{"r", 1.5}});
}

TEST_CASE("what is not open, not wanted or no place is said") {
    Workspace workspace;
    CHECK(workspace.hover("a.sdf", 0).outcome == Outcome::NotOpen);
    CHECK_FALSE(workspace.completion("a.sdf", 0));
    CHECK_FALSE(workspace.text("/none/a.sdf"));
    workspace.set_text("a.sdf", "sphere(1)\n");
    CHECK(workspace.text("a.sdf") == "sphere(1)\n");
    workspace.set_outdated([] { return true; });
    CHECK(workspace.diagnostics("a.sdf").outcome == Outcome::Outdated);
    workspace.set_outdated({});
    CHECK(workspace.diagnostics("a.sdf").outcome == Outcome::Answered);
    const std::size_t far = static_cast<std::size_t>(-1);
    CHECK(workspace.completion("a.sdf", far));
    CHECK(workspace.format("a.sdf", {far, far}));
    CHECK(workspace.tokens("a.sdf", {far, 0}).value.empty());
    CHECK(workspace.format_typed("a.sdf", far, '}'));
    CHECK(workspace.actions("a.sdf", {far, far}));
    CHECK(workspace.selections("a.sdf", far).value.size() >= 1);
    Workspace taken = std::move(workspace);
    CHECK(taken.diagnostics("a.sdf"));
}
