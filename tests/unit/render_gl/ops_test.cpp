// Every op in a shader against its meaning (ir/fold.h), over arguments that break careless code. The arguments come from
// a table, one row a pixel, so that no compiler can fold them.
#include "tests/unit/render_gl/context.h"

#include "backend-glsl/emit.h"
#include "ir/fold.h"
#include "tests/unit/glsl/scenes.h"

#include <catch2/catch.hpp>
#include <epoxy/gl.h>

#include <cmath>
#include <limits>
#include <span>

using namespace fathom;
using ir::Constant;
using ir::NodeId;
using ir::Op;
using ir::Type;

namespace {

constexpr Type int_and_floats[] = {Type::Int,  Type::Float, Type::Vec2, Type::Vec3,
                                   Type::Vec4, Type::Mat2,  Type::Mat3, Type::Mat4};
constexpr std::span<const Type> with_int(int_and_floats), all = with_int.subspan(1),
                                vectors_and_float = all.subspan(0, 4), vectors = all.subspan(1, 3),
                                matrices = all.subspan(4), vec3(&int_and_floats[3], 1);

struct Case {
    Op op;
    std::vector<Type> args;
    Type result;
};

// The types that each op is asked with. Ops that have no value of their own (inputs, structure, hits) are in other tests.
std::vector<Case> cases_of(Op op) {
    std::vector<Case> cases;
    const auto same = [&](std::size_t arity, std::span<const Type> types) {
        for (Type t : types) cases.push_back({op, std::vector<Type>(arity, t), t});
    };
    switch (op) {
    case Op::Const: case Op::Point: case Op::Normal: case Op::Direction: case Op::Time: case Op::Param: case Op::Var:
    case Op::TableRead: case Op::Image: case Op::Grid: case Op::Call: case Op::Fold: case Op::FoldResult:
    case Op::Cached: case Op::MakeHit: case Op::HitDistance: case Op::HitPaint: case Op::HitPoint: case Op::HitExtra:
    case Op::NearestHit: case Op::FarthestHit: case Op::HitWith: case Op::FillPaint:
        break;
    case Op::Neg: case Op::Abs: case Op::Sign: same(1, with_int); break;
    case Op::Add: case Op::Sub: case Op::Mul: case Op::Div: case Op::Mod: case Op::Min: case Op::Max:
        same(2, with_int);
        break;
    case Op::Pow: case Op::Step: case Op::Atan2: same(2, all); break;
    case Op::Floor: case Op::Ceil: case Op::Round: case Op::Trunc: case Op::Fract: case Op::Sqrt: case Op::InverseSqrt:
    case Op::Exp: case Op::Exp2: case Op::Log: case Op::Log2: case Op::Sin: case Op::Cos: case Op::Tan: case Op::Asin:
    case Op::Acos: case Op::Atan: case Op::Sinh: case Op::Cosh: case Op::Tanh:
        same(1, all);
        break;
    case Op::Clamp: same(3, with_int); break;
    case Op::Mix: case Op::Smoothstep: same(3, all); break;
    case Op::Dot:
        for (Type t : vectors_and_float) cases.push_back({op, {t, t}, Type::Float});
        break;
    case Op::Length:
        for (Type t : vectors_and_float) cases.push_back({op, {t}, Type::Float});
        break;
    case Op::Cross: same(2, vec3); break;
    case Op::Normalize: same(1, vectors); break;
    case Op::Less: case Op::LessEqual: case Op::Equal: case Op::NotEqual:
        for (Type t : {Type::Float, Type::Int}) cases.push_back({op, {t, t}, Type::Bool});
        break;
    case Op::And: case Op::Or: cases.push_back({op, {Type::Bool, Type::Bool}, Type::Bool}); break;
    case Op::Not: cases.push_back({op, {Type::Bool}, Type::Bool}); break;
    case Op::Select:
        for (Type t : with_int) cases.push_back({op, {Type::Bool, t, t}, t});
        break;
    case Op::ToFloat:
        cases.push_back({op, {Type::Int}, Type::Float});
        cases.push_back({op, {Type::Bool}, Type::Float});
        break;
    case Op::ToInt:
        cases.push_back({op, {Type::Float}, Type::Int});
        cases.push_back({op, {Type::Bool}, Type::Int});
        break;
    case Op::Splat:
        for (Type t : all)
            if (t != Type::Float) cases.push_back({op, {Type::Float}, t});
        break;
    case Op::Make:
        for (int n = 2; n <= 4; ++n) {
            cases.push_back({op, std::vector<Type>(static_cast<std::size_t>(n), Type::Float), ir::vector_type(n)});
            cases.push_back({op, std::vector<Type>(static_cast<std::size_t>(n), ir::vector_type(n)), ir::matrix_type(n)});
        }
        break;
    case Op::Swizzle: cases.push_back({op, {Type::Vec4}, Type::Vec3}); break;
    case Op::Column: cases.push_back({op, {Type::Mat3}, Type::Vec3}); break;
    case Op::MatMul:
        for (int n = 2; n <= 4; ++n) {
            const Type m = ir::matrix_type(n), v = ir::vector_type(n);
            cases.push_back({op, {m, v}, v});
            cases.push_back({op, {v, m}, v});
            cases.push_back({op, {m, m}, m});
        }
        break;
    case Op::Transpose: same(1, matrices); break;
    case Op::Hash:
        for (Type t : {Type::Int, Type::Float, Type::Vec2, Type::Vec3, Type::Vec4})
            cases.push_back({op, {t}, Type::Float});
        break;
    case Op::Perlin: case Op::Simplex: case Op::ValueNoise: case Op::Worley:
        cases.push_back({op, {Type::Vec3}, Type::Float});
        break;
    case Op::SpotNoise: cases.push_back({op, {Type::Vec3, Type::Float, Type::Float}, Type::Float}); break;
    case Op::Union: case Op::Intersection:
        for (std::size_t n : {1u, 2u, 3u, 5u}) cases.push_back({op, std::vector<Type>(n, Type::Float), Type::Float});
        break;
    case Op::Blend:
        for (std::size_t n : {3u, 4u, 6u}) cases.push_back({op, std::vector<Type>(n, Type::Float), Type::Float});
        break;
    }
    return cases;
}

std::vector<std::uint32_t> payloads_of(Op op) {
    if (op == Op::Blend) return {0, 1, 2, 3, 4};
    if (op == Op::Swizzle) return {ir::swizzle_mask(std::array{3, 0, 1}), ir::swizzle_mask(std::array{2, 2, 0})};
    if (op == Op::Column) return {0, 2};
    return {0};
}

// A small generator of its own, so that a failure can be repeated.
struct Random {
    std::uint32_t state = 12345;
    std::uint32_t next() { return state = state * 1664525u + 1013904223u; }
    double unit() { return (next() >> 8) * (1.0 / 16777216.0); }
};

// Whole numbers and halves, both signs of 0, tiny and large; and where an op can bear it, the largest.
float nasty(Random &random, Op op) {
    const bool trig = op == Op::Sin || op == Op::Cos || op == Op::Tan;
    const bool noise = op == Op::Perlin || op == Op::Simplex || op == Op::ValueNoise || op == Op::Worley ||
                       op == Op::SpotNoise;
    constexpr float special[] = {0.0f,  -0.0f, 1.0f,  -1.0f, 0.5f,    -0.5f,  2.0f,   -2.0f,  3.0f, -3.0f, 1.5f,
                                 -1.5f, 1e-6f, -1e-6f, 0.1f,  0.9999f, 10.0f, -10.0f, 100.0f, -7.25f};
    constexpr float extreme[] = {1e6f, -1e6f, 1e9f, -1e9f, 1e-20f, -1e-20f, 3e38f, -3e38f};
    const double kind = random.unit();
    if (kind < 0.5) return special[random.next() % std::size(special)];
    if (kind < 0.6 && !trig && !noise) return extreme[random.next() % std::size(extreme)];
    return static_cast<float>((random.unit() - 0.5) * (trig ? 12 : 20));
}

double nasty_value(Random &random, Op op, Type type) {
    if (type == Type::Bool) return random.next() & 1u;
    if (type == Type::Int) {
        constexpr double special[] = {0, 1, -1, 2, -2, 3, 7, -7, 100, 65536, -65536};
        return special[random.next() % std::size(special)];
    }
    return nasty(random, op);
}

struct Harness {
    GLuint program = 0, framebuffer = 0, texture = 0, vertex_array = 0, buffer = 0, buffer_texture = 0;
    ~Harness() {
        glDeleteProgram(program);
        glDeleteFramebuffers(1, &framebuffer);
        glDeleteTextures(1, &texture);
        glDeleteTextures(1, &buffer_texture);
        glDeleteBuffers(1, &buffer);
        glDeleteVertexArrays(1, &vertex_array);
    }
};

// `sdf(vec3(row, component, 0))` of an emitted field for rows 0 … count-1 and `components` components.
std::vector<float> run_shader(const glsl::Output &output, int count, int components) {
    Harness h;
    const std::string main = "\nout vec4 value;\nvoid main() {\n    value = vec4(sdf(vec3(gl_FragCoord.xy - 0.5, 0.0)));\n}\n";
    const std::string fragment = output.text + main;
    const char *vertex = "#version 330 core\nvoid main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == "
                         "2 ? 3.0 : -1.0, 0.0, 1.0); }\n";
    h.program = glCreateProgram();
    for (const auto &[kind, text] : {std::pair{GL_VERTEX_SHADER, vertex}, std::pair{GL_FRAGMENT_SHADER, fragment.c_str()}}) {
        const GLuint shader = glCreateShader(static_cast<GLenum>(kind));
        glShaderSource(shader, 1, &text, nullptr);
        glCompileShader(shader);
        glAttachShader(h.program, shader);
        glDeleteShader(shader);
    }
    glLinkProgram(h.program);
    GLint good = 0;
    glGetProgramiv(h.program, GL_LINK_STATUS, &good);
    if (!good) {
        char log[2000] = "";
        glGetProgramInfoLog(h.program, sizeof log, nullptr, log);
        FAIL(log << "\n" << fragment);
    }
    glGenTextures(1, &h.texture);
    glBindTexture(GL_TEXTURE_2D, h.texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, count, components, 0, GL_RGBA, GL_FLOAT, nullptr);
    glGenFramebuffers(1, &h.framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, h.framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, h.texture, 0);
    glGenVertexArrays(1, &h.vertex_array);
    glBindVertexArray(h.vertex_array);
    glUseProgram(h.program);
    if (!output.tables.empty()) {
        glGenBuffers(1, &h.buffer);
        glBindBuffer(GL_TEXTURE_BUFFER, h.buffer);
        glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(output.tables.size() * 4), output.tables.data(), GL_STATIC_DRAW);
        glGenTextures(1, &h.buffer_texture);
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_BUFFER, h.buffer_texture);
        glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, h.buffer);
        glUniform1i(glGetUniformLocation(h.program, "fathom_tables"), 0);
    }
    glViewport(0, 0, count, components);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    std::vector<float> rgba(static_cast<std::size_t>(count * components * 4)), result;
    glReadPixels(0, 0, count, components, GL_RGBA, GL_FLOAT, rgba.data());
    for (std::size_t i = 0; i < rgba.size(); i += 4) result.push_back(rgba[i]);
    return result;
}

// How far a shader's float may be from the exact value: drivers are allowed a few units in the last place, more in the
// functions that they compute by fits.
double tolerance(Op op, double expected, double scale) {
    double relative = 4e-6, absolute = 1e-6;
    if (op == Op::Pow || op == Op::Exp || op == Op::Exp2 || op == Op::Sinh || op == Op::Cosh) relative = 1e-4;
    if (op == Op::Sin || op == Op::Cos || op == Op::Tan || op == Op::Atan || op == Op::Atan2 || op == Op::Asin ||
        op == Op::Acos || op == Op::Tanh)
        absolute = 1e-5, relative = 1e-4;
    if (op == Op::Perlin || op == Op::Simplex || op == Op::ValueNoise || op == Op::Worley || op == Op::SpotNoise)
        absolute = 2e-5;
    return absolute + relative * std::max(std::abs(expected), scale);
}

} // namespace

TEST_CASE("every op means in a shader what it means everywhere") {
    if (!has_context()) return;
    constexpr int rows = 256;
    for (std::size_t index = 0; index < ir::op_count(); ++index) {
        const Op op = static_cast<Op>(index);
        for (const Case &c : cases_of(op))
            for (std::uint32_t payload : payloads_of(op)) {
                std::string types;
                for (Type t : c.args) types += std::string(" ") + ir::type_name(t);
                CAPTURE(ir::info(op).name, types, ir::type_name(c.result), payload);

                // The arguments' numbers, and what comes of them.
                Random random;
                ir::Table table{rows, 0, {}};
                for (Type t : c.args) table.stride += ir::components(t);
                std::vector<Constant> expected;
                std::vector<double> scales;
                for (int row = 0; row < rows; ++row) {
                    std::vector<Constant> args;
                    double scale = 0;
                    for (Type t : c.args) {
                        Constant arg{t, {}};
                        for (int i = 0; i < ir::components(t); ++i) {
                            const double v = nasty_value(random, op, t);
                            arg.value[static_cast<std::size_t>(i)] = v;
                            table.data.push_back(static_cast<float>(v));
                            scale = std::max(scale, std::abs(v));
                        }
                        args.push_back(arg);
                    }
                    const auto value = ir::evaluate(op, c.result, args, payload);
                    REQUIRE(value);
                    expected.push_back(*value);
                    scales.push_back(scale);
                }

                const int components = ir::components(c.result);
                ir::Scene scene = scenes::of_field([&](ir::Graph &g, NodeId p) {
                    const ir::TableId id = g.add_table(table);
                    const NodeId row = g.make(Op::ToInt, Type::Int, {g.component(p, 0)});
                    std::vector<NodeId> args;
                    int column = 0;
                    for (Type t : c.args) {
                        args.push_back(g.make(Op::TableRead, t, {row}, ir::table_slot(id, column)));
                        column += ir::components(t);
                    }
                    const NodeId value = g.make(op, c.result, args, payload);
                    std::vector<NodeId> parts;
                    const auto add = [&](NodeId part) {
                        const Type t = g[part].type;
                        parts.push_back(t == Type::Float ? part : g.make(Op::ToFloat, Type::Float, {part}));
                    };
                    if (ir::is_matrix(c.result)) {
                        const int n = ir::side(c.result);
                        for (int i = 0; i < n * n; ++i)
                            add(g.component(g.make(Op::Column, ir::vector_type(n), {value}, static_cast<std::uint32_t>(i / n)), i % n));
                    } else if (ir::is_vector(c.result)) {
                        for (int i = 0; i < components; ++i) add(g.component(value, i));
                    } else {
                        add(value);
                    }
                    NodeId chosen = parts.back();
                    for (int i = components - 2; i >= 0; --i)
                        chosen = g.make(Op::Select, {g.make(Op::Less, {g.component(p, 1), g.number(i + 0.5)}),
                                                     parts[static_cast<std::size_t>(i)], chosen});
                    return chosen;
                });
                Diagnostics diagnostics;
                const glsl::Output output = glsl::emit(
                    scene, {.target = glsl::Target::Glsl330, .field_only = true, .buffers = true}, diagnostics);
                for (const Diagnostic &d : diagnostics.items()) UNSCOPED_INFO(d.message);
                REQUIRE_FALSE(diagnostics.has_errors());
                const std::vector<float> found = run_shader(output, rows, components);
                int wrong = 0;
                for (int row = 0; row < rows; ++row)
                    for (int i = 0; i < components; ++i) {
                        const double want = static_cast<float>(expected[static_cast<std::size_t>(row)].value[static_cast<std::size_t>(i)]);
                        const float got = found[static_cast<std::size_t>(i * rows + row)];
                        if (std::isnan(want)) continue; // unspecified
                        const double scale = ir::is_vector(c.args[0]) || ir::is_matrix(c.args[0]) || c.args.size() > 1 || op == Op::Fract
                                                 ? scales[static_cast<std::size_t>(row)]
                                                 : 0;
                        // What overflows float on the way has no stated value.
                        const bool huge = scale > 1e15 && op != Op::Min && op != Op::Max && op != Op::Select;
                        const bool good = std::isinf(want) || std::abs(want) > 1e37 || huge
                                              ? !std::isinf(want) || huge || std::abs(got) > 1e30 || std::isnan(got)
                                              : std::abs(got - want) <= tolerance(op, want, scale);
                        if (!good && ++wrong <= 3) {
                            std::string args;
                            for (int k = 0; k < table.stride; ++k)
                                args += " " + std::to_string(table.data[static_cast<std::size_t>(row * table.stride + k)]);
                            UNSCOPED_INFO("of" << args << ": component " << i << " is " << got << ", not " << want);
                        }
                    }
                CHECK(wrong == 0);
            }
    }
}
