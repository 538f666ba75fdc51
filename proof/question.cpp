#include "proof/question.h"

#include <algorithm>
#include <bit>
#include <span>
#include <utility>

namespace fathom::proof {

Question::Question(Flattening &context, const Ranges &ranges, NodeId field, Wanted wanted)
    : context_(context) {
    const auto written = context.written.find(field);
    if (written != context.written.end()) field = written->second;
    ir::Content content = ir::content_of(context.graph, field);
    words_ = std::move(content.words);
    content_words_ = words_.size();
    add_inputs(content, ranges, field);
    add(static_cast<std::uint32_t>(content_words_)); // so that no two questions have equal words
    add(static_cast<std::uint32_t>(wanted) << 1 | std::uint32_t{context.borders});
}

void Question::add(double number) {
    const auto bits = std::bit_cast<std::uint64_t>(number);
    add(static_cast<std::uint32_t>(bits));
    add(static_cast<std::uint32_t>(bits >> 32));
}
void Question::add(const Interval &interval) {
    add(interval.lo);
    add(interval.hi);
}
void Question::add(const Cell &cell) {
    for (const Interval &side : cell.p) add(side);
}
void Question::add(const Zone *zone) {
    if (!zone) return add(std::uint32_t{0});
    add(std::uint32_t{1});
    add(static_cast<std::uint32_t>(zone->kind));
    for (const Interval &one : zone->center) add(one);
    for (const Interval &one : zone->half) add(one);
    add(static_cast<std::uint32_t>(zone->axis));
    add(static_cast<std::uint32_t>(zone->less.size()));
    for (const Zone &less : zone->less) add(&less);
}
void Question::add(const Budget &budget) {
    add(static_cast<double>(budget.instructions));
    add(budget.tolerance);
    add(budget.enough);
    add(budget.hopeless);
    add(static_cast<double>(budget.most));
    add(static_cast<double>(budget.levels));
}

// The ranges of what the field reads, by the numbers that it has in the words.
void Question::add_inputs(const ir::Content &content, const Ranges &ranges, NodeId field) {
    const auto is_weakened = [](double factor) { return factor != 1; };
    const auto add_all = [&](const auto &intervals) {
        for (const Interval &one : intervals) add(one);
    };
    own_.rules = ranges.rules;
    add(static_cast<std::uint32_t>(std::ranges::count_if(ranges.rules.factor, is_weakened)));
    for (std::size_t rule = 0; rule < ranges.rules.factor.size(); ++rule)
        if (is_weakened(ranges.rules.factor[rule])) {
            add(static_cast<std::uint32_t>(rule));
            add(ranges.rules.factor[rule]);
        }
    if (is_weakened(ranges.rules.of_op.factor)) {
        add(static_cast<std::uint32_t>(ranges.rules.of_op.op));
        add(static_cast<std::uint32_t>(ranges.rules.of_op.form));
        add(ranges.rules.of_op.factor);
    }
    if (context_.graph.reads(field).time) add(own_.time = ranges.time);
    for (std::uint32_t param : content.params)
        add_all(own_.params.emplace_back(ranges.params[param]));
    for (std::uint32_t i = 0; i < content.vars.size(); ++i) {
        const auto known = ranges.vars.find(content.vars[i]);
        add(std::uint32_t{known != ranges.vars.end()});
        if (known != ranges.vars.end()) add_all(own_.vars[i] = known->second);
    }
    const auto add_sampled = [&](const std::vector<std::uint32_t> &which,
                                 const std::vector<Ranges::Sampled> &all,
                                 std::vector<Ranges::Sampled> &own) {
        for (std::uint32_t index : which) {
            own.push_back(index < all.size()
                              ? all[index]
                              : Ranges::Sampled{Interval::everything(), ir::rounding::infinity});
            add(own.back().values);
            add(own.back().slope);
        }
    };
    add_sampled(content.images, ranges.images, own_.images);
    add_sampled(content.grids, ranges.grids, own_.grids);
    for (std::uint32_t index : content.caches) {
        const Ranges::Cached &known = own_.caches.emplace_back(
            index < ranges.caches.size() ? ranges.caches[index] : Ranges::Cached{});
        cached_.push_back(index < context_.cached.size() && context_.cached[index]);
        add(std::uint32_t{cached_.back()});
        add_all(known.values);
        add(known.slope);
    }
}

FieldBound Question::searched(const Search &search, Work &work) const {
    ir::Scene scene;
    const NodeId field = ir::rebuilt(scene.graph, std::span(words_).first(content_words_));
    Flattening context{scene.graph, work};
    context.borders = context_.borders;
    context.cached = cached_;
    Ranges ranges = own_;
    ranges.scene = &scene;
    ranges.work = &work;
    context.ranges = &ranges;
    return search(context, ranges, field);
}

FieldBound Question::answer(const Search &search) && {
    BoundCache *const cache = context_.work.spent() ? nullptr : context_.cache;
    if (cache)
        if (const auto known = cache->find(words_); known && known->steps < context_.work.left) {
            context_.work.take(known->steps);
            return known->bound;
        }
    Work work = context_.work;
    const std::size_t before = work.left;
    BoundCache::Answer answer{searched(search, work), 0};
    answer.steps = before - work.left;
    // What was found with too little work is no answer for those who have more.
    if (cache && !work.spent()) cache->keep(std::move(words_), answer);
    context_.work.take(answer.steps);
    return answer.bound;
}

} // namespace fathom::proof
