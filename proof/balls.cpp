// The balls that go up beside the boxes, so that turns within turns do not inflate: a rule a kind,
// from the balls of its children; every other kind has the ball around its box.
#include "proof/prover.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::MapKind;
using ir::Op;
using ir::Shape;
using ir::ShapeId;
using ir::ShapeKind;
using ir::rounding::infinity;
using ir::rounding::up;

namespace {

bool bounded(const Box &box) { return box.finite() && !box.empty(); }

// The ball around a box given by its sides: for the centre of a moved ball, what its place may be.
Ball around(const Vec &sides, int dims) {
    Ball ball{{}, 0, 0};
    double sum = 0;
    for (std::size_t i = 0; i < std::size_t(dims); ++i) {
        if (!sides[i].finite()) return {};
        ball.centre[i] = sides[i].middle();
        sum +=
            std::pow(up(std::max(sides[i].hi - ball.centre[i], ball.centre[i] - sides[i].lo)), 2);
    }
    ball.radius = up(std::sqrt(sum), 8);
    return ball;
}
Ball around(const Box &box, int dims) {
    if (!bounded(box)) return {};
    return around(to_cell(box).p, dims);
}
Ball grown(Ball ball, double by) {
    if (by != 0) ball.radius = up(ball.radius + by);
    if (std::isnan(ball.radius)) ball.radius = infinity;
    return ball;
}
// So much of a ball around `centre` is needed to hold the other.
double reach(const std::array<double, 3> &centre, const Ball &ball) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += std::pow(ball.centre[i] - centre[i], 2);
    return up(std::sqrt(sum) + ball.radius, 8);
}

} // namespace

Ball Prover::ball_of(ShapeId id, const Derived &k) {
    const Shape &shape = scene.shapes[id];
    switch (shape.kind) {
    case ShapeKind::Union:
    case ShapeKind::Blend: {
        // A blend that is a function of the difference is below t where a child is, and where both
        // sides of a step are below t + r: there the later child is.
        double r = 0;
        if (shape.kind == ShapeKind::Blend) {
            if (static_cast<ir::Profile>(shape.payload) == ir::Profile::Columns) return {};
            if (reads_point(shape.args[0])) return {};
            r = std::max(number(shape.args[0]).hi, 0.0);
            if (!std::isfinite(r)) return {};
        }
        Ball all = around(k.fact.bounds, shape.dims);
        if (!std::isfinite(all.radius)) return {};
        all.radius = 0;
        for (std::size_t i = 0; i < shape.children.size(); ++i) {
            const Derived &c = child(shape, i);
            if (c.fact.bounds.empty()) return {};
            Ball ball = i == 0 || r == 0 ? c.ball : grown(c.ball, up(c.ball.growth_rate * r));
            all.radius = std::max(all.radius, reach(all.centre, ball));
            all.growth_rate = std::max(all.growth_rate, c.ball.growth_rate);
        }
        return all;
    }
    case ShapeKind::Map: {
        const Ball inner = child(shape).ball;
        if (!std::isfinite(inner.radius)) return {};
        const Vec c{inner.centre[0], inner.centre[1], inner.centre[2]};
        const auto n = static_cast<std::size_t>(shape.dims);
        Vec to{};
        switch (shape.map) {
        case MapKind::Translate: {
            Vec by = vector(shape.args[2]);
            for (std::size_t i = 0; i < n; ++i) to[i] = c[i] + by[i];
            break;
        }
        case MapKind::Rotate: { // an isometry, whatever the angle
            auto matrix = numbers(shape.args[2]);
            for (std::size_t i = 0; i < n; ++i)
                for (std::size_t j = 0; j < n; ++j)
                    to[i] += meet(Interval(-1, 1), matrix[j * n + i]) * c[j];
            break;
        }
        case MapKind::Scale:
        case MapKind::MirrorFold:
        case MapKind::Revolve:
        case MapKind::Twist:
        case MapKind::Bend:
        case MapKind::Taper:
        case MapKind::Distort: return {};
        }
        Ball ball = grown(around(to, shape.dims), inner.radius);
        ball.growth_rate = inner.growth_rate;
        return ball;
    }
    case ShapeKind::Paint:
    case ShapeKind::Repaint:
    case ShapeKind::Mixed: return child(shape).ball; // colours move nothing
    case ShapeKind::Instances:                       // the child's ball holds every copy
        if (scene.shapes.instance_tables[shape.payload].smooth) return {};
        return child(shape).ball;
    case ShapeKind::Empty:
    case ShapeKind::Leaf:
    case ShapeKind::Intersection:
    case ShapeKind::Complement:
    case ShapeKind::Xor:
    case ShapeKind::Seam:
    case ShapeKind::Lerp:
    case ShapeKind::PseudoNorm:
    case ShapeKind::Offset:
    case ShapeKind::Shell:
    case ShapeKind::Displace:
    case ShapeKind::Extrude:
    case ShapeKind::Repeat:
    case ShapeKind::Within:
    case ShapeKind::Library:
    case ShapeKind::Contract: return {};
    }
    return {};
}

// {f < t} lies in the box grown and in the ball grown, so in both boxes grown by the greater; a
// meet of grown boxes is the grown meet where that is not empty. The corner of a box grown by s is
// sqrt(3)*s further out; but what is exact grows as balls do.
void Prover::keep_in_ball(ShapeId id, Derived &k) {
    const int dims = scene.shapes[id].dims;
    Ball own = around(k.fact.bounds, dims);
    own.growth_rate = k.fact.exact_outside ? 1 : up(k.growth_rate * std::sqrt(3.0), 4);
    const Ball made = ball_of(id, k);
    k.ball = made.radius < own.radius ? made : own;
    if (!std::isfinite(made.radius) || !bounded(k.fact.bounds)) return;
    if (!std::isfinite(made.growth_rate) && std::isfinite(k.growth_rate)) return;
    Vec sides{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(dims); ++i)
        sides[i] = Interval(made.centre[i]) + Interval(-made.radius, made.radius);
    const Box cut = ir::intersect(k.fact.bounds, from_cell({sides}, dims));
    if (cut.empty() || holds(cut, k.fact.bounds)) return;
    k.fact.bounds = cut;
    k.growth_rate = std::max(k.growth_rate, made.growth_rate);
}

} // namespace fathom::proof
