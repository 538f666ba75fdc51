// What each node type is written as in the language. Private to the importer.
#pragma once

#include "save-format/import/importer.h"

namespace fathom::save {

// A shape, painted; empty where it cannot be written (reported).
std::string leaf_text(Importer &in, const NodeTypeRow &row, Properties &properties, Span at);

// `.translate(…)`: the call that a transform appends; empty where the transform changes nothing.
std::string transform_call(Importer &in, const NodeTypeRow &row, Properties &properties, Span at);

// Turns the pieces of two or more operands, from `begin` on (a held piece stands there), into the
// operator's expression. The first operand ends before `first_end`; a held piece at `rest_mark`
// stands before the others, of which there are `rest`.
void operator_text(Importer &in, const NodeTypeRow &row, Properties &properties, Body &body,
                   std::size_t begin, std::size_t first_end, std::size_t rest_mark,
                   std::size_t rest, Span at);

// Of a group whose looks depend on the point: `.paint(material(…))`, else empty.
std::string paint_call(Importer &in, const NodeTypeRow &row, Properties &properties, Span at);

std::string property_flow(const PropertyType &type, const Property &property);

} // namespace fathom::save
