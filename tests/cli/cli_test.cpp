// The program as scripts and editors see it: exit statuses, which stream says what, what is left
// behind. Runs the real one, through a shell.
#include "shell.h"

#include "backend-glsl/targets.h"

#include <catch2/catch.hpp>

namespace glsl = fathom::glsl;

namespace {

struct Scenes : ScratchFolder {
    Scenes() {
        write("good.sdf", "sphere(1)\n");
        write("bad.sdf", "spere(1)\nbox(1).rotate(90)\n");
        write("missing.sdf", "import \"nowhere.sdf\"\nsphere(1)\n");
        write("param.sdf", "param radius = 1.0 in 0.5..2.0\nsphere(radius)\n");
        write("broken.sdf", "sphere(\n");
    }
};

} // namespace

TEST_CASE("the noise cache's passes are written beside the picture's shader") {
    const ScratchFolder folder;
    folder.write("rock.sdf",
                 "sphere(1).displace(cached(p => 0.03 * fbm(2 * p, octaves: 6), cell: 0.05))\n");
    folder.write("plain.sdf", "sphere(1)\n");
    CHECK(shell(folder, "fathom compile rock.sdf --noise-cache").exit == 2);
    CHECK(shell(folder, "fathom compile rock.sdf --noise-cache --target es300 -o a.frag").exit ==
          2);
    CHECK(shell(folder, "fathom compile rock.sdf --noise-cache --field-only -o a.frag").exit == 2);
    CHECK(shell(folder, "fathom render rock.sdf --cache --backend cpu -o a.png").exit == 2);
    CHECK(shell(folder, "fathom compile rock.sdf --noise-cache -o a.frag").exit == 0);
    for (const char *name :
         {"a.frag", "a.reserve.frag", "a.fill.frag", "a.publish.frag", "a.sweep.frag"})
        CHECK(std::filesystem::exists(folder.path() / name));
    CHECK(shell(folder, "fathom compile plain.sdf --noise-cache -o b.frag").exit == 0);
    CHECK(std::filesystem::exists(folder.path() / "b.frag"));
    CHECK(!std::filesystem::exists(folder.path() / "b.fill.frag"));
}

TEST_CASE("a still picture is drawn by cached values where that is no dearer than computing it") {
    const ScratchFolder folder;
    const auto picture = [&](const std::string &name, const std::string &camera,
                             const std::string &more) {
        folder.write(name, "sphere(1).displace(cached(p => 0.03 * fbm(2 * p, octaves: 6), cell: "
                           "0.05))\ncamera(" +
                               camera + ", look_at: [0, 0, 0])\n");
        const Result result =
            shell(folder, "fathom render " + name + " --cache --size 48x48 --backend gl " + more +
                              " -o a.png");
        CHECK(result.exit == 0);
        return result.err;
    };
    CHECK(contains(picture("near.sdf", "at: [0, 0, 1.6], fov: 20deg", ""), "% by cached values"));
    CHECK(contains(picture("near.sdf", "at: [0, 0, 1.6], fov: 20deg", "--samples 2"),
                   "% by cached values"));
    CHECK(contains(picture("few.sdf", "at: [0, 0, 4], fov: 25deg", ""),
                   "drawn exactly: its pixels share too few cached values"));
    CHECK(contains(picture("far.sdf", "at: [0, 0, 40], fov: 25deg", ""),
                   "drawn exactly: cells are narrower than pixels"));
}

TEST_CASE("one figure of the noise cache is measured alone") {
    const ScratchFolder folder;
    folder.write("rock.sdf", "param depth = 0.03 in 0.0..0.03\nparam size = 1.0 in 0.5..1.0\n"
                             "sphere(size).displace(cached(p => depth * fbm(2 * p, octaves: 6), "
                             "cell: 0.05))\ncamera(at: [0, 0, 2], look_at: [0, 0, 0])\n");
    const std::string bench = "'" FATHOM_BENCH "' figures rock.sdf --size 24x24 --frames 1 ";
    CHECK(shell(folder, bench + "--figure 9.1").exit != 0);
    CHECK(shell(folder, bench + "--cells 100").exit != 0);
    const Result edits = shell(folder, bench + "--figure 8.5");
    CHECK(edits.exit == 0);
    CHECK(contains(edits.out, "(figure 8.5)"));
    CHECK(contains(edits.out, "  depth            yes "));
    CHECK(contains(edits.out, "  size             no "));
    // Each frame another depth, from the end of its range inwards: what was kept is missed.
    const std::string row = edits.out.substr(edits.out.find("  depth "));
    CHECK(std::stoi(row.substr(row.rfind(' ', row.find('\n')))) > 0);
    for (const char *other : {"(figure 8.2)", "(figure 8.3)", "(figure 8.4)", "(figure 8.6)"})
        CHECK(!contains(edits.out, other));
    const Result ages = shell(folder, bench + "--figure 8.2");
    CHECK(contains(ages.out, "(figure 8.2)"));
    CHECK(!contains(ages.out, "(figure 8.5)"));
}

TEST_CASE("without images on the card the noise cache's commands draw exactly and say so") {
    const ScratchFolder folder;
    folder.write("rock.sdf",
                 "sphere(1).displace(cached(p => 0.03 * fbm(2 * p, octaves: 6), cell: 0.05))\n");
    const std::string old = "MESA_GL_VERSION_OVERRIDE=4.1FC "
                            "MESA_EXTENSION_OVERRIDE=-GL_ARB_shader_image_load_store ";
    const auto program = [](const std::string &words) { return "'" FATHOM_PROGRAM "' " + words; };
    const std::string size = " --size 32x32 ", gl = " --backend gl ";
    REQUIRE(shell(folder, program("render rock.sdf" + size + gl + "-o exact.png")).exit == 0);
    const Result cached =
        shell(folder, old + program("render rock.sdf --cache" + size + gl + "-o cached.png"));
    CHECK(cached.exit == 0);
    CHECK(contains(cached.err, "drawn exactly: the noise cache needs OpenGL 4.2"));
    CHECK(folder.read("cached.png") == folder.read("exact.png"));
    const Result bench = shell(folder, old + "'" FATHOM_BENCH "' figures rock.sdf" + size);
    CHECK(bench.exit == 0);
    CHECK(contains(bench.err, "drawn exactly: the noise cache needs OpenGL 4.2"));
}

TEST_CASE("what is drawn or evaluated is proved at the values given, what is checked for ranges") {
    const ScratchFolder folder;
    folder.write("waves.sdf", "param a = 0.0 in 0.0..20.0\n"
                              "sphere(6).displace(p => a * sin(p.x) * sin(p.y) * sin(p.z))\n");
    folder.write("moving.sdf", "sphere(1).displace(p => 0.5 * sin(time) * sin(4 * p.x))\n");
    const auto eval = [&](const std::string &words) {
        return std::stod(shell(folder, "fathom eval " + words).out);
    };
    CHECK(eval("waves.sdf --at 10,0,0") == 4);
    CHECK(eval("waves.sdf --at 10,0,0 -D a=2") < 3);
    CHECK(eval("waves.sdf --at 10,0,0 -D a=20") < 1);
    CHECK(eval("moving.sdf --at 3,0,0") == 2);
    CHECK(eval("moving.sdf --at 3,0,0 --time 1.5") < 1.6);
    CHECK(contains(shell(folder, "fathom check waves.sdf").err, "lipschitz 21.1"));
    CHECK(contains(shell(folder, "fathom check waves.sdf").err, "note[costly]"));
    const std::string size = "--size 32x32 --backend cpu ";
    const Result drawn = shell(folder, "fathom render waves.sdf -o a.png " + size);
    CHECK(drawn.exit == 0);
    CHECK(drawn.err.empty()); // at 0 nothing is costly
    CHECK(contains(shell(folder, "fathom render waves.sdf -D a=20 -o b.png " + size).err,
                   "note[costly]"));
    // A sequence is proved from its first frame to its last.
    CHECK(shell(folder, "fathom render moving.sdf -o m.png --frames 0..3 --fps 2 " + size).exit ==
          0);
    CHECK(fs::exists(folder / "m_0002.png"));
}

TEST_CASE("the exit status tells what went wrong") {
    Scenes folder;
    CHECK(shell(folder, "fathom check good.sdf").exit == 0);
    CHECK(shell(folder, "fathom check bad.sdf").exit == 1);
    CHECK(shell(folder, "fathom check missing.sdf").exit ==
          1); // a missing import is the scene's error
    CHECK(shell(folder, "fathom check nothing.sdf").exit == 3);
    CHECK(shell(folder, "fathom check .").exit == 3);
    CHECK(shell(folder, "fathom").exit == 2);
    CHECK(shell(folder, "fathom check").exit == 2);
    CHECK(shell(folder, "fathom check --nonsense good.sdf").exit == 2);
    CHECK(shell(folder, "fathom render good.sdf -o x.png --size 10").exit == 2);
    CHECK(shell(folder, "fathom compile good.sdf --target metal").exit == 2);
    CHECK(shell(folder, "fathom check param.sdf -D radius=3").exit == 2);
    CHECK(shell(folder, "fathom check param.sdf -D radios=1").exit == 2);
    CHECK(shell(folder, "fathom check param.sdf -D radius=1.5").exit == 0);
    CHECK(shell(folder, "fathom compile good.sdf -o none/x.glsl").exit == 3);
}

TEST_CASE("options stand before the scene or behind it") {
    Scenes folder;
    for (const std::string options :
         {"--backend cpu --size 8x8", "--size 8x8 --backend cpu", "--size 8x8 -I ."}) {
        INFO(options);
        CHECK(shell(folder, "fathom render " + options + " good.sdf -o a.png").exit == 0);
        CHECK(shell(folder, "fathom render good.sdf " + options + " -o a.png").exit == 0);
        CHECK(shell(folder, "fathom render -o a.png " + options + " good.sdf").exit == 0);
    }
    CHECK(shell(folder, "fathom --color never eval --at 2,0,0 --at 3,0,0 good.sdf").exit == 0);
    const Result wrong = shell(folder, "fathom render --backend tea good.sdf -o a.png");
    CHECK(wrong.exit == 2);
    CHECK_THAT(wrong.err, Catch::Contains("wants auto, gl or cpu, not `tea`"));
}

TEST_CASE("results go to standard output, words to standard error") {
    Scenes folder;
    Result check = shell(folder, "fathom check bad.sdf");
    CHECK(check.out.empty());
    CHECK(contains(check.err, "bad.sdf:1:1: error[unknown-name]:"));
    CHECK(contains(check.err, "bad.sdf:2:"));
    Result json = shell(folder, "fathom check --json bad.sdf");
    CHECK(json.exit == 1);
    CHECK(json.err.empty());
    CHECK(json.out.starts_with("{\"ok\":false"));
    CHECK(contains(json.out, "\"code\":\"unknown-name\""));
    Result good = shell(folder, "fathom check --json good.sdf");
    CHECK(contains(good.out, "\"ok\":true,\"lipschitz\":1.0,\"status\":\"proved\",\"exact\":true"));
    CHECK(contains(good.out, "\"bounds\":[[-1")); // a little outside of the sphere
    CHECK(shell(folder, "fathom compile good.sdf").out.starts_with("#version"));
    CHECK(shell(folder, "fathom compile bad.sdf").out.empty());
}

TEST_CASE("a scene can come from standard input") {
    Scenes folder;
    CHECK(shell(folder, "echo 'sphere(2)' | fathom eval - --at 0,0,0").out.starts_with("-2 "));
    CHECK(contains(shell(folder, "echo 'spere(2)' | fathom check -").err, "<stdin>:1:1: error"));
}

TEST_CASE("points are answered with distance and gradient") {
    Scenes folder;
    CHECK(shell(folder, "fathom eval good.sdf --at 3,0,0").out == "2 1 0 0\n");
    CHECK(shell(folder, "fathom eval good.sdf --at 3,0,0 --at 0,-2,0").out ==
          "2 1 0 0\n1 0 -1 0\n");
    CHECK(shell(folder, "fathom eval good.sdf --at -3,0,0").out == "2 -1 0 0\n");
    Result many =
        shell(folder, "printf '2 0 0\\n\\n0 3 0\\n0 0 4' | fathom eval good.sdf --points -");
    CHECK(many.out == "1 1 0 0\n2 0 1 0\n3 0 0 1\n");
    Result wrong = shell(folder, "printf '2 0 0\\n1 2\\n' | fathom eval good.sdf --points -");
    CHECK(wrong.exit == 2);
    CHECK(contains(wrong.err, "line 2"));
    CHECK(shell(folder, "fathom eval good.sdf").exit == 2);
    // Where numbers that are sorted are equal, a smooth field still has its own gradient, of
    // length 1.
    folder.write("sorted.sdf", "octahedron(1)\n");
    CHECK(shell(folder, "fathom eval sorted.sdf --at 1,1,1 --at -1,-1,1").out ==
          "1.15470052 0.577350259 0.577350259 0.577350259\n"
          "1.15470052 -0.577350259 -0.577350259 0.577350259\n");
    // On a face, a length whose one component passes 0 is that component's size.
    folder.write("face.sdf", "pyramid(1)\n");
    CHECK(shell(folder, "fathom eval face.sdf --at 0,-0.5,0").out == "0 0 -1 0\n");
    CHECK(shell(folder, "fathom eval param.sdf -Dradius=1.5 --at 3,0,0").out.starts_with("1.5 1"));
}

TEST_CASE("a time that no proof covers is refused where the field reads it") {
    const ScratchFolder folder;
    folder.write("wave.sdf", "box(1).displace(p => 0.1 * sin(p.x * (1 + time)))\n"
                             "render(time: 10)\n");
    folder.write("still.sdf", "sphere(1).paint(p => hsv(time, 1, 1))\n");
    const auto says = [&](const std::string &command) { return shell(folder, command); };
    CHECK(says("fathom eval wave.sdf --at 1,0,0 --time 10").exit == 0);
    const Result late = says("fathom eval wave.sdf --at 1,0,0 --time 10.5");
    CHECK(late.exit == 2);
    CHECK(contains(late.err, "proved from 0 to 10 seconds"));
    CHECK(says("fathom eval wave.sdf --at 1,0,0 --time -1").exit == 2);
    CHECK(says("fathom eval wave.sdf --at 1,0,0 --time nan").exit == 2);
    CHECK(says("fathom render wave.sdf --size 4x4 -o a.png --frames 0..22 --fps 2").exit == 2);
    CHECK(says("fathom render wave.sdf --size 4x4 -o a.png --frames 19..21 --fps 2").exit == 0);
    CHECK(says("fathom render still.sdf --size 4x4 -o b.png --time 9999").exit == 0);
}

TEST_CASE("a large table goes into a buffer's file beside the shader, a loop's into neither") {
    Scenes folder;
    folder.write("data.sdf", "for q in shuffle([for i in 0..300 { hash(i) }], 1) {\n"
                             "  sphere(0.1 + 0.1 * q).translate(x: 9 * q)\n}\n");
    folder.write("loop.sdf", "for i in 0..300 { sphere(0.4).translate(x: i) }\n");
    CHECK(shell(folder, "fathom compile data.sdf -o data.glsl").exit == 0);
    CHECK(contains(folder.read("data.glsl"), "uniform samplerBuffer fathom_tables"));
    const std::size_t size = folder.read("data.glsl").size();
    CHECK(folder.read("data.glsl.tables").size() == 300 * 4 * sizeof(float));
    CHECK(shell(folder, "fathom compile data.sdf").out.size() > size + 2000); // no file, no buffer
    CHECK(shell(folder, "fathom compile loop.sdf -o loop.glsl").exit == 0);
    CHECK(folder.read("loop.glsl").size() < size + 500);
    CHECK(folder.read("loop.glsl.tables").empty());
}

TEST_CASE("a failed command leaves the old file") {
    Scenes folder;
    folder.write("out.glsl", "old");
    CHECK(shell(folder, "fathom compile bad.sdf -o out.glsl").exit == 1);
    CHECK(folder.read("out.glsl") == "old");
    CHECK(shell(folder, "fathom compile good.sdf -o out.glsl").exit == 0);
    CHECK(folder.read("out.glsl").starts_with("#version"));
    folder.write("out.png", "old");
    CHECK(shell(folder, "ulimit -f 0; trap '' XFSZ; fathom render good.sdf -o out.png --backend "
                        "cpu --size 64x48")
              .exit == 3);
    CHECK(folder.read("out.png") == "old");
    for (const auto &entry : fs::directory_iterator(folder.path()))
        CHECK_FALSE(contains(entry.path().filename().string(), "fathom-tmp"));
}

TEST_CASE("no result is written over what it is made from") {
    Scenes folder;
    for (const char *command :
         {"fathom export good.sdf -o ./good.sdf", "fathom compile good.sdf -o good.sdf",
          "fathom render good.sdf --size 4x4 -o good.sdf", "fathom import good.sdf -o good.sdf"}) {
        INFO(command);
        const Result result = shell(folder, command);
        CHECK(result.exit == 2);
        CHECK(contains(result.err, "that is the file that is read"));
    }
    const Result reflected = shell(folder, "fathom compile good.sdf --reflect good.sdf -o a.frag");
    CHECK(reflected.exit == 2);
    CHECK(contains(reflected.err, "--reflect good.sdf: that is the file that is read"));
    CHECK_FALSE(fs::exists(folder / "a.frag"));
    CHECK(shell(folder, "cat good.sdf").out == "sphere(1)\n");
}

TEST_CASE("a file that may not grow further is an error that is told") {
    Scenes folder;
    const Result result = shell(folder, "(ulimit -f 1; fathom compile good.sdf -o big.frag)");
    CHECK(result.exit == 3);
    CHECK(contains(result.err, "cannot write `big.frag`: file too large"));
    CHECK_FALSE(fs::exists(folder / "big.frag"));
}

TEST_CASE("words that have no place are told as such") {
    Scenes folder;
    const auto said = [&](const std::string &line) {
        const Result result = shell(folder, "fathom " + line);
        INFO(line);
        CHECK(result.exit == 2);
        return result.err;
    };
    CHECK(contains(said("eval good.sdf a b c"), "a coordinate is a number, as 1.5, not beyond"));
    for (const char *number : {"nan", "inf", "1e999", "1e30", "1,2"})
        CHECK(contains(said(std::string("eval good.sdf 0 ") + number + " 0"),
                       std::string("not `") + number + "`"));
    CHECK(contains(said("eval good.sdf --at 0,1e30,0"), "none beyond 1e18"));
    CHECK(shell(folder, "printf '1 nan 0' | fathom eval good.sdf --points -").exit == 2);
    CHECK(contains(said("render good.sdf -o x.png --sze 10x10"),
                   "there is no option `--sze`; did you mean `--size`?"));
    CHECK(contains(said("measure --tolerence 3 good.sdf"),
                   "there is no option `--tolerence`; did you mean `--tolerance`?"));
    CHECK(contains(said("explain loop-limit x"), "`x` is a word too many"));
    CHECK(contains(said("check good.sdf --stritc-proof"),
                   "there is no option `--stritc-proof`; did you mean `--strict-proof`?"));
    CHECK(contains(said("check good.sdf -I none"), "there is no folder `none`"));
    CHECK(contains(said("render good.sdf --frames 0..99999999999 -o a.png"), "none above 1000000"));
    CHECK(contains(said("render good.sdf --jobs many -o a.png"), "not `many`"));
}

TEST_CASE("a reader that leaves ends the program quietly, a full disk does not") {
    Scenes folder;
    Result head = shell(folder, "fathom explain | head -n 1");
    CHECK(head.exit == 0);
    CHECK(head.err.empty());
    Result full = shell(folder, "fathom explain >/dev/full");
    CHECK(full.exit == 3);
    CHECK(contains(full.err, "no space left"));
}

TEST_CASE("colours are for terminals, or for those who ask") {
    Scenes folder;
    CHECK_FALSE(contains(shell(folder, "fathom check bad.sdf").err, "\x1b["));
    CHECK(contains(shell(folder, "fathom check bad.sdf --color always").err, "\x1b["));
    CHECK(contains(shell(folder, "fathom --color always check bad.sdf").err, "\x1b["));
    CHECK_FALSE(contains(shell(folder, "NO_COLOR=1 fathom check bad.sdf").err, "\x1b["));
}

TEST_CASE("explaining says whether shapes are left out where they cannot matter") {
    Scenes folder;
    folder.write("many.sdf", "for i in 0..500 { sphere(0.1).translate([0.5 * i, 0, 0]) }\n");
    CHECK(contains(shell(folder, "fathom check --explain good.sdf").out, "pruning: not worth it"));
    CHECK(contains(shell(folder, "fathom check --explain many.sdf").out,
                   "pruning: the processor computes for each cell"));
    CHECK_FALSE(contains(shell(folder, "fathom check many.sdf").out, "pruning"));
}

TEST_CASE("the formatter changes files, or only names them") {
    Scenes folder;
    folder.write("messy.sdf", "sphere( 1 )\n");
    Result check = shell(folder, "fathom fmt --check messy.sdf good.sdf");
    CHECK(check.exit == 1);
    CHECK(check.out == "messy.sdf\n");
    CHECK(folder.read("messy.sdf") == "sphere( 1 )\n");
    CHECK(shell(folder, "fathom fmt messy.sdf").exit == 0);
    CHECK(folder.read("messy.sdf") == "sphere(1)\n");
    CHECK(shell(folder, "echo 'box( 2 )' | fathom fmt -").out == "box(2)\n");
    CHECK(shell(folder, "fathom fmt broken.sdf good.sdf").exit == 1);
    CHECK(folder.read("broken.sdf") == "sphere(\n");
}

TEST_CASE("what is misspelt is answered with what is near") {
    Scenes folder;
    CHECK(contains(shell(folder, "fathom rendr good.sdf").err, "did you mean `render`"));
    CHECK(contains(shell(folder, "fathom good.sdf").err, "fathom view good.sdf"));
    CHECK(contains(shell(folder, "fathom explain unknown-nam").err, "did you mean `unknown-name`"));
    CHECK(contains(shell(folder, "fathom doc spher").err, "did you mean `sphere`"));
    CHECK(shell(folder, "fathom explain unknown-name").out.starts_with("# unknown-name"));
    CHECK(shell(folder, "fathom doc sphere").out.starts_with("sphere(radius"));
    CHECK(shell(folder, "fathom doc dfmodel.sphere").out.starts_with("dfmodel.sphere(radius"));
    // A head is told on one line, however long it is.
    CHECK(shell(folder, "fathom doc gdf_blend")
              .out.starts_with("gdf_blend(a: [vec3], b: [vec3], a_scale: float"));
    CHECK(contains(shell(folder, "fathom help render").out, "--backend"));
    CHECK(contains(shell(folder, "fathom render --help").out, "--backend"));
    CHECK(contains(shell(folder, "fathom --version").out, "fathom "));
}

TEST_CASE("pictures are made, one or many, named by their frame") {
    Scenes folder;
    CHECK(shell(folder, "fathom render good.sdf -o one.png --size 32x24 --backend cpu").exit == 0);
    CHECK(folder.read("one.png").starts_with("\x89PNG"));
    CHECK(shell(folder, "fathom render good.sdf -o f.png --size 8x8 --backend cpu --frames 0..3")
              .exit == 0);
    for (std::string name : {"f_0000.png", "f_0001.png", "f_0002.png"})
        CHECK(fs::exists(folder / name));
    CHECK_FALSE(fs::exists(folder / "f_0003.png"));
    CHECK(shell(folder,
                "fathom render good.sdf -o 'g##.png' --size 8x8 --backend cpu --frames 9..=10")
              .exit == 0);
    CHECK((fs::exists(folder / "g09.png") && fs::exists(folder / "g10.png")));
    CHECK(shell(folder, "fathom render good.sdf -o x.png --frames 3..3").exit == 2);
}

TEST_CASE("watch goes on after an error and sees the next save") {
    Scenes folder;
    folder.write("w.sdf", "spere(1)\n");
    Result result = shell(folder, "timeout 60 sh -c '\"" FATHOM_PROGRAM
                                  "\" compile --watch w.sdf -o w.glsl & p=$!; "
                                  "sleep 1; echo \"sphere(1)\" > w.sdf; "
                                  "until [ -s w.glsl ]; do sleep 0.1; done; kill $p'");
    CHECK(result.exit == 0);
    CHECK(contains(result.err, "unknown-name"));
    CHECK(folder.read("w.glsl").starts_with("#version"));
}

TEST_CASE("no display is a sentence and status 3") {
    Scenes folder;
    Result result =
        shell(folder, "env -u DISPLAY -u WAYLAND_DISPLAY '" FATHOM_PROGRAM "' view good.sdf");
    CHECK(result.exit == 3);
    CHECK(contains(result.err, "no display"));
    CHECK(shell(folder, "fathom view none/nothing.sdf").exit == 3);
    CHECK(contains(shell(folder, "fathom view none/nothing.sdf").err, "no such file"));
    CHECK(shell(folder, "fathom view nothing.txt").exit == 3);
    CHECK(shell(folder, "fathom view ''").exit == 3);
    CHECK(shell(folder, "fathom view .").exit == 3);
    CHECK(shell(folder, "fathom view -").exit == 2);
}

TEST_CASE("no name and no -D steers the terminal or adds a line to what is said") {
    const ScratchFolder folder;
    const std::string scene = "param r = 1.0 in 0.5..2.0 \"\x1b[31m\"\nsphere(r)\n";
    const std::string nasty = "a\x1b]0;title\x07\r\u202e\u0085b";
    folder.write(nasty + ".sdf", scene);
    folder.write("two\nfathom: all is well.sdf", scene);
    folder.write("bad\x1b[2J.sdf", "sphere(\n");
    folder.write("good.sdf", scene);
    folder.write("ugly\x1b[2J.sdf", "sphere( 1 )\n");
    const auto lines_of = [&](const std::string &line, long lines) {
        const Result result = shell(folder, line);
        INFO(line << "\n" << result.out << result.err);
        for (const char *byte : {"\x1b", "\x07", "\r", "\u202e", "\u0085"})
            CHECK_FALSE(contains(result.err, byte));
        CHECK(std::count(result.err.begin(), result.err.end(), '\n') == lines);
        return result;
    };
    const std::string name = "'" + nasty + ".sdf'", two = "'two\nfathom: all is well.sdf'";
    CHECK(lines_of("fathom check " + name, 1).exit == 0);
    CHECK(lines_of("fathom check " + two, 1).exit == 0);
    CHECK(lines_of("fathom check 'none" + nasty + "'", 1).exit == 3);
    CHECK(lines_of("fathom check " + two + "x", 1).exit == 3);
    CHECK(lines_of("fathom check 'bad\x1b[2J.sdf'", 9).exit == 1);
    CHECK(lines_of("fathom check good.sdf -D 'r=\x1b[31mred\n'", 1).exit == 2);
    CHECK(lines_of("fathom check good.sdf -D 'r\x1b[31m\r\n=2'", 1).exit == 2);
    CHECK(lines_of("fathom check good.sdf -D '\x1b[31m\n'", 1).exit == 2);
    CHECK(lines_of("fathom check good.sdf '--\x1b[31m\n'", 1).exit == 2);
    CHECK(lines_of("fathom '\x1b[31m\n'", 1).exit == 2);
    CHECK(lines_of("fathom help '\x1b[31m\n'", 1).exit == 2);
    CHECK(lines_of("fathom doc '\x1b[31m\n'", 1).exit == 2);
    CHECK(lines_of("fathom explain '\x1b[31m\n'", 1).exit == 2);
    CHECK(lines_of("fathom render good.sdf --size 8x8 -o '\x1b[31m/\n.png'", 1).exit == 3);
    CHECK(lines_of("fathom compile good.sdf --target '\x1b[31m\n'", 1).exit == 2);
    CHECK(lines_of("fathom view 'none" + nasty + "'", 1).exit == 3);
    // Results in a pipe are as they are.
    CHECK(lines_of("fathom fmt --check 'ugly\x1b[2J.sdf'", 0).out == "ugly\x1b[2J.sdf\n");
    for (const glsl::Target target : glsl::all_targets()) {
        if (glsl::traits_of(target).form == glsl::Form::SpirV) continue;
        const std::string by = std::string(" --target ") + glsl::traits_of(target).name;
        const Result by_name = lines_of("fathom compile " + two + by, 0);
        const Result plain = lines_of("fathom compile good.sdf" + by, 0);
        CHECK(by_name.exit == 0);
        CHECK(std::count(by_name.out.begin(), by_name.out.end(), '\n') ==
              std::count(plain.out.begin(), plain.out.end(), '\n'));
    }
    CHECK(lines_of("fathom compile " + two + " --target spirv -o a.spv", 0).exit == 0);
}

TEST_CASE("what a proof rests on is named, and refused under --strict-proof") {
    ScratchFolder folder;
    folder.write("proved.sdf", "implicit(p => length(p) - 1)\n");
    folder.write("library.sdf", "sphere(1)\n");
    folder.write("assumed.sdf",
                 "fn g(p: vec3) -> float = if p.y > 0 { atan(p.x + 4) } else { pi / 2 - atan(1 / "
                 "(p.x + 4)) }\n"
                 "implicit(p => length(p) - 1 + 0.2 * g(p), within: ball(2), lipschitz: 1.2)\n");
    folder.write("estimated.sdf", "implicit(p => length(p) - 1, estimate: 1)\n");
    for (const std::string command : {"check ", "compile --field-only ", "compile ",
                                      "render --size 8x8 --backend cpu -o a.png "}) {
        INFO(command);
        for (const std::string good : {"proved.sdf", "library.sdf"})
            CHECK(shell(folder, "fathom " + command + good + " --strict-proof").exit == 0);
        for (const std::string bad : {"assumed.sdf", "estimated.sdf"}) {
            CHECK(shell(folder, "fathom " + command + bad).exit == 0);
            const Result strict = shell(folder, "fathom " + command + bad + " --strict-proof");
            CHECK(strict.exit == 1);
            CHECK(contains(strict.err, "error[unproved]"));
        }
    }
    CHECK(contains(shell(folder, "fathom check --explain proved.sdf").out, "rests on no axiom"));
    CHECK(contains(shell(folder, "fathom check --explain library.sdf").out,
                   "rests on sphere: exact"));
    CHECK(contains(shell(folder, "fathom check --json library.sdf").out,
                   R"("kind":"library","says":"sphere: exact")"));
    CHECK(contains(shell(folder, "fathom check --json assumed.sdf").out, R"("kind":"assumed")"));
    const auto header = [&](const std::string &scene) {
        return shell(folder, "fathom compile " + scene).out.substr(0, 400);
    };
    CHECK(contains(header("proved.sdf"), "// The bound of its field is proved.\n"));
    CHECK(contains(header("library.sdf"), "// The bound of its field is proved, on "));
    CHECK(contains(header("assumed.sdf"), "// The bound of its field is assumed.\n"));
    CHECK(contains(header("estimated.sdf"), "// The bound of its field is estimated.\n"));
}
