// A picture by passes: a draw gives a ray so many steps, and the rays that are not done go on in the
// next one, from textures that keep where they are; so no draw is long, and a ray may take as many
// steps as it needs. The first pass keeps nothing, since few pictures need another: the second one
// begins its rays anew. Needs a current context of GL 3.3.
#pragma once

#include "render-gl/program.h"

#include <cstdint>
#include <functional>
#include <span>

namespace fathom::gl {

// Rays that are not decided, of a picture's samples; and those that passed a surface without an
// inside.
struct Undecided {
    std::uint64_t rays = 0;    // from the eye
    std::uint64_t shadows = 0; // pixels' samples with a ray from a light
    std::uint64_t passed = 0;  // from the eye
};

// What is drawn over: textures of the same size, `picks` 0 where there are none.
struct Drawn {
    unsigned color = 0, picks = 0;
    int width = 0, height = 0;
    friend bool operator==(const Drawn &, const Drawn &) = default;
};

// The passes of one target.
class Passes {
  public:
    Passes() = default;
    ~Passes();
    Passes(const Passes &) = delete;
    Passes &operator=(const Passes &) = delete;

    // What the next passes draw over. False where the card has no memory for it.
    bool use(const Drawn &drawn);

    // Begins a sample of the rows from `bottom` on, of a program by passes. `turns`: steps a pass may
    // give a ray; 0: as the program says.
    // `only`: not 0 where a pixel of these rows is drawn, from the lowest row up; without, all are.
    void begin(const Program &program, int bottom, int rows, int turns,
               std::span<const std::uint8_t> only = {});
    // One pass of the program that it was begun with. `draw` draws all of it, in however many views,
    // and touches neither the framebuffer nor the depth test. False: there is no memory for what is
    // kept.
    bool draw(const Program &program, const std::function<void(const Pass &pass)> &draw);
    bool done() const { return left_ == 0; }
    std::uint64_t left() const { return left_; } // rays that go on

    const Undecided &undecided() const { return undecided_; } // of all that was begun since:
    void forget() { undecided_ = {}; }

    // The program that counts the rays of which something is said, and marks them.
    static constexpr const char *marks_text = R"(#version 330 core
uniform sampler2D rays;
uniform vec2 between;
void main() {
    float ray = texelFetch(rays, ivec2(gl_FragCoord.xy), 0).x;
    if (!(ray > between.x && ray < between.y)) discard;
}
)";

  private:
    bool make_kept();
    bool keeps() const { return pass_ > 0; }
    std::uint64_t count(float above, float below, bool mark) const;
    void release();

    Drawn drawn_;
    bool some_ = false; // the first pass draws marked pixels alone
    int bottom_ = 0, rows_ = 0, turns_ = 0, pass_ = 0;
    std::uint64_t left_ = 0;
    Undecided undecided_;
    unsigned rays_ = 0, depth_ = 0;    // a texture: what became of each ray; a renderbuffer
    unsigned first_ = 0, marks_ = 0;   // framebuffers
    std::array<unsigned, 2> turned_{}; // … of the passes after the first
    std::array<std::array<unsigned, 4>, 2> kept_{}; // textures
    unsigned query_ = 0, mark_ = 0;                 // a program of another
};

} // namespace fathom::gl
