// What numbers are between on one side of a border: of unknown steps the range is known, and how far
// what is rounded is from the whole number (docs/lipschitz.md, 2.29).
#pragma once

#include "ir/graph.h"
#include "ir/interval.h"
#include "proof/continuity.h"
#include "proof/work.h"

#include <map>
#include <optional>
#include <set>
#include <unordered_map>
#include <vector>

namespace fathom::proof {

using ir::Graph;
using ir::Interval;
using ir::NodeId;
using ir::Op;

// What is known of ranges, on all sides alike.
struct Notes {
    std::map<NodeId, Interval> given;         // of unknown numbers, and of coordinates
    std::map<NodeId, NodeId> rounded;         // of unknown whole numbers: t + d, t what was rounded
    std::set<NodeId> sloped;                  // unknown numbers of what is_sloped
    std::map<NodeId, std::vector<NodeId>> as; // what forms were before they were sums of products
    std::unordered_map<NodeId, Interval> found; // ranges of others
    void keep(NodeId form, NodeId made);
};

// What |x| is at least: the size of another number less a constant.
struct Core {
    NodeId of;
    double off = 0;
    bool turned = false; // has sines and cosines for factors
};

struct SideRanges {
    Graph &graph;
    Notes &notes;
    Work &work;
    Expansion &forms; // of the graph's sums

    // What a scalar is between, made of numbers and unknown steps; nothing is known of the point.
    Interval of(NodeId id);
    // The first extreme's argument that is never beyond the other, but for rounding.
    std::optional<NodeId> outermost(Op extreme, NodeId a, NodeId b);
    // The limit that x is never within of, but for rounding, of min(max(x, least), most).
    std::optional<NodeId> beyond(NodeId x, NodeId least, NodeId most);
    // 1 or 0 of a smoothstep that is one of these there.
    std::optional<double> faded(NodeId from, NodeId to, NodeId x);
    double size_of_terms(NodeId id) const; // the greatest number in a sum
    // Does a sum grow along some coordinate at a constant rate, whatever the rest is? Then it is one
    // number in no set of points that has an inside.
    bool is_sloped(NodeId sum) const;
    // Is it never below 0, and 0 only where a coordinate, or an unknown number of what is sloped, is
    // at an end of its range?
    bool is_0_at_ends_alone(NodeId sum, double rounding);

  private:
    Interval found(NodeId id);
    Interval as_made(NodeId id);
    Interval as_made_of_parts(NodeId id);
    Interval of_terms(const std::vector<Term> &terms);
    Interval by_rounded(const std::vector<Term> &terms);
    // Of turned and moved parts: lengths, and the greatest of several.
    bool is_wave(NodeId factor) const; // a sine, a cosine, or the size of what has such
    std::optional<Core> core_of(NodeId x, bool from_below, int depth = 0);
    Interval by_cores(const std::vector<NodeId> &parts, bool greatest);
};

} // namespace fathom::proof
