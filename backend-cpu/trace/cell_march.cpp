#include "backend-cpu/trace/cell_march.h"

#include <bit>

namespace fathom::cpu {

namespace {

class Marcher {
  public:
    Marcher(Worker &worker, std::span<const RayState> rays, std::span<Landing> landings)
        : worker_(worker), pruning_(*worker.stage.pruning), evaluator_(*worker.evaluator),
          memory_(*worker.cell_march), rays_(rays), landings_(landings), lengths_(worker.stage),
          budget_(worker.stage.budget) {}

    void run() {
        memory_.walks.resize(std::max(memory_.walks.size(), rays_.size()));
        memory_.next.resize(std::max(memory_.next.size(), rays_.size()));
        memory_.stops.clear(), memory_.queue.clear(), memory_.crossings.clear();
        ++memory_.turn;
        if (memory_.seen.empty()) memory_.seen.resize(4096);
        for (std::uint32_t i = 0; i < rays_.size(); ++i) {
            landings_[i] = {};
            memory_.walks[i] = {};
            memory_.walks[i].t = rays_[i].begin;
            if (rays_[i].end >= rays_[i].begin) go_on(i);
        }
        std::size_t first = 0;
        while (first < memory_.queue.size()) halt(memory_.queue[first++]);
        refine(worker_, rays_, memory_.crossings, landings_);
        look_back(worker_, memory_.walks, landings_);
    }

  private:
    // Through far cells to one where the ray has to wait, or to its end.
    void go_on(std::uint32_t i) {
        Walk &walk = memory_.walks[i];
        const RayState &ray = rays_[i];
        while (goes_on(i)) {
            const Vec p = ray.origin + walk.t * ray.direction;
            const PruneCell &cell = cell_at(pruning_, evaluator_, p.x, p.y, p.z);
            if (!(cell.far > 0 && cell.far >= limit_at(walk.t, lengths_))) {
                wait(i, cell.far > 0 ? *cell.above : cell);
                return;
            }
            ++evaluator_.tally.far, ++worker_.work.evaluations;
            walk.d = cell.far;
            ++walk.steps;
            if (!goes_on_from(i)) return;
        }
    }

    // Who has run out of steps or of way is done.
    bool goes_on(std::uint32_t i) {
        const Walk &walk = memory_.walks[i];
        const bool free = !(walk.t <= rays_[i].end + lengths_.slack);
        if (!free && walk.steps < budget_) return true;
        landings_[i] = {free ? -1.0f : walk.t, walk.steps, free ? RayEnd::Miss : RayEnd::Undecided};
        return false;
    }

    // By the distance at its last sample.
    bool goes_on_from(std::uint32_t i) {
        Walk &walk = memory_.walks[i];
        switch (judge(walk, lengths_)) {
        case Verdict::GoOn: advance(walk, rays_[i].end, lengths_, false); return true;
        case Verdict::GoBack: go_back(walk, lengths_, false); return true;
        case Verdict::Crossed:
            landings_[i].steps = walk.steps;
            memory_.crossings.push_back(crossing(walk, i));
            return false;
        case Verdict::Touches: pass(walk, rays_[i].end, lengths_); return true;
        case Verdict::Near: landings_[i] = beside(walk, lengths_); return false;
        case Verdict::Undecided: break;
        }
        landings_[i] = {walk.t, walk.steps, RayEnd::Undecided};
        return false;
    }

    std::uint32_t stop_at(const PruneCell &cell) {
        if (4 * memory_.stops.size() > memory_.seen.size()) {
            memory_.seen.assign(2 * memory_.seen.size(), {});
            for (std::uint32_t s = 0; s < memory_.stops.size(); ++s)
                *seen_at(*memory_.stops[s].cell) = {memory_.stops[s].cell, memory_.turn, s};
        }
        CellMarch::Seen *seen = seen_at(cell);
        if (seen->turn != memory_.turn) {
            *seen = {&cell, memory_.turn, static_cast<std::uint32_t>(memory_.stops.size())};
            memory_.stops.push_back({&cell, 0, 0});
        }
        return seen->stop;
    }
    CellMarch::Seen *seen_at(const PruneCell &cell) {
        const std::size_t mask = memory_.seen.size() - 1;
        std::size_t at = (reinterpret_cast<std::uintptr_t>(&cell) / sizeof(PruneCell)) & mask;
        while (memory_.seen[at].turn == memory_.turn && memory_.seen[at].cell != &cell)
            at = (at + 1) & mask;
        return &memory_.seen[at];
    }

    void wait(std::uint32_t i, const PruneCell &cell) {
        const std::uint32_t s = stop_at(cell);
        CellMarch::Stop &stop = memory_.stops[s];
        if (stop.count++ == 0) memory_.queue.push_back(s);
        memory_.next[i] = stop.first;
        stop.first = i;
    }

    // All who wait in a cell, until none is in it.
    void halt(std::uint32_t s) {
        CellMarch::Stop &stop = memory_.stops[s];
        const PruneCell &cell = *stop.cell;
        std::vector<std::uint32_t> &here = memory_.here;
        here.clear();
        for (std::uint32_t k = 0, i = stop.first; k < stop.count; ++k, i = memory_.next[i])
            here.push_back(i);
        stop.count = 0;
        for (std::size_t k = 0; k < here.size(); ++k) {
            const RayState &ray = rays_[here[k]];
            worker_.points.set(0, k, ray.origin + memory_.walks[here[k]].t * ray.direction);
        }
        worker_.work.evaluations += here.size();
        float *out = worker_.values.data();
        evaluate_in(pruning_, evaluator_, cell, worker_.points.pointers(), &out, here.size());
        for (std::size_t k = 0; k < here.size(); ++k) {
            const std::uint32_t i = here[k];
            memory_.walks[i].d = worker_.values[k];
            ++memory_.walks[i].steps;
            if (goes_on_from(i)) go_on(i);
        }
    }

    Worker &worker_;
    const Pruning &pruning_;
    CellEvaluator &evaluator_;
    CellMarch &memory_;
    std::span<const RayState> rays_;
    std::span<Landing> landings_;
    const Lengths lengths_;
    const int budget_;
};

} // namespace

void march_by_cells(Worker &worker, std::span<const RayState> rays, std::span<Landing> landings) {
    if (!worker.cell_march) worker.cell_march = std::make_shared<CellMarch>();
    Marcher(worker, rays, landings).run();
}

} // namespace fathom::cpu
