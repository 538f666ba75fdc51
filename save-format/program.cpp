// The language's text of a field program.
#include "save-format/program.h"

#include "save-format/sdf_text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace fathom::save {
namespace {

// How each operation of the table is written; and what the save format alone has.
struct Spelling {
    std::string_view op;
    int arity;
    std::string_view text; // {0} {1} {2} stand for the arguments
};
constexpr Spelling spellings[] = {
#define FATHOM_OP(name, arity, rule, glsl, text, ...) {#name, arity, text},
#include "ir/ops.def"
    {"WholeDiv", 2, "div({0}, {1})"},
};

std::string filled(std::string_view form, const std::vector<std::string> &arguments) {
    std::string text;
    for (std::size_t i = 0; i < form.size(); ++i) {
        const bool place = i + 2 < form.size() && form[i] == '{' && form[i + 2] == '}';
        if (place)
            text += arguments[static_cast<std::size_t>(form[i + 1] - '0')], i += 2;
        else
            text += form[i];
    }
    return text;
}
constexpr std::size_t max_inline = 20000; // characters of an expression without names

constexpr std::string_view constructors[] = {"vec2", "vec3", "vec4", "mat2", "mat3", "mat4"};

std::string constant_text(const Value &value) {
    // no length of a shape's, but any single: what a search for the nearest begins with
    if (const auto number = number_of(value, double(std::numeric_limits<float>::max())))
        return *number < 0 ? "(" + sdf_number(*number) + ")" : sdf_number(*number);
    if (value.kind == Value::Kind::Scalar && value.plain) {
        if (const auto on = switch_of(value)) return *on ? "true" : "false";
    }
    return {};
}

class Program {
  public:
    Program(const Value &steps, const Words &words, Given given, std::string &why)
        : steps_(steps), words_(words), given_(given), why_(why) {}

    std::string text() {
        if (steps_.kind != Value::Kind::Sequence || steps_.items.empty()) {
            why_ = "it has to be a list of steps";
            return {};
        }
        count_uses();
        for (std::size_t i = 0; i < steps_.items.size(); ++i) {
            std::string expression = step(i);
            if (expression.empty()) {
                if (why_.empty())
                    why_ = fmt::format(
                        "step {} is not an operation with earlier steps as its arguments", i);
                return {};
            }
            const bool last = i + 1 == steps_.items.size();
            // A value that is used twice, or grows long, gets a name; others stand where they are
            // used, as all do where no block can stand.
            if (expression.size() > max_inline) {
                why_ = "it is too long for a number";
                return {};
            }
            if (!last && given_ != Given::Nothing && (uses_[i] > 1 || expression.size() > 60) &&
                expression.size() > 3) {
                lets_ += fmt::format("let t{} = {}; ", i, expression);
                expression = fmt::format("t{}", i);
            }
            texts_.push_back(std::move(expression));
        }
        std::string result = texts_.back();
        if (given_ == Given::Nothing) return result;
        if (result.size() > 2 && result.front() == '(' && whole_in_parentheses(result))
            result = result.substr(1, result.size() - 2);
        return std::string(normal_used_                 ? "(p, n) => "
                           : given_ == Given::Direction ? "d => "
                                                        : "p => ") +
               (lets_.empty() ? result : "{ " + lets_ + result + " }");
    }

  private:
    static bool whole_in_parentheses(std::string_view text) {
        int depth = 0;
        for (std::size_t i = 0; i < text.size(); ++i) {
            if (text[i] == '(') ++depth;
            if (text[i] == ')' && --depth == 0) return i + 1 == text.size();
        }
        return false;
    }

    const std::string *argument(const Value &value) const {
        const auto number = number_of(value);
        if (!number || *number != std::floor(*number) || *number < 0 ||
            *number >= static_cast<double>(texts_.size()))
            return nullptr;
        return &texts_[static_cast<std::size_t>(*number)];
    }

    void count_uses() {
        uses_.assign(steps_.items.size(), 0);
        for (const Value &step : steps_.items) {
            if (step.kind != Value::Kind::Sequence) continue;
            const std::string op = step.items.empty() ? std::string() : step.items[0].text;
            if (op == "Const" || op == "Id" || op == "Param") continue;
            for (std::size_t i = op == "Cached" ? 2 : 1; i < step.items.size(); ++i) {
                const auto number = number_of(step.items[i]);
                if (number && *number >= 0 && *number < static_cast<double>(uses_.size()))
                    ++uses_[static_cast<std::size_t>(*number)];
            }
        }
    }

    std::string step(std::size_t index) {
        const Value &value = steps_.items[index];
        if (value.kind != Value::Kind::Sequence || value.items.empty()) return {};
        const std::string &op = value.items[0].text;
        const std::size_t count = value.items.size() - 1;
        if (op == "Point") {
            const bool legal = given_ != Given::Direction && given_ != Given::Nothing;
            return legal ? "p" : std::string();
        }
        if (op == "Direction") return given_ == Given::Direction ? "d" : std::string();
        if (op == "Time") return "time";
        if (op == "Param" && count == 1) {
            const auto found = words_.params.find(value.items[1].text);
            return found == words_.params.end() ? std::string() : found->second;
        }
        if (op == "Id" && count == 1) {
            const auto number = number_of(value.items[1]);
            const bool legal =
                number && *number == std::floor(*number) && *number >= 0 && *number < words_.copies;
            return legal ? copy_name(static_cast<int>(*number)) : std::string();
        }
        if (op == "Normal") {
            if (given_ != Given::PointAndNormal) return {};
            normal_used_ = true;
            return "n";
        }
        if (op == "Const") return count == 1 ? constant_text(value.items[1]) : std::string();
        std::vector<std::string> arguments;
        std::size_t first = 1;
        std::string_view word; // of Make, Splat and Swizzle: the type or the components
        if (op == "Make" || op == "Splat" || op == "Swizzle" || op == "Column" || op == "Cached") {
            if (count < 2) return {};
            word = value.items[1].text;
            first = 2;
        }
        for (std::size_t i = first; i < value.items.size(); ++i) {
            const std::string *text = argument(value.items[i]);
            if (!text) return {};
            arguments.push_back(*text);
        }
        const auto call = [&](std::string_view function) {
            std::string text(function);
            text += '(';
            for (const std::string &part : arguments)
                text += (text.back() == '(' ? "" : ", ") + part;
            return text + ")";
        };
        if (op == "Make" || op == "Splat") {
            const bool known = std::find(std::begin(constructors), std::end(constructors), word) !=
                               std::end(constructors);
            return known ? call(word) : std::string();
        }
        if (op == "Swizzle" || op == "Column") {
            const bool legal =
                arguments.size() == 1 && !word.empty() && word.size() <= 4 &&
                word.find_first_not_of(op == "Column" ? "0123" : "xyzw") == std::string_view::npos;
            if (!legal) return {};
            return op == "Column" ? arguments[0] + "[" + std::string(word) + "]"
                                  : arguments[0] + "." + std::string(word);
        }
        if (op == "Cached") {
            const auto index = number_of(value.items[1]);
            const bool legal = arguments.size() == 1 && index && *index == std::floor(*index) &&
                               *index >= 0 && *index < static_cast<double>(words_.caches.size());
            return legal ? call(words_.caches[static_cast<std::size_t>(*index)]) : std::string();
        }
        const auto known = std::ranges::find(spellings, op, &Spelling::op);
        if (known == std::end(spellings) || known->text.empty()) return {};
        if (known->arity >= 0) {
            const bool fits = arguments.size() == static_cast<std::size_t>(known->arity);
            return fits ? filled(known->text, arguments) : std::string();
        }
        if (arguments.empty()) return {}; // of any number: one after another
        std::string text = arguments[0];
        for (std::size_t i = 1; i < arguments.size(); ++i)
            text = filled(known->text, {text, arguments[i]});
        return text;
    }

    const Value &steps_;
    const Words &words_;
    Given given_;
    bool normal_used_ = false;
    std::string &why_;
    std::vector<int> uses_;
    std::vector<std::string> texts_;
    std::string lets_;
};

std::string vector_of(const Value *value) {
    double part[3];
    static constexpr const char *axes[] = {"X", "Y", "Z"};
    for (int i = 0; i < 3; ++i) {
        const Value *component =
            value && value->kind == Value::Kind::Mapping ? value->find(axes[i]) : nullptr;
        const auto number = component ? number_of(*component) : std::nullopt;
        if (!number) return {};
        part[i] = *number;
    }
    return sdf_vector(part);
}

} // namespace

std::string yaml_number(double value) {
    if (std::isinf(value)) return value < 0 ? "-.inf" : ".inf";
    return sdf_number(value);
}

std::string vector_text(const Value &vector) { return vector_of(&vector); }

std::string copy_name(int level) { return fmt::format("id_{}", level + 1); }

std::string program_text(const Value &steps, const Words &words, std::string &why, Given given) {
    return Program(steps, words, given, why).text();
}

// {Ball: radius, Center: {X, Y, Z}}, {Low: …, High: …}, {Tube: radius, Axis: Y}, `Everywhere`, and
// in each `Less`: a list. `Varying` beside them has programs for what follows params and time.
std::string region_text(const Value &region, const Words &words) {
    std::string text;
    if (region.kind == Value::Kind::Scalar)
        return spelling_key(region.text) == "everywhere" ? "everywhere" : "";
    if (region.kind != Value::Kind::Mapping) return {};
    const Value *varying = region.find("Varying");
    const auto part = [&](const char *key, bool vector) -> std::string {
        const Value *present = region.find(key);
        if (!present) return {};
        std::string why;
        if (const Value *steps = varying ? varying->find(key) : nullptr)
            return program_text(*steps, words, why, Given::Nothing);
        if (vector) return vector_of(present);
        const auto number = number_of(*present);
        return number ? sdf_number(*number) : std::string();
    };
    if (region.find("Ball")) {
        const std::string radius = part("Ball", false), at = part("Center", true);
        if (radius.empty() || (at.empty() && region.find("Center"))) return {};
        text = "ball(" + radius + (at.empty() ? "" : ", at: " + at) + ")";
    } else if (region.find("Low")) {
        const std::string low = part("Low", true), high = part("High", true);
        if (low.empty() || high.empty()) return {};
        text = "aabb(" + low + ", " + high + ")";
    } else if (region.find("Tube")) {
        const std::string radius = part("Tube", false);
        const Value *axis = region.find("Axis");
        if (radius.empty() || !axis ||
            (axis->text != "X" && axis->text != "Y" && axis->text != "Z"))
            return {};
        text = "tube(" + axis->text + ", " + radius + ")";
    } else if (region.find("Everywhere")) {
        text = "everywhere";
    } else {
        return {};
    }
    if (const Value *less = region.find("Less")) {
        for (const Value &other : less->items) {
            const std::string cut = region_text(other, words);
            if (cut.empty()) return {};
            text += " - " + cut;
        }
    }
    return text;
}

std::string distortion_text(const Value &map, const Value &within, const Words &words,
                            std::string &why) {
    const std::string lambda = program_text(map, words, why);
    if (lambda.empty()) return {};
    const std::string region = region_text(within, words);
    return ".distort(" + lambda + (region.empty() ? "" : ", within: " + region) + ")";
}

} // namespace fathom::save
