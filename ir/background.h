// The background of a scene that gives none: a quiet sky, from a warm horizon to a soft blue,
// linear.
#pragma once

#include "ir/graph.h"

namespace fathom::ir {

// The expression of a direction that gives the sky its colour.
inline NodeId usual_background(Graph &graph) {
    const NodeId direction = graph.make(Op::Direction, Type::Vec3, std::initializer_list<NodeId>{});
    const NodeId up = graph.make(
        Op::Smoothstep, {graph.number(-0.3), graph.number(0.8), graph.component(direction, 1)});
    return graph.make(Op::Mix, {graph.vec3(0.63, 0.66, 0.68), graph.vec3(0.21, 0.34, 0.53),
                                graph.splat(up, Type::Vec3)});
}

} // namespace fathom::ir
