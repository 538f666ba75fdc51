// A field's bound as a formula of the params that it reads: what is drawn has one value of each, and
// should not pay for the steepest that its range allows.
#pragma once

#include "proof/field.h"

namespace fathom::proof {

// A node that reads params alone and is, for all their values, at least the field's Lipschitz
// constant over `domain`, and the most that it is; no node where `whole`, the bound for all values
// together, is little more than the bound for the present ones. Params without a range stay as they
// are; at most a few are told apart, each with the others over all of their ranges (lipschitz.md,
// 2.11).
struct ParamBound {
    ir::NodeId formula;
    double most = ir::rounding::infinity;
};
ParamBound bound_by_params(Flattening &context, const Ranges &ranges, ir::NodeId field,
                           const Domain &domain, const Budget &budget, double whole);

} // namespace fathom::proof
