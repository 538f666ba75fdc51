// What of a domain has to be searched for a field's bound: one period of what repeats, and one side
// of a mirror.
#pragma once

#include "proof/field.h"
#include "proof/tape.h"

#include <array>

namespace fathom::proof {

// Along each axis that the domain is longer than a period, one period; says along which.
std::array<bool, 3> to_one_period(const Periods &periods, Cell &whole);

// From the one period that is searched to the domain.
void to_domain(const Periods &periods, const std::array<bool, 3> &shifted, const Cell &domain,
               FieldBound &found);

// A domain that is its own mirror image is cut down to the part where coordinates are not below 0,
// as far as the field is as steep on both sides; true where its values there are the others negated.
bool keep_half(const Tape &tape, Cell &whole, const Zone *zone);

} // namespace fathom::proof
