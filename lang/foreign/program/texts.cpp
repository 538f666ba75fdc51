// Texts of ours, put together from parts.
#include "base/text.h"
#include "lang/foreign/program/program.h"

namespace fathom::lang::program {

std::string call_text(std::string_view name, const std::vector<std::string> &arguments) {
    std::string out(name);
    for (std::size_t i = 0; i < arguments.size(); ++i) out += (i > 0 ? ", " : "(") + arguments[i];
    return out + (arguments.empty() ? "()" : ")");
}

static std::string_view ending_of(Of of) {
    switch (of) {
    case Of::Sdf: return "_of_sdf";
    case Of::Jscad: return "_of_jscad";
    case Of::Three:
    case Of::Script: return "_of_script";
    case Of::Curv: return "_of_curv";
    case Of::Lisp: return "_of_lisp";
    }
    return {};
}

// A call that only its name keeps from being read: a few of them leave the rest of use.
Written Writer::unread_call(const std::string &name, const std::vector<std::string> &arguments) {
    constexpr std::size_t most = 4;
    if (unread_.insert(name).second && unread_.size() > most) throw Unsure{};
    return {call_text(name + std::string(ending_of(of_)), arguments), as_call, Kind::Unknown};
}
Written Writer::unread_change(const Written &of, const std::string &name,
                              const std::vector<std::string> &arguments) {
    return {wrapped(of, as_call) + "." + unread_call(name, arguments).text, as_call, of.kind};
}

std::string wrapped(const Written &w, int needs) {
    return w.binds < needs ? "(" + w.text + ")" : w.text;
}

std::string halved(std::string_view value) {
    if (const auto number = parse_number(std::string(value))) return format_shortest(*number / 2);
    if (value.starts_with("2 * ") && value.find_first_of(" +-/|&", 4) == std::string_view::npos)
        return std::string(value.substr(4));
    const bool plain = value.find_first_of("+-|&?") == std::string_view::npos;
    return plain ? std::string(value) + " / 2" : "(" + std::string(value) + ") / 2";
}

std::string negated(std::string_view value) {
    const bool list = value.starts_with("[") && value.find(']') + 1 == value.size();
    const bool product = value.find_first_of("+-|&?") == std::string_view::npos;
    const bool plain = list || product || value.find_first_of(" +*/|&") == std::string_view::npos;
    if (plain && !product && !list && value.starts_with("-")) return std::string(value.substr(1));
    return plain ? "-" + std::string(value) : "-(" + std::string(value) + ")";
}

// The parts of `[a, b]`; none of all else.
static std::vector<std::string> parts_of_vector(std::string_view v) {
    std::vector<std::string> out;
    if (!v.starts_with("[") || !v.ends_with("]")) return out;
    int depth = 0;
    for (std::size_t begin = 1, i = 1; i < v.size(); ++i) {
        if (depth == 0 && (v[i] == ',' || i + 1 == v.size())) {
            while (v[begin] == ' ') ++begin;
            out.emplace_back(v.substr(begin, i - begin));
            begin = i + 1;
        }
        depth += v[i] == '(' || v[i] == '[' ? 1 : v[i] == ')' || v[i] == ']' ? -1 : 0;
        if (depth < 0 && i + 1 < v.size()) return {};
    }
    return out;
}

// What lies between two corners: a box or a rectangle.
std::string between_corners(std::string_view shape, const Written &low, const Written &high) {
    const std::vector<std::string> a = parts_of_vector(low.text), b = parts_of_vector(high.text);
    const std::string head(shape);
    if (a.empty() || a.size() != b.size())
        return head + "(" + wrapped(high, 8) + " - " + wrapped(low, 9) + ").translate((" +
               wrapped(low, 8) + " + " + wrapped(high, 9) + ") / 2)";
    const auto plain = [](const std::string &one) {
        return one.find_first_of(" +-*/|&?") == std::string::npos ? one : "(" + one + ")";
    };
    std::string size, middle;
    bool moves = false;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const auto x = parse_number(a[i]), y = parse_number(b[i]);
        const std::string comma = i > 0 ? ", " : "";
        if (x && y) {
            size += comma + format_shortest(*y - *x);
            middle += comma + format_shortest((*x + *y) / 2);
            moves = moves || *x + *y != 0;
            continue;
        }
        const bool opposite = a[i] == negated(b[i]), from_zero = a[i] == "0";
        size += comma + (opposite    ? "2 * " + plain(b[i])
                         : from_zero ? b[i]
                                     : b[i] + " - " + plain(a[i]));
        middle += comma + (opposite    ? "0"
                           : from_zero ? halved(b[i])
                                       : "(" + a[i] + " + " + plain(b[i]) + ") / 2");
        moves = moves || !opposite;
    }
    return head + "([" + size + "])" + (moves ? ".translate([" + middle + "])" : "");
}

} // namespace fathom::lang::program
