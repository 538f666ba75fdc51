// The graph's storage: making and finding nodes. What a node simplifies to stands in simplify.cpp,
// what hangs below it in walk.cpp.
#include "ir/graph.h"

#include "base/hash.h"
#include "ir/passes/early_exit.h"
#include "ir/passes/fold.h"
#include "ir/passes/simplify.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>

namespace fathom::ir {

// -- types and ops

int components(Type type) {
    switch (type) {
    case Type::Bool:
    case Type::Int:
    case Type::Float: return 1;
    case Type::Vec2: return 2;
    case Type::Vec3: return 3;
    case Type::Vec4:
    case Type::Mat2: return 4;
    case Type::Mat3:
    case Type::Hit: return 9;
    case Type::Mat4: return 16;
    }
    return 0;
}

Type vector_type(int size) {
    assert(size >= 1 && size <= 4);
    return size == 2 ? Type::Vec2 : size == 3 ? Type::Vec3 : size == 4 ? Type::Vec4 : Type::Float;
}

Type matrix_type(int size) {
    constexpr Type types[] = {Type::Mat2, Type::Mat3, Type::Mat4};
    assert(size >= 2 && size <= 4);
    return types[size - 2];
}

int side(Type matrix) {
    assert(is_matrix(matrix));
    return matrix == Type::Mat2 ? 2 : matrix == Type::Mat3 ? 3 : 4;
}

bool is_vector(Type type) { return type == Type::Vec2 || type == Type::Vec3 || type == Type::Vec4; }
bool is_matrix(Type type) { return type == Type::Mat2 || type == Type::Mat3 || type == Type::Mat4; }

const char *type_name(Type type) {
    switch (type) {
    case Type::Bool: return "bool";
    case Type::Int: return "int";
    case Type::Float: return "float";
    case Type::Vec2: return "vec2";
    case Type::Vec3: return "vec3";
    case Type::Vec4: return "vec4";
    case Type::Mat2: return "mat2";
    case Type::Mat3: return "mat3";
    case Type::Mat4: return "mat4";
    case Type::Hit: return "hit";
    }
    return "";
}

namespace {
bool commutes(Op op) {
    return op == Op::Add || op == Op::Mul || op == Op::Min || op == Op::Max || op == Op::Dot ||
           op == Op::Equal || op == Op::NotEqual || op == Op::And || op == Op::Or;
}
} // namespace

// -- packed payloads

std::uint32_t table_slot(TableId table, int column) {
    assert(table.index < (1u << 20) && column >= 0 && column < 4096);
    return table.index << 12 | static_cast<std::uint32_t>(column);
}
TableId table_of(std::uint32_t slot) { return TableId{std::size_t{slot >> 12}}; }
int column_of(std::uint32_t slot) { return static_cast<int>(slot & 4095u); }

std::uint32_t swizzle_mask(std::span<const int> parts) {
    assert(!parts.empty() && parts.size() <= 4);
    std::uint32_t mask = static_cast<std::uint32_t>(parts.size()) << 8;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        assert(parts[i] >= 0 && parts[i] < 4);
        mask |= static_cast<std::uint32_t>(parts[i]) << (2 * i);
    }
    return mask;
}
int swizzle_size(std::uint32_t mask) { return static_cast<int>(mask >> 8); }
int swizzle_component(std::uint32_t mask, int i) { return static_cast<int>(mask >> (2 * i) & 3u); }

// -- making nodes

namespace {

std::uint64_t hash_of(Op op, Type type, std::span<const NodeId> args, std::uint32_t payload) {
    std::uint64_t h = hash_combine(
        static_cast<std::uint64_t>(op) << 8 | static_cast<std::uint64_t>(type), payload);
    if (commutes(op)) // the same in either order
        return hash_combine(hash_combine(h, std::min(args[0].index, args[1].index)),
                            std::max(args[0].index, args[1].index));
    for (NodeId arg : args) h = hash_combine(h, arg.index);
    return h;
}
std::uint64_t hash_of(const Constant &constant) {
    std::uint64_t h = static_cast<std::uint64_t>(constant.type);
    for (int i = 0; i < components(constant.type); ++i)
        h = hash_combine(h,
                         std::bit_cast<std::uint64_t>(constant.value[static_cast<std::size_t>(i)]));
    return h;
}

// The type of an op whose rule is Given, where its arguments decide it.
Type given_type(const Graph &graph, Op op, std::span<const NodeId> args, std::uint32_t payload) {
    const auto type = [&](std::size_t i) { return graph.type(args[i]); };
    if (op == Op::MatMul) return is_matrix(type(0)) ? type(1) : type(0);
    if (op == Op::Make)
        return is_vector(type(0)) ? matrix_type(static_cast<int>(args.size()))
                                  : vector_type(static_cast<int>(args.size()));
    if (op == Op::Swizzle) return vector_type(swizzle_size(payload));
    if (op == Op::Column) return vector_type(side(type(0)));
    if (op == Op::ToInt || op == Op::HitPaint) return Type::Int;
    if (op == Op::HitPoint) return Type::Vec3;
    if (op == Op::HitExtra) return Type::Vec4;
    if (op == Op::Image) return Type::Vec4;
    if (op == Op::Call) return graph.type(graph.function(FunctionId{std::size_t{payload}}).result);
    if (op == Op::Loop) return graph.type(graph.loop(LoopId{std::size_t{payload}}).vars.front());
    if (op == Op::MakeHit || op == Op::NearestHit || op == Op::FarthestHit || op == Op::HitWith ||
        op == Op::FillPaint)
        return Type::Hit;
    assert(op == Op::ToFloat || op == Op::SpotNoise || op == Op::Grid);
    return Type::Float;
}

} // namespace

std::span<const NodeId> Graph::args(NodeId id) const {
    const Node &node = nodes_[id];
    return {args_.data() + node.first, node.count};
}

NodeId Graph::make(Op op, std::span<const NodeId> args) {
    switch (info(op).rule) {
    case TypeRule::Given: return make(op, given_type(*this, op, args, 0), args, 0);
    case TypeRule::Same: return make(op, type(args.front()), args, 0);
    case TypeRule::Last: return make(op, type(args.back()), args, 0);
    case TypeRule::ToFloat: return make(op, Type::Float, args, 0);
    case TypeRule::ToBool: return make(op, Type::Bool, args, 0);
    }
    return {};
}

NodeId Graph::make(Op op, Type type, std::span<const NodeId> args, std::uint32_t payload) {
    assert(info(op).arity < 0 ? !args.empty()
                              : args.size() == static_cast<std::size_t>(info(op).arity));
    assert(op != Op::Const);
    assert(op != Op::LoopResult || nodes_[args[0]].op == Op::Loop);
    if (info(op).rule == TypeRule::Same && op != Op::Transpose)
        for ([[maybe_unused]] NodeId arg : args) assert(this->type(arg) == type);
    if (const NodeId known = simplified(*this, op, type, args, payload)) return known;
    if (const NodeId constant = folded(op, type, args, payload)) return constant;
    return intern(op, type, args, payload);
}

NodeId Graph::make(Op op, std::initializer_list<NodeId> args) {
    return make(op, std::span<const NodeId>(args.begin(), args.size()));
}
NodeId Graph::make(Op op, Type type, std::initializer_list<NodeId> args, std::uint32_t payload) {
    return make(op, type, std::span<const NodeId>(args.begin(), args.size()), payload);
}

template <class Equal> NodeId &Graph::slot_of(std::uint64_t hash, const Equal &equal) {
    const auto free_or_equal = [](std::vector<NodeId> &slots, std::uint64_t of, const auto &same) {
        const std::size_t mask = slots.size() - 1;
        std::size_t at = of & mask;
        while (slots[at] && !same(slots[at])) at = (at + 1) & mask;
        return at;
    };
    if (nodes_.size() * 2 >= slots_.size()) {
        std::vector<NodeId> grown(std::max<std::size_t>(1024, slots_.size() * 4));
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const NodeId id{i};
            const Node &node = nodes_[id];
            const std::uint64_t of = is_constant(id)
                                         ? hash_of(constant_of(id))
                                         : hash_of(node.op, node.type, args(id), node.payload);
            grown[free_or_equal(grown, of, [](NodeId) { return false; })] = id;
        }
        slots_ = std::move(grown);
    }
    return slots_[free_or_equal(slots_, hash, equal)];
}

NodeId Graph::intern(Op op, Type type, std::span<const NodeId> args, std::uint32_t payload) {
    NodeId &slot = slot_of(hash_of(op, type, args, payload), [&](NodeId id) {
        const Node &node = nodes_[id];
        if (node.op != op || node.type != type || node.payload != payload ||
            node.count != args.size())
            return false;
        const std::span<const NodeId> have = this->args(id);
        return std::equal(have.begin(), have.end(), args.begin()) ||
               (commutes(op) && have[0] == args[1] && have[1] == args[0]);
    });
    if (!slot) slot = add_node(op, type, args, payload);
    return slot;
}

NodeId Graph::add_node(Op op, Type type, std::span<const NodeId> args, std::uint32_t payload) {
    Node node{op, type, payload, static_cast<std::uint32_t>(args_.size()),
              static_cast<std::uint32_t>(args.size())};
    const std::less<> before;
    if (!args.empty() && !before(args.data(), args_.data()) &&
        before(args.data(), args_.data() + args_.size())) { // another node's own arguments
        const std::vector<NodeId> copy(args.begin(), args.end());
        args_.insert(args_.end(), copy.begin(), copy.end());
    } else {
        args_.insert(args_.end(), args.begin(), args.end());
    }
    const NodeId id = nodes_.add(node);
    reads_.push_back(reads_of(nodes_[id]));
    of_scalars_.push_back(made_of_scalars(nodes_[id]));
    return id;
}

bool Graph::made_of_scalars(const Node &node) const {
    constexpr OpSet made{Op::Make, Op::Splat, Op::Const},
        by_component{Op::Add, Op::Sub, Op::Neg, Op::Mul,   Op::Div,
                     Op::Mix, Op::Min, Op::Max, Op::Clamp, Op::Select};
    if (!is_vector(node.type) || made[node.op]) return is_vector(node.type);
    if (!by_component[node.op]) return false;
    for (std::uint32_t i = 0; i < node.count; ++i) {
        const NodeId arg = args_[node.first + i];
        if (is_vector(type(arg)) && !of_scalars_[arg.index]) return false;
    }
    return true;
}

std::optional<NodeId> Graph::scalar_part(NodeId vector, int i, int depth) {
    constexpr int max_depth = 200;
    if (!of_scalars_[vector.index] || depth > max_depth) return {};
    const Node node = nodes_[vector];
    if (node.op == Op::Make || node.op == Op::Splat || node.op == Op::Const)
        return component(vector, i);
    const std::uint64_t key = std::uint64_t(vector.index) * 4 + std::uint64_t(i);
    if (const auto known = scalar_parts_.find(key); known != scalar_parts_.end())
        return known->second;
    const std::span<const NodeId> all = args(vector);
    std::vector<NodeId> parts(all.begin(), all.end());
    for (NodeId &part : parts) {
        if (!is_vector(type(part))) continue;
        const auto scalar = scalar_part(part, i, depth + 1);
        if (!scalar) return {};
        part = *scalar;
    }
    return scalar_parts_[key] = make(node.op, Type::Float, parts, node.payload);
}

NodeId Graph::folded(Op op, Type type, std::span<const NodeId> args, std::uint32_t payload) {
    if (args.empty()) return {};
    for (NodeId arg : args)
        if (!is_constant(arg)) return {};
    folding_.clear();
    for (NodeId arg : args) folding_.push_back(constant_of(arg));
    const std::optional<Constant> result = evaluate(op, type, folding_, payload);
    if (!result) return {};
    for (double value : result->value)
        if (std::isnan(value)) return {}; // stays an operation, so that no text has to spell it
    return constant(*result);
}

// -- leaves

NodeId Graph::constant(const Constant &wanted) {
    Constant value = wanted;
    const std::size_t count = static_cast<std::size_t>(components(value.type));
    for (std::size_t i = 0; i < count; ++i)
        if (value.value[i] == 0) value.value[i] = 0; // -0 is the same number
    std::fill(value.value.begin() + static_cast<std::ptrdiff_t>(count), value.value.end(), 0.0);
    NodeId &slot = slot_of(hash_of(value), [&](NodeId id) {
        return is_constant(id) && type(id) == value.type &&
               std::memcmp(&numbers_[nodes_[id].payload], value.value.data(),
                           count * sizeof(double)) == 0;
    });
    if (slot) return slot;
    const auto first = static_cast<std::uint32_t>(numbers_.size());
    numbers_.insert(numbers_.end(), value.value.begin(),
                    value.value.begin() + static_cast<std::ptrdiff_t>(count));
    return slot = add_node(Op::Const, value.type, {}, first);
}

NodeId Graph::number(double value) { return constant({Type::Float, {value}}); }
NodeId Graph::integer(int value) { return constant({Type::Int, {static_cast<double>(value)}}); }
NodeId Graph::boolean(bool value) { return constant({Type::Bool, {value ? 1.0 : 0.0}}); }
NodeId Graph::vec(std::span<const double> values) {
    Constant result{vector_type(static_cast<int>(values.size())), {}};
    std::copy(values.begin(), values.end(), result.value.begin());
    return constant(result);
}
NodeId Graph::vec3(double x, double y, double z) { return constant({Type::Vec3, {x, y, z}}); }
NodeId Graph::point(Type type) { return intern(Op::Point, type, {}, 0); }
NodeId Graph::fresh_var(Type type) { return intern(Op::Var, type, {}, vars_++); }
NodeId Graph::param(std::uint32_t index, Type type) { return intern(Op::Param, type, {}, index); }
NodeId Graph::time() { return intern(Op::Time, Type::Float, {}, 0); }

Constant Graph::constant_of(NodeId id) const {
    assert(is_constant(id));
    Constant constant{type(id), {}};
    std::copy_n(&numbers_[nodes_[id].payload], components(constant.type), constant.value.begin());
    return constant;
}

std::optional<double> Graph::as_number(NodeId id) const {
    if (!is_constant(id) || components(type(id)) != 1) return std::nullopt;
    return numbers_[nodes_[id].payload];
}

// -- short forms

namespace {
NodeId spread(Graph &graph, Op op, NodeId a, NodeId b) {
    if (graph.type(a) == Type::Float && graph.type(b) != Type::Float)
        a = graph.splat(a, graph.type(b));
    if (graph.type(b) == Type::Float && graph.type(a) != Type::Float)
        b = graph.splat(b, graph.type(a));
    return graph.make(op, {a, b});
}
} // namespace

NodeId Graph::add(NodeId a, NodeId b) { return spread(*this, Op::Add, a, b); }
NodeId Graph::sub(NodeId a, NodeId b) { return spread(*this, Op::Sub, a, b); }
NodeId Graph::mul(NodeId a, NodeId b) { return spread(*this, Op::Mul, a, b); }
NodeId Graph::div(NodeId a, NodeId b) { return spread(*this, Op::Div, a, b); }
NodeId Graph::neg(NodeId a) { return make(Op::Neg, {a}); }
NodeId Graph::component(NodeId vector, int i) {
    if (type(vector) == Type::Float) return vector;
    return swizzle(vector, std::array{i});
}
NodeId Graph::swizzle(NodeId vector, std::span<const int> parts) {
    return make(Op::Swizzle, vector_type(static_cast<int>(parts.size())), {vector},
                swizzle_mask(parts));
}
NodeId Graph::splat(NodeId scalar, Type to) {
    return type(scalar) == to ? scalar : make(Op::Splat, to, {scalar});
}
NodeId Graph::call(FunctionId id, std::span<const NodeId> args) {
    return make(Op::Call, type(function(id).result), args, id.index);
}

// -- what nodes refer to

std::size_t Graph::bytes() const {
    constexpr std::size_t hashed = 48; // what a hash table adds
    return nodes_.size() * (sizeof(Node) + sizeof(Reads) + 2 * sizeof(NodeId)) +
           args_.size() * sizeof(NodeId) + numbers_.size() * sizeof(double) +
           functions_.size() * (sizeof(Function) + hashed) +
           loops_.size() * (sizeof(Loop) + hashed) + table_bytes_;
}

FunctionId Graph::add_function(Function function) { return functions_.add(std::move(function)); }
LoopId Graph::add_loop(Loop loop) {
    make_exit_conditions(*this, loop);
    return loops_.add(std::move(loop));
}
void Graph::change_loop(LoopId id, Loop loop) { loops_[id] = std::move(loop); }
TableId Graph::add_table(Table table) {
    std::uint64_t h = hash_combine(static_cast<std::uint64_t>(table.rows),
                                   static_cast<std::uint64_t>(table.stride));
    for (float x : table.data) h = hash_combine(h, std::bit_cast<std::uint32_t>(x));
    const auto [first, last] = interned_tables_.equal_range(h);
    for (auto it = first; it != last; ++it) {
        const Table &have = tables_[it->second];
        if (have.rows == table.rows && have.stride == table.stride &&
            have.computed == table.computed &&
            std::equal(have.data.begin(), have.data.end(), table.data.begin(), table.data.end()))
            return it->second;
    }
    table_bytes_ += sizeof table + table.data.size() * sizeof(float);
    const TableId id = tables_.add(std::move(table));
    interned_tables_.emplace(h, id);
    return id;
}
CacheId Graph::add_cache(Cache cache) { return caches_.add(cache); }

} // namespace fathom::ir
