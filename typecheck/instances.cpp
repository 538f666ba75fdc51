// Lists of like shapes become one shape over a table: `for i in 0..256 { sphere(0.1).translate([…])
// }` is one `Instances` whose rows hold what differs, so that neither the shader nor the proof
// grows with the count.
//
// Two shapes are alike when their trees differ in constants only. A shape's *skeleton* is its tree
// with the constants taken out, in the order of a walk; the constants, in that order, are its row.
#include "typecheck/instances.h"
#include "typecheck/closed_forms.h"

#include "ir/passes/rows.h"
#include "ir/passes/walk.h"

#include <algorithm>
#include <functional>
#include <map>

namespace fathom::typecheck {

using ir::NodeId;
using ir::Op;
using ir::ShapeId;
using ir::ShapeKind;
using ir::Type;

namespace {

constexpr std::size_t min_instances = 8;
constexpr std::size_t largest_walk = 4000; // parts of one shape; larger ones stay as they are

struct SkeletonBuilder {
    const ir::Scene &scene;
    ir::Skeleton tree{};
    std::vector<bool>
        stated{}; // by row: a library call's number or claim, which no evaluator reads
    bool in_statement = false;
    bool too_large = false;

    void node(NodeId id) {
        too_large = too_large || !ir::take_apart(scene.graph, id, largest_walk, tree);
        stated.resize(tree.row.size(), in_statement);
    }
    void region(const ir::Region &r) {
        tree.words.push_back(static_cast<std::uint64_t>(r.kind) << 8 |
                             static_cast<std::uint64_t>(r.axis + 1));
        node(r.center), node(r.size);
        tree.words.push_back(r.less.size());
        for (const ir::Region &l : r.less) region(l);
    }
    void shape(ShapeId id) {
        too_large = too_large || tree.words.size() > largest_walk;
        if (too_large) return;
        const ir::Shape &s = scene.shapes[id];
        tree.words.push_back(
            static_cast<std::uint64_t>(s.kind) << 40 | static_cast<std::uint64_t>(s.map) << 32 |
            static_cast<std::uint64_t>(s.dims) << 24 | static_cast<std::uint64_t>(s.axis) << 16 |
            static_cast<std::uint64_t>(s.towards) << 8);
        tree.words.push_back(static_cast<std::uint64_t>(s.assumed * 1e6));
        tree.words.push_back(static_cast<std::uint64_t>(s.estimate * 1e6));
        tree.words.push_back(s.children.size() << 16 | s.args.size());
        switch (s.kind) {
        case ShapeKind::Within: region(scene.shapes.regions[s.payload]); break;
        case ShapeKind::Paint:
        case ShapeKind::Repaint: {
            const ir::Material &m = scene.shapes.materials[s.payload];
            node(m.diffuse), node(m.specular), node(m.exponent), node(m.emission);
            tree.words.push_back(static_cast<std::uint64_t>(m.texture.image + 1));
            break;
        }
        case ShapeKind::Library: {
            const ir::Library &l = scene.shapes.libraries[s.payload];
            tree.words.push_back(std::hash<std::string>{}(l.name));
            in_statement = true;
            for (const auto &[name, argument] : l.arguments) node(argument);
            tree.words.push_back(static_cast<std::uint64_t>(l.claims.kind) << 4 |
                                 l.has_claims << 3 | l.claims.symmetric[0] << 2 |
                                 l.claims.symmetric[1] << 1 | l.claims.symmetric[2]);
            node(l.claims.lipschitz), node(l.claims.lo), node(l.claims.hi),
                node(l.claims.growth_rate);
            for (NodeId moment_arm : l.claims.moment_arm) node(moment_arm);
            in_statement = false;
            break;
        }
        // these hold variables or a instance_table of their own: alike only where they are the same
        case ShapeKind::Repeat:
        case ShapeKind::Instances:
        case ShapeKind::Contract:
        case ShapeKind::Blend:
        case ShapeKind::Seam:
        case ShapeKind::Empty:
        case ShapeKind::Leaf:
        case ShapeKind::Union:
        case ShapeKind::Intersection:
        case ShapeKind::Complement:
        case ShapeKind::Xor:
        case ShapeKind::Lerp:
        case ShapeKind::PseudoNorm:
        case ShapeKind::Map:
        case ShapeKind::Offset:
        case ShapeKind::Shell:
        case ShapeKind::Displace:
        case ShapeKind::Extrude:
        case ShapeKind::Mixed: tree.words.push_back(s.payload); break;
        }
        for (NodeId a : s.args) node(a);
        for (ShapeId c : s.children) shape(c);
    }
};

// A tree of shapes with other expressions, in the same order.
struct Rebuild {
    Interpreter &ev;
    std::function<NodeId(NodeId)> node;

    ir::Region region(ir::Region r) {
        r.center = node(r.center), r.size = node(r.size);
        for (ir::Region &l : r.less) l = region(l);
        return r;
    }
    ShapeId shape(ShapeId id) {
        ir::Shape s = ev.scene.shapes[id];
        if (s.kind == ShapeKind::Within) {
            ir::Region r = region(ev.scene.shapes.regions[s.payload]);
            s.payload = intern_region(ev, r);
        } else if (s.kind == ShapeKind::Paint || s.kind == ShapeKind::Repaint) {
            ir::Material m = ev.scene.shapes.materials[s.payload];
            m.diffuse = node(m.diffuse), m.specular = node(m.specular),
            m.exponent = node(m.exponent), m.emission = node(m.emission);
            s.payload = intern_material(ev, m);
        } else if (s.kind == ShapeKind::Library) {
            ir::Library l = ev.scene.shapes.libraries[s.payload];
            for (auto &[name, argument] : l.arguments) argument = node(argument);
            l.claims.lipschitz = node(l.claims.lipschitz), l.claims.lo = node(l.claims.lo),
            l.claims.hi = node(l.claims.hi), l.claims.growth_rate = node(l.claims.growth_rate);
            for (NodeId &moment_arm : l.claims.moment_arm) moment_arm = node(moment_arm);
            s.payload = static_cast<std::uint32_t>(ev.scene.shapes.libraries.size());
            ev.scene.shapes.libraries.push_back(std::move(l));
        }
        for (NodeId &a : s.args) a = node(a);
        for (ShapeId &c : s.children) c = shape(c);
        return ev.scene.shapes.add(std::move(s));
    }
};

void region_nodes(const ir::Region &r, std::vector<NodeId> &out) {
    out.push_back(r.center), out.push_back(r.size);
    for (const ir::Region &less : r.less) region_nodes(less, out);
}

// The columns that differ, as a table: of those that evaluators read (stated: false), or of the
// library's statements, so that a shader holds the first alone. Fills `replacement` for the columns
// it took.
bool add_columns(Interpreter &ev, const std::vector<ir::Row> &rows, const std::vector<bool> &wanted,
                 NodeId index, std::vector<NodeId> &replacement) {
    ir::Graph &g = ev.scene.graph;
    ir::Table table;
    std::vector<int> column;
    table.rows = static_cast<int>(rows.size());
    table.stride = ir::lay_out(g, rows, wanted, 0, column);
    if (table.stride > ir::max_columns) return false;
    if (table.stride == 0) return true;
    const auto stride = static_cast<std::size_t>(table.stride);
    table.data.resize(rows.size() * stride);
    for (std::size_t r = 0; r < rows.size(); ++r)
        ir::fill_row(g, rows[r], column, table.data.data() + r * stride);
    ir::TableId id = g.add_table(std::move(table));
    for (std::size_t c = 0; c < column.size(); ++c)
        if (column[c] >= 0)
            replacement[c] =
                ir::read_table(g, g.type(rows[0][c]), index, ir::table_slot(id, column[c]));
    return true;
}

ShapeId add_instance_table(Interpreter &ev, ir::InstanceTable instance_table, ShapeId copy,
                           NodeId k, int dims) {
    ir::Shape many;
    many.kind = ShapeKind::Instances;
    many.dims = static_cast<std::uint8_t>(dims);
    many.children = {copy};
    many.origin = ev.scene.shapes[copy].origin;
    if (instance_table.smooth) many.args = {k};
    many.payload = static_cast<std::uint32_t>(ev.scene.shapes.instance_tables.size());
    ev.scene.shapes.instance_tables.push_back(instance_table);
    return ev.scene.shapes.add(std::move(many));
}

ir::InstanceTable instance_table_of(Interpreter &ev, std::size_t count, bool smooth) {
    return {ev.scene.graph.fresh_var(Type::Int), static_cast<int>(count), smooth};
}

ShapeId make_instance_table(Interpreter &ev, const std::vector<ShapeId> &members,
                            const std::vector<ir::Row> &rows, const std::vector<bool> &stated,
                            bool smooth, NodeId k, int dims) {
    const ir::InstanceTable instance_table = instance_table_of(ev, members.size(), smooth);
    std::vector<NodeId> replacement(rows[0].size());
    std::vector<bool> read = stated;
    read.flip();
    if (!add_columns(ev, rows, read, instance_table.index, replacement)) return {};
    if (!add_columns(ev, rows, stated, instance_table.index, replacement)) return {};
    const auto read_or_cached = [&](std::size_t c, NodeId constant) {
        return replacement[c] ? replacement[c] : constant;
    };
    std::size_t next = 0;
    Rebuild rebuild{
        ev, [&](NodeId id) { return ir::put_together(ev.scene.graph, id, read_or_cached, next); }};
    return add_instance_table(ev, instance_table, rebuild.shape(members[0]), k, dims);
}

// The iterations of one loop: its body's shape, which reads what depends on the iteration from a
// table. Columns with a formula stand in a table of their own, so that a text may do without it.
std::optional<ShapeId> instances_of_iterations(Interpreter &ev, const std::vector<ShapeId> &members,
                                               bool smooth, NodeId k, int dims) {
    const std::optional<IterationTable> iterations = table_of_iterations(ev, members);
    if (!iterations) return std::nullopt;
    ir::Graph &g = ev.scene.graph;
    const ir::InstanceTable instance_table = instance_table_of(ev, members.size(), smooth);
    ir::Substitution reads;
    for (bool computed : {true, false}) {
        ir::Table table;
        table.rows = static_cast<int>(members.size());
        std::vector<std::size_t> columns;
        std::vector<int> offset;
        for (std::size_t c = 0; c < iterations->places.size(); ++c) {
            if (static_cast<bool>(iterations->formulas[c]) != computed) continue;
            columns.push_back(c), offset.push_back(table.stride);
            table.stride += ir::components(g.type(iterations->places[c]));
        }
        if (columns.empty()) continue;
        if (table.stride > ir::max_columns) return std::nullopt;
        for (const auto &row : iterations->rows)
            for (std::size_t c : columns)
                for (int i = 0; i < ir::components(row[c].type); ++i)
                    table.data.push_back(
                        static_cast<float>(row[c].value[static_cast<std::size_t>(i)]));
        for (std::size_t j = 0; j < columns.size() && computed; ++j) {
            NodeId formula = iterations->formulas[columns[j]];
            Type type = g.type(formula);
            if (type == Type::Int || type == Type::Bool)
                formula = g.make(Op::ToFloat, Type::Float, {formula});
            table.computed.emplace_back(
                offset[j], g.add_function({"of_row",
                                           ev.scene.shapes[iterations->symbolic].origin,
                                           {iterations->row},
                                           formula}));
        }
        ir::TableId id = g.add_table(std::move(table));
        for (std::size_t j = 0; j < columns.size(); ++j) {
            NodeId place = iterations->places[columns[j]];
            reads[place] = ir::read_table(g, g.type(place), instance_table.index,
                                          ir::table_slot(id, offset[j]));
        }
    }
    Rebuild rebuild{ev, [&](NodeId id) { return id ? ir::substitute(g, id, reads) : id; }};
    return add_instance_table(ev, instance_table, rebuild.shape(iterations->symbolic), k, dims);
}

} // namespace

// Every expression of a tree of shapes; of one with more parts than a walk takes, more than that
// many, and not all.
void shape_nodes(const ir::Scene &scene, ShapeId id, std::vector<NodeId> &out) {
    if (out.size() > largest_walk) return;
    out.push_back({}); // a shape counts, also one without any
    const ir::Shape &s = scene.shapes[id];
    if (s.kind == ShapeKind::Within) region_nodes(scene.shapes.regions[s.payload], out);
    if (s.kind == ShapeKind::Paint || s.kind == ShapeKind::Repaint) {
        const ir::Material &m = scene.shapes.materials[s.payload];
        out.insert(out.end(), {m.diffuse, m.specular, m.exponent, m.emission});
    }
    if (s.kind == ShapeKind::Library) {
        const ir::Library &l = scene.shapes.libraries[s.payload];
        for (const auto &[name, argument] : l.arguments) out.push_back(argument);
        out.insert(out.end(), {l.claims.lipschitz, l.claims.lo, l.claims.hi, l.claims.growth_rate});
        out.insert(out.end(), l.claims.moment_arm.begin(), l.claims.moment_arm.end());
    }
    out.insert(out.end(), s.args.begin(), s.args.end());
    for (ShapeId child : s.children) shape_nodes(scene, child, out);
}

// Order matters to colours only on ties, so a plain union may gather its like members from anywhere
// in the list.
std::vector<ShapeId> gather_instances(Interpreter &ev, std::vector<ShapeId> shapes, int dims,
                                      Span place) {
    if (shapes.size() < min_instances) return shapes;
    struct Group {
        std::vector<std::size_t> members;
        std::vector<ir::Row> rows;
        std::vector<bool> stated;
    };
    std::vector<bool> taken(shapes.size(), false);
    std::map<std::size_t, ShapeId> made; // by the first member's place, to keep a stable order
    std::map<ShapeId, std::vector<std::size_t>> loops; // iterations by their body's shape
    for (std::size_t i = 0; i < shapes.size(); ++i)
        if (auto iteration = ev.iterations.find(shapes[i].index); iteration != ev.iterations.end())
            loops[iteration->second.symbolic].push_back(i);
    for (const auto &[symbolic, places] : loops) {
        std::vector<ShapeId> members;
        for (std::size_t i : places) members.push_back(shapes[i]);
        auto instance_table = instances_of_iterations(ev, members, false, {}, dims);
        if (!instance_table) continue;
        for (std::size_t i : places) taken[i] = true;
        made[places[0]] = *instance_table;
    }
    std::map<std::vector<std::uint64_t>, Group> groups;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        if (taken[i] || ev.scene.shapes[shapes[i]].kind == ShapeKind::Instances) continue;
        SkeletonBuilder builder{ev.scene};
        builder.shape(shapes[i]);
        constexpr std::size_t words_of_a_step = 8; // in time
        if (!spend(ev, place, 1 + builder.tree.words.size() / words_of_a_step)) return shapes;
        if (builder.too_large || builder.tree.row.empty()) continue;
        Group &g = groups[builder.tree.words];
        g.members.push_back(i);
        builder.tree.row.shrink_to_fit();
        g.rows.push_back(std::move(builder.tree.row));
        g.stated = std::move(builder.stated);
    }
    for (auto &[skeleton, g] : groups) {
        if (g.members.size() < min_instances) continue;
        std::vector<ShapeId> members;
        for (std::size_t i : g.members) members.push_back(shapes[i]);
        ShapeId instance_table =
            make_instance_table(ev, members, g.rows, g.stated, false, {}, dims);
        if (!instance_table) continue;
        for (std::size_t i : g.members) taken[i] = true;
        made[g.members[0]] = instance_table;
    }
    std::vector<ShapeId> out;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        if (auto it = made.find(i); it != made.end())
            out.push_back(it->second);
        else if (!taken[i])
            out.push_back(shapes[i]);
    }
    return out;
}

// A smooth union folds in the order written, so only a list that is alike as a whole becomes a
// instance_table.
std::optional<ShapeId> smooth_instances(Interpreter &ev, const std::vector<ShapeId> &shapes,
                                        NodeId k, int dims) {
    if (shapes.size() < min_instances) return std::nullopt;
    if (auto iterations = instances_of_iterations(ev, shapes, true, k, dims)) {
        ev.scene.shapes.listed.emplace(*iterations, shapes);
        return iterations;
    }
    std::vector<ir::Row> rows;
    std::vector<std::uint64_t> skeleton;
    std::vector<bool> stated;
    for (ShapeId s : shapes) {
        SkeletonBuilder builder{ev.scene};
        builder.shape(s);
        if (builder.too_large || (!rows.empty() && builder.tree.words != skeleton))
            return std::nullopt;
        skeleton = std::move(builder.tree.words);
        builder.tree.row.shrink_to_fit();
        rows.push_back(std::move(builder.tree.row));
        stated = std::move(builder.stated);
    }
    ShapeId instance_table = make_instance_table(ev, shapes, rows, stated, true, k, dims);
    if (instance_table) ev.scene.shapes.listed.emplace(instance_table, shapes);
    return instance_table ? std::optional(instance_table) : std::nullopt;
}

// The union, flat: unions inside are opened, what is nowhere is left out, what stands twice stands
// once.
ShapeId unite(Interpreter &ev, std::vector<ShapeId> shapes, int dims, Span origin) {
    std::vector<ShapeId> flat, listed;
    std::map<std::uint32_t, bool> seen;
    for (ShapeId id : shapes) {
        const ir::Shape &s = ev.scene.shapes[id];
        if (s.kind == ShapeKind::Empty) continue;
        std::vector<ShapeId> parts{id};
        if (s.kind == ShapeKind::Union) {
            parts = s.children;
            auto inner = ev.scene.shapes.listed.find(id);
            const auto &all = inner == ev.scene.shapes.listed.end() ? parts : inner->second;
            listed.insert(listed.end(), all.begin(), all.end());
        } else
            listed.push_back(id);
        if (!spend(ev, origin, 4 * parts.size())) return id; // each is looked up and copied
        for (ShapeId part : parts)
            if (!std::exchange(seen[part.index], true)) flat.push_back(part);
    }
    flat = gather_instances(ev, std::move(flat), dims, origin);
    const bool gathered = flat != listed;
    ir::Shape out;
    out.dims = static_cast<std::uint8_t>(dims);
    out.origin = origin;
    if (flat.size() == 1) {
        const bool doubles = std::find(listed.begin(), listed.end(), flat[0]) != listed.end();
        if (gathered && !doubles) ev.scene.shapes.listed.emplace(flat[0], std::move(listed));
        if (!gathered || !doubles) return flat[0];
        // the same shape several times: a union of one, so that what was listed has a shape to
        // stand by
    }
    if (!flat.empty()) out.kind = ShapeKind::Union, out.children = std::move(flat);
    ShapeId united = ev.scene.shapes.add(std::move(out));
    if (gathered) ev.scene.shapes.listed.emplace(united, std::move(listed));
    return united;
}

} // namespace fathom::typecheck
