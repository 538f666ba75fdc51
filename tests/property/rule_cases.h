// Cases of the rules of a proof, in which what a rule says is nearly attained (rules.cpp).
#pragma once

#include "build.h"

#include <functional>
#include <string>
#include <vector>

namespace fathom::test {

struct Case {
    std::string name;
    proof::Rule rule;
    std::function<ShapeId(Scenery &)> build;
    double attained; // sampled over proved, at least
    double reach = 3;
    bool tighten = false; // the rule is how a bound is made less
    double x = 0;         // of the middle of what is sampled
};

// Of endless cells (lipschitz.md, 2.34). The fields stand still up to `from`, and are steepest not far
// beyond: there a cell that begins at 1 or 2 has to say how steep they are, as intervals have no end.
struct FarCase {
    std::string name;
    proof::Rule rule;
    double from;
    std::function<NodeId(Scenery &, NodeId)> of; // what begins at `from`

    NodeId field(Scenery &s) const {
        return of(s, s.g.make(Op::Max, {s.call(Op::Abs, s.y), s.n(from)}));
    }
};

inline std::vector<FarCase> far_cases() {
    using proof::Rule;
    const auto log = [](Scenery &s, NodeId a) { return s.call(Op::Log, a); };
    // Of q: as steep far out as near.
    const auto sine = [=](Scenery &s, NodeId q, double k) {
        return s.sin(s.g.mul(s.n(k), log(s, q)));
    };
    const auto cosine = [=](Scenery &s, NodeId q, double k) {
        return s.cos(s.g.mul(s.n(k), log(s, q)));
    };
    const auto times = [](Scenery &s, double k, NodeId q) { return s.g.mul(s.n(k), q); };
    // No cell is cut that is hardly steeper than what is seen everywhere.
    const auto steep = [=](Scenery &s, double k) { return times(s, k, s.call(Op::Abs, s.y)); };
    std::vector<FarCase> out;
    out.push_back({"a product", Rule::FarProduct, 1.02,
                   [=](Scenery &s, NodeId q) { return s.g.mul(q, sine(s, q, 3)); }});
    out.push_back({"a quotient", Rule::FarQuotient, 1.02, [=](Scenery &s, NodeId q) {
                       return s.g.div(q, s.g.add(s.n(1), times(s, 0.1, sine(s, q, 20))));
                   }});
    out.push_back({"a root", Rule::FarPower, 1.02, [=](Scenery &s, NodeId q) {
                       const NodeId waves = s.g.add(s.n(2), sine(s, q, 6));
                       return s.call(Op::Sqrt, s.g.mul(s.g.mul(q, q), waves));
                   }});
    out.push_back({"a sum", Rule::FarSum, 1.02, [=](Scenery &s, NodeId q) {
                       const NodeId less = times(s, 0.1, s.g.mul(q, sine(s, q, 1)));
                       return s.g.add(less, s.g.mul(q, sine(s, q, 3)));
                   }});
    out.push_back(
        {"the greater of a difference", Rule::FarDifference, 1.02, [=](Scenery &s, NodeId q) {
             const NodeId less = s.g.sub(s.g.mul(q, q), times(s, 0.98, q));
             return s.g.add(steep(s, 40), s.call(Op::Sqrt, less));
         }});
    out.push_back(
        {"an exponential", Rule::FarExponential, 1.02 * 0x1p23, [=](Scenery &s, NodeId q) {
             const NodeId falls = s.call(Op::Exp, times(s, -12 * 0x1p-23, q));
             return s.g.sub(steep(s, 20), times(s, 2e4, s.g.mul(q, falls)));
         }});
    out.push_back({"a logarithm", Rule::FarLogarithm, 1.02, log});
    out.push_back({"a wave", Rule::FarFunction, 1.02,
                   [=](Scenery &s, NodeId q) { return s.g.mul(q, cosine(s, q, 3)); }});
    out.push_back({"an inverse tangent", Rule::FarFunction, 2.04,
                   [](Scenery &s, NodeId q) { return s.call(Op::Atan, q); }});
    out.push_back({"a mean", Rule::FarMean, 1.02, [=](Scenery &s, NodeId q) {
                       const NodeId t = s.g.add(s.n(0.5), times(s, 0.49, sine(s, q, 3)));
                       return s.g.make(Op::Mix, {s.g.neg(q), times(s, 0.9, q), t});
                   }});
    out.push_back({"a length", Rule::FarLength, 1.02, [=](Scenery &s, NodeId q) {
                       const NodeId less = times(s, 0.01, s.g.mul(q, sine(s, q, 1)));
                       return s.length(s.g.make(Op::Make, {less, s.g.mul(q, sine(s, q, 3))}));
                   }});
    out.push_back({"the greater of two", Rule::FarChoice, 1.02, [=](Scenery &s, NodeId q) {
                       const NodeId less = times(s, -3, q);
                       return s.g.make(Op::Max, {less, s.g.mul(q, sine(s, q, 3))});
                   }});
    return out;
}

} // namespace fathom::test
