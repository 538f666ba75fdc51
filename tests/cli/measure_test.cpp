// `fathom measure` as scripts see it.
#include "shell.h"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include <sstream>

using Json = nlohmann::json;

namespace {

bool holds(const Json &row, double value) {
    return row["least"].get<double>() <= value && value <= row["most"].get<double>();
}

} // namespace

TEST_CASE("a solid's measures as a table and as JSON") {
    ScratchFolder folder;
    folder.write("block.sdf", "param d = 3 in 1..4\nbox([1, 2, d]).translate(x: 10)\n");
    const Result table = shell(folder, "fathom measure block.sdf --resolution 24");
    CHECK(table.exit == 0);
    CHECK(table.err.empty());
    for (const char *part : {"at least", "at most", "volume  ", "area  ", "size x  ", "centre z  "})
        CHECK(contains(table.out, part));
    const Result made = shell(folder, "fathom measure block.sdf --resolution 24 --density 7.85 "
                                      "--units cm --json");
    CHECK(made.exit == 0);
    const Json json = Json::parse(made.out);
    CHECK(holds(json["volume"], 6));
    CHECK(holds(json["mass"], 47.1));
    CHECK(json["area"]["value"].get<double>() == Approx(22).epsilon(1e-3));
    CHECK(holds(json["area"], 22));
    CHECK(json["area"]["most"].get<double>() - json["area"]["least"].get<double>() < 0.7);
    CHECK(holds(json["center"][0], 10));
    CHECK(holds(json["from"][2], -1.5));
    CHECK(holds(json["to"][1], 1));
    CHECK(json["unit"] == "cm");
    CHECK((json["mesh_components"] == 1 && json["mesh_genus"] == 0));
    const Json deeper = Json::parse(
        shell(folder, "cat block.sdf | fathom measure - -D d=4 --resolution 24 --json").out);
    CHECK(holds(deeper["volume"], 8));
    CHECK(deeper["unit"].is_null());
}

TEST_CASE("parts are measured by their names, and how far they are apart") {
    ScratchFolder folder;
    folder.write("pair.sdf", "let peg = sphere(1)\npeg\nbox(1).translate(x: 3)\n"
                             "for i in 0..2 { box(0.5).translate(y: 3 + i) }\n"
                             "peg.translate(x: 1.5)\n");
    const Result made = shell(folder, "fathom measure pair.sdf --resolution 24 --parts --json "
                                      "--between peg,box --between 'peg,peg#2'");
    REQUIRE(made.exit == 0);
    const Json json = Json::parse(made.out);
    REQUIRE(json["parts"].size() == 4);
    const char *names[] = {"peg", "box", "box#2", "peg#2"};
    for (std::size_t k = 0; k < 4; ++k) CHECK(json["parts"][k]["name"] == names[k]);
    CHECK(json["parts"][1]["line"] == 3);
    CHECK(holds(json["parts"][1]["volume"], 1));
    CHECK(json["parts"][2]["mesh_components"] == 2); // all passes of the loop
    CHECK(holds(json["clearances"][0], 1.5));
    CHECK(json["clearances"][1]["most"] == 0); // they have points in common
    const Json alone =
        Json::parse(shell(folder, "fathom measure pair.sdf --part box --resolution 24 --json").out);
    CHECK(alone["volume"] == json["parts"][1]["volume"]);
    const Result mesh = shell(folder, "fathom mesh pair.sdf --part box --resolution 12 -o -"),
                 all = shell(folder, "fathom mesh pair.sdf --resolution 12 -o -");
    CHECK((mesh.exit == 0 && mesh.out != all.out));
}

TEST_CASE("a drawing's area, border, box and centre are measured") {
    const ScratchFolder folder;
    folder.write("plate.sdf", "param r = 4 in 1..5\n"
                              "rectangle([40, 20]) - circle(r).translate(x: 10)\n"
                              "circle(3).translate(x: 40)\n");
    const std::string measure = "fathom measure plate.sdf --resolution 64 ";
    const Result made = shell(folder, measure + "-D r=5 --json --units mm --parts "
                                                "--between rectangle,circle");
    INFO(made.err);
    REQUIRE(made.exit == 0);
    const double pi = 3.14159265358979;
    const Json json = Json::parse(made.out);
    CHECK(holds(json["area"], 800 - 25 * pi + 9 * pi));
    CHECK(holds(json["perimeter"], 120 + 10 * pi + 6 * pi));
    CHECK(holds(json["perimeter"], json["perimeter"]["value"].get<double>()));
    CHECK(json["perimeter"]["most"].get<double>() < 172);
    CHECK(json["area"]["most"].get<double>() < 750);
    CHECK(holds(json["center"][0], (-250 * pi + 360 * pi) / (800 - 16 * pi)));
    CHECK(json["center"].size() == 2);
    CHECK((holds(json["from"][0], -20) && holds(json["to"][0], 43) && holds(json["to"][1], 10)));
    CHECK((json["outlines"] == 2 && json["holes"] == 1 && json["unit"] == "mm"));
    CHECK(holds(json["parts"][1]["area"], 9 * pi));
    CHECK(holds(json["clearances"][0], 17));
    const Result table = shell(folder, measure);
    for (const char *part : {"area  ", "perimeter  ", "size y  ", "centre x  "})
        CHECK(contains(table.out, part));
    CHECK_FALSE((contains(table.out, "volume") || contains(table.out, "size z")));
    const Json cut = Json::parse(shell(folder, measure + "--json --bounds=-50,-50,-1,0,50,1").out);
    CHECK(holds(cut["area"], 400));
    const Result mass = shell(folder, measure + "--density 2");
    CHECK((mass.exit == 2 && contains(mass.err, "--density is of solids")));
    const Result piped = shell(folder, "cat plate.sdf | fathom measure -");
    CHECK((piped.exit == 1 && contains(piped.err, "name the scene")));
    folder.write("mixed.sdf", "circle(1)\nsphere(1)\n");
    const Result mixed = shell(folder, "fathom measure mixed.sdf");
    CHECK((mixed.exit == 1 && contains(mixed.err, "flat-shape")));
    folder.write("none.sdf", "circle(1) & circle(1).translate(x: 5)\n");
    CHECK(contains(shell(folder, "fathom measure none.sdf").err, "empty"));
}

TEST_CASE("a printed number lies in what is proved of it") {
    ScratchFolder folder;
    folder.write("needle.sdf", "cone(0.05, 2)\n"); // its tip is lost by coarse cells
    const Result made =
        shell(folder, "fathom measure needle.sdf --resolution 8 --density 1 --json");
    REQUIRE(made.exit == 0);
    const Json json = Json::parse(made.out);
    std::vector<Json> rows{json["volume"], json["mass"]};
    for (const char *name : {"center", "from", "to"})
        for (const Json &row : json[name]) rows.push_back(row);
    for (const Json &row : rows) {
        INFO(row.dump());
        CHECK(holds(row, row["value"].get<double>()));
    }
}

TEST_CASE("small numbers are printed as they are, however far away the solid is") {
    ScratchFolder folder;
    folder.write("far.sdf", "sphere(0.001).translate(x: 10)\n");
    const Result made = shell(folder, "fathom measure far.sdf --resolution 24");
    REQUIRE(made.exit == 0);
    const double pi = 3.14159265358979;
    for (const auto &[name, value] :
         {std::pair<std::string, double>{"  volume ", 4e-9 / 3 * pi}, {"  area ", 4e-6 * pi}}) {
        const std::size_t at = made.out.find(name);
        REQUIRE(at != std::string::npos);
        std::istringstream row(made.out.substr(at + name.size()));
        double printed = 0, least = 0, most = 0;
        row >> printed >> least >> most;
        INFO(made.out);
        CHECK((0 < least && least <= value && value <= most && most < 2 * value));
    }
}

TEST_CASE("a part that holds no point is listed as empty") {
    ScratchFolder folder;
    folder.write("pair.sdf", "let none = sphere(1) & sphere(1).translate(x: 5)\nbox(1)\nnone\n"
                             "sphere(1).translate(x: 9)\n");
    const Result made = shell(folder, "fathom measure pair.sdf --parts --resolution 16 --json");
    INFO(made.err);
    REQUIRE(made.exit == 0);
    const Json json = Json::parse(made.out);
    CHECK(json["parts"].size() == 2);
    CHECK(json["empty"] == Json{"none"});
    const Result table = shell(folder, "fathom measure pair.sdf --parts --resolution 16");
    CHECK(contains(table.out, "none, line 3\n  holds no point\n"));
}

TEST_CASE("a wall that the mesh has holes in is said beside its measures") {
    ScratchFolder folder;
    folder.write("shell.sdf", "capped_cone(1, 0.85, 0.02)\n"); // its edge is thinner still
    const Result thin = shell(folder, "fathom measure shell.sdf --resolution 24");
    CHECK(thin.exit == 0);
    CHECK(contains(thin.err, "what stands beside the enclosures is of a mesh: walls or gaps may "
                             "have holes: one is about 0.0"));
    folder.write("round.sdf", "sphere(1).shell(0.01)\n");
    CHECK(contains(shell(folder, "fathom measure round.sdf --resolution 24").err,
                   "walls thinner than cells are drawn by the solid grown by 0.0"));
    folder.write("ball.sdf", "sphere(1)\n");
    CHECK(shell(folder, "fathom measure ball.sdf --resolution 24").err.empty());
}

TEST_CASE("what cannot be measured says why") {
    ScratchFolder folder;
    folder.write("ground.sdf", "plane(Y, 0)\n");
    folder.write("nothing.sdf", "sphere(1) & sphere(1).translate(x: 5)\n");
    folder.write("ball.sdf", "sphere(1)\n");
    folder.write("wrong.sdf", "shpere(1)\n");
    const auto fails = [&](const std::string &arguments, int exit, const std::string &words) {
        INFO(arguments);
        const Result made = shell(folder, "fathom measure " + arguments);
        CHECK(made.exit == exit);
        INFO(made.err);
        CHECK(contains(made.err, words));
        CHECK(made.out.empty());
    };
    fails("ground.sdf", 1, "`--bounds X,Y,Z,X,Y,Z`");
    fails("nothing.sdf", 1, "empty");
    fails("wrong.sdf", 1, "unknown-name");
    fails("none.sdf", 3, "none.sdf");
    fails("ball.sdf --part egg", 2, "there is no part `egg`; this scene has sphere");
    fails("ball.sdf --between sphere", 2, "wants two parts");
    fails("ball.sdf --between sphere,egg", 2, "there is no part `egg`");
    fails("ball.sdf --part sphere --parts", 2, "one of them");
    fails("ball.sdf --density 0", 2, "above 0");
    fails("ball.sdf --units furlong", 2, "um, mm, cm, m, in or ft");
    fails("ball.sdf --tolerance 1e-9", 2, "too fine");
    fails("ball.sdf --bounds=5,5,5,6,6,6", 1, "no point of the solid lies in the bounds");
    fails("ball.sdf --bounds=-1e12,-2,-2,2,2,2", 2, "within 1e9 of the origin");
    const std::string cut = " --resolution 16 --bounds=-1,-1,-1,1,1,1";
    const Result ground = shell(folder, "fathom measure ground.sdf" + cut);
    CHECK(ground.exit == 0);
    CHECK(ground.err.empty()); // it has an end now, and no camera looks
    CHECK(shell(folder, "fathom measure ball.sdf --bounds=-1e8,-2,-2,2,2,2 --resolution 16").exit ==
          0);
}

TEST_CASE("a mesh, a measure and a check of one moment are proved for that moment") {
    const ScratchFolder folder;
    folder.write("power.sdf", "implicit(p => length(p) - 1 - 0.1 * pow(max(p.x, 0), time), "
                              "within: ball(2))\n");
    folder.write("waves.sdf", "param a = 0.0 in 0.0..20.0\n"
                              "sphere(6).displace(p => a * sin(p.x) * sin(p.y) * sin(p.z))\n");
    const auto exit = [&](const std::string &words) {
        return shell(folder, "fathom " + words).exit;
    };
    CHECK(exit("check power.sdf") == 1);
    CHECK(exit("check power.sdf --time 2") == 0);
    CHECK(exit("check power.sdf --time 0.5") == 1);
    folder.write("short.sdf", "box(1).displace(p => 0.1 * sin(p.x * (1 + time)))\n"
                              "render(time: 10)\n");
    CHECK(exit("check short.sdf --time 10") == 0);
    CHECK(exit("check short.sdf --time 10.5") == 2);
    CHECK(contains(shell(folder, "fathom check waves.sdf --time 0").err, "lipschitz 1\n"));
    CHECK(exit("mesh power.sdf --resolution 12 --time 0.5 -o a.stl") == 1);
    CHECK(exit("mesh power.sdf --resolution 12 --time 2 -o a.stl") == 0);
    CHECK(exit("mesh power.sdf --resolution 12 --time 2 --frames 0..3 -o f.stl") == 0);
    CHECK(exit("measure power.sdf --resolution 12 --time 2") == 0);
    CHECK(exit("slice power.sdf --resolution 12 --time 2 --z 0 -o a.svg") == 0);
}

TEST_CASE("a bound that is not the one that was stated says which is, and what makes it another") {
    ScratchFolder folder;
    const std::string field = "fn g(p: vec3) -> float = if p.y > 0 { atan(p.x + 4) } else { pi / 2 "
                              "- atan(1 / (p.x + 4)) }\n"
                              "implicit(p => length(p) - 1 + 0.2 * g(p), lipschitz: 1.5, within: ";
    folder.write("whole.sdf", field + "ball(2))\n");
    folder.write("holed.sdf", field + "ball(2) - tube(Y, 0.4))\n");
    folder.write("twisted.sdf", field + "ball(2)).twist(0.5)\n");
    CHECK(contains(shell(folder, "fathom check whole.sdf").err, "ok, assumed, lipschitz 1.5\n"));
    const std::string holed = shell(folder, "fathom check holed.sdf").err;
    CHECK(contains(holed, "ok, assumed, lipschitz 3.17"));
    CHECK(contains(holed, "(1.5 is stated; within makes it 2.114 times as much: the field inside, "
                          "led on across the region's holes"));
    CHECK(
        contains(shell(folder, "fathom check twisted.sdf").err, "(1.5 is stated; twist makes it "));
}
