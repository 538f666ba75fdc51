// The targets as a table: targets.def has a row for each, and what a target decides is a column of
// it. Code reads the row and names no target.
#pragma once

#include <span>

namespace fathom::glsl {

enum class Target {
#define FATHOM_TARGET(id, ...) id,
#include "backend-glsl/targets.def"
#undef FATHOM_TARGET
};

// What is handed out: the text, its words as SPIR-V, or a page around the text.
enum class Form { Text, SpirV, Page };

// A row. Names of templates are those of files in templates/, without their ends; empty: none.
struct TargetTraits {
    const char *name = ""; // on the command line
    const char *use = "";  // the head's comment: what to do with the text of a picture
    const char *suffix = ".frag";
    Form form = Form::Text;
    const char *field_by = "";   // of a page: the target that a field alone is written by
    int version = 330;           // that the text needs at least; 0: its host says it
    bool es = false;             // GLSL ES: precisions are said, uniforms have no initialisers
    bool lists_defaults = false; // a comment lists the uniforms' values for the first view
    bool locations = false;      // uniforms, samplers and outputs have numbers in the text
    bool hosted = true;          // the host sets our uniforms; else params are constants and the
                                 // entry sets the camera
    bool samplers = true;        // the host binds images and grids
    bool buffer_file = false;    // large tables may be a buffer, whose file is written beside OUT
    bool noise_cache = false;    // `--noise-cache` goes with it
    const char *time = "";       // not hosted: an expression of the seconds
    const char *zero = "min(fathom_mode, 0)"; // an int that is 0 whenever the shader runs, though
                                              // no compiler knows
    const char *inputs = "";     // template: inputs of the host's own that the text declares; of
                                 // a PICTURE, or of a field that reads the TIME
    const char *entry = "entry"; // template: the entry point of a picture, which sets a camera
                                 // where it is not hosted (values: picture.cpp)
    const char *main = "main";   // the entry point's name
    const char *host = "";       // template: what the host puts around TEXT, for the check
    const char *reserved = "";   // names that the host declares, with blanks between
};

const TargetTraits &traits_of(Target target);
std::span<const Target> all_targets(); // in the table's order

} // namespace fathom::glsl
