// The library as its users meet it: by the public headers alone.
#include <catch2/catch.hpp>

#include <fathom/fathom.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>
#include <thread>

namespace {

fathom::Scene compiled(std::string_view text, const fathom::CompileOptions &options = {}) {
    fathom::CompileResult result = fathom::compile_text("test.sdf", text, options);
    for (const fathom::Diagnostic &d : result.diagnostics) UNSCOPED_INFO(d.message);
    REQUIRE(result.scene);
    return *result.scene;
}

fathom::Field field_of(const fathom::Scene &scene, double time = 0) {
    std::optional<fathom::Field> field = fathom::make_field(scene, time);
    REQUIRE(field);
    return *field;
}

float at(const fathom::Field &field, fathom::Point point) {
    float distance = 0;
    REQUIRE(field.distances({&point, 1}, {&distance, 1}));
    return distance;
}

// Points of a lattice about the origin.
std::vector<fathom::Point> lattice(int side, float extent) {
    std::vector<fathom::Point> points;
    const auto place = [&](int i) {
        return extent * (2 * (static_cast<float>(i) + 0.37f) / static_cast<float>(side) - 1);
    };
    for (int x = 0; x < side; ++x)
        for (int y = 0; y < side; ++y)
            for (int z = 0; z < side; ++z) points.push_back({place(x), place(y), place(z)});
    return points;
}

} // namespace

TEST_CASE("a text that does not compile says where and what to write") {
    const fathom::CompileResult result = fathom::compile_text("a.sdf", "shpere(1)\n");
    CHECK_FALSE(result);
    REQUIRE(result.diagnostics.size() == 1);
    const fathom::Diagnostic &d = result.diagnostics[0];
    CHECK(d.code == "unknown-name");
    CHECK(d.severity == fathom::Severity::Error);
    CHECK(d.at.file == "a.sdf");
    CHECK((d.at.line == 1 && d.at.column == 1 && d.at.end_column == 7));
    REQUIRE(d.edits.size() == 1);
    CHECK(d.edits[0].replacement == "sphere");
    CHECK((d.edits[0].at.begin == 0 && d.edits[0].at.end == 6));
}

TEST_CASE("a file that is not there is a diagnostic") {
    const fathom::CompileResult result = fathom::compile_file("no such file.sdf");
    CHECK_FALSE(result);
    REQUIRE(result.diagnostics.size() == 1);
    CHECK(result.diagnostics[0].code == "unreadable");
    CHECK(result.diagnostics[0].at.line == 0);
}

TEST_CASE("a provider stands for the file system") {
    std::vector<std::string> asked;
    fathom::CompileOptions options;
    options.files = [&](const std::string &path) -> std::optional<std::string> {
        asked.push_back(path);
        if (path == "parts/a.sdf") return "import \"b.sdf\"\nfn a() = b(2)\n";
        if (path == "parts/b.sdf") return "fn b(r) = sphere(r)\n";
        return std::nullopt;
    };
    const fathom::Scene scene = compiled("import \"parts/a.sdf\"\na()\n", options);
    CHECK(at(field_of(scene), {3, 0, 0}) == 1);
    CHECK(asked == std::vector<std::string>{"parts/a.sdf", "parts/b.sdf"});

    const auto missing = fathom::compile_text("test.sdf", "import \"c.sdf\"\nsphere(1)\n", options);
    CHECK_FALSE(missing);
    asked.clear();
    const auto outside =
        fathom::compile_text("test.sdf", "import \"../c.sdf\"\nsphere(1)\n", options);
    CHECK_FALSE(outside);
    CHECK(asked.empty()); // not even asked for
}

TEST_CASE("params are read and set") {
    const fathom::Scene scene = compiled("param r = 1 in 0.5..2\nparam n = 2 in 1..4\n"
                                         "union { for i in 0..n { sphere(r).translate(x: 9*i) } }");
    REQUIRE(scene.params().size() == 2);
    CHECK(scene.params()[0].name == "r");
    CHECK(scene.params()[0].ranged);
    CHECK((scene.params()[0].lo[0] == 0.5 && scene.params()[0].hi[0] == 2));
    CHECK(scene.params()[1].structural);

    const fathom::CompileResult larger = scene.with({{"r", {2}}});
    REQUIRE(larger);
    CHECK(at(field_of(*larger.scene), {-3, 0, 0}) == 1);
    CHECK(at(field_of(scene), {-3, 0, 0}) == 2); // the old one is as it was

    const fathom::CompileResult more = larger.scene->with({{"n", {3}}});
    REQUIRE(more);
    CHECK(at(field_of(*more.scene), {18, 0, 0}) == -2);
    CHECK(more.scene->params()[0].value[0] == 2); // and what was set stays set

    for (const auto &[name, value] : std::map<std::string, std::vector<double>>{
             {"q", {1}}, {"r", {3}}, {"r ", {1}}, {"n", {1.5}}}) {
        const fathom::CompileResult refused = scene.with({{name, value}});
        CHECK_FALSE(refused);
        REQUIRE(refused.diagnostics.size() == 1);
        CHECK(refused.diagnostics[0].code == "usage");
    }
    CHECK_FALSE(scene.with({{"r", {1, 2}}}));
    CHECK_FALSE(scene.with({{"r", {std::nan("")}}}));
}

TEST_CASE("facts say what was proved") {
    const fathom::Scene ball = compiled("sphere(1).translate(x: 1)");
    CHECK(ball.facts().exact);
    CHECK(ball.facts().status == fathom::Status::Proved);
    CHECK(ball.facts().lipschitz == 1.0);
    REQUIRE(ball.facts().bounds);
    CHECK((ball.facts().bounds->lo[0] <= 0 && ball.facts().bounds->hi[0] >= 2));

    const fathom::Scene wave = compiled("implicit(p => p.y - sin(3 * p.x))");
    CHECK(*wave.facts().lipschitz > 3);
    CHECK_FALSE(wave.facts().exact);
    CHECK_FALSE(wave.facts().bounds);
}

TEST_CASE("there is no field where the facts do not hold") {
    const fathom::Scene moves = compiled("sphere(1 + time)\nrender(time: 2)"),
                        rests = compiled("sphere(1)\nrender(time: 2)");
    for (const double time : {-0.1, 2.1, std::nan(""), -std::numeric_limits<double>::infinity()}) {
        CHECK_FALSE(fathom::hold_at(moves.facts(), time));
        CHECK_FALSE(fathom::make_field(moves, time));
        CHECK(fathom::make_field(rests, time).has_value() == std::isfinite(time));
    }
    CHECK(fathom::make_field(moves, 2));
}

TEST_CASE("distances, gradients and intervals agree") {
    const fathom::Scene scene = compiled(
        "smooth_union(0.3, sphere(1), box(1.5).rotate(30deg, axis: X)) - cylinder(0.3, 4)");
    const fathom::Field field = field_of(scene);
    const std::vector<fathom::Point> points = lattice(13, 2);
    std::vector<float> values(points.size()), again(points.size());
    std::vector<fathom::Point> gradients(points.size());
    REQUIRE(field.distances(points, values));
    REQUIRE(field.gradients(points, again, gradients));
    CHECK(values == again);
    for (const fathom::Point &g : gradients) CHECK(std::hypot(g[0], g[1], g[2]) < 1.0001f);

    // A box about each point, and one about all: each holds what is found in it.
    std::vector<fathom::Box> boxes;
    for (const fathom::Point &p : points)
        boxes.push_back(
            {{p[0] - 0.1f, p[1] - 0.1f, p[2] - 0.1f}, {p[0] + 0.1f, p[1] + 0.1f, p[2] + 0.1f}});
    boxes.push_back({{-2, -2, -2}, {2, 2, 2}});
    std::vector<fathom::Interval> intervals(boxes.size());
    REQUIRE(field.intervals(boxes, intervals));
    for (std::size_t k = 0; k < points.size(); ++k) {
        CHECK((intervals[k].lo <= values[k] && values[k] <= intervals[k].hi));
        CHECK((intervals.back().lo <= values[k] && values[k] <= intervals.back().hi));
        CHECK(intervals[k].hi - intervals[k].lo < 2);
    }
}

TEST_CASE("a steep field's distances are continuous, and their gradients theirs") {
    const fathom::Field field =
        field_of(compiled("implicit(p => p.y - 0.1 * p.x ^ 6, within: ball(2))"));
    std::vector<fathom::Point> points;
    for (int i = 0; i < 2000; ++i)
        points.push_back({0.5f, -1.2f + 0.0012f * static_cast<float>(i), -1.0f});
    std::vector<float> distances(points.size());
    std::vector<fathom::Point> gradients(points.size());
    REQUIRE(field.gradients(points, distances, gradients));
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        REQUIRE(std::abs(distances[i + 1] - distances[i]) <= 0.0013f);
        REQUIRE(gradients[i][1] > 0);
    }
}

TEST_CASE("spans of unlike lengths compute what all hold") {
    const fathom::Field field = field_of(compiled("sphere(1)"));
    const std::vector<fathom::Point> points{{2, 0, 0}, {3, 0, 0}, {4, 0, 0}};
    std::vector<float> two(2, -9);
    REQUIRE(field.distances(points, two));
    CHECK(two == std::vector<float>{1, 2});
    std::vector<float> none;
    CHECK(field.distances(points, none));
    CHECK(field.distances({}, two));
}

TEST_CASE("threads share a scene and a field") {
    const fathom::Scene scene = compiled("sphere(1).displace(p => 0.1 * sin(5 * p.x + time))");
    const fathom::Field field = field_of(scene, 0.5);
    const std::vector<fathom::Point> points = lattice(12, 2);
    std::vector<float> alone(points.size());
    REQUIRE(field.distances(points, alone));
    std::vector<std::vector<float>> found(8, std::vector<float>(points.size()));
    std::vector<std::thread> threads;
    for (std::vector<float> &values : found)
        threads.emplace_back([&] {
            for (int turn = 0; turn < 20; ++turn) field.distances(points, values);
        });
    for (std::thread &thread : threads) thread.join();
    for (const std::vector<float> &values : found) CHECK(values == alone);
}

TEST_CASE("every target makes a shader, and tells its uniforms") {
    const fathom::Scene scene = compiled("param r = 1 in 0.5..2\nsphere(r)");
    const std::vector<std::string> targets = fathom::shader_targets();
    CHECK(targets.size() > 3);
    for (const std::string &target : targets) {
        INFO(target);
        fathom::ShaderOptions options;
        options.target = target;
        std::vector<fathom::Diagnostic> said;
        const auto shader = fathom::make_shader(scene, options, &said);
        REQUIRE(shader);
        CHECK(shader->text.empty() != shader->words.empty());
    }
    const auto shader = fathom::make_shader(scene);
    REQUIRE(shader);
    REQUIRE(shader->uniforms.size() == 1);
    CHECK(shader->uniforms[0].param == "r");
    CHECK(shader->text.find(shader->uniforms[0].name) != std::string::npos);

    fathom::ShaderOptions options;
    options.target = "glsl999";
    std::vector<fathom::Diagnostic> said;
    CHECK_FALSE(fathom::make_shader(scene, options, &said));
    REQUIRE(said.size() == 1);
    CHECK(said[0].code == "usage");
}

TEST_CASE("a shader's inputs are its uniforms, with the first view's values") {
    const fathom::Scene scene = compiled("param r = 1 in 0.5..2 \"Radius\"\n"
                                         "param n = 2 in 1..5\n"
                                         "for i in 0..n { sphere(r).translate(x: 3 * i) }");
    for (const std::string &target : fathom::shader_targets()) {
        INFO(target);
        fathom::ShaderOptions options;
        options.target = target;
        const auto shader = fathom::make_shader(scene, options);
        REQUIRE(shader);
        for (const fathom::ShaderInput &input : shader->inputs) {
            INFO(input.name);
            CHECK(input.meaning.empty() != input.param.empty()); // no sampler here
            CHECK_FALSE(input.value.empty());
            CHECK((input.place >= 0) == !shader->words.empty());
            if (shader->words.empty() && target != "html") // whose page has its text packed
                CHECK(shader->text.find("uniform " + input.type + " " + input.name) !=
                      std::string::npos);
        }
        const auto r = std::ranges::find(shader->inputs, "r", &fathom::ShaderInput::param);
        const bool hosted = target != "shadertoy" && target != "glslviewer";
        CHECK((r != shader->inputs.end()) == hosted);
        CHECK((shader->reflection.find("\"param\": \"n\"") >
               shader->reflection.find("\"constants\"")));
        if (!hosted) continue;
        CHECK((r->value == std::vector<double>{1} && r->type == "float"));
        REQUIRE(shader->uniforms.size() == 1);
        CHECK(shader->uniforms[0].location == r->place);
    }
}

TEST_CASE("a shader's camera goes around, up and away from what it looks at") {
    const auto shader =
        fathom::make_shader(compiled("sphere(1)\ncamera(at: [0, 0, 5], look_at: [0, 0, 1])\n"));
    REQUIRE(shader);
    const auto value = [&](double around, double above, double distance, const char *name) {
        for (const auto &input : fathom::turned_camera(*shader, around, above, distance))
            if (input.name == name) return input.value;
        return std::vector<double>{};
    };
    const auto near = [](const std::vector<double> &a, const std::vector<double> &b) {
        return std::ranges::equal(a, b, [](double x, double y) { return std::abs(x - y) < 1e-9; });
    };
    constexpr double quarter = std::numbers::pi / 2;
    for (const fathom::ShaderInput &input : fathom::turned_camera(*shader, 0, 0)) {
        const auto first =
            std::ranges::find(shader->inputs, input.name, &fathom::ShaderInput::name);
        CHECK((first != shader->inputs.end() && near(input.value, first->value)));
    }
    CHECK(near(value(quarter, 0, 1, "fathom_origin"), {4, 0, 1}));
    CHECK(near(value(0, quarter / 3, 2, "fathom_origin"), {0, 4, 1 + 8 * std::cos(quarter / 3)}));
    CHECK(near(value(0, 0, 2, "fathom_focus"), {8}));
    CHECK(near(value(0, 9, 1, "fathom_forward"), {0, -1, 0})); // no farther than straight down
    CHECK(near(value(0, 9, 1, "fathom_up"), {0, 0, -1}));
    CHECK(near(value(quarter, -9, 1, "fathom_forward"), {0, 1, 0}));

    fathom::ShaderOptions field;
    field.field_only = true;
    const auto alone = fathom::make_shader(compiled("sphere(1)"), field);
    REQUIRE(alone);
    CHECK(fathom::turned_camera(*alone, 1, 1).empty());
}

TEST_CASE("a volume is the distances at its lattice") {
    const fathom::Field field = field_of(compiled("sphere(1).translate(x: 1)"));
    const fathom::Box box{{-1, -2, -3}, {1, 2, 3}};
    std::vector<float> values(3 * 5 * 4);
    REQUIRE(field.volume(box, {3, 5, 4}, values));
    for (std::size_t z = 0; z < 4; ++z)
        for (std::size_t y = 0; y < 5; ++y)
            for (std::size_t x = 0; x < 3; ++x)
                CHECK(values[(z * 5 + y) * 3 + x] ==
                      at(field, {static_cast<float>(x) - 1, static_cast<float>(y) - 2,
                                 2 * static_cast<float>(z) - 3}));
    CHECK_FALSE(field.volume(box, {1, 5, 4}, values));
    CHECK_FALSE(field.volume(box, {3, 5, 5}, values));
    CHECK_FALSE(field.volume({{1, 0, 0}, {1, 1, 1}}, {3, 5, 4}, values));
    const std::size_t huge = std::numeric_limits<std::size_t>::max() / 2;
    CHECK_FALSE(field.volume(box, {huge, huge, 4}, values));
}

TEST_CASE("facts name what they rest on") {
    const fathom::Scene scene = compiled("sphere(1)");
    CHECK(std::ranges::count(scene.facts().axioms, "sphere: exact") == 1);
}

TEST_CASE("the save format goes out and comes back") {
    const fathom::Scene scene = compiled("box([1, 2, 3]).translate(x: 1)");
    std::vector<fathom::Diagnostic> said;
    const std::string yaml = fathom::export_yaml(scene, &said);
    CHECK(said.empty());
    const fathom::CompileResult back = fathom::compile_text("back.yaml", yaml);
    REQUIRE(back);
    const fathom::Field one = field_of(scene), two = field_of(*back.scene);
    for (const fathom::Point &p : lattice(5, 3))
        CHECK(at(one, p) == Approx(at(two, p)).margin(1e-6));
    const fathom::Imported broken = fathom::import_yaml("b.yaml", "{[");
    CHECK_FALSE(broken.complete);
    CHECK_FALSE(broken.diagnostics.empty());
}

TEST_CASE("texts are formatted") {
    CHECK(fathom::format_text("sphere( 1 )") == "sphere(1)\n");
    CHECK_FALSE(fathom::format_text("sphere("));
}

TEST_CASE("public headers see only themselves and the standard library") {
    namespace fs = std::filesystem;
    const fs::path folder = fs::path(FATHOM_SOURCE_DIR) / "include/fathom";
    int counted = 0;
    for (const fs::directory_entry &entry : fs::directory_iterator(folder)) {
        std::ifstream in(entry.path());
        for (std::string line; std::getline(in, line);) {
            if (line.rfind("#include", 0) != 0) continue;
            ++counted;
            INFO(entry.path() << ": " << line);
            const std::string name =
                line.substr(line.find('<') + 1, line.find('>') - line.find('<') - 1);
            CHECK(line.find('"') == line.npos);
            CHECK((name.rfind("fathom/", 0) == 0 || name.find('/') == name.npos));
            if (name.rfind("fathom/", 0) == 0) CHECK(fs::exists(folder.parent_path() / name));
        }
    }
    CHECK(counted > 20);
}

namespace {

// Fields whose proof asks many times whether it is still wanted.
std::string steep_fields(int count) {
    std::string text;
    for (int i = 0; i < count; ++i)
        text += "implicit(p => sin(" + std::to_string(i + 3) +
                "*p.x + sin(5*p.y)) * cos(6*p.z + sin(4*p.x*p.y)) * sin(p.x*p.z), "
                "within: ball(4))\n";
    return text;
}

} // namespace

TEST_CASE("a compilation that is cancelled ends early") {
    fathom::CompileOptions options;
    std::vector<fathom::Phase> phases;
    options.entered = [&](fathom::Phase phase) { phases.push_back(phase); };
    int asked = 0;
    options.cancelled = [&] { return ++asked, false; };
    options.cache = fathom::ProofCache::of_bytes();
    REQUIRE(fathom::compile_text("a.sdf", steep_fields(6), options));
    const int asked_in_all = asked;
    const std::size_t searches = options.cache.searches();
    CHECK(asked_in_all > 40);
    CHECK(searches >= 6);
    using fathom::Phase;
    CHECK(phases == std::vector{Phase::Check, Phase::Prove, Phase::Lower, Phase::Done});

    phases.clear();
    asked = 0;
    options.cache = fathom::ProofCache::of_bytes();
    options.cancelled = [&] { return ++asked >= 8; };
    const fathom::CompileResult ended = fathom::compile_text("a.sdf", steep_fields(6), options);
    CHECK_FALSE(ended);
    REQUIRE(ended.diagnostics.size() == 1);
    CHECK(ended.diagnostics[0].code == "cancelled");
    CHECK(asked == 8); // once it was told it asks no more
    CHECK(phases.back() == Phase::Prove);
    CHECK(options.cache.searches() < searches / 2); // what was left is not searched

    // What was found before is of use, and what was broken off does no harm.
    options.cancelled = nullptr;
    const fathom::Scene after = compiled(steep_fields(6), options);
    CHECK(*after.facts().lipschitz == *compiled(steep_fields(6)).facts().lipschitz);

    options.cancelled = [] { return true; };
    CHECK_FALSE(fathom::compile_text("a.sdf", "sphere(1)\n", options));
}

TEST_CASE("a cache of proofs changes no answer, and may be shared by threads") {
    fathom::CompileOptions options;
    options.cache = fathom::ProofCache::of_bytes();
    const fathom::Facts alone = compiled(steep_fields(3)).facts();
    std::vector<double> bounds(4);
    std::vector<std::thread> threads;
    for (double &bound : bounds)
        threads.emplace_back([&] {
            const auto result = fathom::compile_text("a.sdf", steep_fields(3), options);
            bound = result ? *result.scene->facts().lipschitz : 0;
        });
    for (std::thread &thread : threads) thread.join();
    for (double bound : bounds) CHECK(bound == *alone.lipschitz);
    const std::size_t searches = options.cache.searches();
    compiled("// moved\n" + steep_fields(3), options);
    CHECK(options.cache.searches() == searches);
    CHECK(options.cache.bytes() > 0);
    CHECK(fathom::ProofCache().searches() == 0);
    options.cache = fathom::ProofCache::of_bytes(100); // holds nothing, and does no harm
    CHECK(*compiled(steep_fields(1), options).facts().lipschitz > 0);
    CHECK(options.cache.bytes() <= 100);
}
