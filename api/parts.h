// The statements of a scene that are its parts, and the scene that each of them is alone.
#pragma once

#include "api/impl.h"

namespace fathom::v1 {

// A statement of the scene, and the shapes that it gave.
struct Statement {
    std::string name; // Part::name
    Span span;
    std::vector<ir::TopLevel> shapes;
};
std::vector<Statement> statements_of(const Scene &scene);

// The scene with those shapes alone, where and as they stand in the whole.
Scene scene_of(const Scene &whole, const Statement &statement);

} // namespace fathom::v1
