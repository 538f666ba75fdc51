// What the emitter writes: valid on every target, linear, readable.
#include "tests/unit/glsl/op_cases.h"
#include "tests/unit/glsl/scenes.h"

#include "backend-glsl/emit.h"
#include "backend-glsl/marcher.h"
#include "backend-glsl/names.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

using namespace fathom;
using namespace fathom::scenes;

namespace {

glsl::Output emitted(const Scene &scene, const glsl::Options &options = {}) {
    Diagnostics diagnostics;
    glsl::Output output = glsl::emit(scene, options, diagnostics);
    for (const Diagnostic &d : diagnostics.items()) {
        UNSCOPED_INFO(d.message);
        for (const std::string &note : d.notes) UNSCOPED_INFO(note);
    }
    CHECK_FALSE(diagnostics.has_errors());
    return output;
}

// The function `sdf` of the emitted field.
std::string sdf_of(const Scene &scene, glsl::Options options = {}) {
    options.field_only = true;
    const std::string text = emitted(scene, options).text;
    const std::size_t begin = text.find("float sdf(vec3 p) {");
    REQUIRE(begin != std::string::npos);
    return text.substr(begin, text.find("\n}\n", begin) + 3 - begin);
}

std::size_t count(const std::string &text, const std::string &what) {
    std::size_t n = 0;
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size())
        ++n;
    return n;
}

NodeId loop(Graph &g, Loop record, NodeId start) {
    const LoopId id = g.add_loop(std::move(record));
    return g.make(Op::LoopResult, g[start].type,
                  {g.make(Op::Loop, g[start].type, {start}, id.index)}, 0);
}

} // namespace

TEST_CASE("a sphere is emitted for every target") {
    for (glsl::Target target : glsl::all_targets())
        for (bool field_only : {false, true}) {
            CAPTURE(glsl::traits_of(target).name, field_only);
            const glsl::Output out =
                emitted(sphere(), {.target = target, .field_only = field_only});
            const bool spirv = glsl::traits_of(target).form == glsl::Form::SpirV;
            CHECK(out.text.empty() == spirv);
            CHECK(out.words.empty() == !spirv);
        }
}

TEST_CASE("a field that moves is emitted for every target, alone or in its picture") {
    for (glsl::Target target : glsl::all_targets())
        for (bool field_only : {false, true}) {
            CAPTURE(glsl::traits_of(target).name, field_only);
            const Scene scene = of_field([](Graph &g, NodeId p) {
                return g.sub(g.make(Op::Length, {p}), g.make(Op::Cos, {g.time()}));
            });
            emitted(scene, {.target = target, .field_only = field_only});
        }
}

TEST_CASE("every op is emitted for every target") {
    for (glsl::Target target : glsl::all_targets()) {
        const Scene scene = of_field([](Graph &g, NodeId p) {
            NodeId sum = g.number(0);
            for (std::size_t index = 0; index < op_count; ++index) {
                const Op op = static_cast<Op>(index);
                for (const Case &c : cases_of(op))
                    for (std::uint32_t payload : payloads_of(op)) {
                        std::vector<NodeId> args; // different ones, none constant
                        for (std::size_t i = 0; i < c.args.size(); ++i) {
                            const Type t = c.args[i];
                            const NodeId x = g.add(g.component(p, static_cast<int>(i % 3)),
                                                   g.number(static_cast<double>(i) + 1));
                            if (t == Type::Bool)
                                args.push_back(g.make(Op::Less, {x, g.number(0)}));
                            else if (t == Type::Int)
                                args.push_back(g.make(Op::ToInt, Type::Int, {x}));
                            else
                                args.push_back(t == Type::Float ? x : g.splat(x, t));
                        }
                        NodeId value = g.make(op, c.result, args, payload);
                        if (is_matrix(c.result))
                            value = g.make(Op::Column, vector_type(side(c.result)), {value}, 0);
                        if (is_vector(g[value].type)) value = g.make(Op::Length, {value});
                        if (g[value].type != Type::Float)
                            value = g.make(Op::ToFloat, Type::Float, {value});
                        sum = g.add(sum, value);
                    }
            }
            return sum;
        });
        CAPTURE(glsl::traits_of(target).name);
        emitted(scene, {.target = target});
    }
}

TEST_CASE("a shared node is computed once") {
    const Scene scene = of_field([](Graph &g, NodeId p) {
        const NodeId l = g.make(Op::Length, {p});
        return g.sub(g.mul(l, l), g.make(Op::Sin, {l}));
    });
    CHECK(sdf_of(scene) == R"(float sdf(vec3 p) {
    float d1 = length(p);
    return d1 * d1 - fathom_sin(d1);
}
)");
}

TEST_CASE("text grows with the graph, not with its paths") {
    const auto doubled = [](int times) {
        return of_field([&](Graph &g, NodeId p) {
            NodeId x = g.component(p, 0);
            for (int i = 0; i < times; ++i) x = g.add(g.make(Op::Sin, {x}), g.make(Op::Cos, {x}));
            return x;
        });
    };
    const std::size_t few = sdf_of(doubled(20)).size(), many = sdf_of(doubled(40)).size();
    CHECK(many < 2.2 * static_cast<double>(few));
}

TEST_CASE("an arm with work of its own is a block, and a chain of them stays flat") {
    const Scene scene = of_field([](Graph &g, NodeId p) {
        const NodeId x = g.component(p, 0), y = g.component(p, 1);
        const auto arm = [&](double k) {
            const NodeId s = g.make(Op::Sin, {g.mul(y, g.number(k))});
            return g.add(g.mul(s, s), g.make(Op::Exp, {s}));
        };
        const NodeId rest =
            g.make(Op::Select, {g.make(Op::Less, {x, g.number(2)}), arm(2), arm(3)});
        return g.make(Op::Select, {g.make(Op::Less, {x, g.number(1)}), arm(5), rest});
    });
    CHECK(sdf_of(scene) == R"(float sdf(vec3 p) {
    float d1;
    bool b2 = true;
    if (p.x < 1.0) {
        float d3 = fathom_sin(p.y * 5.0);
        d1 = d3 * d3 + exp(d3);
        b2 = false;
    }
    if (b2 && p.x < 2.0) {
        float d4 = fathom_sin(p.y * 2.0);
        d1 = d4 * d4 + exp(d4);
        b2 = false;
    }
    if (b2) {
        float d5 = fathom_sin(p.y * 3.0);
        d1 = d5 * d5 + exp(d5);
    }
    return d1;
}
)");
}

TEST_CASE("a cheap choice is an expression") {
    const Scene scene = of_field([](Graph &g, NodeId p) {
        const NodeId x = g.component(p, 0);
        return g.make(Op::Select,
                      {g.make(Op::Less, {x, g.number(0)}), g.neg(x), g.mul(x, g.number(2))});
    });
    CHECK(sdf_of(scene) == R"(float sdf(vec3 p) {
    return mix(p.x * 2.0, -p.x, p.x < 0.0);
}
)");
}

// SwiftShader takes time that doubles with each such branch in a loop (helpers/arithmetic.glsl).
TEST_CASE("no branch in a loop has two arms") {
    std::vector<std::string> names;
    const std::string folder = FATHOM_SOURCE_DIR "/backend-glsl/";
    for (const auto &file : std::filesystem::directory_iterator(folder + "helpers"))
        names.push_back(file.path().string());
    for (const char *name : {"march", "march_ahead", "shadow_ahead", "nearest", "shadow", "shade"})
        names.push_back(folder + "templates/" + name + ".glsl");
    CHECK(names.size() > 8);
    for (const std::string &name : names) {
        INFO(name);
        std::ifstream file(name);
        REQUIRE(file);
        for (std::string line; std::getline(file, line);) {
            if (line.starts_with("$")) continue;
            INFO(line);
            line = line.substr(0, line.find("//"));
            CHECK(line.find("else") == line.npos);
        }
    }
}

TEST_CASE("a loop stays a loop, and what does not change in it stands before") {
    const Scene scene = of_field([](Graph &g, NodeId p) {
        const NodeId x = g.fresh_var(Type::Float), i = g.fresh_var(Type::Int);
        const NodeId steady = g.make(Op::Sin, {g.component(p, 1)});
        const NodeId next = g.make(Op::Union, Type::Float,
                                   {x, g.mul(g.make(Op::ToFloat, Type::Float, {i}), steady)});
        const NodeId condition = g.make(Op::Less, {g.number(0), x});
        return loop(g, {g.integer(8), i, {x}, {next}, condition, 8}, g.component(p, 0));
    });
    CHECK(sdf_of(scene) == R"(float sdf(vec3 p) {
    float d1 = fathom_sin(p.y);
    float d2 = p.x;
    for (int i3 = 0; i3 < 8; ++i3) {
        if (!(0.0 < d2)) break;
        d2 = min(d2, float(i3) * d1);
    }
    return d2;
}
)");
}

TEST_CASE(
    "256 spheres that differ by their row are a loop over a table, under 64 KB with their data") {
    const glsl::Output text = emitted(table_of_spheres(256));
    CHECK(text.text.size() < 65536);
    CHECK(count(text.text, "length(p - ") == 2); // the distance and the hit
    const glsl::Output buffered = emitted(table_of_spheres(256), {.buffers = true});
    CHECK(buffered.tables.size() == 256 * 8);
    CHECK(buffered.text.size() < 30500);
}

TEST_CASE("users' names are kept where GLSL allows them, and made so where not") {
    const auto named = [](std::vector<std::string> names) {
        Scene scene = of_field([&](Graph &g, NodeId p) {
            NodeId sum = g.number(0);
            double k = 1;
            for (const std::string &name : names) {
                const NodeId q = g.fresh_var(Type::Vec3);
                const FunctionId f =
                    g.add_function({name, {}, {q}, g.mul(g.make(Op::Length, {q}), g.number(++k))});
                sum = g.add(sum, g.call(f, {&p, 1}));
            }
            return sum;
        });
        return sdf_of(scene);
    };
    CHECK(named({"pillar", "pillar", "mix", "sdf", "gl_x", "a__b", "d1", "\xc3\xa9tage"}) ==
          R"(float sdf(vec3 p) {
    float d2 = pillar(p) + pillar_2(p) + mix_2(p) + sdf_2(p) + my_gl_x(p) + a_b(p) + d1(p);
    return d2 + tage(p);
}
)");
}

TEST_CASE("params are uniforms where there is a host, constants where there is none") {
    Scene scene = of_field([](Graph &g, NodeId p) {
        return g.sub(g.make(Op::Length, {p}),
                     g.add(g.param(0, Type::Float), g.make(Op::Sin, {g.time()})));
    });
    Param radius;
    radius.name = "radius";
    radius.label = "How large";
    radius.has_range = true;
    radius.value[0] = 1.25;
    radius.lo[0] = 0.5;
    radius.hi[0] = 2;
    scene.params.push_back(radius);
    const glsl::Output hosted = emitted(scene);
    REQUIRE(hosted.uniforms.size() == 1);
    CHECK(hosted.uniforms[0].name == "param_radius");
    CHECK(hosted.reads_time);
    CHECK(count(hosted.text, "uniform float param_radius = 1.25;") == 1);
    const std::string toy = emitted(scene, {.target = glsl::Target::Shadertoy}).text;
    CHECK(count(toy, "const float param_radius = 1.25; // 0.5..2  How large\n") == 1);
    CHECK(toy.find("const float param_radius") < toy.find("fathom_resolution"));
    CHECK(toy.find("const float param_radius") < 400); // what may be changed stands at the top
    CHECK(count(emitted(scene, {.target = glsl::Target::Html}).text,
                "\"name\": \"param_radius\"") == 1);
}

TEST_CASE("what a target's row reserves is no name in any text") {
    std::size_t checked = 0;
    for (const glsl::Target target : glsl::all_targets()) {
        std::istringstream words(glsl::traits_of(target).reserved);
        for (std::string word; words >> word; ++checked) {
            CAPTURE(word);
            CHECK(glsl::is_reserved(word));
            CHECK_FALSE(glsl::is_reserved(word + "x"));
            CHECK_FALSE(glsl::is_reserved(word.substr(1)));
            CHECK(glsl::Names().unique(word) == word + "_2");
        }
    }
    CHECK(checked > 10);
    CHECK_FALSE(glsl::is_reserved(""));
    CHECK_FALSE(glsl::is_reserved("iTime iTimeDelta"));
}

TEST_CASE("many plain materials are a table") {
    Scene scene = sphere();
    scene.surfaces.clear();
    for (int i = 0; i < 300; ++i)
        scene.surfaces.push_back(plain_surface(scene.graph, i / 300.0, 0.5, 0.5));
    const std::string text = emitted(scene, {.buffers = true}).text;
    CHECK(count(text, "if (paint ==") == 0);
    CHECK(text.size() < 32000);
}

TEST_CASE("few rows whose formula takes a sine are read, many or cheap ones computed") {
    const auto text_of = [](int rows, bool sine) {
        return sdf_of(of_field([&](Graph &g, NodeId p) {
            const NodeId row = g.fresh_var(Type::Int);
            NodeId formula = g.make(Op::ToFloat, Type::Float, {row});
            if (sine) formula = g.make(Op::Sin, {formula});
            Table table{rows, 1, {}};
            for (int i = 0; i < rows; ++i)
                table.data.push_back(static_cast<float>(sine ? std::sin(i) : i));
            table.computed.emplace_back(0, g.add_function({"of_row", {}, {row}, formula}));
            const TableId id = g.add_table(table);
            const NodeId at = g.make(Op::ToInt, Type::Int, {g.component(p, 0)});
            return g.make(Op::TableRead, Type::Float, {at}, table_slot(id, 0));
        }));
    };
    CHECK(count(text_of(64, true), "table_0[") == 1);
    CHECK(count(text_of(64, true), "of_row(") == 0);
    CHECK(count(text_of(1000, true), "of_row(") == 1);
    CHECK(count(text_of(64, false), "of_row(") == 1);
}

TEST_CASE("infinities and the least int are written so that GLSL reads them") {
    const Scene scene = of_field([](Graph &g, NodeId p) {
        const NodeId i = g.make(Op::Min, {g.make(Op::ToInt, Type::Int, {g.component(p, 0)}),
                                          g.integer(-2147483647 - 1)});
        return g.make(Op::Min,
                      {g.number(INFINITY), g.make(Op::Max, {g.make(Op::ToFloat, Type::Float, {i}),
                                                            g.number(-INFINITY)})});
    });
    for (glsl::Target target : glsl::all_targets()) emitted(scene, {.target = target});
}

TEST_CASE(
    "a picture of one pass gives a ray the more steps the steeper its field and the longer its "
    "way") {
    CHECK(glsl::steps_in_one_pass(1, 10) == 256);
    CHECK(glsl::steps_in_one_pass(0, 0) == 256);
    CHECK(glsl::steps_in_one_pass(10, std::exp(10.0)) == 6400);
    CHECK(glsl::steps_in_one_pass(20, std::exp(10.0)) == 12800);
    CHECK(glsl::steps_in_one_pass(2376, 1e6) == 65536);
    Scene scene = sphere();
    scene.render.max_steps = 77;
    CHECK(count(emitted(scene, {.target = glsl::Target::Shadertoy}).text, "int limit = 77") == 2);
}

TEST_CASE("a matrix in a table is made of its columns, wherever its row begins in a texel") {
    for (int column : {0, 1, 2, 3})
        for (Type type : {Type::Mat2, Type::Mat3, Type::Mat4}) {
            const int side = ir::side(type);
            CAPTURE(column, side);
            const Scene scene = of_field([&](Graph &g, NodeId p) {
                ir::Table table{3, column + side * side, {}};
                for (int i = 0; i < table.rows * table.stride; ++i)
                    table.data.push_back(0.01f * float(i));
                const NodeId row = g.make(Op::ToInt, Type::Int, {g.component(p, 0)}),
                             matrix = g.make(Op::TableRead, type, {row},
                                             table_slot(g.add_table(table), column)),
                             first = g.make(Op::Column, ir::vector_type(side), {matrix}, 0);
                return g.add(g.component(first, 0), g.number(-1));
            });
            const std::string text = sdf_of(scene, {.target = glsl::Target::Glsl330});
            const std::string size = std::to_string(side);
            std::size_t at = text.find("mat" + size + "(");
            REQUIRE(at != std::string::npos);
            std::vector<std::string> columns(1);
            int depth = 0;
            for (at += 5; depth > 0 || text[at] != ')'; ++at) {
                depth += (text[at] == '(') - (text[at] == ')');
                if (depth == 0 && text[at] == ',')
                    columns.emplace_back();
                else
                    columns.back() += text[at];
            }
            CHECK(columns.size() == static_cast<std::size_t>(side));
            for (const std::string &each : columns) {
                CAPTURE(each);
                const std::string read = each.substr(each.find_first_not_of(" \n"));
                const std::size_t dot = read.rfind('.'), close = read.find_last_of(")]");
                const bool whole = dot == std::string::npos || dot < close;
                CHECK((read.starts_with("vec" + size + "(") || (whole && side == 4) ||
                       (!whole && read.find_first_not_of("xyzw", dot + 1) >=
                                      dot + 1 + static_cast<std::size_t>(side))));
            }
        }
}

TEST_CASE("GLSL's clamp is used where its limits are known to be in order alone") {
    const auto text_of = [](const std::function<NodeId(Graph &, NodeId x)> &field) {
        return sdf_of(of_field(
            [&](Graph &g, NodeId p) { return g.sub(field(g, g.component(p, 0)), g.number(2)); }));
    };
    const auto clamped = [](Graph &g, NodeId x, NodeId lo, NodeId hi) {
        return g.make(Op::Clamp, {x, lo, hi});
    };
    CHECK(
        count(text_of([&](Graph &g, NodeId x) { return clamped(g, x, g.number(-1), g.number(1)); }),
              "clamp(p.x, -1.0, 1.0)") == 1);
    CHECK(
        count(text_of([&](Graph &g, NodeId x) { return clamped(g, x, g.number(1), g.number(-1)); }),
              "min(max(p.x, 1.0), -1.0)") == 1);
    CHECK(count(text_of([&](Graph &g, NodeId x) { return clamped(g, x, g.neg(x), x); }),
                "min(max(p.x, -p.x), p.x)") == 1);
}
