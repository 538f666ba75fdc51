// What the library's handles hold, and the words of the compiler as the public headers have them.
// The public names lie in fathom::v1 here, since the compiler's own have the same ones in fathom.
#pragma once

#include "driver/compile.h"
#include "ir/view.h"

#include <fathom/fathom.h>

#include <array>
#include <exception>
#include <new>

namespace fathom::proof {
struct Explanation;
}

namespace fathom::v1 {

// What a scene was compiled from, to compile it again where a structural param is set.
struct Origin {
    bool is_file = false;
    std::filesystem::path file;
    std::string name, text;
    CompileOptions options;
};

struct Scene::Impl {
    std::shared_ptr<const Origin> origin;
    std::shared_ptr<const driver::Compilation> compilation; // good
    // The compilation's own, or a copy with other values of its params, or a part of it.
    std::shared_ptr<const ir::Scene> scene;
    std::vector<Param> params;
    Facts facts;
    std::string part; // of which it is that one alone; empty: all of it
};

struct ProofCache::Impl {
    explicit Impl(std::size_t most) : bounds(most) {}
    proof::BoundCache bounds;
};

// The texts of a compilation, or those alone.
struct Texts::Impl {
    std::shared_ptr<const driver::Compilation> compilation; // none: of no compilation
    Sources own;
    const Sources &sources() const { return compilation ? compilation->sources : own; }
};

Texts texts_of(Sources sources);

inline const ir::Scene &ir_of(const Scene &scene) { return *scene.impl().scene; }

Facts facts_of(const ir::Scene &scene, const Sources &sources);
// What a scene names, from the provider alone.
typecheck::Loader loader_of(const FileProvider &provider);
Severity severity_of(fathom::Severity severity);
Place place_of(Span span, const Sources &sources);
Diagnostic translated(const fathom::Diagnostic &diagnostic, const Sources &sources);
std::vector<Diagnostic> translated(const Diagnostics &diagnostics, const Sources &sources);
Explanation translated(proof::Explanation explanation, const Sources &sources);
Diagnostic sentence(std::string code, std::string message); // an error without a place
std::string beyond_proof(const Facts &facts);               // of a time at which they do not hold

// Where a uniform of the frame has its values on the host.
struct FrameRow {
    const char *name;
    double *values;
    std::size_t count;
};
std::array<FrameRow, 7> rows_of(ir::View &view, double &orthographic); // all that a view has

// What a call gives whose work could not be done, for lack of memory or by a fault of ours.
template <class Work, class Failed> auto guarded(Work work, Failed failed) noexcept {
    try {
        return work();
    } catch (const std::bad_alloc &) {
        return failed(sentence("memory", "there is not enough memory"));
    } catch (const std::exception &error) {
        return failed(sentence("internal", error.what()));
    }
}

} // namespace fathom::v1
