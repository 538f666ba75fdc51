#include "api/impl.h"

#include "backend-cpu/prune/shorten.h"
#include "ir/lower/lower.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

namespace fathom::v1 {

// Memory of one kind for the threads that evaluate a field: taken and given back.
template <class Memory> class Pool {
  public:
    template <class Make> std::unique_ptr<Memory> take(Make make) {
        {
            const std::lock_guard lock(mutex_);
            if (!free_.empty()) {
                std::unique_ptr<Memory> memory = std::move(free_.back());
                free_.pop_back();
                return memory;
            }
        }
        return std::make_unique<Memory>(make());
    }
    void give(std::unique_ptr<Memory> memory) {
        const std::lock_guard lock(mutex_);
        free_.push_back(std::move(memory));
    }

  private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<Memory>> free_;
};

// Bounds by cells give lengths of steps, which jump at walls (docs/lipschitz.md, 6.1). A field is
// what one bound leaves.
static ir::Scene by_one_bound(ir::Scene scene) {
    scene.cells.clear();
    ir::lower(scene);
    return scene;
}

struct Field::Impl {
    explicit Impl(const ir::Scene &scene, double time)
        : program(cpu::compile(scene, scene.distance)), inputs(cpu::inputs_of(scene, time)),
          parts(cpu::prune_program_of(program, inputs)), whole(cpu::whole_tape(parts)) {}
    const cpu::Program program;
    const cpu::Inputs inputs;
    const cpu::PruneProgram parts; // refers to `program`
    const cpu::ShortTape whole;
    mutable Pool<cpu::Scratch> values;
    mutable Pool<cpu::GradientScratch> gradients;
    mutable Pool<cpu::Shortener> ranges;
};

namespace {

constexpr std::size_t block = 1024; // points that are transposed at once

// Whether the work could be done.
template <class Work> bool done(Work work) noexcept {
    return guarded(
        [&] {
            work();
            return true;
        },
        [](const Diagnostic &) { return false; });
}

void distances_of(const Field::Impl &impl, std::span<const Point> points,
                  std::span<float> distances) {
    const std::size_t count = std::min(points.size(), distances.size());
    auto scratch = impl.values.take([&] { return cpu::make_scratch(impl.program, impl.inputs); });
    std::array<std::array<float, block>, 3> in;
    for (std::size_t first = 0; first < count; first += block) {
        const std::size_t n = std::min(block, count - first);
        for (std::size_t k = 0; k < n; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis) in[axis][k] = points[first + k][axis];
        const std::array<const float *, 3> from{in[0].data(), in[1].data(), in[2].data()};
        float *const to = distances.data() + first;
        cpu::evaluate(impl.program, *scratch, from.data(), &to, n);
    }
    impl.values.give(std::move(scratch));
}

void gradients_of(const Field::Impl &impl, std::span<const Point> points,
                  std::span<float> distances, std::span<Point> gradients) {
    const std::size_t count = std::min({points.size(), distances.size(), gradients.size()});
    auto scratch =
        impl.gradients.take([&] { return cpu::make_gradient_scratch(impl.program, impl.inputs); });
    std::array<std::array<float, block>, 3> in;
    std::array<std::array<float, block>, 4> out;
    for (std::size_t first = 0; first < count; first += block) {
        const std::size_t n = std::min(block, count - first);
        for (std::size_t k = 0; k < n; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis) in[axis][k] = points[first + k][axis];
        const std::array<const float *, 3> from{in[0].data(), in[1].data(), in[2].data()};
        const std::array<float *, 4> to{out[0].data(), out[1].data(), out[2].data(), out[3].data()};
        cpu::evaluate_gradient(impl.program, *scratch, from.data(), to.data(), n);
        for (std::size_t k = 0; k < n; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis)
                gradients[first + k][axis] = out[axis + 1][k];
    }
    impl.gradients.give(std::move(scratch));
    distances_of(impl, points.first(count), distances.first(count)); // the same bits as alone
}

void volume_of(const Field::Impl &impl, const Box &box, const std::array<std::size_t, 3> &counts,
               std::span<float> distances) {
    const auto place = [&](std::size_t axis, std::size_t i) {
        const double share = static_cast<double>(i) / static_cast<double>(counts[axis] - 1);
        return static_cast<float>((1 - share) * box.lo[axis] + share * box.hi[axis]);
    };
    std::vector<Point> row(counts[0]);
    for (std::size_t i = 0; i < counts[0]; ++i) row[i][0] = place(0, i);
    for (std::size_t z = 0; z < counts[2]; ++z)
        for (std::size_t y = 0; y < counts[1]; ++y) {
            for (Point &point : row) point[1] = place(1, y), point[2] = place(2, z);
            distances_of(impl, row, distances.subspan((z * counts[1] + y) * counts[0], counts[0]));
        }
}

bool is_lattice(const Box &box, const std::array<std::size_t, 3> &counts, std::size_t room) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (counts[axis] < 2 || counts[axis] > room) return false;
        room /= counts[axis];
        if (!std::isfinite(box.lo[axis]) || !std::isfinite(box.hi[axis]) ||
            !(box.lo[axis] < box.hi[axis]))
            return false;
    }
    return true;
}

void intervals_of(const Field::Impl &impl, std::span<const Box> boxes,
                  std::span<Interval> intervals) {
    const std::size_t count = std::min(boxes.size(), intervals.size());
    auto shortener = impl.ranges.take([&] { return cpu::Shortener(impl.parts); });
    constexpr std::size_t row = 16; // Boxes::count is a multiple of it
    for (std::size_t first = 0; first < count; first += cpu::max_boxes) {
        const std::size_t n = std::min(cpu::max_boxes, count - first);
        cpu::Boxes asked;
        asked.count = (n + row - 1) / row * row;
        for (std::size_t k = 0; k < asked.count; ++k) {
            const Box &box = boxes[first + std::min(k, n - 1)];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                asked.lo[axis][k] = box.lo[axis];
                asked.hi[axis][k] = box.hi[axis];
            }
        }
        cpu::run_values(impl.parts, *shortener, impl.whole.selection(impl.parts), asked);
        for (std::size_t k = 0; k < n; ++k)
            intervals[first + k] = {shortener->result_lo[k], shortener->result_hi[k]};
    }
    impl.ranges.give(std::move(shortener));
}

} // namespace

Field::Field(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

bool Field::distances(std::span<const Point> points, std::span<float> distances) const noexcept {
    return done([&] { distances_of(*impl_, points, distances); });
}

bool Field::gradients(std::span<const Point> points, std::span<float> distances,
                      std::span<Point> gradients) const noexcept {
    return done([&] { gradients_of(*impl_, points, distances, gradients); });
}

bool Field::intervals(std::span<const Box> boxes, std::span<Interval> intervals) const noexcept {
    return done([&] { intervals_of(*impl_, boxes, intervals); });
}

bool Field::volume(const Box &box, const std::array<std::size_t, 3> &counts,
                   std::span<float> distances) const noexcept {
    if (!is_lattice(box, counts, distances.size())) return false;
    return done([&] { volume_of(*impl_, box, counts, distances); });
}

std::optional<Field> make_field(const Scene &scene, double time) noexcept {
    return guarded(
        [&]() -> std::optional<Field> {
            if (!hold_at(scene.facts(), time)) return std::nullopt;
            const ir::Scene &whole = ir_of(scene);
            return Field(whole.cells.empty()
                             ? std::make_shared<const Field::Impl>(whole, time)
                             : std::make_shared<const Field::Impl>(by_one_bound(whole), time));
        },
        [](const Diagnostic &) { return std::optional<Field>(); });
}

} // namespace fathom::v1
