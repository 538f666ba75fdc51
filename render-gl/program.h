// An emitted text as a linked GL program with its data, and the one pass that it draws. Needs a
// current context of GL 3.3 or later, its own or a window's; makes none.
#pragma once

#include "backend-glsl/emit.h"
#include "ir/view.h"
#include "render-gl/shaders.h"

#include <array>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace fathom::gl {

class Pruning;

// What a scene's shader writes; the numbers stand in its text.
enum class Mode { Picture = 0, Heat = 1, Numbers = 2, Linear = 3, Slice = 4, Check = 5 };

// One draw of a picture by passes (passes.h).
struct Pass {
    int turns = 0;                  // steps that it may give a ray; 0: the budget
    bool keeps = false;             // rays that go on are kept
    bool resumed = false;           // rays go on, from what the textures `kept` tell of them
    std::array<unsigned, 4> kept{}; // read where `resumed`
};

// What changes from frame to frame: view, time, params, mode.
struct FrameInputs {
    ir::View view;
    glm::dvec3 sun{0, 1, 0}; // ir::lights_of's, where the scene has none
    int width = 0, height = 0;
    std::array<double, 2> offset{0.5, 0.5};
    double time = 0;
    Mode mode = Mode::Picture;
    std::array<double, 4> plane{0, 0, 1, 0}; // Mode::Slice: unit normal, offset
    // Of a program by passes: a texture that tells for each pixel of what is drawn its place in the
    // picture, in pixels from the top left; 0: its own, by `offset`.
    unsigned places = 0;
    // Of a program by passes: steps that a ray may take in all of them, 0: as many as the scene says;
    // and the pass.
    int budget = 0;
    Pass pass{};
};

// A linked scene shader with its data on the card.
class Program {
  public:
    // `output` is of Target::Glsl330, Glsl450 or Es300; the images and grids that it names are taken from
    // `scene`.
    static std::variant<Program, ProgramError> build(const glsl::Output &output,
                                                     const ir::Scene &scene);

    // Draws over the current framebuffer and viewport (the scissor rectangle applies), with the
    // params' values of `params`.
    void draw(const FrameInputs &inputs, const std::vector<ir::Param> &params) const;

    Pruning *pruning() const; // nothing where all rows are computed everywhere

    // Whether its pictures are drawn by passes, and how many steps a draw may give a ray then: the
    // first one, and any other.
    bool by_passes() const { return first_kept_unit_ > 0; }
    int first_turns() const;
    int most_turns() const { return most_turns_; }
    // To be called before a draw that keeps its rays. False: the driver has no memory for it.
    bool prepare_to_keep() const;
    unsigned marks() const { return marks_; } // what marks the rays that go on (passes.h)

    // For passes that set uniforms of their own, where it has no passes (passes.h): the GL program,
    // and how to make it current.
    unsigned name() const { return program_; }
    void use() const;

    // A fresh output of the same text, literals apart: its params may stand elsewhere, its tables
    // hold other numbers.
    void adopt(const glsl::Output &output);

    // The numbers that stand in for literals of the text (`uniform float fathom_edited[N]`).
    void set_edited(std::vector<float> values) { edited_ = std::move(values); }

    // What the driver puts off to the first draw is done now, in a picture of a few pixels.
    void warm_up(const std::vector<ir::Param> &params) const;

    Program(Program &&other) noexcept;
    Program &operator=(Program &&other) noexcept;
    ~Program();

  private:
    Program();
    void release();
    void name_units(unsigned program) const;

    unsigned program_ = 0, marks_ = 0;
    // A driver on the processor takes longer to compile a text that keeps rays, and a third
    // longer to draw by it; few pictures need it. There `program_` begins rays alone, and this is
    // made of the text when it is first wanted. No text: `program_` does both.
    std::string keeping_text_;
    mutable unsigned keeping_ = 0;
    std::vector<unsigned> subroutines_; // of `program_` (subroutines.h)
    int budget_ = 0, most_turns_ = 0, first_kept_unit_ = 0;
    TableData tables_;
    std::unique_ptr<Pruning> pruning_; // where the text runs over lists by cell
    struct Texture {
        unsigned target = 0, name = 0;
        std::string sampler;
    };
    std::vector<Texture> textures_; // bound to units 1, 2, …
    std::vector<glsl::Uniform> uniforms_;
    std::vector<float> edited_;
};

// One triangle over the current viewport, with the current program. Its vertex array lives no
// longer than the call: such objects, unlike programs and textures, belong to one context of
// several that share.
void draw_triangle();

} // namespace fathom::gl
