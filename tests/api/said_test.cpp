// What programs that talk to people use: diagnostics as text, verdicts, explanations, the words of
// the language, files and their watcher. By the public headers alone.
#include <catch2/catch.hpp>

#include <fathom/fathom.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <thread>

namespace {

namespace fs = std::filesystem;

std::string all_printed(const fathom::CompileResult &result) {
    std::string all;
    for (const fathom::Diagnostic &d : result.diagnostics) all += fathom::printed(d, result.texts);
    return all;
}

fathom::Scene said_scene(std::string_view text) {
    fathom::CompileResult result = fathom::compile_text("test.sdf", text);
    REQUIRE(result.scene);
    return *result.scene;
}

// A folder that is removed with all that is in it.
struct Folder {
    fs::path path = fs::temp_directory_path() / "fathom_said_test";
    Folder() {
        fs::remove_all(path);
        fs::create_directory(path);
    }
    ~Folder() { fs::remove_all(path); }
};

} // namespace

TEST_CASE("a diagnostic is printed with the lines that it is about") {
    const auto wrong = fathom::compile_text("ball.sdf", "let r = 1\nshpere(r)\n");
    CHECK(all_printed(wrong) ==
          "ball.sdf:2:1: error[unknown-name]: nothing here is called `shpere`\n"
          "  |\n"
          "2 | shpere(r)\n"
          "  | ^^^^^^\n"
          "  |\n"
          "  = help: did you mean `sphere`?\n"
          "  |\n"
          "2 | sphere(r)\n"
          "  | ~~~~~~\n");
    const fathom::Diagnostic &first = wrong.diagnostics.front();
    CHECK(first.at.text >= 0);
    CHECK(wrong.texts.text(static_cast<std::size_t>(first.at.text)) == "let r = 1\nshpere(r)\n");
    CHECK(fathom::printed(first, wrong.texts, true).find("\033[") != std::string::npos);

    // A second place, whose words are kept apart from those of the first.
    const auto twice = fathom::compile_text("twice.sdf", "let a = 1\nlet a = 2\nsphere(a)\n");
    CHECK(all_printed(twice).find("1 | let a = 1\n") != std::string::npos);
    CHECK(all_printed(twice).find("2 | let a = 2\n") != std::string::npos);

    // What is about no text, places that a caller made up, and none at all.
    const auto none = fathom::compile_file("/nowhere/at/all.sdf");
    CHECK(all_printed(none) == "fathom: cannot read `/nowhere/at/all.sdf`: no such file\n");
    fathom::Diagnostic own = first;
    own.at.text = 99;
    own.at.end = std::numeric_limits<std::size_t>::max();
    CHECK_FALSE(fathom::printed(own, wrong.texts).empty());
    own.at.text = first.at.text;
    CHECK_FALSE(fathom::printed(own, wrong.texts).empty());
    CHECK_FALSE(fathom::printed(own, {}).empty());
    CHECK(fathom::Texts().count() == 0);
    CHECK(fathom::Texts().text(0).empty());
}

TEST_CASE("a verdict is a JSON document, also of a text that is wrong") {
    CHECK(fathom::verdict_json(fathom::compile_text("a.sdf", "sphere(1)\n"))
              .starts_with("{\"ok\":true,\"lipschitz\":1.0,\"status\":\"proved\",\"exact\":true"));
    CHECK(fathom::verdict_json(fathom::compile_text("a.sdf", "shpere(1)\n"))
              .starts_with("{\"ok\":false"));
    CHECK(fathom::verdict_json({}).empty());
}

TEST_CASE("a bound is explained as a tree whose root is the bound") {
    const fathom::Scene scene =
        said_scene("box([1, 4, 1]).twist(30deg) | sphere(1).translate(x: 5)\n");
    const auto root = fathom::explain(scene);
    REQUIRE(root);
    CHECK(root->lipschitz == *scene.facts().lipschitz);
    bool twist = false;
    const auto look = [&](const auto &self, const fathom::Explanation &node) -> void {
        if (node.operation == "twist") {
            twist = true;
            CHECK(node.steepest);
            CHECK(node.factor > 1);
            CHECK(node.at.line == 1);
        }
        for (const fathom::Explanation &child : node.children) {
            CHECK((!child.steepest || node.steepest));
            self(self, child);
        }
    };
    look(look, *root);
    CHECK(twist);
    CHECK_FALSE(fathom::pruning(scene).by_cells);
    CHECK(fathom::pruning(scene).shapes >= 1);
}

TEST_CASE("what a compilation is told decides what it proves") {
    fathom::CompileOptions options;
    const std::string stated =
        "fn g(p: vec3) -> float = if p.y > 0 { atan(p.x + 4) } else { pi / 2 - atan(1 / (p.x + 4)) "
        "}\n"
        "implicit(p => length(p) - noise(p) + 0.1 * g(p), within: ball(2), lipschitz: 3.2)\n";
    const auto loose = fathom::compile_text("a.sdf", stated);
    REQUIRE(loose);
    CHECK(loose.scene->facts().status == fathom::Status::Assumed);
    options.strict_proof = true;
    CHECK_FALSE(fathom::compile_text("a.sdf", stated, options));

    options = {};
    const std::string param =
        "param a = 0.1 in 0..2\nimplicit(p => p.y - a * sin(p.x), within: ball(4))\n";
    const double all = *said_scene(param).facts().lipschitz;
    options.times = {0, 0};
    const auto now = fathom::compile_text("a.sdf", param, options);
    REQUIRE(now);
    CHECK(*now.scene->facts().lipschitz < all);
    CHECK(said_scene("render(time: 2)\nsphere(1 + 0.1 * time)\n").facts().reads_time);
    CHECK_FALSE(said_scene("sphere(1)\n").facts().reads_time);
}

TEST_CASE("the language's words, constants and codes are known") {
    const fathom::Vocabulary words = fathom::vocabulary();
    CHECK(std::ranges::count(words.keywords, "let") == 1);
    CHECK(std::ranges::count(words.units, "deg") == 1);
    const auto constants = fathom::library_constants();
    const auto tomato = std::ranges::find(constants, "tomato", &fathom::LibraryConstant::name);
    REQUIRE(tomato != constants.end());
    CHECK(tomato->rgb == 0xff6347u);
    for (const fathom::DiagnosticCode &code : fathom::diagnostic_codes()) {
        INFO(code.name);
        CHECK_FALSE(code.summary.empty());
        CHECK(code.page.starts_with("# " + code.name));
    }
    bool sphere = false;
    for (const fathom::LibraryEntry &entry : fathom::library_entries())
        sphere = sphere || (entry.name == "sphere" && entry.file.ends_with(".sdf"));
    CHECK(sphere);
}

TEST_CASE("a text that cannot be formatted says why") {
    const fathom::Formatted good = fathom::format_text("a.sdf", "sphere( 1 )\n");
    CHECK(good.text == "sphere(1)\n");
    const fathom::Formatted bad = fathom::format_text("a.sdf", "sphere(\n");
    CHECK_FALSE(bad.text);
    REQUIRE_FALSE(bad.diagnostics.empty());
    CHECK(fathom::printed(bad.diagnostics[0], bad.texts).starts_with("a.sdf:"));
}

TEST_CASE("the table of targets is that of their names; the noise cache has its passes") {
    std::vector<std::string> names;
    for (const fathom::ShaderTarget &target : fathom::shader_target_table()) {
        names.push_back(target.name);
        CHECK(target.suffix.starts_with("."));
    }
    CHECK(names == fathom::shader_targets());

    const fathom::Scene noisy =
        said_scene("sphere(1).displace(cached(p => 0.03 * fbm(2 * p, octaves: 6), cell: 0.05))\n");
    for (const fathom::ShaderTarget &target : fathom::shader_target_table()) {
        INFO(target.name);
        fathom::ShaderOptions options;
        options.target = target.name;
        options.noise_cache = true;
        std::vector<fathom::Diagnostic> said;
        const auto shader = fathom::make_shader(noisy, options, &said);
        CHECK(shader.has_value() == target.noise_cache);
        if (!shader) {
            REQUIRE_FALSE(said.empty());
            CHECK(said[0].code == "usage");
            continue;
        }
        for (const std::string *pass : {&shader->cache.reserve, &shader->cache.fill,
                                        &shader->cache.publish, &shader->cache.sweep})
            CHECK(pass->find("void main") != std::string::npos);
        options.noise_cache = false;
        CHECK(fathom::make_shader(noisy, options)->cache.fill.empty());
    }
}

TEST_CASE("files are read up to a limit and written whole") {
    const Folder folder;
    std::string why;
    CHECK(fathom::write_file(folder.path / "a", "12345").empty());
    CHECK(fathom::read_file(folder.path / "a", 5, why) == "12345");
    CHECK_FALSE(fathom::read_file(folder.path / "a", 4, why));
    CHECK_FALSE(why.empty());
    CHECK_FALSE(fathom::read_file(folder.path / "b", 5, why));
    CHECK(why == "no such file");
    CHECK_FALSE(fathom::write_file(folder.path / "none" / "a", "1").empty());
}

TEST_CASE("a watcher hears of an import, and of what was saved before it watched") {
    const Folder folder;
    const fs::path part = folder.path / "part.sdf", scene = folder.path / "scene.sdf";
    REQUIRE(fathom::write_file(part, "let ball = sphere(1)\n").empty());
    REQUIRE(fathom::write_file(scene, "import \"part.sdf\" as part\npart.ball\n").empty());
    const auto result = fathom::compile_file(scene);
    REQUIRE(result);
    REQUIRE(fathom::write_file(part, "let ball = sphere(20)\n").empty());
    fathom::Watcher watcher;
    watcher.watch(result);
    CHECK(watcher.wait(std::chrono::seconds(10)));
    watcher.watch(fathom::compile_file(scene));
    CHECK_FALSE(watcher.wait(std::chrono::milliseconds(1)));
    std::thread other([&] { watcher.wake(); });
    CHECK_FALSE(watcher.wait(std::chrono::seconds(100)));
    other.join();
}
