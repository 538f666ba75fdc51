// The nasty arguments, and what may be asked of float32.
#include "tests/conformance/questions.h"

#include <cmath>
#include <fmt/format.h>

namespace fathom::conformance {

using ir::Constant;
using ir::Op;
using ir::Type;

namespace {

bool is_noise(Op op) {
    return op == Op::Perlin || op == Op::Simplex || op == Op::ValueNoise || op == Op::Worley ||
           op == Op::SpotNoise;
}
bool is_sine(Op op) { return op == Op::Sin || op == Op::Cos; }
bool is_angle(Op op) { return op == Op::Sin || op == Op::Cos || op == Op::Tan; }

float nasty(Random &random, Op op) {
    constexpr float usual[] = {0.0f,   -0.0f, 1.0f,   -1.0f,   0.5f,   -0.5f,      2.0f,  -2.0f,
                               3.0f,   -3.0f, 1.5f,   -1.5f,   2.5f,   0.1f,       -0.1f, 1e-6f,
                               -1e-6f, 0.75f, 100.0f, -100.0f, -7.25f, 3.14159274f};
    constexpr float extreme[] = {1e9f,   -1e9f,       3e38f,          -3e38f,    1e-38f,    -1e-38f,
                                 1e-45f, 16777216.0f, -2147483648.0f, HUGE_VALF, -HUGE_VALF};
    const std::uint32_t kind = random.below(10);
    if (kind < 5) return usual[random.below(std::size(usual))];
    if (kind == 5 && !is_noise(op) && !is_angle(op))
        return extreme[random.below(std::size(extreme))];
    if (kind == 5 && is_sine(op)) return static_cast<float>(random.between(-3e5, 3e5));
    return static_cast<float>(random.between(-10, 10));
}

Constant argument(Random &random, Op op, Type type) {
    constexpr double whole[] = {0, 1,  -1,  2,     -2,     3,          -3,
                                7, -7, 100, 65537, -65537, 2147483647, -2147483648.0};
    Constant constant{type, {}};
    for (int i = 0; i < ir::components(type); ++i) {
        double &value = constant.value[static_cast<std::size_t>(i)];
        if (type == Type::Bool)
            value = random.below(2);
        else if (type == Type::Int)
            value = whole[random.below(std::size(whole))];
        // A spot's radius and density: below that the coordinates leave what float32 can tell
        // apart.
        else if (op == Op::SpotNoise && type == Type::Float)
            value = static_cast<float>(random.between(0.2, 9));
        else
            value = nasty(random, op);
    }
    return constant;
}

// Ops whose float32 result is the rounded true one, or chosen among the arguments.
constexpr ir::OpSet is_exact{Op::Neg,   Op::Add,          Op::Sub,     Op::Mul,      Op::Div,
                             Op::Min,   Op::Max,          Op::Step,    Op::Abs,      Op::Sign,
                             Op::Floor, Op::Ceil,         Op::Trunc,   Op::Sqrt,     Op::Clamp,
                             Op::Less,  Op::LessEqual,    Op::Equal,   Op::NotEqual, Op::And,
                             Op::Or,    Op::Not,          Op::Select,  Op::ToFloat,  Op::ToInt,
                             Op::Splat, Op::Make,         Op::Swizzle, Op::Column,   Op::Transpose,
                             Op::Union, Op::Intersection, Op::Hash};

} // namespace

std::string Question::name() const {
    std::string text = ir::info(c.op).name;
    for (Type type : c.args) text += std::string(" ") + ir::type_name(type);
    if (payload != 0) text += fmt::format(" ({})", payload);
    if (fixed) text += fmt::format(" by {}", rows[0].back().value[0]);
    return text;
}

std::vector<ir::NodeId> with_fixed(const Question &question, ir::Graph &graph,
                                   std::vector<ir::NodeId> args) {
    if (question.fixed) args.back() = graph.constant(question.rows[0].back());
    return args;
}

namespace {

// Constant exponents, some of which are computed by products and roots (ir/powers.h).
void add_powers(std::vector<Question> &all) {
    for (const Type type : {Type::Float, Type::Vec3})
        for (const float exponent :
             {-20.0f, -4.0f, -3.0f, -2.0f, -1.0f, -0.5f, 0.0f, 0.05f, 0.5f,  1.0f,  1.5f,  2.0f,
              3.0f,   4.0f,  5.0f,  6.0f,  7.0f,  8.0f,  9.0f, 11.0f, 12.0f, 20.0f, 64.0f, 65.0f}) {
            Question question{{Op::Pow, {type, type}, type}, 0, {}, true};
            Random random{static_cast<std::uint32_t>(exponent * 100 + 7777)};
            Constant last{type, {}};
            for (int i = 0; i < ir::components(type); ++i)
                last.value[static_cast<std::size_t>(i)] = exponent;
            for (int row = 0; row < 203; ++row)
                question.rows.push_back({argument(random, Op::Pow, type), last});
            all.push_back(std::move(question));
        }
}

} // namespace

std::vector<Question> questions() {
    std::vector<Question> all;
    add_powers(all);
    for (std::size_t i = 0; i < ir::op_count; ++i) {
        const Op op = static_cast<Op>(i);
        for (const scenes::Case &c : scenes::cases_of(op))
            for (std::uint32_t payload : scenes::payloads_of(op)) {
                Question question{c, payload, {}};
                // by the name, so that another op in the table changes nothing for this one
                Random random{1};
                for (const char letter : question.name())
                    random.state = random.state * 31 + static_cast<unsigned char>(letter);
                for (int row = 0; row < 203; ++row) { // no multiple of any vector's width
                    std::vector<Constant> args;
                    for (Type type : c.args) args.push_back(argument(random, op, type));
                    question.rows.push_back(std::move(args));
                }
                all.push_back(std::move(question));
            }
    }
    return all;
}

Constant canonical(const Question &question, const std::vector<Constant> &row) {
    return ir::evaluate(question.c.op, question.c.result, row, question.payload).value();
}

std::string fault(const Question &question, std::size_t index, const Constant &answer) {
    const Op op = question.c.op;
    const std::vector<Constant> &row = question.rows[index];
    const Constant want = canonical(question, row);
    double scale = 0;
    std::string text;
    for (const Constant &arg : row)
        for (int i = 0; i < ir::components(arg.type); ++i) {
            scale = std::max(scale, std::abs(arg.value[static_cast<std::size_t>(i)]));
            text += fmt::format(" {}", arg.value[static_cast<std::size_t>(i)]);
        }
    for (std::size_t i = 0; i < static_cast<std::size_t>(ir::components(question.c.result)); ++i) {
        const bool is_float = question.c.result != Type::Int && question.c.result != Type::Bool;
        const double exact = want.value[i], w = is_float ? static_cast<float>(exact) : exact,
                     got = is_float ? static_cast<float>(answer.value[i]) : answer.value[i];
        const std::string said = fmt::format(" of{}: component {} is {}, not {}", text, i, got, w);
        if (std::isnan(w)) continue; // has no stated value
        if (w == got) continue;
        if (op == Op::Div && std::isinf(w) && std::isinf(got))
            continue; // the sign of a zero means nothing
        if (is_exact[op] && std::abs(w) >= 1e-37)
            return said;            // below, the processor may take tiny numbers for 0
        if (scale > 1e15) continue; // overflows float32 on the way
        if (op == Op::Normalize && scale < 1e-18) continue; // its square is no float32
        if (op == Op::Mod) {
            const double y = std::abs(row[1].value[i]);
            if (std::abs(row[0].value[i]) / y > 1e30) continue;
            if (std::abs(std::abs(got - w) - y) <= 1e-6 + 2e-6 * std::max(y, scale))
                continue; // 0 and y are neighbours on the circle
        }
        const double relative = op == Op::Pow ? 1e-5 : 2e-6;
        const double absolute = is_noise(op) ? 2e-5 : 1e-6;
        // What is lost in differences of the arguments is lost; functions of one argument lose
        // nothing.
        const bool cancels =
            row.size() > 1 || ir::components(row[0].type) > 1 || op == Op::Fract || op == Op::Round;
        if (!(std::abs(got - w) <=
              absolute + relative * std::max(std::abs(w), cancels ? scale : 0)))
            return said;
    }
    return {};
}

} // namespace fathom::conformance
