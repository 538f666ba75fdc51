// What the calls that make meshes, measures, slices and volumes share.
#pragma once

#include "api/impl.h"
#include "mesh/mesh.h"
#include "mesh/write.h"

namespace fathom::v1 {

// Why a call cannot do what it is asked; none where it can.
struct Refusal {
    MeshStatus status = MeshStatus::Done;
    std::string message;
    explicit operator bool() const { return status != MeshStatus::Done; }
};

Refusal refusal_of(const Scene &scene, const MeshOptions &options);
// Of what the mesher says; `place` as Made has it.
Refusal refusal_of(fathom::mesh::Failure failure, const fathom::mesh::Point &place = {});
// The same of a mesh that was not made, in numbers of the solid where there are some.
Refusal refusal_of(const fathom::mesh::Made &made, const fathom::mesh::Settings &settings);
// `share`: of the whole work's progress.
fathom::mesh::Settings settings_of(const MeshOptions &options, double share = 1);
fathom::mesh::Unit inner(MeshUnit unit);
std::vector<std::string> rests_on(bool used_bound);

} // namespace fathom::v1
