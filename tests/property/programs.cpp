// Long: one grammar, whose rules call each other.
#include "programs.h"

#include <array>
#include <fmt/format.h>
#include <initializer_list>
#include <random>
#include <utility>
#include <vector>

namespace programs {
namespace {

enum class Kind { Bool, Int, Float, Vec2, Vec3, Vec4, Mat2, Mat3, Floats, Points, Color, Shape };

const char *type_text(Kind kind) {
    switch (kind) {
    case Kind::Bool: return "bool";
    case Kind::Int: return "int";
    case Kind::Float: return "float";
    case Kind::Vec2: return "vec2";
    case Kind::Vec3: return "vec3";
    case Kind::Vec4: return "vec4";
    case Kind::Mat2: return "mat2";
    case Kind::Mat3: return "mat3";
    case Kind::Floats: return "[float]";
    case Kind::Points: return "[vec3]";
    case Kind::Color: return "color";
    case Kind::Shape: return "shape";
    }
    return "";
}

struct Name {
    std::string text;
    Kind kind = Kind::Float;
    bool field = false; // not known before the point is
    bool var = false;
};

struct Function {
    std::string name;
    std::vector<std::pair<std::string, Kind>> parameters;
    Kind result = Kind::Float;
    bool scene_only = false; // its list or loop decides what there is
};

class Writer {
  public:
    explicit Writer(unsigned seed) : random_(seed * 2654435761u + 12345u) {}

    std::string whole_scene() {
        const std::size_t functions = pick(4);
        for (std::size_t i = 0; i < functions; ++i)
            declare_function(one_of({Kind::Float, Kind::Vec3}));
        if (often()) declare_param();
        if (rarely()) declare_param();
        const std::size_t lets = pick(4);
        for (std::size_t i = 0; i < lets; ++i) declare_let();
        if (often()) declare_shape_function();
        if (rarely())
            out_ += "import \"dfmodel\" as thesis\nthesis.box([1, 2, 1]).translate(y: 3)\n";
        const std::size_t shapes = 1 + pick(4);
        for (std::size_t i = 0; i < shapes; ++i) contribute("", 3);
        if (rarely())
            out_ += "background(d => " + at_field({{"d", Kind::Vec3}}, Kind::Color) + ")\n";
        if (rarely()) out_ += "light(at: [3, " + number() + ", 2], color: " + color(1) + ")\n";
        if (rarely()) out_ += "camera(at: [5, 3, 6], look_at: [0, 0, 0], fov: 45deg)\n";
        return out_;
    }

    std::string whole_function() {
        const std::size_t functions = pick(3);
        for (std::size_t i = 0; i < functions; ++i)
            declare_function(one_of({Kind::Float, Kind::Vec3}));
        names_.push_back({"a", Kind::Float, true, false});
        names_.push_back({"b", Kind::Vec3, true, false});
        names_.push_back({"n", Kind::Int, true, false});
        out_ += "fn f(a: float, b: vec3, n: int) -> float {\n" + body("  ", Kind::Float) + "}\n";
        return out_;
    }

  private:
    // -- chance

    std::size_t pick(std::size_t n) { return random_() % n; }
    bool often() { return pick(2) == 0; }
    bool rarely() { return pick(5) == 0; }
    Kind one_of(std::initializer_list<Kind> kinds) { return kinds.begin()[pick(kinds.size())]; }
    std::string fresh(const char *stem) { return fmt::format("{}{}", stem, ++named_); }

    std::string number() {
        static constexpr std::array plain = {"0.5", "1",   "2",    "1.5",  "0.25",
                                             "3",   "0.1", "1e-1", "0.75", "4"};
        static constexpr std::array others = {"45deg", "0.25turn", "1.2rad", "pi",
                                              "turn",  "0",        "0.3333"};
        return rarely() ? others[pick(others.size())] : plain[pick(plain.size())];
    }

    // -- names in scope

    std::string name_of(Kind kind) {
        std::vector<const Name *> fit;
        for (const Name &name : names_)
            if (name.kind == kind && (in_field_ || !name.field)) fit.push_back(&name);
        return fit.empty() ? std::string() : fit[pick(fit.size())]->text;
    }

    // Calls a function of the program; empty where none fits.
    std::string call_of(Kind kind, int depth) {
        std::vector<const Function *> fit;
        for (const Function &f : functions_)
            if (f.result == kind && !(f.scene_only && in_field_)) fit.push_back(&f);
        if (fit.empty() || depth <= 0) return {};
        const Function f = *fit[pick(fit.size())];
        const bool dotted = rarely() && f.parameters.front().second != Kind::Int &&
                            f.parameters.front().second != Kind::Float;
        std::string text,
            first = f.parameters.empty() ? "" : expression(f.parameters.front().second, depth - 1);
        bool named = false;
        for (std::size_t i = 1; i < f.parameters.size(); ++i) {
            named = named || rarely();
            text += (i > 1 ? ", " : "") + (named ? f.parameters[i].first + ": " : "") +
                    expression(f.parameters[i].second, depth - 1);
        }
        if (dotted) return "(" + first + ")." + f.name + "(" + text + ")";
        return f.name + "(" + first + (f.parameters.size() > 1 ? ", " : "") + text + ")";
    }

    // -- expressions: of what could be nothing special, everywhere else total (no root of what is
    // negative, no quotient by 0), since scene time refuses what field time defines

    std::string expression(Kind kind, int depth) {
        if (rarely())
            if (std::string name = name_of(kind); !name.empty()) return name;
        switch (kind) {
        case Kind::Bool: return boolean(depth);
        case Kind::Int: return whole(depth);
        case Kind::Float: return scalar(depth);
        case Kind::Vec2:
        case Kind::Vec3:
        case Kind::Vec4: return vector(kind, depth);
        case Kind::Mat2:
        case Kind::Mat3: return matrix(kind, depth);
        case Kind::Floats:
        case Kind::Points: return list(kind, depth);
        case Kind::Color: return color(depth);
        case Kind::Shape: return shape(depth);
        }
        return {};
    }

    std::string boolean(int depth) {
        if (depth <= 0) return often() ? "true" : "false";
        switch (pick(6)) {
        case 0: return "(" + boolean(depth - 1) + " and " + boolean(depth - 1) + ")";
        case 1: return "(" + boolean(depth - 1) + " or " + boolean(depth - 1) + ")";
        case 2: return "not (" + boolean(depth - 1) + ")";
        case 3: return "(" + whole(depth - 1) + " == " + whole(depth - 1) + ")";
        default: {
            static constexpr std::array ops = {" < ", " <= ", " > ", " >= "};
            const std::string a = scalar(depth - 1), b = scalar(depth - 1);
            return "(" + a + ops[pick(ops.size())] + b + ")";
        }
        }
    }

    // Small: in the text an int that leaves 32 bits is an error.
    std::string whole(int depth) {
        const std::string name = name_of(Kind::Int);
        if (depth <= 0 || rarely())
            return name.empty() || rarely() ? fmt::to_string(pick(5)) : name;
        const std::string a = whole(depth - 1), b = whole(depth - 1);
        switch (pick(9)) {
        case 0: return "(" + a + " + " + b + ") % 11";
        case 1: return "(" + a + " - " + b + ") % 7";
        case 2: return "(" + a + " * " + b + ") % 5";
        case 3: return fmt::format("div({}, {})", a, 1 + pick(4));
        case 4: return "min(" + a + ", " + b + ")";
        case 5: return "max(" + a + ", " + b + ")";
        case 6: return "int(clamp(" + scalar(depth - 1) + ", -9, 9))";
        case 7: return "(if " + boolean(depth - 1) + " { " + a + " } else { " + b + " })";
        default: return "len(" + expression(Kind::Floats, depth - 1) + ")";
        }
    }

    std::string scalar(int depth) {
        if (std::string name = name_of(Kind::Float); !name.empty() && (depth <= 0 || pick(4) == 0))
            return name;
        if (depth <= 0) return in_field_ && !in_function_ && pick(8) == 0 ? "time" : number();
        static constexpr std::array ops = {" + ", " - ", " * "};
        static constexpr std::array plain = {"sin",   "cos",      "abs",   "floor",   "ceil",
                                             "round", "trunc",    "fract", "sign",    "atan",
                                             "tanh",  "saturate", "float", "radians", "asinh"};
        switch (pick(26)) {
        case 0:
        case 1:
        case 2:
        case 3: {
            const std::string a = scalar(depth - 1), b = scalar(depth - 1);
            return "(" + a + ops[pick(ops.size())] + b + ")";
        }
        case 4: return scalar(depth - 1) + " / (abs(" + scalar(depth - 1) + ") + 0.5)";
        case 5: return "(" + scalar(depth - 1) + ") % (abs(" + scalar(depth - 1) + ") + 0.5)";
        case 6: return "-(" + scalar(depth - 1) + ")";
        case 7: return "(abs(" + scalar(depth - 1) + ") + 0.1) ^ " + (often() ? "2" : "1.5");
        case 8: return std::string(plain[pick(plain.size())]) + "(" + scalar(depth - 1) + ")";
        case 9: return "sqrt(abs(" + scalar(depth - 1) + "))";
        case 10: return "min(" + scalar(depth - 1) + ", " + scalar(depth - 1) + ")";
        case 11: return "max(" + scalar(depth - 1) + ", " + scalar(depth - 1) + ")";
        case 12: return "clamp(" + scalar(depth - 1) + ", -1, 1.5)";
        case 13:
            return "mix(" + scalar(depth - 1) + ", " + scalar(depth - 1) + ", " + number() + ")";
        case 14: return (often() ? "smoothstep(-1, 1, " : "step(0.5, ") + scalar(depth - 1) + ")";
        case 15: return "atan(" + scalar(depth - 1) + ", " + scalar(depth - 1) + ")";
        case 16:
            return "length(" + vector(one_of({Kind::Vec2, Kind::Vec3, Kind::Vec4}), depth - 1) +
                   ")";
        case 17: {
            const Kind kind = one_of({Kind::Vec2, Kind::Vec3, Kind::Vec4});
            return "dot(" + vector(kind, depth - 1) + ", " + vector(kind, depth - 1) + ")";
        }
        case 18:
            return "(" + vector(Kind::Vec3, depth - 1) + ")" +
                   (often()   ? ".x"
                    : often() ? ".z"
                              : ".g");
        case 19: {
            const std::string values = expression(Kind::Floats, 0);
            return often()
                       ? values + "[(" + whole(depth - 1) + ") % len(" + values + ")]"
                       : "fold(" + values + ", " + number() + ", (s, x) => 0.5 * s + " +
                             inside({{"s", Kind::Float}, {"x", Kind::Float}}, Kind::Float, 1) + ")";
        }
        case 20:
            return "(if " + boolean(depth - 1) + " { " + scalar(depth - 1) + " } else { " +
                   scalar(depth - 1) + " })";
        case 21:
            return "(x => " + inside({{"x", Kind::Float}}, Kind::Float, depth - 1) + ")(" +
                   scalar(depth - 1) + ")";
        case 22: return "exp(-abs(" + scalar(depth - 1) + "))";
        case 23: return (often() ? "noise(" : "value_noise(") + vector(Kind::Vec3, depth - 1) + ")";
        case 24: return (in_field_ || often() ? "hash(" : "random(") + whole(depth - 1) + ")";
        default: {
            const std::string call = call_of(Kind::Float, depth);
            return call.empty() ? "(" + whole(depth - 1) + ") * 0.5" : call;
        }
        }
    }

    std::string vector(Kind kind, int depth) {
        if (std::string name = name_of(kind); !name.empty() && (depth <= 0 || pick(4) == 0))
            return name;
        const std::size_t size = kind == Kind::Vec2 ? 2 : kind == Kind::Vec3 ? 3 : 4;
        std::string literal = "[";
        for (std::size_t i = 0; i < size; ++i)
            literal += (i ? ", " : "") + scalar(depth > 0 ? depth - 1 : 0);
        literal += "]";
        if (depth <= 0) return literal;
        switch (pick(11)) {
        case 0:
            return "(" + vector(kind, depth - 1) + (often() ? " + " : " - ") +
                   vector(kind, depth - 1) + ")";
        case 1: return "(" + vector(kind, depth - 1) + " * " + scalar(depth - 1) + ")";
        case 2: return std::string(often() ? "abs(" : "sin(") + vector(kind, depth - 1) + ")";
        case 3:
            return (often() ? "min(" : "max(") + vector(kind, depth - 1) + ", " +
                   scalar(depth - 1) + ")";
        case 4: return "normalize(" + vector(kind, depth - 1) + " + 3)";
        case 5:
            return "mix(" + vector(kind, depth - 1) + ", " + vector(kind, depth - 1) + ", " +
                   scalar(depth - 1) + ")";
        case 6:
            if (kind == Kind::Vec2)
                return "(" + vector(Kind::Vec3, depth - 1) + ")" + (often() ? ".zx" : ".xy");
            if (kind == Kind::Vec3)
                return "cross(" + vector(kind, depth - 1) + ", " + vector(kind, depth - 1) + ")";
            return "(" + vector(Kind::Vec2, depth - 1) + ").xyxy";
        case 7:
            if (kind == Kind::Vec3)
                return "vec3(" + vector(Kind::Vec2, depth - 1) + ", " + scalar(depth - 1) + ")";
            if (kind == Kind::Vec2)
                return "rotate2(" + vector(kind, depth - 1) + ", " + scalar(depth - 1) + ")";
            return "vec4(" + vector(Kind::Vec3, depth - 1) + ", " + scalar(depth - 1) + ")";
        case 8:
            if (kind == Kind::Vec4) return literal;
            return matrix(kind == Kind::Vec2 ? Kind::Mat2 : Kind::Mat3, depth - 1) + " * " +
                   vector(kind, depth - 1);
        case 9: {
            if (kind != Kind::Vec3) return literal;
            const std::string values = expression(Kind::Points, 0),
                              call = often() ? call_of(kind, depth) : "";
            return !call.empty() ? call
                                 : values + "[(" + whole(depth - 1) + ") % len(" + values + ")]";
        }
        default: return literal;
        }
    }

    std::string matrix(Kind kind, int depth) {
        const Kind column = kind == Kind::Mat2 ? Kind::Vec2 : Kind::Vec3;
        const char *make = kind == Kind::Mat2 ? "mat2(" : "mat3(";
        if (depth > 0 && rarely()) return "transpose(" + matrix(kind, depth - 1) + ")";
        if (depth > 0 && rarely())
            return "(" + matrix(kind, depth - 1) + " * " + matrix(kind, depth - 1) + ")";
        if (rarely()) return make + number() + ")";
        std::string text = make + vector(column, depth - 1) + ", " + vector(column, depth - 1);
        if (kind == Kind::Mat3) text += ", " + vector(column, depth - 1);
        return text + ")";
    }

    // Scene time alone: a list's length is known.
    std::string list(Kind kind, int depth) {
        if (std::string name = name_of(kind); !name.empty() && (depth <= 0 || pick(4) == 0))
            return name;
        const bool field = std::exchange(in_field_, false);
        const Kind item = kind == Kind::Floats ? Kind::Float : Kind::Vec3;
        const bool points = kind == Kind::Points;
        std::string text;
        const std::string v = fresh("v");
        switch (pick(depth > 0 && !field ? 5 : 2)) {
        case 0: text = "[" + expression(item, 0) + ", " + expression(item, 1) + "]"; break;
        case 1: {
            const std::string i = fresh("i");
            text = fmt::format("[for {} in 0..{} {{ {} }}]", i, 2 + pick(6),
                               inside({{i, Kind::Int}}, item, 1));
            break;
        }
        case 2:
            text = "map(" + list(kind, depth - 1) + ", " + v + " => " +
                   inside({{v, item}}, item, 1) + ")";
            break;
        case 3:
            text = "concat(" + list(kind, depth - 1) + ", [" + expression(item, 1) + ", " +
                   expression(item, 1) + "])";
            break;
        default: text = (points ? "reverse(" : "sort(") + list(kind, depth - 1) + ")";
        }
        in_field_ = field;
        return text;
    }

    std::string color(int depth) {
        static constexpr std::array plain = {"#8a8378", "tomato", "#fa0",
                                             "skyblue", "white",  "gold"};
        if (depth <= 0 || often()) return plain[pick(plain.size())];
        if (often())
            return "mix(" + color(depth - 1) + ", " + color(depth - 1) + ", saturate(" +
                   scalar(depth - 1) + "))";
        return "rgb(saturate(" + scalar(depth - 1) + "), 0.5, saturate(" + scalar(depth - 1) + "))";
    }

    // An expression that may name these too.
    std::string inside(const std::vector<std::pair<std::string, Kind>> &parameters, Kind kind,
                       int depth) {
        const std::size_t names = names_.size();
        for (const auto &[text, of] : parameters) names_.push_back({text, of, in_field_, false});
        std::string result = expression(kind, depth);
        names_.resize(names);
        return result;
    }
    std::string at_field(const std::vector<std::pair<std::string, Kind>> &parameters, Kind kind,
                         int depth = 3) {
        const bool field = std::exchange(in_field_, true);
        std::string result = inside(parameters, kind, depth);
        in_field_ = field;
        return result;
    }

    // -- a body's statements

    std::string body(const std::string &margin, Kind result) {
        const bool field = std::exchange(in_field_, true),
                   function = std::exchange(in_function_, true);
        const std::size_t names = names_.size();
        std::string text;
        const std::size_t statements = 1 + pick(5);
        for (std::size_t i = 0; i < statements; ++i) text += statement(margin, result, 2);
        text += margin + expression(result, 3) + "\n";
        names_.resize(names);
        in_field_ = field, in_function_ = function;
        return text;
    }

    std::string block(const std::string &margin, Kind result, int depth) {
        const std::size_t names = names_.size();
        std::string text = "{\n";
        const std::size_t statements = 1 + pick(3);
        for (std::size_t i = 0; i < statements; ++i)
            text += statement(margin + "  ", result, depth);
        names_.resize(names);
        return text + margin + "}";
    }

    std::string assignment() {
        std::vector<const Name *> fit;
        for (const Name &name : names_)
            if (name.var) fit.push_back(&name);
        if (fit.empty()) return {};
        const Name to = *fit[pick(fit.size())];
        static constexpr std::array ops = {" = ", " += ", " -= ", " *= "};
        if (to.kind == Kind::Bool) return to.text + " = " + boolean(2);
        // halved, so that a loop's numbers stay in range
        if (to.kind == Kind::Int) return to.text + " = (" + to.text + " + " + whole(1) + ") % 9";
        if (to.kind == Kind::Vec3 && often())
            return to.text + (often() ? ".xz = " + vector(Kind::Vec2, 1) + " * 0.5"
                                      : ".y" + std::string(ops[pick(3)]) + scalar(1));
        if (rarely()) return to.text + " /= " + number() + " + 0.5";
        return to.text + std::string(ops[pick(3)]) + "0.5 * " + expression(to.kind, 2);
    }

    std::string statement(const std::string &margin, Kind result, int depth) {
        const std::string name = fresh("v");
        switch (pick(depth > 0 ? 12 : 5)) {
        case 0:
        case 1: {
            const Kind kind = one_of({Kind::Float, Kind::Vec3, Kind::Vec2, Kind::Int, Kind::Bool});
            const std::string value = expression(kind, 2);
            names_.push_back({name, kind, true, false});
            return margin + "let " + name + (rarely() ? std::string(": ") + type_text(kind) : "") +
                   " = " + value + "\n";
        }
        case 2: {
            const Kind kind = one_of({Kind::Float, Kind::Vec3, Kind::Int, Kind::Bool, Kind::Vec2});
            const std::string value = kind == Kind::Int || kind == Kind::Bool
                                          ? expression(kind, 2)
                                          : "0.5 * " + expression(kind, 2);
            names_.push_back({name, kind, true, true});
            return margin + "var " + name + " = " + value + "\n";
        }
        case 3:
        case 4: {
            const std::string text = assignment();
            return text.empty() ? "" : margin + text + "\n";
        }
        case 5:
        case 6: {
            const std::string i = fresh("i");
            const bool over_list = rarely();
            std::string head = over_list  ? expression(Kind::Floats, 0)
                               : rarely() ? fmt::format("range(1, {}, 2)", 5 + pick(9))
                               : rarely() ? fmt::format("0..={}", pick(6))
                                          : fmt::format("0..{}", pick(9));
            names_.push_back({i, over_list ? Kind::Float : Kind::Int, true, false});
            std::string text = margin + "for " + i + " in " + head + " " +
                               loop_block(margin, result, depth - 1) + "\n";
            names_.pop_back();
            return text;
        }
        case 7: {
            const std::string head = scalar(1) + " < " + scalar(1);
            return fmt::format("{}while {} limit {} {}\n", margin, head, 1 + pick(9),
                               loop_block(margin, result, depth - 1));
        }
        case 8:
        case 9: {
            std::string text = margin + "if " + boolean(2) + " " + block(margin, result, depth - 1);
            if (rarely()) text += " else if " + boolean(1) + " " + block(margin, result, depth - 1);
            if (often()) text += " else " + block(margin, result, depth - 1);
            return text + "\n";
        }
        case 10: {
            const Kind kind = one_of({Kind::Float, Kind::Vec3});
            const std::string g = fresh("g"), x = fresh("x");
            const std::string value = inside({{x, kind}}, Kind::Float, 2);
            functions_.push_back({g, {{x, kind}}, Kind::Float, false});
            // used at once, then forgotten
            const std::string use = fresh("v");
            const std::string text =
                margin +
                (often() ? "let " + g + " = " + x + " => " + value
                         : "fn " + g + "(" + x + ": " + type_text(kind) + ") = " + value) +
                "\n" + margin + "let " + use + " = " + g + "(" + expression(kind, 1) + ")\n";
            functions_.pop_back();
            names_.push_back({use, Kind::Float, true, false});
            return text;
        }
        default: return margin + "if " + boolean(2) + " { return " + expression(result, 1) + " }\n";
        }
    }

    std::string loop_block(const std::string &margin, Kind result, int depth) {
        std::string text = block(margin, result, depth);
        if (rarely()) {
            // leaving early, as the loop's last act
            text.resize(text.size() - margin.size() - 1);
            text += margin + "  if " + boolean(1) + " { break }\n" + margin + "}";
        }
        return text;
    }

    // -- declarations

    void declare_function(Kind result) {
        Function f{fresh("f"), {}, result, false};
        const std::size_t names = names_.size(), count = 1 + pick(3);
        std::string head;
        for (std::size_t i = 0; i < count; ++i) {
            const Kind kind = one_of({Kind::Float, Kind::Vec3, Kind::Int, Kind::Bool, Kind::Vec2});
            const std::string name = fresh("a");
            f.parameters.push_back({name, kind});
            names_.push_back({name, kind, true, false});
            head += (i ? ", " : "") + name + (often() ? std::string(": ") + type_text(kind) : "");
        }
        out_ += "fn " + f.name + "(" + head + ")" +
                (often() ? std::string(" -> ") + type_text(result) : "");
        if (often())
            out_ += " {\n" + body("  ", result) + "}\n";
        else {
            in_function_ = true;
            out_ += " = " + at_field({}, result) + "\n";
            in_function_ = false;
        }
        names_.resize(names);
        functions_.push_back(f);
    }

    void declare_param() {
        const std::string name = fresh("param");
        switch (pick(4)) {
        case 0:
            out_ += "param " + name + " = 2 in 1..5 \"Count\"\n";
            names_.push_back({name, Kind::Int, false, false});
            break;
        case 1:
            out_ += "param " + name + " = true\n";
            names_.push_back({name, Kind::Bool, false, false});
            break;
        case 2:
            out_ += "param " + name + " = #d94f2b\n";
            names_.push_back({name, Kind::Color, true, false});
            break;
        default:
            out_ += "param " + name + " = 1.2 in 0.5..2.0\n";
            names_.push_back({name, Kind::Float, true, false});
        }
    }

    void declare_let() {
        const Kind kind = one_of({Kind::Float, Kind::Floats, Kind::Points, Kind::Vec3, Kind::Int,
                                  Kind::Mat3, Kind::Shape});
        const std::string name = fresh("let"), value = expression(kind, 2);
        out_ += "let " + name + " = " + value + "\n";
        names_.push_back({name, kind, false, false});
    }

    void declare_shape_function() {
        const std::string name = fresh("make"), size = fresh("a"), count = fresh("n"),
                          i = fresh("i");
        const std::size_t names = names_.size();
        names_.push_back({size, Kind::Float, false, false});
        names_.push_back({count, Kind::Int, false, false});
        const std::string motif = shape(1);
        out_ += "fn " + name + "(" + size + ": float, " + count + ": int) -> shape {\n";
        if (often())
            out_ += "  if " + count + " <= 0 { sphere(0.3) } else { smooth_union(0.1) { " + motif +
                    "\n    " + name + "(0.7 * " + size + ", min(" + count +
                    " - 1, 3)).translate(y: 1) } }\n}\n";
        else
            out_ += "  let part = " + motif + "\n  union { for " + i + " in 0..3 { part.rotate(" +
                    i + " * turn / 3).translate(x: " + i + ") } }\n}\n";
        names_.resize(names);
        functions_.push_back({name, {{size, Kind::Float}, {count, Kind::Int}}, Kind::Shape, true});
    }

    // -- shapes

    std::string size() { return "(0.3 + abs(" + scalar(1) + ") % 2)"; } // positive, bounded

    std::string solid(int depth) {
        switch (pick(9)) {
        case 0: return "sphere(" + size() + ")";
        case 1: return "box([" + size() + ", 1, 0.5])";
        case 2: return "torus(1, 0.2)";
        case 3: return "cylinder(0.4, " + size() + ")";
        case 4: return "capsule([0, -1, 0], [0, 1, 0], 0.3)";
        case 5: return "octahedron(" + size() + ")";
        case 6:
            return "implicit(p => length(p * [1, 1.5, 1]) - 1 + 0.1 * sin(3 * p.x), within: "
                   "ball(2))";
        case 7:
            return "implicit(p => " + at_field({{"p", Kind::Vec3}}, Kind::Float) + ", estimate: 4)";
        default: {
            const std::string call = call_of(Kind::Shape, depth);
            return call.empty() ? "rounded_box([1, 1, 2], radius: 0.1)" : call;
        }
        }
    }

    std::string shape(int depth) {
        if (std::string name = name_of(Kind::Shape); !name.empty() && rarely()) return name;
        if (depth <= 0) return solid(0);
        const std::string a = shape(depth - 1);
        switch (pick(18)) {
        case 0: return a + ".translate(" + vector(Kind::Vec3, 1) + ")";
        case 1:
            return a + ".rotate(" + scalar(1) + ", axis: " + (often() ? "Z" : "[1, 2, 0.5]") + ")";
        case 2: return a + ".scale(" + size() + ")";
        case 3: return "(" + a + " | " + shape(depth - 1) + ")";
        case 4: return "(" + a + " - " + shape(depth - 1) + ")";
        case 5: return "(" + a + " & " + shape(depth - 1) + ")";
        case 6: return "smooth_union(0.2) { " + a + "; " + shape(depth - 1) + " }";
        case 7: return "round_difference(0.1, " + a + ", " + shape(depth - 1) + ")";
        case 8: return a + ".shell(0.1)";
        case 9: return a + ".offset(0.05)";
        case 10: return a + ".mirror(X)";
        case 11: return a + ".repeat([5, 0, 5], [3, 1, 2])";
        case 12: return a + ".repeat_polar(5)";
        case 13: return a + ".paint(" + color(1) + ")";
        case 14: return a + ".paint(p => " + at_field({{"p", Kind::Vec3}}, Kind::Color) + ")";
        case 15:
            return a + ".paint(material(diffuse: (p, n) => " +
                   at_field({{"p", Kind::Vec3}, {"n", Kind::Vec3}}, Kind::Color) +
                   ", exponent: 8))";
        case 16: return "blend(" + a + ", " + shape(depth - 1) + ", 0.4)";
        default: return solid(depth);
        }
    }

    // Where shapes contribute: a shape, a loop, a choice.
    void contribute(const std::string &margin, int depth) {
        const std::size_t names = names_.size();
        switch (depth > 0 ? pick(6) : 0) {
        case 1: {
            const std::string i = fresh("i");
            out_ += fmt::format("{}for {} in 0..{} {{\n", margin, i, 2 + pick(12));
            names_.push_back({i, Kind::Int, false, false});
            contribute(margin + "  ", depth - 1);
            out_ += margin + "}\n";
            break;
        }
        case 2: {
            const std::string v = fresh("v");
            out_ += margin + "for " + v + " in " + list(Kind::Floats, 1) + " {\n";
            names_.push_back({v, Kind::Float, false, false});
            contribute(margin + "  ", depth - 1);
            out_ += margin + "}\n";
            break;
        }
        case 3:
            out_ += margin + "if " + boolean(2) + " {\n";
            contribute(margin + "  ", depth - 1);
            out_ += margin + "} else {\n";
            contribute(margin + "  ", depth - 1);
            out_ += margin + "}\n";
            break;
        case 4: {
            static constexpr std::array heads = {"union", "difference", "smooth_union(0.1)",
                                                 "intersection"};
            out_ += margin + heads[pick(heads.size())] + " {\n";
            contribute(margin + "  ", depth - 1);
            contribute(margin + "  ", depth - 1);
            out_ += margin + "}\n";
            break;
        }
        default: out_ += margin + shape(2) + "\n";
        }
        names_.resize(names);
    }

    std::minstd_rand random_;
    std::string out_;
    std::vector<Name> names_;
    std::vector<Function> functions_;
    bool in_field_ = false;
    bool in_function_ = false; // which is called at scene time too: no `time` in it
    int named_ = 0;
};

} // namespace

std::string scene(unsigned seed) { return Writer(seed).whole_scene(); }
std::string function(unsigned seed) { return Writer(seed).whole_function(); }

} // namespace programs
