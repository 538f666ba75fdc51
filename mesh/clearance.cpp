#include "mesh/clearance.h"

#include "backend-cpu/prune/solid_box.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace fathom::mesh {
namespace {

constexpr double nowhere = std::numeric_limits<double>::infinity();
constexpr double enlarged = 1 + 1e-9;
constexpr std::size_t most_pairs = 300'000; // that are looked at
constexpr std::size_t samples = 64;         // of the way between two points
constexpr std::size_t none_seen = samples + 1;

// A box in which points of a solid may be.
struct Place {
    Point lo{}, hi{};
    std::int32_t children = none; // the first; `count` of them, once it is divided
    std::int32_t count = none;    // none: not divided yet
    bool known = false;           // its middle is in the solid
    double beyond = 0;            // no point of it is nearer to the other solid
};

Point middle(const Place &node) {
    Point m;
    for (std::size_t i = 0; i < 3; ++i) m[i] = 0.5f * (node.lo[i] + node.hi[i]);
    return m;
}
double diagonal(const Place &node) {
    double squares = 0;
    for (std::size_t i = 0; i < 3; ++i) squares += std::pow(double(node.hi[i]) - node.lo[i], 2);
    return std::sqrt(squares);
}
double distance(const Point &a, const Point &b) {
    double squares = 0;
    for (std::size_t i = 0; i < 3; ++i) squares += std::pow(double(a[i]) - b[i], 2);
    return std::sqrt(squares);
}
double distance(const Place &a, const Place &b) {
    double squares = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double gap = std::max(double(a.lo[i]) - b.hi[i], double(b.lo[i]) - a.hi[i]);
        squares += gap > 0 ? gap * gap : 0;
    }
    return std::sqrt(squares) / enlarged;
}

struct Solid {
    Solid(const ir::Scene &scene, double time) : field(scene, time, {}), evaluator(field) {}
    Field field;
    Evaluator evaluator;
    std::vector<Place> nodes;
};

struct Pair {
    double least = 0; // no two points of theirs are nearer
    double size = 0;
    std::int32_t a = 0, b = 0;
    std::size_t number = 0;
};
// The nearest first; of those the smallest, then the newest.
struct Later {
    bool operator()(const Pair &p, const Pair &q) const {
        if (p.least != q.least) return p.least > q.least;
        return p.size != q.size ? p.size > q.size : p.number < q.number;
    }
};

struct Search {
    Solid a, b;
    double ulp = 0;
    Clearance found;
    cpu::Boxes boxes;
    std::priority_queue<Pair, std::vector<Pair>, Later> queue;
    std::size_t made = 0;
    Points way;
    std::vector<float> in_a, in_b;
    std::array<std::vector<float>, 4> slopes;

    Search(const ir::Scene &first, const ir::Scene &second, double time)
        : a(first, time), b(second, time) {
        found.distance.hi = nowhere;
        found.used_bound = a.field.proved || b.field.proved;
    }

    void meet(const Point &p, const Point &q) {
        const double d = p == q ? 0 : distance(p, q) * enlarged;
        if (!(d < found.distance.hi)) return;
        found.distance.hi = d;
        found.near = {p, q};
    }

    void divide(Solid &own, Solid &other, std::int32_t number) {
        const Place whole = own.nodes[static_cast<std::size_t>(number)];
        boxes.count = 16;
        std::array<Place, 8> parts;
        for (std::size_t k = 0; k < 8; ++k) {
            Place &part = parts[k];
            part.lo = whole.lo, part.hi = whole.hi;
            const Point cut = middle(whole);
            for (std::size_t i = 0; i < 3; ++i) (k >> i & 1 ? part.lo : part.hi)[i] = cut[i];
            const Point m = middle(part);
            for (std::size_t i = 0; i < 3; ++i) {
                boxes.lo[i][k] = part.lo[i], boxes.hi[i][k] = part.hi[i];
                boxes.lo[i][8 + k] = boxes.hi[i][8 + k] = m[i];
            }
        }
        ranges_over(own.evaluator, *own.field.whole, boxes);
        ranges_over(other.evaluator, *other.field.whole, boxes);
        std::int32_t count = 0;
        double nearest_value = found.distance.hi; // of the other field, at points of this solid
        std::optional<Point> nearest;
        const auto first = static_cast<std::int32_t>(own.nodes.size());
        for (std::size_t k = 0; k < 8; ++k) {
            Place &part = parts[k];
            const double half = 0.5 * diagonal(part);
            if (space_of(own.evaluator, k, half, ulp, true) == Space::Outside) continue;
            part.known = own.evaluator.ranges.result_hi[8 + k] < 0;
            if (other.field.proved) {
                const cpu::Shortener &ranges = other.evaluator.ranges;
                part.beyond = std::max({0.0, whole.beyond, double(ranges.result_lo[k]) - 8 * ulp,
                                        ranges.result_lo[8 + k] - half * enlarged - 8 * ulp});
            }
            const double value = other.evaluator.ranges.result_hi[8 + k];
            if (part.known && value < 0) meet(middle(part), middle(part));
            if (part.known && value < nearest_value) nearest_value = value, nearest = middle(part);
            own.nodes.push_back(part);
            ++count;
        }
        own.nodes[static_cast<std::size_t>(number)].children = first;
        own.nodes[static_cast<std::size_t>(number)].count = count;
        if (nearest && nearest_value > 0) aim(own, other, *nearest);
    }

    // Points on the way from one point to another, and the fields' values there.
    void look(const Point &from, const Point &to) {
        way.clear();
        for (std::size_t k = 0; k <= samples; ++k) {
            const double t = double(k) / samples;
            Point p;
            for (std::size_t i = 0; i < 3; ++i)
                p[i] = static_cast<float>((1 - t) * from[i] + t * to[i]);
            way.add(p);
        }
        values_at(a.evaluator, *a.field.whole, way, in_a);
        values_at(b.evaluator, *b.field.whole, way, in_b);
    }

    // From a point of the first solid to one of the second: the shortest stretch between points of
    // both that is seen on the way.
    void walk(const Point &from, const Point &to) {
        look(from, to);
        std::size_t last = none_seen, first = none_seen; // the last point in `a` before one in `b`
        for (std::size_t k = 0, in = none_seen; k <= samples && first == none_seen; ++k) {
            if (in_a[k] < 0) in = k;
            if (in_b[k] < 0 && in != none_seen) last = in, first = k;
        }
        if (first == none_seen) return;
        Point p = way[last], q = way[first];
        meet(p, q);
        if (last == first || !(distance(p, q) < 2 * found.distance.hi)) return;
        // The same more finely about both ends.
        const Point beyond_p = way[last + 1], before_q = way[first - 1];
        look(p, beyond_p);
        for (std::size_t k = 0; k <= samples && in_a[k] < 0; ++k) p = way[k];
        look(q, before_q);
        for (std::size_t k = 0; k <= samples && in_b[k] < 0; ++k) q = way[k];
        meet(p, q);
    }

    // From a point of a solid towards where the other one's field says that it is.
    void aim(Solid &own, Solid &other, const Point &from) {
        way.clear();
        way.add(from);
        gradients_at(other.evaluator, *other.field.whole, way, slopes);
        const double value = slopes[0][0];
        double squares = 0;
        for (std::size_t i = 0; i < 3; ++i) squares += std::pow(slopes[1 + i][0], 2);
        if (!(value > 0 && squares > 0 && std::isfinite(value / squares))) return;
        Point to;
        for (std::size_t i = 0; i < 3; ++i)
            to[i] = static_cast<float>(from[i] - 1.25 * value / squares * slopes[1 + i][0]);
        &own == &a ? walk(from, to) : walk(to, from);
    }

    void add(std::int32_t p, std::int32_t q) {
        const Place &x = a.nodes[static_cast<std::size_t>(p)],
                    &y = b.nodes[static_cast<std::size_t>(q)];
        const double least = std::max({distance(x, y), x.beyond, y.beyond});
        if (least < found.distance.hi)
            queue.push({least, std::max(diagonal(x), diagonal(y)), p, q, made++});
    }

    void run(double tolerance, Progress &progress) {
        add(0, 0);
        double least = nowhere;
        for (std::size_t looked = 0; !queue.empty(); ++looked) {
            const Pair pair = queue.top();
            least = pair.least;
            if (least + tolerance >= found.distance.hi || looked == most_pairs) break;
            if (looked % 1024 == 0) progress.tell(double(looked) / most_pairs);
            if (progress.cancelled) break;
            queue.pop();
            const Place x = a.nodes[static_cast<std::size_t>(pair.a)],
                        y = b.nodes[static_cast<std::size_t>(pair.b)];
            if (x.known && y.known &&
                distance(middle(x), middle(y)) < 2 * found.distance.hi + tolerance)
                walk(middle(x), middle(y));
            // Where the other's field is as good as a distance, one solid is divided alone: pairs of
            // small boxes are many.
            const double most = found.distance.hi - tolerance;
            const bool by_field_x = std::isfinite(most) && x.beyond + diagonal(x) >= most,
                       by_field_y = std::isfinite(most) && y.beyond + diagonal(y) >= most;
            const bool first = by_field_x != by_field_y ? by_field_x
                               : by_field_x             ? diagonal(x) < diagonal(y)
                                                        : diagonal(x) >= diagonal(y);
            if ((first ? diagonal(x) : diagonal(y)) < 64 * ulp) { // floats tell no more
                queue.push(pair);
                break;
            }
            Solid &own = first ? a : b, &other = first ? b : a;
            const std::int32_t number = first ? pair.a : pair.b;
            if (own.nodes[static_cast<std::size_t>(number)].count == none)
                divide(own, other, number);
            const Place whole = own.nodes[static_cast<std::size_t>(number)];
            for (std::int32_t k = whole.children; k < whole.children + whole.count; ++k)
                first ? add(k, pair.b) : add(pair.a, k);
        }
        // Where no pair is left none is nearer than those that were seen.
        if (queue.empty()) least = found.distance.hi;
        found.distance.lo = std::min(least, found.distance.hi);
    }
};

// Where the solid lies; all of the space that is searched where it has no end.
Failure start(const ir::Scene &scene, double time, Place &node, bool &endless) {
    Settings settings;
    settings.time = time;
    ir::Box box;
    const Failure failure = box_of(scene, settings, box);
    endless = failure == Failure::Endless || failure == Failure::Unbounded;
    if (failure != Failure::None && !endless) return failure;
    constexpr float far = cpu::endless_from;
    for (std::size_t i = 0; i < 3; ++i) {
        const double slack = 1e-6 * (std::fabs(box.lo[i]) + std::fabs(box.hi[i]));
        node.lo[i] = endless ? -far : static_cast<float>(box.lo[i] - slack);
        node.hi[i] = endless ? far : static_cast<float>(box.hi[i] + slack);
    }
    return Failure::None;
}

} // namespace

Clearance clearance(const ir::Scene &a, const ir::Scene &b, double time, double tolerance,
                    Progress &progress) {
    Clearance failed;
    Place in_a, in_b;
    bool endless_a = false, endless_b = false;
    failed.failure = start(a, time, in_a, endless_a);
    if (failed.failure == Failure::None) failed.failure = start(b, time, in_b, endless_b);
    if (failed.failure == Failure::None && endless_a && endless_b)
        failed.failure = Failure::Endless;
    if (failed.failure != Failure::None) return failed;
    Search search(a, b, time);
    double largest = 0;
    for (const Place &node : {in_a, in_b})
        for (std::size_t i = 0; i < 3; ++i)
            largest = std::max<double>({largest, std::fabs(node.lo[i]), std::fabs(node.hi[i])});
    if (endless_a != endless_b) { // what is far from the one with an end is of no matter
        const Place &end = endless_a ? in_b : in_a;
        largest = std::max(std::fabs(double(distance(end.lo, end.hi))), 1e-6);
        for (std::size_t i = 0; i < 3; ++i)
            largest = std::max<double>({largest, std::fabs(end.lo[i]), std::fabs(end.hi[i])});
    }
    search.ulp = std::ldexp(1.0, std::ilogb(2 * largest) - 23);
    search.a.nodes.push_back(in_a);
    search.b.nodes.push_back(in_b);
    search.run(tolerance, progress);
    if (progress.cancelled) search.found.failure = Failure::Cancelled;
    return search.found;
}

} // namespace fathom::mesh
