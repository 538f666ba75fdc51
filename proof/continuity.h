// Expressions as polynomials in what they are made of: do the two arms of a choice agree where the
// choice turns, does a fold keep lengths? Decided on the expressions, never by sampling.
#pragma once

#include "ir/graph.h"
#include "proof/work.h"

#include <optional>
#include <span>
#include <vector>

namespace fathom::proof {

class Expansion; // polynomials.h: what many sums are asked of

// True where `condition ? a : b` is proved continuous across the condition's border, given that a
// and b are. Takes its steps off `work`; without any left nothing is proved.
bool arms_agree(ir::Graph &graph, ir::NodeId condition, ir::NodeId a, ir::NodeId b, Work &work);

// True where two expressions of the point, each continuous, are proved equal wherever u and v are.
bool agree_where_equal(ir::Graph &graph, ir::NodeId u, ir::NodeId v, ir::NodeId a, ir::NodeId b,
                       Work &work);

// One component of a vector, written with scalars as far as that goes.
ir::NodeId component_of(ir::Graph &graph, ir::NodeId vector, int i);
// One entry of a matrix that is a constant, or made of scalars or of columns; else nothing.
std::optional<ir::NodeId> entry_of(ir::Graph &graph, ir::NodeId matrix, int row, int column);
// The same number as a sum of products: equal sums become one node.
ir::NodeId in_one_form(ir::Graph &graph, ir::NodeId scalar, Work *work = nullptr);
// … without what is no more than rounding beside its other terms: for comparing.
ir::NodeId without_rounding(ir::Graph &graph, ir::NodeId scalar, Work *work = nullptr);
// … with numbers of 44 bits: for comparing roots and sizes of sums that differ by rounding alone.
ir::NodeId with_round_numbers(ir::Graph &graph, ir::NodeId scalar);
// The same angle in one form, with whole turns left out: of a + 3 pi, a + pi; of 2 pi n with n
// whole, 0. Numbers are rounded to 2^-32 on the way, so this is for comparing.
ir::NodeId without_iterations(ir::Graph &graph, ir::NodeId angle);
// What a scalar is at most, where it is a number but for sines and cosines with factors that are
// no more than rounding.
std::optional<double> number_of(ir::Graph &graph, ir::NodeId scalar);
// |q| = |p| for all p, as of reflections: proved as polynomials.
bool keeps_length(ir::Graph &graph, ir::NodeId q);

// Are both the same number (or vector) in exact arithmetic, as polynomials in whatever they are
// made of?
bool same(ir::Graph &graph, ir::NodeId a, ir::NodeId b, Work *work = nullptr);

// A coordinate (a component of a vector that is not made of scalars) in which `scalar` is linear,
// and what it is where `scalar` has the value `is`: of 2 x + y, x is (is - y) / 2.
struct Solved {
    ir::NodeId vector;
    int component = 0;
    ir::NodeId value;
};
std::optional<Solved> solved(ir::Graph &graph, ir::NodeId scalar, ir::NodeId is);

// What a scalar is, where it is a sum of these atoms, each with a number for factor, and a number,
// which comes last.
std::optional<std::vector<double>> combination(Expansion &forms, ir::NodeId scalar,
                                               std::span<const ir::NodeId> atoms);

// by and rest of by*atom + rest, where `atom` stands nowhere else but inside other functions.
struct Linear {
    double by = 0;
    ir::NodeId rest;
};
std::optional<Linear> linear_in(ir::Graph &graph, ir::NodeId scalar, ir::NodeId atom);

// A scalar as a sum of products: each a number times its factors, which are sorted, and repeat. An
// atom's size |a| stands for itself but in its square. Nothing where it is too large.
struct Term {
    double by = 0;
    std::vector<ir::NodeId> factors;
};
std::optional<std::vector<Term>> terms_of(ir::Graph &graph, ir::NodeId scalar);
std::optional<std::vector<Term>> terms_of(Expansion &forms, ir::NodeId scalar);

// Are two scalars the same (same(), above), with each mix(a, b, t) as a + t (b - a)?
bool same_with_mixes_as_sums(ir::Graph &graph, ir::NodeId a, ir::NodeId b, Work *work = nullptr);

// a - b as a sum in which equal terms have cancelled; nothing where the expressions are too large.
std::optional<ir::NodeId> difference(ir::Graph &graph, ir::NodeId a, ir::NodeId b);

} // namespace fathom::proof
