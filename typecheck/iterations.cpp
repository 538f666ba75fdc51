// Shapes that a loop made, and how they follow from its variable. After a loop in shape position
// has run, its body runs once more, quietly, with a variable in place of the number: if that gives
// shapes too, each shape of iteration i is what these become at i. Whoever gathers the shapes into
// a table (instances.cpp) may then compute a column instead of listing it. Says nothing of numbers:
// what is noted here is checked row by row before it is used (closed_forms.cpp).
#include "typecheck/conditions.h"
#include "typecheck/instances.h"
#include "typecheck/interpreter.h"

#include <cmath>
#include <utility>

namespace fathom::typecheck {

using ir::ShapeId;
using ir::ShapeKind;

namespace {

void note(Interpreter &ev, ShapeId known, ShapeId symbolic, std::uint32_t variable,
          int iteration_number) {
    if (known == symbolic) return;
    Iteration iteration;
    iteration.symbolic = symbolic;
    // a loop inside has run with the outer variable free: its own note says more
    if (auto inner = ev.iterations.find(symbolic.index); inner != ev.iterations.end())
        iteration = inner->second;
    iteration.at.emplace_back(variable, iteration_number);
    // the parts of a union come to stand in a list one by one
    const ir::Shape &a = ev.scene.shapes[known], &b = ev.scene.shapes[symbolic];
    if (a.kind == ShapeKind::Union && b.kind == ShapeKind::Union &&
        a.children.size() == b.children.size())
        for (std::size_t k = 0; k < a.children.size(); ++k)
            note(ev, a.children[k], b.children[k], variable, iteration_number);
    ev.iterations[known.index] = std::move(iteration);
}

// The loop's variable as an expression of the iteration's number, where it runs in equal steps.
std::optional<Value> item_of(Interpreter &ev, const std::vector<Value> &items, ir::NodeId number) {
    const Value &first = items[0];
    if (first.kind != ValueKind::Int && first.kind != ValueKind::Float) return std::nullopt;
    const double start = first.num[0], step = items[1].num[0] - start;
    for (std::size_t i = 0; i < items.size(); ++i)
        if (items[i].kind != first.kind ||
            std::abs(items[i].num[0] - (start + step * static_cast<double>(i))) >
                1e-12 * (std::abs(start) + std::abs(items[i].num[0])))
            return std::nullopt;
    ir::Graph &g = ev.scene.graph;
    if (first.kind == ValueKind::Int)
        return from_node(ev, g.add({g.mul(number, g.integer(static_cast<int>(step))),
                                    g.integer(static_cast<int>(start))}));
    const ir::NodeId n = g.make(ir::Op::ToFloat, ir::Type::Float, {number});
    return from_node(ev, g.add({g.mul(n, g.number(step)), g.number(start)}));
}

} // namespace

void note_iterations(
    Interpreter &ev, const std::vector<Value> &items, const std::vector<std::size_t> &starts,
    const std::vector<Contribution> &made,
    const std::function<void(const Value &item, std::vector<Contribution> &out)> &iteration) {
    if (starts.size() < 2) return;
    const std::size_t each = starts[1] - starts[0], total = made.size() - starts[0];
    if (each == 0 || each * starts.size() != total) return;
    if (total < min_computed && ev.symbolic_iterations == 0) return;
    for (std::size_t i = 0; i < starts.size(); ++i)
        if (starts[i] != starts[0] + i * each) return;
    const LoopVariable variable{ev.scene.graph.fresh_var(ir::Type::Int),
                                static_cast<int>(starts.size())};
    const std::optional<Value> item = item_of(ev, items, variable.node);
    if (!item) return;

    JournalMark mark = journal_mark(ev);
    const std::size_t demanded = ev.scene.conditions.size();
    ++ev.quiet, ++ev.symbolic_iterations;
    std::size_t errors = std::exchange(ev.quiet_errors, 0);
    std::vector<Contribution> symbolic;
    iteration(*item, symbolic);
    const bool failed = ev.quiet_errors > 0 || symbolic.size() != each;
    ev.quiet_errors = errors;
    --ev.quiet, --ev.symbolic_iterations;
    journal_take(ev, mark);
    take_conditions(ev, demanded); // each iteration has put its own
    if (failed) return;

    ev.loop_variables.push_back(variable);
    for (std::size_t i = 0; i < starts.size(); ++i)
        for (std::size_t k = 0; k < each; ++k) {
            const Value &known = made[starts[i] + k].value, &free = symbolic[k].value;
            if (is(known, ValueKind::Shape) && is(free, ValueKind::Shape))
                note(ev, shape_of(known), shape_of(free),
                     static_cast<std::uint32_t>(ev.loop_variables.size() - 1), static_cast<int>(i));
        }
}

} // namespace fathom::typecheck
