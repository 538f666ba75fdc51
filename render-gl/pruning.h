// The lists by cell that a text with `pruning` runs over (backend-glsl/prune.h): made on the card
// by compute shaders, level by level, when a program first draws and again when what they read
// changed. Needs a current context of GL 4.3.
#pragma once

#include "backend-glsl/emit.h"
#include "render-gl/shaders.h"

#include <array>
#include <memory>
#include <variant>
#include <vector>

namespace fathom::gl {

bool can_prune();   // whether the current context can
bool is_software(); // whether it draws on the processor

// The cell lists of one scene on the card.
class Pruning {
  public:
    static std::variant<std::unique_ptr<Pruning>, ProgramError> build(const glsl::Pruning &pruning);

    // The lists and far cells for these values, made where they are not yet.
    void prepare(const std::vector<ir::Param> &params, double time);
    void remake(const std::vector<ir::Param> &params, double time); // to be measured
    // Sets what a picture's text reads; its program must be current.
    void bind(unsigned program) const;
    // Fresh numbers, or fresh texts.
    void adopt(const glsl::Pruning &pruning);

    struct Tally {
        int side = 0;    // cells along an axis
        double rows = 0; // in a cell, of all grids: mean
        double all = 0;  // in a cell without pruning
    };
    Tally tally() const { return tally_; }
    // By cell, x first: how far its centre is from all surfaces; 0 where the cell is not far.
    std::vector<float> far_cells() const;

    ~Pruning();
    Pruning(const Pruning &) = delete;
    Pruning &operator=(const Pruning &) = delete;

  private:
    struct Kernel {
        unsigned program = 0;
        TableData tables;
        std::vector<double> values; // of the params that it reads, when it last ran
    };
    Pruning() = default;
    static std::optional<ProgramError> compile(Kernel &kernel, const glsl::PruneKernel &source);
    void make_lists(const std::vector<ir::Param> &params, double time);
    void make_far(const std::vector<ir::Param> &params, double time);
    void level(int side, int parent_side, std::size_t room, const std::vector<ir::Param> &params,
               double time);

    glsl::Pruning source_;
    std::vector<Kernel> kernels_; // the lists', then that of the far cells
    bool stale_ = true;
    int side_ = 0;
    unsigned cells_ = 0, rows_ = 0, far_cells_ = 0, next_cells_ = 0, next_rows_ = 0, total_ = 0;
    Tally tally_;
};

} // namespace fathom::gl
