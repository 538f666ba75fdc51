// Expressions to values.
#include "base/srgb.h"
#include "ir/maps.h"
#include "typecheck/instances.h"
#include "typecheck/interpreter.h"
#include "typecheck/places.h"
#include "typecheck/remedies.h"

#include <fmt/format.h>

#include <cmath>

namespace fathom::typecheck {

using ir::Type;

static Value eval_name(Interpreter &ev, const File &ast, const lang::Name &name, Span place,
                       std::uint32_t frame) {
    if (auto v = look_up(ev, frame, symbol_of(ast, name))) return *v;
    report_unknown_name(ev, frame, name.text, place, {Use::Value, nullptr, &ast});
    return poison();
}

static Value eval_list(Interpreter &ev, const File &ast, const lang::List &list, Span place,
                       std::uint32_t frame) {
    std::vector<Value> items;
    items.reserve(list.items.size());
    bool numbers = list.items.size() >= 2 && list.items.size() <= 4, wrong = false;
    for (lang::ExprId id : list.items) {
        if (!spend(ev, ast.exprs[id].span)) return poison();
        items.push_back(eval(ev, ast, id, frame));
        wrong = wrong || is_poison(items.back());
        numbers = numbers && is_scalar(ev, items.back());
    }
    if (wrong && items.size() <= 4) return poison();
    // `inf` may stand beside what is computed: the limits of a box, or of `clamp`
    if (numbers) return make_vector(ev, items, static_cast<int>(items.size()), place);
    return list_value(ev, std::move(items));
}

static Value eval_range(Interpreter &ev, const File &ast, const lang::Range &range,
                        std::uint32_t frame) {
    const Value first = eval(ev, ast, range.first, frame);
    const Span from = ast.exprs[range.first].span, to = ast.exprs[range.last].span;
    if (first.kind == ValueKind::Shape) return report_two_dots(ev, from, to);
    const Value last = eval(ev, ast, range.last, frame);
    if (is_poison(first) || is_poison(last)) return poison();
    auto a = want_known_int(ev, first, from, "a range's first number");
    auto b = want_known_int(ev, last, to, "a range's last number");
    if (!a || !b) return poison();
    Value v = make_value(ValueKind::Range);
    v.num = {double(*a), double(*b) + (range.inclusive ? 1 : 0), 1, 0};
    return v;
}

static bool is_shape_op(const Value &v) { return v.kind == ValueKind::Shape; }

static Value shape_complement(Interpreter &ev, const Value &v, Span place) {
    ir::Shape s;
    s.kind = ir::ShapeKind::Complement;
    s.dims = v.size;
    s.children = {shape_of(v)};
    s.origin = place;
    return shape_value(ev.scene.shapes.add(std::move(s)), v.size);
}

static Value combine(Interpreter &ev, ir::ShapeKind kind, const std::vector<Value> &values,
                     const std::vector<Span> &places, Span place) {
    int dims = 0;
    std::vector<ir::ShapeId> children;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (is_poison(values[i])) continue;
        if (values[i].kind != ValueKind::Shape) {
            const char *op = kind == ir::ShapeKind::Union ? "|" : "&";
            Diagnostic &d = report(
                ev, Code::TypeMismatch, places[i],
                fmt::format("`{}` combines shapes, this is {}", op, describe(ev, values[i])));
            help_with_operand(ev, d, values[i], kind == ir::ShapeKind::Union, places[i]);
            return poison();
        }
        if (dims != 0 && values[i].size != dims) {
            report(ev, Code::FlatShape, places[i],
                   dims == 2 ? "a solid is combined with a flat shape"
                             : "a flat shape is combined with a solid")
                .help("make the flat one solid with `.extrude(height)` or `.revolve()`");
            return poison();
        }
        auto shape = want_shape(ev, values[i], places[i], "this combination", dims);
        if (!shape) return poison();
        if (ev.scene.shapes[*shape].kind != ir::ShapeKind::Empty) dims = values[i].size;
        children.push_back(*shape);
    }
    if (children.empty()) return poison();
    if (dims == 0) dims = 3;
    if (kind == ir::ShapeKind::Union)
        return shape_value(unite(ev, std::move(children), dims, place), dims);
    for (ir::ShapeId c : children) // the part common with nothing is nothing
        if (ev.scene.shapes[c].kind == ir::ShapeKind::Empty) return shape_value(c, dims);
    if (children.size() == 1) return shape_value(children[0], dims);
    ir::Shape s;
    s.kind = kind;
    s.dims = static_cast<std::uint8_t>(dims);
    s.children = std::move(children);
    s.origin = place;
    return shape_value(ev.scene.shapes.add(std::move(s)), dims);
}

// `sphere(1) && box(1)`: the text was read as conditions, with what there is to say of `&&`.
static void report_joined_shapes(Interpreter &ev, const lang::Binary &b) {
    const bool is_and = b.op() == lang::BinaryOp::And;
    std::vector<Edit> edits;
    for (std::size_t i = 1; i < b.operands.size(); ++i) {
        const Span op = b.operands[i].op_span;
        if (ev.quiet == 0) ev.diagnostics.withdraw(Code::ForeignSyntax, op);
        edits.push_back({op, is_and ? "&" : "|"});
    }
    report(ev, Code::TypeMismatch, b.operands[1].op_span,
           is_and ? "what shapes have in common is written with `&`" : "shapes are united with `|`")
        .help(is_and ? "write `&`" : "write `|`", std::move(edits));
}

static Value eval_logic(Interpreter &ev, const File &ast, const lang::Binary &b,
                        std::uint32_t frame) {
    bool is_and = b.op() == lang::BinaryOp::And;
    Value total = boolean(is_and);
    for (const auto &[id, op, op_span] : b.operands) {
        Value v = eval(ev, ast, id, frame);
        if (is_poison(v)) return v;
        if (v.kind == ValueKind::Shape) {
            report_joined_shapes(ev, b);
            return poison();
        }
        if (!is_numeric(v) || numeric_type(ev, v) != Type::Bool) {
            report(ev, Code::TypeMismatch, ast.exprs[id].span,
                   fmt::format("`{}` joins conditions, this is {}", is_and ? "and" : "or",
                               describe(ev, v)));
            return poison();
        }
        total = is_and ? logical_and(ev, total, v) : logical_or(ev, total, v);
        if (total.kind == ValueKind::Bool && (total.num[0] != 0) != is_and)
            return total; // decided: the rest is not evaluated
    }
    return total;
}

// How many regions it is made of: each is kept whole.
static std::size_t parts_of(const ir::Region &region) {
    std::size_t parts = 1;
    for (const ir::Region &less : region.less) parts += parts_of(less);
    return parts;
}

static Value eval_binary(Interpreter &ev, const File &ast, const lang::Binary &b, Span place,
                         std::uint32_t frame) {
    using lang::BinaryOp;
    if (b.op() == BinaryOp::And || b.op() == BinaryOp::Or) return eval_logic(ev, ast, b, frame);
    if (b.op() == BinaryOp::Union || b.op() == BinaryOp::Intersection) {
        std::vector<Value> values;
        std::vector<Span> places;
        for (const auto &[id, op, op_span] : b.operands) {
            values.push_back(eval(ev, ast, id, frame));
            places.push_back(ast.exprs[id].span);
        }
        return combine(
            ev, b.op() == BinaryOp::Union ? ir::ShapeKind::Union : ir::ShapeKind::Intersection,
            values, places, place);
    }
    Value total = eval(ev, ast, b.operands[0].value, frame);
    Span total_place = ast.exprs[b.operands[0].value].span;
    std::vector<Value>
        kept; // of `a - b - c` what is common to all: a, and the space around b and c
    std::vector<Span> kept_places;
    const auto cut = [&] {
        if (!kept.empty())
            total = combine(ev, ir::ShapeKind::Intersection, std::exchange(kept, {}),
                            std::exchange(kept_places, {}), total_place);
    };
    for (std::size_t i = 1; i < b.operands.size(); ++i) {
        const auto &[id, op, op_span] = b.operands[i];
        Span right_place = ast.exprs[id].span;
        Value right = eval(ev, ast, id, frame);
        Span whole = join(total_place, right_place);
        if (op != BinaryOp::Sub || !is_shape_op(right)) cut();
        if (op == BinaryOp::Sub && (is_shape_op(total) || is_shape_op(right))) {
            if (is_poison(total) || is_poison(right))
                total = is_poison(right) ? total : poison();
            else if (!is_shape_op(total) || !is_shape_op(right)) {
                const Value &wrong = is_shape_op(total) ? right : total;
                Diagnostic &d =
                    report(ev, Code::TypeMismatch, is_shape_op(total) ? right_place : total_place,
                           fmt::format("`-` cuts a shape out of a shape, this is {}",
                                       describe(ev, wrong)));
                help_with_cut(d, wrong);
                total = poison();
            } else if (ev.scene.shapes[shape_of(right)].kind != ir::ShapeKind::Empty) {
                if (kept.empty()) kept = {total}, kept_places = {total_place};
                kept.push_back(shape_complement(ev, right, right_place));
                kept_places.push_back(right_place);
            }
        } else if (op == BinaryOp::Sub && total.kind == ValueKind::Region &&
                   right.kind == ValueKind::Region) {
            const std::size_t size =
                parts_of(ev.regions[total.id]) + parts_of(ev.regions[right.id]);
            if (!spend(ev, whole, size) || !has_room(ev, whole, size * sizeof(ir::Region)))
                return poison();
            ir::Region region = ev.regions[total.id];
            region.less.push_back(ev.regions[right.id]);
            ev.made += size * sizeof(ir::Region);
            total = region_value(ev, std::move(region), std::min(total.size, right.size));
        } else {
            total = arithmetic(ev, op, total, right, whole, total_place, right_place);
        }
        total_place = whole;
    }
    cut();
    return total;
}

static Value eval_index(Interpreter &ev, const File &ast, const lang::Index &node, Span place,
                        std::uint32_t frame) {
    Value object = eval(ev, ast, node.object, frame), index = eval(ev, ast, node.index, frame);
    if (is_poison(object) || is_poison(index)) return poison();
    Span index_place = ast.exprs[node.index].span;
    ir::Graph &g = ev.scene.graph;
    bool field_index = index.kind == ValueKind::Field && numeric_type(ev, index) == Type::Int &&
                       (ev.in_field > 0 || g.reads(node_of(index)).free_vars);
    std::vector<Value> items;
    bool is_matrix = is_numeric(object) && ir::is_matrix(numeric_type(ev, object));
    if (is_matrix) {
        for (int i = 0; i < ir::side(numeric_type(ev, object)); ++i)
            items.push_back(from_node(
                ev, g.make(ir::Op::Column, ir::vector_type(ir::side(numeric_type(ev, object))),
                           {to_node(ev, object)}, static_cast<std::uint32_t>(i))));
    } else if (object.kind == ValueKind::Shape || object.kind == ValueKind::Closure ||
               is_scalar(ev, object) || object.kind == ValueKind::String) {
        report(ev, Code::TypeMismatch, ast.exprs[node.object].span,
               fmt::format("only lists, vectors and matrices have elements, this is {}",
                           describe(ev, object)))
            .help(object.kind == ValueKind::Closure
                      ? "a call's arguments stand in parentheses: `f(x)`"
                      : "a list is made by brackets: `[a, b]`");
        return poison();
    }
    if (!field_index) {
        auto i = want_known_int(ev, index, index_place, "an index");
        if (!i) return poison();
        int size = 0;
        if (object.kind == ValueKind::Range)
            size = static_cast<int>(
                std::max(0.0, std::ceil((object.num[1] - object.num[0]) / object.num[2])));
        else if (object.kind == ValueKind::List)
            size = static_cast<int>(ev.lists[object.id].size());
        else if (is_matrix)
            size = static_cast<int>(items.size());
        else {
            auto all = want_list(ev, object, ast.exprs[node.object].span, "an index");
            if (!all) return poison();
            items = std::move(*all);
            size = static_cast<int>(items.size());
        }
        if (*i < 0 || *i >= size) {
            Diagnostic &d = report(
                ev, Code::BadIndex, index_place,
                size == 0 ? fmt::format("index {} of an empty list", *i)
                          : fmt::format("index {} of a list of {}: the first is 0, the last {}", *i,
                                        size, size - 1));
            const Span list = ast.exprs[node.object].span;
            if (*i < 0 && -*i <= size && list.end - list.begin < 40)
                d.help(
                    fmt::format("from the end it is `len({}) - {}`", text(ev.sources, list), -*i),
                    {{index_place, fmt::format("len({}) - {}", text(ev.sources, list), -*i)}});
            return poison();
        }
        if (object.kind == ValueKind::Range) return integer(object.num[0] + *i * object.num[2]);
        return object.kind == ValueKind::List ? ev.lists[object.id][static_cast<std::size_t>(*i)]
                                              : items[static_cast<std::size_t>(*i)];
    }
    // an index that is known only at field time reads a table, or selects among few
    if (items.empty()) {
        auto all = want_list(ev, object, ast.exprs[node.object].span, "an index");
        if (!all) return poison();
        items = std::move(*all);
    }
    if (items.empty()) {
        report(ev, Code::BadIndex, index_place, "an index of an empty list");
        return poison();
    }
    Type type = Type::Int;
    bool known = true;
    for (Value &item : items) {
        if (item.kind == ValueKind::List) { // a list of numbers in a list of vectors
            std::vector<Value> inner = ev.lists[item.id];
            if (inner.size() >= 2 && inner.size() <= 4)
                item = make_vector(ev, inner, static_cast<int>(inner.size()), place);
        }
        if (!is_numeric(item) || ir::is_matrix(numeric_type(ev, item))) {
            report(ev, Code::StageMismatch, index_place,
                   fmt::format("an index that depends on the point reads numbers or vectors, this "
                               "list holds {}",
                               describe(ev, item)));
            return poison();
        }
        Type t = numeric_type(ev, item);
        if (type == Type::Int) type = t;
        known = known && item.kind != ValueKind::Field;
        if (t != type && !(t == Type::Int && type == Type::Float)) {
            report(ev, Code::StageMismatch, index_place,
                   "an index that depends on the point reads a list of one type");
            return poison();
        }
    }
    bool whole = type == Type::Int;
    if (known) {
        ir::Table table;
        table.rows = static_cast<int>(items.size());
        table.stride = ir::components(type);
        for (const Value &item : items)
            for (int c = 0; c < table.stride; ++c)
                table.data.push_back(static_cast<float>(item.num[static_cast<std::size_t>(c)]));
        ir::TableId id = g.add_table(std::move(table));
        ir::NodeId read = g.make(ir::Op::TableRead, whole ? Type::Float : type, {node_of(index)},
                                 ir::table_slot(id, 0));
        note_place(ev, from_node(ev, read), index_place);
        if (whole) read = g.make(ir::Op::ToInt, Type::Int, {read});
        return from_node(ev, read, !items.empty() && items[0].color);
    }
    Value out = items.back();
    for (std::size_t i = items.size() - 1; i-- > 0;) {
        Value hit = from_node(
            ev, g.make(ir::Op::LessEqual, {node_of(index), g.integer(static_cast<int>(i))}));
        auto selected = select_value(ev, hit, items[i], out);
        if (!selected) return poison();
        out = *selected;
    }
    return out;
}

static Value eval_member(Interpreter &ev, const File &ast, const lang::Member &m, Span place,
                         std::uint32_t frame) {
    Value object = eval(ev, ast, m.object, frame);
    if (is_poison(object)) return object;
    if (object.kind == ValueKind::Module) {
        const Module &module = ev.modules[object.id];
        if (m.name.text[0] == '_') {
            report(ev, Code::UnknownName, m.name.span,
                   fmt::format("`{}` is private to `{}`: its name begins with `_`", m.name.text,
                               module.name));
            return poison();
        }
        const Frame &f = ev.frames[module.frame];
        if (auto slot = slot_in_module(ev, module.frame, symbol_of(ast, m.name)))
            return f.bindings[*slot].value;
        report(ev, Code::UnknownMember, m.name.span,
               fmt::format("`{}` declares no `{}`", module.name, m.name.text));
        return poison();
    }
    if (object.kind == ValueKind::List && ev.lists[object.id].size() <= 4) {
        std::vector<Value> items = ev.lists[object.id];
        if (items.size() <= 4 && items.size() >= 2 && is_scalar(ev, items[0]))
            object = make_vector(ev, items, int(items.size()), place);
    }
    if (is_numeric(object) && ir::is_vector(numeric_type(ev, object)) &&
        swizzle_indices(m.name.text, ir::components(numeric_type(ev, object))))
        return swizzle(ev, object, m.name.text, m.name.span);
    if (auto f = look_up(ev, frame, symbol_of(ast, m.name)); f && is_function(*f)) {
        Argument self;
        self.value = object;
        self.span = ast.exprs[m.object].span;
        return call_value(ev, *f, m.name.text, {&self, 1}, place, m.name.span);
    }
    if (is_numeric(object)) return swizzle(ev, object, m.name.text, m.name.span);
    report_unknown_member(ev, object, ast, m, place);
    return poison();
}

Value make_closure(Interpreter &ev, const File &ast, lang::FunctionId function,
                   std::uint32_t frame) {
    Closure c;
    c.ast = &ast;
    c.function = function;
    c.frame = frame;
    c.module = ev.current_module;
    c.in_field = ev.in_field > 0;
    c.library = ev.modules[ev.current_module].library;
    for (std::uint32_t f = frame;; f = ev.frames[f].parent) {
        if (ev.frames[f].captured) break;
        ev.frames[f].captured = true;
        if (ev.frames[f].parent == f) break;
    }
    ev.closures.push_back(c);
    return make_value(ValueKind::Closure, static_cast<std::uint32_t>(ev.closures.size() - 1));
}

static Value eval_unary(Interpreter &ev, const File &ast, const lang::Unary &u, Span place,
                        std::uint32_t frame) {
    Value v = eval(ev, ast, u.operand, frame);
    if (is_poison(v)) return v;
    if (u.op == lang::UnaryOp::Not && v.kind == ValueKind::Shape) {
        const Span sign{place.source, place.begin, ast.exprs[u.operand].span.begin};
        if (ev.quiet == 0)
            ev.diagnostics.withdraw(Code::ForeignSyntax,
                                    {place.source, place.begin, place.begin + 1});
        report(ev, Code::TypeMismatch, place, "a shape is no condition")
            .help("the space around a shape is `complement(s)`",
                  {{sign, "complement("}, {{place.source, place.end, place.end}, ")"}});
        return poison();
    }
    if (u.op == lang::UnaryOp::Not) {
        if (!is_numeric(v) || numeric_type(ev, v) != Type::Bool) {
            report(ev, Code::TypeMismatch, ast.exprs[u.operand].span,
                   fmt::format("`not` wants a condition, this is {}", describe(ev, v)));
            return poison();
        }
        return logical_not(ev, v);
    }
    if (v.kind == ValueKind::Shape) {
        report_negated_shape(ev, place, ast.exprs[u.operand].span);
        return poison();
    }
    return negate(ev, v, place);
}

static Value eval_kind(Interpreter &ev, const File &ast, lang::ExprId id, std::uint32_t frame) {
    const lang::Expr &e = ast.exprs[id];
    struct Visit {
        Interpreter &ev;
        const File &ast;
        lang::ExprId id;
        std::uint32_t frame;
        Span span;
        Value operator()(const lang::Poison &) { return poison(); }
        Value operator()(const lang::Number &n) {
            if (n.is_int && std::abs(n.value) > 2147483647.0) {
                report(ev, Code::NumberRange, span,
                       fmt::format("{:.0f} does not fit a whole number of 32 bits", n.value))
                    .help("write it with a decimal point");
                return poison();
            }
            return n.is_int && n.unit.empty() ? integer(n.value) : number(n.value);
        }
        Value operator()(const lang::String &s) { return string_value(ev, std::string(s.value)); }
        Value operator()(const lang::Bool &b) { return boolean(b.value); }
        Value operator()(const lang::Color &c) {
            if (c.rgba[3] != 1)
                report(ev, Code::AlphaIgnored, span, "nothing is drawn half transparent")
                    .help("leave the last two digits away",
                          {{{span.source, span.end - 2, span.end}, ""}});
            return color(linear_of_srgb(c.rgba[0]), linear_of_srgb(c.rgba[1]),
                         linear_of_srgb(c.rgba[2]));
        }
        Value operator()(const lang::Name &n) { return eval_name(ev, ast, n, span, frame); }
        Value operator()(const lang::List &l) { return eval_list(ev, ast, l, span, frame); }
        Value operator()(const lang::Comprehension &c) {
            std::vector<Contribution> items;
            std::uint32_t inner = push_frame(ev, frame);
            contribute_block(ev, ast, c.body, inner, items);
            pop_frame(ev, inner);
            std::vector<Value> values;
            if (!has_room(ev, span, items.size() * sizeof(Value))) return poison();
            for (const Contribution &item : items) values.push_back(item.value);
            return list_value(ev, std::move(values));
        }
        Value operator()(const lang::Range &r) { return eval_range(ev, ast, r, frame); }
        Value operator()(const lang::Unary &u) { return eval_unary(ev, ast, u, span, frame); }
        Value operator()(const lang::Binary &b) { return eval_binary(ev, ast, b, span, frame); }
        Value operator()(const lang::Call &c) { return eval_call(ev, ast, id, c, frame); }
        Value operator()(const lang::Index &i) { return eval_index(ev, ast, i, span, frame); }
        Value operator()(const lang::Member &m) { return eval_member(ev, ast, m, span, frame); }
        Value operator()(const lang::Lambda &l) { return make_closure(ev, ast, l.function, frame); }
        Value operator()(const lang::If &i) { return value_of_if(ev, ast, i, span, frame); }
        Value operator()(const lang::BlockExpr &b) {
            return run_block(ev, ast, b.block, frame).value;
        }
    };
    return std::visit(Visit{ev, ast, id, frame, e.span}, e.kind);
}

Value eval(Interpreter &ev, const File &ast, lang::ExprId id, std::uint32_t frame) {
    if (!spend(ev, ast.exprs[id].span)) return poison();
    const char here =
        0; // the stack grows downwards, and its end is that of the system that runs us
    if (ev.depth >= max_depth || &here < ev.stack_end) {
        report(ev, Code::RecursionLimit, ast.exprs[id].span, "this nests too deep to be evaluated");
        return poison();
    }
    ++ev.depth;
    Value v = eval_kind(ev, ast, id, frame);
    --ev.depth;
    return v;
}

} // namespace fathom::typecheck
