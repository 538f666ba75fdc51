// Which params of a scene its shapes and expressions read, through calls, loops and caches.
#pragma once

#include "ir/scene.h"

#include <set>

namespace fathom::ir {

// Collects the params of all that it is shown; the scene outlives it.
class ParamReads {
  public:
    explicit ParamReads(const Scene &scene) : scene_(scene), used_(scene.params.size(), false) {}
    bool used(std::size_t param) const { return used_[param]; } // by Scene::params
    void form(ShapeId id); // what decides a shape's form, without the materials
    void node(NodeId root);

  private:
    void region(const Region &region);
    const Scene &scene_;
    std::vector<bool> used_;
    std::set<std::uint32_t> shapes_, nodes_;
};

} // namespace fathom::ir
