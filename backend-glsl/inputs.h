// The declarations of what a text is given: the frame's inputs, params, the time, data. For a host
// that sets our uniforms they are these; else they are constants, globals that the entry sets, and
// the host's own inputs.
#pragma once

#include "backend-glsl/module.h"
#include "backend-glsl/params.h"
#include "ir/view.h"

namespace fathom::glsl {

class Inputs {
  public:
    explicit Inputs(const Module &module)
        : module_(module), scene_(module.scene), options_(module.options),
          target_(traits_of(module.options.target)) {}

    std::string of_field();                   // what the scene's functions read
    std::string of_picture(const ir::View &); // and the frame's; their values are the first view's

    // Of the uniforms declared so far, for a target that lists them.
    std::string defaults() const;

    const std::vector<Input> &uniforms() const { return uniforms_; } // declared so far, in order

  private:
    std::string uniform(Input input, const std::string &value, const std::string &range = "");
    std::string sampler(const std::string &type, const std::string &name);
    std::string own_inputs(bool picture) const;
    std::string time();
    std::string params();
    std::string samplers(); // and the buffer

    const Module &module_;
    const ir::Scene &scene_;
    const Options &options_;
    const TargetTraits &target_;
    std::vector<Default> declared_; // uniforms, in order
    std::vector<Input> uniforms_;   // and samplers
    int location_ = 0, binding_ = 0;
};

// Whether a param is a constant in the text because it decides what there is. A host of ours makes
// the text anew where it moves, and keeps it where any other does.
bool is_fixed(const ir::Param &param, const Options &options);

} // namespace fathom::glsl
