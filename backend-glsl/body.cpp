// Spells a scheduled body (schedule.h) as GLSL statements and expressions. Knows the op table's
// spelling column and what the ops without one look like; helper functions are only named here
// (helpers.cpp holds them).
// Long: one class that writes an expression; its members share its state.
#include "backend-glsl/certain.h"
#include "backend-glsl/clone_loops.h"
#include "backend-glsl/module.h"
#include "backend-glsl/schedule.h"
#include "backend-glsl/turns.h"
#include "ir/powers.h"

#include <algorithm>
#include <cassert>
#include <fmt/format.h>
#include <optional>

namespace fathom::glsl {

using ir::NodeId;
using ir::Op;
using ir::Type;

namespace {

// How tightly an expression binds, GLSL's levels; a looser operand gets parentheses.
enum Level { Primary, Unary, Product, Sum, Relation, Equality, Conjunction, Disjunction, Choice };

struct Text {
    std::string text;
    Level level = Primary;
};

Level level_of(Op op) {
    if (op == Op::Mul || op == Op::Div || op == Op::MatMul) return Product;
    if (op == Op::Add || op == Op::Sub) return Sum;
    if (op == Op::Less || op == Op::LessEqual) return Relation;
    if (op == Op::Equal || op == Op::NotEqual) return Equality;
    if (op == Op::And) return Conjunction;
    if (op == Op::Or) return Disjunction;
    if (op == Op::Neg || op == Op::Not) return Unary;
    return Primary;
}

std::string at_least(const Text &t, Level level) {
    return t.level <= level ? t.text : "(" + t.text + ")";
}

char prefix_of(Type type) {
    switch (type) {
    case Type::Bool: return 'b';
    case Type::Int: return 'n';
    case Type::Float: return 'd';
    case Type::Vec2:
    case Type::Vec3:
    case Type::Vec4: return 'v';
    case Type::Mat2:
    case Type::Mat3:
    case Type::Mat4: return 'm';
    case Type::Hit: return 'h';
    }
    return 'x';
}

const char *profile_helper(ir::Profile profile) {
    switch (profile) {
    case ir::Profile::Smooth: return "fathom_blend_smooth";
    case ir::Profile::Round: return "fathom_blend_round";
    case ir::Profile::Chamfer: return "fathom_blend_chamfer";
    case ir::Profile::Stairs: return "fathom_blend_stairs";
    case ir::Profile::Columns: return "fathom_blend_columns";
    }
    return "";
}

class Writer {
  public:
    Writer(Module &module, const ir::Graph &graph, std::span<Bound> bound,
           std::span<const NodeId> roots)
        : module_(module), graph_(graph), plan_(schedule(graph_, roots)), known_{graph_, plan_},
          names_(module.names) {
        for (Bound &b : bound) name_[b.var] = b.name = names_.unique(b.name);
    }

    std::string take() { return std::move(out_); }
    void block(BlockId id, int indent) {
        statements(plan_.blocks[static_cast<std::size_t>(id)].statements, indent);
    }
    std::string value(NodeId id) { return expression(id).text; }

  private:
    void line(int indent, const std::string &text) {
        out_.append(static_cast<std::size_t>(indent) * 4, ' ');
        out_ += text;
        out_ += '\n';
    }

    void statements(const std::vector<NodeId> &ids, int indent) {
        for (NodeId id : ids) statement(id, indent);
    }

    void statement(NodeId id, int indent) {
        const ir::Node &node = graph_[id];
        if (node.op == Op::Loop) return loop(id, indent);
        const std::string type = glsl_type(node.type);
        if (auto arms = plan_.arms.find(id); arms != plan_.arms.end()) {
            const std::string name = names_.numbered(prefix_of(node.type));
            line(indent, type + " " + name + ";");
            choice(id, name, indent);
            name_[id] = name;
            return;
        }
        if (node.count > 2 && is_folded(node.op)) {
            const bool blend = node.op == Op::Blend;
            const std::size_t first = blend ? 2 : 0;
            const std::string start = expression(graph_.args(id)[first]).text;
            const std::string name = names_.numbered(prefix_of(node.type));
            line(indent, type + " " + name + " = " + start + ";");
            std::string aside; // whose paint the others take where they have none
            if (node.op == Op::FarthestHit) {
                aside = names_.numbered('h');
                line(indent, "Hit " + aside + " = " + name + ";");
            }
            for (std::size_t i = first + 1; i < node.count; ++i)
                line(indent,
                     name + " = " + joined(id, name, value(graph_.args(id)[i]), aside) + ";");
            name_[id] = name;
            return;
        }
        const std::string text = spell(id).text;
        const std::string name = names_.numbered(prefix_of(node.type));
        line(indent, type + " " + name + " = " + text + ";");
        name_[id] = name;
    }

    static bool is_folded(Op op) {
        return op == Op::Union || op == Op::Intersection || op == Op::NearestHit ||
               op == Op::FarthestHit || op == Op::Blend;
    }

    // One turn of an n-ary combination.
    std::string joined(NodeId id, const std::string &a, const std::string &b,
                       const std::string &first = "") {
        const ir::Node &node = graph_[id];
        if (node.op == Op::Union) return "min(" + a + ", " + b + ")";
        if (node.op == Op::Intersection) return "max(" + a + ", " + b + ")";
        if (node.op == Op::NearestHit) return helper("fathom_nearest") + "(" + a + ", " + b + ")";
        if (node.op == Op::FarthestHit && first.empty())
            return helper("fathom_farthest") + "(" + a + ", " + b + ")";
        if (node.op == Op::FarthestHit)
            return helper("fathom_farthest_of") + "(" + first + ", " + a + ", " + b + ")";
        const auto profile = static_cast<ir::Profile>(node.payload);
        std::string text =
            helper(profile_helper(profile)) + "(" + a + ", " + b + ", " + value(graph_.arg(id, 0));
        if (profile == ir::Profile::Stairs || profile == ir::Profile::Columns)
            text += ", " + value(graph_.arg(id, 1));
        return text + ")";
    }

    // Of the arms that follow each other the first is taken whose condition holds. None is an
    // `else`: why, helpers/arithmetic.glsl says.
    void choice(NodeId id, const std::string &target, int indent) {
        const std::string open = names_.numbered(prefix_of(Type::Bool));
        line(indent, "bool " + open + " = true;");
        std::string before = "if (";
        while (true) {
            const auto [yes, no] = plan_.arms.at(id);
            const Text condition = expression(graph_.arg(id, 0));
            line(indent,
                 before +
                     (before.ends_with('(') ? condition.text : at_least(condition, Conjunction)) +
                     ") {");
            block(yes, indent + 1);
            assign(indent + 1, target, graph_.arg(id, 1));
            line(indent + 1, open + " = false;");
            line(indent, "}");
            const NodeId other = graph_.arg(id, 2);
            const auto &rest = plan_.blocks[static_cast<std::size_t>(no)].statements;
            if (rest.size() == 1 && rest.front() == other && plan_.arms.contains(other)) {
                before = "if (" + open + " && ";
                id = other;
                continue;
            }
            line(indent, "if (" + open + ") {");
            block(no, indent + 1);
            assign(indent + 1, target, other);
            line(indent, "}");
            return;
        }
    }

    void assign(int indent, const std::string &target, NodeId id) {
        line(indent, target + " = " + value(id) + ";");
    }

    void loop(NodeId id, int indent) {
        const ir::Loop &loop = graph_.loop(ir::LoopId{graph_[id].payload});
        for (std::size_t k = 0; k < loop.vars.size(); ++k) {
            const Type type = graph_[loop.vars[k]].type;
            const NodeId begin = graph_.args(id)[k];
            if (loop.next[k] == loop.vars[k] && graph_.is_constant(begin)) {
                name_[loop.vars[k]] = at_least(expression(begin), Primary);
                continue;
            }
            const std::string start = value(begin);
            const std::string name = names_.numbered(prefix_of(type));
            line(indent, std::string(glsl_type(type)) + " " + name + " = " + start + ";");
            name_[loop.vars[k]] = name;
        }
        const std::string i = names_.numbered('i');
        const int stride = turns_together(graph_, loop);
        std::string turn_end; // a turn's last line, of turns too many
        if (const auto pruned = module_.pruned.find(graph_[id].payload);
            pruned != module_.pruned.end()) {
            turn_end = listed_loop(pruned->second, loop, i, indent);
        } else if (stride == 0) {
            turn_end = filled_loop(loop, i, indent);
        } else if (stride > 1) {
            const std::string group = names_.numbered('i'), turn = names_.numbered('i');
            line(indent,
                 fmt::format(
                     "for (int {} = 0; {} < {}; {} += {}) for (int {} = 0; {} < {}; ++{}) {{",
                     group, group, expression(loop.count).text, group, stride, turn, turn, stride,
                     turn));
            line(indent + 1, "int " + i + " = " + group + " + " + turn + ";");
        } else {
            line(indent, "for (int " + i + " = 0; " + i + " < " +
                             at_least(expression(loop.count), Sum) + "; ++" + i + ") {");
        }
        name_[loop.index] = i;

        // What the condition needs comes first, then the way out, then the rest.
        const auto &all = plan_.blocks[static_cast<std::size_t>(plan_.loop.at(id))].statements;
        std::vector<NodeId> before, after;
        if (loop.condition) {
            std::unordered_map<NodeId, bool> known;
            for (NodeId s : all) (needs(loop.condition, s, known) ? before : after).push_back(s);
            statements(before, indent + 1);
            const bool negated =
                graph_[loop.condition].op == Op::Not && !name_.contains(loop.condition);
            line(indent + 1, "if (" +
                                 (negated ? expression(graph_.arg(loop.condition, 0)).text
                                          : "!" + at_least(expression(loop.condition), Primary)) +
                                 ") break;");
            statements(after, indent + 1);
        } else {
            statements(all, indent + 1);
        }

        // All next values are of the old ones: a value that a later line still reads is put aside.
        std::vector<std::pair<std::string, std::string>> moves;
        for (std::size_t k = 0; k < loop.vars.size(); ++k) {
            if (loop.next[k] == loop.vars[k]) continue;
            const std::string &target = name_[loop.vars[k]];
            bool read_later = false;
            for (std::size_t j = k + 1; j < loop.vars.size(); ++j)
                read_later |= mentions(loop.next[j], loop.vars[k]);
            if (!read_later) {
                assign(indent + 1, target, loop.next[k]);
                continue;
            }
            const std::string name = names_.numbered(prefix_of(graph_[loop.vars[k]].type));
            line(indent + 1, std::string(glsl_type(graph_[loop.vars[k]].type)) + " " + name +
                                 " = " + value(loop.next[k]) + ";");
            moves.emplace_back(target, name);
        }
        for (const auto &[target, name] : moves) line(indent + 1, target + " = " + name + ";");
        if (!turn_end.empty()) line(indent + 1, turn_end);
        line(indent, "}");
        name_[id] = name_[loop.vars[0]];
    }

    // The head of a loop in groups that do not fill it; what the last group's turns compute beyond
    // the end is taken back, by the line handed back.
    std::string filled_loop(const ir::Loop &loop, const std::string &i, int indent) {
        const std::string group = names_.numbered('i'), turn = names_.numbered('i'),
                          &carried = name_[loop.vars[0]],
                          count = at_least(expression(loop.count), Primary);
        const Type type = graph_[loop.vars[0]].type;
        const std::string before = names_.numbered(prefix_of(type));
        line(indent,
             fmt::format("for (int {} = 0; {} < {}; {} += {}) for (int {} = 0; {} < {}; ++{}) {{",
                         group, group, count, group, most_together, turn, turn, most_together,
                         turn));
        line(indent + 1, "int " + i + " = min(" + group + " + " + turn + ", " + count + " - 1);");
        line(indent + 1, std::string(glsl_type(type)) + " " + before + " = " + carried + ";");
        return "if (" + group + " + " + turn + " >= " + count + ") " + carried + " = " + before +
               ";";
    }

    // The same over the rows of a cell's list.
    std::string listed_loop(const PrunePlan::Use &use, const ir::Loop &loop, const std::string &i,
                            int indent) {
        const std::string list = names_.numbered('n'), group = names_.numbered('i'),
                          turn = names_.numbered('i'), &carried = name_[loop.vars[0]];
        const Type type = graph_[loop.vars[0]].type;
        const std::string before = names_.numbered(prefix_of(type));
        line(indent, fmt::format("uvec2 {} = fathom_list({}, {}, {}u);", list, value(use.point),
                                 use.grid, use.rows));
        line(indent, "for (uint " + group + " = " + list + ".x; " + group + " < " + list + ".y; " +
                         group + " += 4u) for (uint " + turn + " = 0u; " + turn + " < 4u; ++" +
                         turn + ") {");
        line(indent + 1, "int " + i + " = int(fathom_rows[min(" + group + " + " + turn + ", " +
                             list + ".y - 1u)]);");
        line(indent + 1, std::string(glsl_type(type)) + " " + before + " = " + carried + ";");
        return "if (" + group + " + " + turn + " >= " + list + ".y) " + carried + " = " + before +
               ";";
    }

    // Whether `root` reads statement `s` (itself, or through other nodes of the same loop).
    bool needs(NodeId root, NodeId s, std::unordered_map<NodeId, bool> &known) {
        if (root == s) return true;
        if (root < s) return false;
        known.clear();
        return reaches(root, s, known);
    }
    bool reaches(NodeId from, NodeId to, std::unordered_map<NodeId, bool> &known) {
        if (from == to) return true;
        if (!from || from < to) return false;
        auto [entry, fresh] = known.try_emplace(from, false);
        if (!fresh) return entry->second;
        bool found = false;
        for (NodeId arg : graph_.args(from)) found = found || reaches(arg, to, known);
        if (graph_[from].op == Op::Loop) {
            const ir::Loop &loop = graph_.loop(ir::LoopId{graph_[from].payload});
            found = found || reaches(loop.count, to, known) || reaches(loop.condition, to, known);
            for (NodeId next : loop.next) found = found || reaches(next, to, known);
        }
        return known[from] = found;
    }

    // Whether the text of `id`'s value mentions `var` (and not a local that was computed before).
    bool mentions(NodeId id, NodeId var) {
        if (id == var) return true;
        if (plan_.named(id)) return false;
        return std::ranges::any_of(graph_.args(id), [&](NodeId arg) { return mentions(arg, var); });
    }

    Text expression(NodeId id) {
        if (auto known = name_.find(id); known != name_.end()) return {known->second, Primary};
        return spell(id);
    }

    std::string helper(const std::string &name, const std::string &type = "") {
        module_.helpers.insert({name, type});
        return name;
    }

    std::string list(NodeId id, std::size_t from = 0) {
        std::string text;
        for (std::size_t i = from; i < graph_[id].count; ++i)
            text += (i == from ? "" : ", ") + value(graph_.args(id)[i]);
        return text;
    }

    // Long: a case for each op.
    Text spell(NodeId id) {
        const ir::Node &node = graph_[id];
        auto arg = [&](int i) { return graph_.arg(id, i); };
        switch (node.op) {
        case Op::Const: {
            const std::string text = literal(graph_.constant_of(id));
            return {text, text[0] == '-' ? Unary : Primary};
        }
        case Op::Point:
        case Op::Normal:
        case Op::Direction:
        case Op::Var: assert(!"inputs of a function are its parameters"); return {"0.0", Primary};
        case Op::Time: module_.reads_time = true; return {"fathom_time", Primary};
        case Op::Param: return {module_.params.at(node.payload), Primary};
        case Op::Neg:
        case Op::Not:
            if (node.type == Type::Int && !known_.in_range(id)) return saturating(id, "fathom_neg");
            return {(node.op == Op::Neg ? "-" : "!") + at_least(expression(arg(0)), Primary),
                    Unary};
        case Op::Mul:
            if (ir::is_matrix(node.type)) return {"matrixCompMult(" + list(id) + ")", Primary};
            if (node.type == Type::Int && !known_.in_range(id)) return saturating(id, "fathom_mul");
            return infix(id, " * ");
        case Op::Div:
            if (node.type == Type::Int && !known_.plain_quotient(id))
                return {helper("fathom_div") + "(" + list(id) + ")", Primary};
            return infix(id, " / ");
        case Op::Add:
        case Op::Sub:
            if (node.type == Type::Int && !known_.in_range(id))
                return saturating(id, node.op == Op::Add ? "fathom_add" : "fathom_sub");
            return sum(id);
        case Op::MatMul: return infix(id, " * ");
        case Op::Less: return infix(id, " < ");
        case Op::LessEqual: return infix(id, " <= ");
        case Op::Equal: return infix(id, " == ");
        case Op::NotEqual: return infix(id, " != ");
        case Op::And: return infix(id, " && ");
        case Op::Or: return infix(id, " || ");
        case Op::Select: return select(id);
        case Op::ToFloat: return {"float(" + value(arg(0)) + ")", Primary};
        case Op::ToInt:
            if (graph_[arg(0)].type == Type::Float)
                return {helper("fathom_int") + "(" + value(arg(0)) + ")", Primary};
            return {"int(" + value(arg(0)) + ")", Primary};
        case Op::Splat: return splat(id);
        case Op::Make: return {std::string(glsl_type(node.type)) + "(" + list(id) + ")", Primary};
        case Op::Swizzle: {
            std::string text = at_least(expression(arg(0)), Primary) + ".";
            for (int i = 0; i < ir::swizzle_size(node.payload); ++i)
                text += "xyzw"[ir::swizzle_component(node.payload, i)];
            return {text, Primary};
        }
        case Op::Column: return part(id, fmt::format("[{}]", node.payload));
        case Op::TableRead: return table_read(id);
        case Op::Hash:
            return {helper("fathom_hash", glsl_type(graph_[arg(0)].type)) + "(" + list(id) + ")",
                    Primary};
        case Op::Image:
            return {helper("fathom_image") + "(" + module_.images.at(node.payload) + ", " +
                        list(id) + ")",
                    Primary};
        case Op::Grid:
            return {helper("fathom_grid") + "(" + module_.grids.at(node.payload) + ", " + list(id) +
                        ")",
                    Primary};
        case Op::Call: return {module_.functions.at(node.payload) + "(" + list(id) + ")", Primary};
        case Op::Cached: {
            const auto field = graph_.cache(ir::CacheId{node.payload}).field;
            const char *cached = module_.cached.contains(node.payload) ? "_cached(" : "(";
            return {module_.functions.at(field.index) + cached + list(id) + ")", Primary};
        }
        case Op::Loop: return {name_.at(id), Primary};
        case Op::LoopResult: {
            const ir::Loop &loop = graph_.loop(ir::LoopId{graph_[arg(0)].payload});
            return {name_.at(loop.vars[node.payload]), Primary};
        }
        case Op::Union:
        case Op::Intersection:
        case Op::NearestHit:
        case Op::FarthestHit:
        case Op::Blend: {
            const int first = node.op == Op::Blend ? 2 : 0;
            if (static_cast<int>(node.count) == first + 1) return expression(arg(first));
            return {joined(id, value(arg(first)), value(arg(first + 1))), Primary};
        }
        case Op::MakeHit: return {"Hit(" + list(id) + ")", Primary};
        case Op::HitDistance: return part(id, ".distance");
        case Op::HitPaint: return part(id, ".paint");
        case Op::HitPoint: return part(id, ".point");
        case Op::HitExtra: return part(id, ".extra");
        case Op::HitWith: return {helper("fathom_hit_with") + "(" + list(id) + ")", Primary};
        case Op::FillPaint: return {helper("fathom_fill_paint") + "(" + list(id) + ")", Primary};
        case Op::Abs:
            if (node.type == Type::Int) return saturating(id, "fathom_abs");
            return by_table(id);
        case Op::Mod: // by a constant it is GLSL's own
            if (node.type != Type::Int && !ir::is_matrix(node.type) && known_.is_nonzero(arg(1)))
                return {"mod(" + list(id) + ")", Primary};
            if (node.type == Type::Int && known_.plain_quotient(id))
                return {at_least(expression(arg(0)), Product) + " % " +
                            at_least(expression(arg(1)), Unary),
                        Product};
            return by_table(id);
        case Op::Smoothstep:
            if (!ir::is_matrix(node.type) && known_.below(arg(0), arg(1)))
                return {"smoothstep(" + list(id) + ")", Primary};
            return {filled_by_helper(id, "fathom_smoothstep"), Primary};
        case Op::Clamp: // GLSL's own is undefined where the limits are in the wrong order
            if (!ir::is_matrix(node.type) && known_.below(arg(1), arg(2)))
                return {"clamp(" + list(id) + ")", Primary};
            return by_table(id);
        case Op::Pow:
            if (!ir::is_matrix(node.type))
                if (Text made = power(id, known_.exponent(arg(1))); !made.text.empty()) return made;
            return by_table(id);
        case Op::Min:
        case Op::Max:
        case Op::Step:
        case Op::Atan2:
        case Op::Sign:
        case Op::Floor:
        case Op::Ceil:
        case Op::Round:
        case Op::Trunc:
        case Op::Fract:
#define FATHOM_FUNCTION(name, ...) case Op::name:
#include "ir/ops.def"
        case Op::Mix:
        case Op::Dot:
        case Op::Length:
        case Op::Cross:
        case Op::Normalize:
        case Op::Transpose:
        case Op::Perlin:
        case Op::Simplex:
        case Op::ValueNoise:
        case Op::Worley:
        case Op::SpotNoise: return by_table(id);
        }
        return {};
    }

    // One of two values that are both computed.
    Text select(NodeId id) {
        const Type type = graph_[id].type;
        const std::string condition = value(graph_.arg(id, 0)), yes = value(graph_.arg(id, 1)),
                          no = value(graph_.arg(id, 2));
        if (type != Type::Float && !ir::is_vector(type))
            return {helper("fathom_either", glsl_type(type)) + "(" + condition + ", " + yes + ", " +
                        no + ")",
                    Primary};
        const std::string by = type == Type::Float
                                   ? condition
                                   : fmt::format("bvec{}({})", ir::components(type), condition);
        return {"mix(" + no + ", " + yes + ", " + by + ")", Primary};
    }

    Text saturating(NodeId id, const char *name) {
        return {helper(name, "int") + "(" + list(id) + ")", Primary};
    }

    // x^n; where n is a whole constant by products (ir/powers.h). Empty where it is not.
    Text power(NodeId id, double n) {
        const std::string type = glsl_type(graph_[id].type), x = value(graph_.arg(id, 0));
        if (n == 0.5) return {helper("fathom_sqrt", type) + "(" + x + ")", Primary};
        std::string text = x;
        for (const int factor : ir::power_factors(std::abs(n)))
            text = helper(fmt::format("fathom_power_{}", factor), type) + "(" + text + ")";
        if (text == x && n != -1) return {};
        if (n > 0) return {text, Primary};
        return {"1.0 / " + (n == -1 ? "(" + text + ")" : text), Product};
    }

    std::string filled_by_helper(NodeId id, const std::string &name) {
        const Type type = graph_[id].type;
        if (!ir::is_matrix(type)) return helper(name, glsl_type(type)) + "(" + list(id) + ")";
        const Type column = ir::vector_type(ir::side(type));
        helper(name, glsl_type(column));
        std::string text = std::string(glsl_type(type)) + "(";
        for (int i = 0; i < ir::side(type); ++i)
            text += (i ? ", " : "") +
                    filled(id, name + "({0}, {1}, {2})", column, fmt::format("[{}]", i));
        return text + ")";
    }

    Text part(NodeId id, const std::string &which) {
        return {at_least(expression(graph_.arg(id, 0)), Primary) + which, Primary};
    }

    Text infix(NodeId id, const char *op) {
        const Level level = level_of(graph_[id].op);
        const auto tighter = static_cast<Level>(level - 1);
        return {at_least(operand(id, 0), level) + op + at_least(operand(id, 1), tighter), level};
    }

    // An operand of + - * /: GLSL lets a float stand for a vector of equal components where the
    // other is a vector.
    Text operand(NodeId id, int which) {
        const NodeId mine = graph_.arg(id, which), other = graph_.arg(id, 1 - which);
        const bool applies = graph_[id].op != Op::MatMul && ir::is_vector(graph_[mine].type) &&
                             !as_scalar(other) && !plan_.named(mine) && as_scalar(mine);
        return applies ? *as_scalar(mine) : expression(mine);
    }

    std::optional<Text> as_scalar(NodeId id) {
        if (graph_[id].op == Op::Splat && graph_[graph_.arg(id, 0)].type == Type::Float)
            return expression(graph_.arg(id, 0));
        const auto c = known_.constant(id);
        if (!c || !ir::is_vector(c->type)) return std::nullopt;
        for (int i = 1; i < ir::components(c->type); ++i)
            if (c->value[static_cast<std::size_t>(i)] != c->value[0]) return std::nullopt;
        const std::string text = literal({Type::Float, {c->value[0]}});
        return Text{text, text[0] == '-' ? Unary : Primary};
    }

    // a + -3 is written a - 3, and a + -b as a - b: the same number.
    Text sum(NodeId id) {
        const ir::Node &node = graph_[id];
        bool minus = node.op == Op::Sub;
        Text right = operand(id, 1);
        if (right.level == Unary && right.text[0] == '-') {
            minus = !minus;
            right = {right.text.substr(1), Primary};
        }
        return {at_least(operand(id, 0), Sum) + (minus ? " - " : " + ") + at_least(right, Product),
                Sum};
    }

    Text splat(NodeId id) {
        const Type type = graph_[id].type;
        const std::string scalar = value(graph_.arg(id, 0));
        if (!ir::is_matrix(type))
            return {std::string(glsl_type(type)) + "(" + scalar + ")", Primary};
        std::string text =
            std::string(glsl_type(type)) + "("; // mat3(x) would be x times the identity
        const std::string column =
            std::string(glsl_type(ir::vector_type(ir::side(type)))) + "(" + scalar + ")";
        for (int i = 0; i < ir::side(type); ++i) text += (i ? ", " : "") + column;
        return {text + ")", Primary};
    }

    // Ops that the table spells as a call. GLSL's built-in functions take no matrices: those go
    // column by column.
    Text by_table(NodeId id) {
        const ir::Node &node = graph_[id];
        const std::string_view form = ir::info(node.op).glsl;
        Type type = node.type;
        if (ir::is_matrix(type) && node.op != Op::Transpose) {
            const Type column = ir::vector_type(ir::side(type));
            std::string text = std::string(glsl_type(type)) + "(";
            for (int i = 0; i < ir::side(type); ++i)
                text += (i ? ", " : "") + filled(id, form, column, fmt::format("[{}]", i));
            return {text + ")", Primary};
        }
        if (node.op == Op::Length || node.op == Op::Dot) type = graph_[graph_.arg(id, 0)].type;
        return {filled(id, form, type, ""), Primary};
    }

    std::string filled(NodeId id, std::string_view form, Type type, const std::string &part) {
        std::string text;
        for (std::size_t i = 0; i < form.size(); ++i) {
            if (form[i] != '{') {
                text += form[i];
                continue;
            }
            const int n = form[i + 1] - '0';
            i += 2;
            // Only in `floor({0} + 0.5)` does an argument stand beside an operator.
            const bool alone = form.find(" + ") == std::string_view::npos;
            text += part.empty() ? at_least(expression(graph_.arg(id, n)), alone ? Choice : Sum)
                                 : at_least(expression(graph_.arg(id, n)), Primary) + part;
        }
        if (form.starts_with("fathom_")) {
            const std::string name(form.substr(0, form.find('(')));
            const Op op = graph_[id].op;
            const bool fixed = op == Op::Perlin || op == Op::Simplex || op == Op::ValueNoise ||
                               op == Op::Worley || op == Op::SpotNoise;
            helper(name, fixed ? "" : glsl_type(type));
        }
        return text;
    }

    Text table_read(NodeId id) {
        const ir::Node &node = graph_[id];
        const NodeId row = graph_.arg(id, 0);
        if (const auto formula = module_.computed.find(node.payload);
            formula != module_.computed.end())
            return {module_.functions.at(formula->second.index) + "(" + expression(row).text + ")",
                    Primary};
        const TableUse &use = module_.tables.at(ir::table_of(node.payload).index);
        const auto counted = plan_.rows.find(row);
        const bool inside = counted != plan_.rows.end() && counted->second <= use.rows;
        std::string at = inside ? at_least(expression(row), Product)
                                : fmt::format("clamp({}, 0, {})", value(row), use.rows - 1);
        if (use.texels > 1) at += fmt::format(" * {}", use.texels);
        const int column = ir::column_of(node.payload);
        if (ir::is_matrix(node.type)) {
            // A constructor of a matrix takes its columns alone: of vectors that lie across columns,
            // as texels do, NVIDIA's driver (580) makes other matrices, or refuses them.
            const int side = ir::side(node.type);
            std::string columns;
            for (int i = 0; i < side; ++i)
                columns += (i ? ", " : "") + numbers(use, at, column + i * side, side);
            return {std::string(glsl_type(node.type)) + "(" + columns + ")", Primary};
        }
        const std::string read = numbers(use, at, column, ir::components(node.type));
        if (node.type == Type::Bool) return {read + " != 0.0", Equality};
        if (node.type == Type::Int) return {"int(" + read + ")", Primary};
        return {read, Primary};
    }

    // `count` numbers of a row, 1 to 4, from `column` on, as a float or a vector. `row`: the place of
    // its first texel.
    static std::string numbers(const TableUse &use, const std::string &row, int column, int count) {
        std::string parts;
        int left = count;
        while (left > 0) {
            const int first = column / 4, from = column % 4, taken = std::min(left, 4 - from);
            parts += (left < count ? ", " : "") +
                     texel(use, row + (first ? fmt::format(" + {}", first) : ""));
            if (taken < 4)
                parts += "." + std::string("xyzw").substr(static_cast<std::size_t>(from),
                                                          static_cast<std::size_t>(taken));
            if (taken == count) return parts;
            column += taken;
            left -= taken;
        }
        return fmt::format("vec{}({})", count, parts);
    }

    Module &module_;
    const ir::Graph &graph_;
    Schedule plan_;
    Certain known_;
    Names names_;
    std::unordered_map<NodeId, std::string> name_;
    std::string out_;
};

} // namespace

Body body(Module &module, std::span<Bound> bound, std::span<const NodeId> roots) {
    const std::optional<ClonedLoops> apart = clone_shared_loops(module.scene.graph, roots);
    if (apart) roots = apart->roots;
    Writer writer(module, apart ? apart->graph : module.scene.graph, bound, roots);
    writer.block(0, 1);
    Body result;
    for (NodeId root : roots) result.values.push_back(writer.value(root));
    result.statements = writer.take();
    return result;
}

} // namespace fathom::glsl
