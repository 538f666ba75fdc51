// The scene tree: one pass over its nodes, each written as an expression when its last property was
// read. What an export of the written text would not give back by itself (groups that unions
// dissolve, names, nodes left out) is recorded.
#include "save-format/import/node_text.h"
#include "save-format/import/tree_reader.h"
#include "save-format/yaml_writer.h"

#include "base/encode.h"
#include "base/suggest.h"
#include "base/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <optional>

namespace fathom::save {
std::string TreeReader::path_text() const {
    std::string text;
    for (const std::size_t index : path_) {
        if (!text.empty()) text += '/';
        text += fmt::to_string(index);
    }
    return text;
}

namespace {

// "Sphere 12" says no more than that it is a sphere.
bool is_default_name(std::string_view name, std::string_view type) {
    if (name.empty()) return true;
    if (name.substr(0, type.size()) != type) return false;
    return std::all_of(name.begin() + static_cast<std::ptrdiff_t>(type.size()), name.end(),
                       [](char c) { return c == ' ' || (c >= '0' && c <= '9'); });
}

void add_comment(Piece &piece, std::string_view comment) {
    if (!piece.comment.empty()) piece.comment += ", ";
    piece.comment += for_comment(cut(comment, 200));
}

// Statements nest as deep as blocks do; the language reads 256 levels, and people fewer.
constexpr std::size_t block_limit = 24;

} // namespace

void TreeReader::children(const Event &key, const NodeTypeRow *row, Body &body, Children &into,
                          Properties &properties) {
    Event list = in_.reader.next();
    if (list.kind == EventKind::Broken) return;
    const bool null = list.kind == EventKind::Scalar && list.plain && is_none(list.text);
    if (list.kind != EventKind::SequenceStart || into.given) {
        if (!null)
            in_.report.content(key.span, into.given ? "`Children` is given twice"
                                                    : "`Children` has to be a list of nodes");
        std::string flow;
        take_flow(in_.reader, std::move(list), flow);
        if (!into.given && !null) properties.keep("Children", flow);
        return;
    }
    into.given = true;
    const NodeType type = row ? row->type : NodeType::Generic;
    const bool first_alone = type == NodeType::Difference || type == NodeType::Blend ||
                             type == NodeType::PseudoNormBlend || type == NodeType::Seam;
    for (;; ++into.read) {
        Event event = in_.reader.next();
        if (event.kind == EventKind::SequenceEnd || event.kind == EventKind::Broken ||
            event.kind == EventKind::End) {
            // the last piece has to be the one that a transform's call is appended to
            if (into.read > 1 && body.size() == into.rest_mark + 1) body.pop_back();
            return;
        }
        Place place = Place::United;
        if (type == NodeType::Intersection) place = Place::Intersected;
        if (type == NodeType::ProfileBlend || (first_alone && into.read == 0)) place = Place::Alone;
        if (into.read == 1) {
            into.rest_mark = body.size();
            body.emplace_back();
        }
        path_.push_back(into.read);
        Result result = node(event, place, body, false);
        path_.pop_back();
        if (!result.contributed) continue;
        into.display = into.pieces == 0 ? result.display : std::string();
        into.dissolves = into.pieces == 0 ? result.dissolves : std::nullopt;
        ++into.pieces;
        into.base += result.base;
        if (into.read == 0) {
            into.first = true;
            into.first_base = result.base;
            into.first_end = body.size();
        } else {
            ++into.rest_pieces;
        }
    }
}

void TreeReader::read_properties(Event event, const NodeTypeRow *row, const std::string &type,
                                 Body &body, Children &into, Properties &properties) {
    static const NodeTypeRow nothing{NodeType::Generic, "", Arity::Many, {}};
    const std::string of = "`" + std::string(cut(type, 80)) + "`";
    for (;;) {
        event = in_.reader.next();
        if (event.kind == EventKind::MappingEnd || event.kind == EventKind::Broken ||
            event.kind == EventKind::End)
            return;
        const bool has_children = !row || row->children != Arity::Leaf;
        if (event.kind == EventKind::Scalar && has_children &&
            spelling_key(event.text) == "children") {
            const PropertyType *differ = row ? find_property(*row, "Differ") : nullptr;
            into.differ =
                differ &&
                properties.values[static_cast<std::size_t>(differ - row->properties.data())]
                        .number[0] != 0;
            in_.words.copies += into.differ;
            children(event, row, body, into, properties);
            in_.words.copies -= into.differ;
        } else if (!row) { // already reported as a whole
            std::string key, value;
            const std::string name = event.text;
            const bool scalar = event.kind == EventKind::Scalar;
            take_flow(in_.reader, std::move(event), key);
            take_flow(in_.reader, in_.reader.next(), value);
            if (scalar) {
                properties.keep(name, value);
            } else {
                properties.unknown +=
                    (properties.unknown.empty() ? "? " : ", ? ") + key + ": " + value;
            }
        } else {
            in_.read_property(row ? *row : nothing, event, properties, of);
        }
    }
}

namespace {

// A node of the file, read, and what it becomes: in the text, behind `begin`, and as a record in its
// slot, for an export.
struct NodeForm {
    Importer &in_;
    const NodeTypeRow *row; // none: the type is unknown, or cannot be used
    std::string type;
    Span type_span;
    std::string name, name_flow, path;
    Place place;
    std::size_t slot; // of Importer::kept
    Body &target;
    std::size_t begin;
    bool usable, custom; // custom: the name is no default one
    Properties properties{};
    Children kids{};
    Result result{};
    bool based = false; // an export has a node of this type here
    std::string base_type{};

    std::uint32_t part() const { return type_span.begin; }
    void keep_given();
    void as_group(std::size_t base);
    void unite();
    void group(std::size_t base);
    void hold();
    void combine();
    void transform();
    void leaf();
    void settle();
};

void NodeForm::keep_given() {
    for (std::size_t i = 0; row && i < row->properties.size(); ++i) {
        const PropertyType &property = row->properties[i];
        if (properties.values[i].given && property.kind != PropertyKind::Carried)
            properties.keep(property.name, property_flow(property, properties.values[i]));
    }
    if (!properties.varying.entries.empty())
        properties.keep("Varying", flow_text(properties.varying));
}

// A head that an export cannot know is recorded with all that it said.
void NodeForm::as_group(std::size_t base) {
    keep_given();
    in_.kept[slot] = {"group",
                      path,
                      fmt::format("[{}, {}, {}, {{{}}}]", base, flow_scalar(type, true), name_flow,
                                  properties.unknown),
                      {},
                      true};
}

// The children, in their united form, as this node's expression.
void NodeForm::unite() {
    if (kids.pieces > 1) {
        target[begin] = {Piece::Kind::Open, "union {", {}};
        target.push_back({Piece::Kind::Close, "}", {}});
    }
    result.contributed = kids.pieces > 0;
}

// A node that means no more than the union of its children.
void NodeForm::group(std::size_t base) {
    if (place == Place::United || base == 1) {
        as_group(base);
        result.base = base;
    } else {
        if (base_type != "Union")
            in_.kept[slot] = {"type", path, flow_scalar(type, true), {}, true};
        based = true;
    }
}

// An operator of which one operand is left is no more than that; but a group that would dissolve in
// its new place needs something to stand in.
void NodeForm::hold() {
    target[begin] = {Piece::Kind::Open, "difference {", {}};
    target.push_back({Piece::Kind::Line, "empty", {}});
    target.push_back({Piece::Kind::Close, "}", {}});
    keep_given();
    if (base_type != "Difference")
        in_.kept[slot] = {"type", path, flow_scalar(type, true), {}, true};
    based = true;
}

void NodeForm::combine() {
    const NodeType kind = row ? row->type : NodeType::Generic;
    if (kind == NodeType::Generic || kind == NodeType::Union) {
        unite();
        const std::string paint = row && result.contributed
                                      ? paint_call(in_, *row, properties, type_span)
                                      : std::string();
        if (!paint.empty()) {
            target.back().text += chain_mark + marked(part(), paint);
            based = true;
        } else if (result.contributed) {
            group(kids.base);
        }
    } else if (kind == NodeType::Intersection) {
        result.contributed = kids.pieces > 0;
        if (kids.pieces > 1) {
            target[begin] = {Piece::Kind::Open, "intersection {", {}};
            target.push_back({Piece::Kind::Close, "}", {}});
        }
        if (kids.pieces == 1 && kids.dissolves == place) {
            hold();
        } else if (kids.base == 1 || (place == Place::Intersected && result.contributed)) {
            as_group(kids.base);
            result.base = kids.base;
        } else {
            based = result.contributed;
        }
    } else if (!kids.first && kind != NodeType::ProfileBlend) {
        // Without its first operand there is nothing that the rest could be taken from or
        // blended with.
        if (kids.pieces > 0)
            in_.report.content(type_span,
                               "the first child of this node is missing, so that it is left out");
    } else if (kids.pieces == 1) {
        result.contributed = true;
        if (kids.dissolves == place)
            hold();
        else
            group(kids.base);
    } else if (kids.pieces > 1) {
        result.contributed = based = true;
        operator_text(in_, *row, properties, target, begin, kids.first_end, kids.rest_mark,
                      kids.rest_pieces, type_span);
        for (Piece *piece : {&target[begin], &target.back()})
            piece->text = marked(part(), std::move(piece->text));
        if (target[target.size() - 2].kind == Piece::Kind::Line) // its last argument
            target[target.size() - 2].text =
                marked(part(), std::move(target[target.size() - 2].text));
    }
}

void NodeForm::transform() {
    const std::string call = transform_call(in_, *row, properties, type_span);
    if (kids.differ && kids.pieces > 0 && call.ends_with(")")) {
        // `s.repeat(…, copies: …)` needs of s only that it is a shape
        target[begin] = {Piece::Kind::Open,
                         marked(part(), "sphere(1)") + call.substr(0, call.size() - 1) +
                             ", copies: (_, " + copy_name(in_.words.copies) + ") => union {",
                         {}};
        target.push_back({Piece::Kind::Close, "})", {}});
        result.contributed = true;
    } else {
        unite();
    }
    if (result.contributed && kids.differ) {
        based = true;
    } else if (!result.contributed) {
    } else if (call.empty()) {
        group(kids.base);
    } else {
        target.back().text += chain_mark;
        target.back().text += marked(part(), call);
        based = true;
    }
    if (kids.pieces == 1 && !custom) result.display = kids.display;
}

void NodeForm::leaf() {
    std::string text = usable ? leaf_text(in_, *row, properties, type_span) : std::string();
    if (!text.empty()) {
        target.push_back({Piece::Kind::Line, marked(part(), std::move(text)), {}});
        result.contributed = based = true;
    }
}

// Where a place of its kind would dissolve it, and how many nodes an export has there.
void NodeForm::settle() {
    const bool held = based && target[begin].text == "difference {"; // not marked: `hold` made it
    if (!based)
        result.dissolves = kids.dissolves;
    else if (!held && (!row || row->type == NodeType::Generic || row->type == NodeType::Union))
        result.dissolves = Place::United;
    else if (!held && row->type == NodeType::Intersection)
        result.dissolves = Place::Intersected;
    if (based) {
        result.base = 1;
        // An export names nodes by their type and its ordinal among the nodes that it finds itself,
        // children first.
        const bool named =
            row && name == fmt::format("{} {}", base_type,
                                       ++in_.ordinals[static_cast<std::size_t>(row->type)]);
        if (!named) in_.keep("name", path, name_flow);
        if (!properties.unknown.empty())
            in_.keep("properties", path, "{" + properties.unknown + "}");
    }
}

} // namespace

// The rest of a node whose first item is no type.
void TreeReader::keep_untyped(Event event) {
    in_.report.content(event.span, "a node's type has to be text")
        .note("the node is left out, and kept for an export");
    std::string flow = "[";
    if (event.kind != EventKind::SequenceEnd) {
        take_flow(in_.reader, std::move(event), flow);
        in_.rest_of_sequence(flow);
    } else {
        flow += ']';
    }
    keep("node", std::move(flow));
}

// What stands in a node behind its properties.
void TreeReader::keep_extra(Event event) {
    in_.report
        .content(event.span, "a node has a type, a name and one mapping of properties, and no more")
        .note("the rest is kept for an export");
    std::string flow = "[";
    take_flow(in_.reader, std::move(event), flow);
    in_.rest_of_sequence(flow);
    keep("extra", std::move(flow));
}

// Says of a node's type that there is none of that name, or why it cannot be used.
void TreeReader::report_type(const std::string &type, Span span, const NodeTypeRow *row,
                             const std::string *unusable) {
    if (unusable) {
        const bool leaf = row && row->children == Arity::Leaf;
        in_.report
            .content(span, "this `" + std::string(cut(type, 80)) + "` cannot be used: " + *unusable)
            .note(leaf ? "it is left out, and kept for an export"
                       : "its children are united in its place; it is kept for an export");
        return;
    }
    std::vector<std::string> known;
    for (const NodeTypeRow &other : node_types()) known.emplace_back(other.name);
    Remark remark =
        in_.report.content(span, "there is no node type `" + std::string(cut(type, 80)) + "`");
    remark.note("its children, if it has any, are united in its place; it is kept for an export");
    const std::string near = nearest_name(type, known);
    if (!near.empty()) remark.help("did you mean `" + near + "`?");
}

Result TreeReader::node(const Event &first, Place place, Body &body, bool top) {
    if (first.kind == EventKind::Broken || first.kind == EventKind::End) return {};
    if (first.kind != EventKind::SequenceStart) {
        in_.report.content(first.span, "a node has to be a list of its type, name and properties")
            .note("it is left out, and kept for an export");
        std::string flow;
        take_flow(in_.reader, first, flow);
        keep("node", std::move(flow));
        return {};
    }
    const std::size_t kept_mark = in_.kept.size(), out_mark = in_.out.size();
    const auto ordinals_mark = in_.ordinals;
    const std::size_t slot = kept_mark;
    in_.kept.emplace_back(); // a group's record has to stand before those of its children

    Event event = in_.reader.next();
    if (event.kind != EventKind::Scalar) {
        keep_untyped(std::move(event));
        return {};
    }
    const std::string type = event.text;
    const Span type_span = event.span;
    const std::uint32_t part = type_span.begin;
    const NodeTypeRow *row = find_node_type(type);
    const auto unusable = in_.options.unusable.find(part);
    const bool usable = unusable == in_.options.unusable.end();
    if (row && row->type == NodeType::Lighting) {
        if (top && !in_.lighting_seen) {
            in_.read_lighting(true);
            return {};
        }
        row = nullptr;
    }
    ++in_.nodes;
    if (!usable || !row) report_type(type, type_span, row, usable ? nullptr : &unusable->second);
    if (!usable && !(row && row->children == Arity::Leaf)) row = nullptr;

    std::string name;
    bool name_plain = true;
    event = in_.reader.next();
    if (event.kind == EventKind::Scalar) {
        name = event.text;
        name_plain = event.plain;
        event = in_.reader.next();
    } else {
        in_.report.content(type_span, "this node has no name");
    }

    // A block that has a name of its own, or stands too deep, becomes a statement of its own.
    const bool block = !row || row->children != Arity::Leaf;
    const bool custom =
        !is_default_name(name, row ? std::string_view(row->name) : std::string_view(type));
    const bool hoisted = // but not out of copies that differ: what it says may name the copy
        block && !top && in_.words.copies == 0 &&
        (blocks_ >= block_limit || (custom && row && row->children != Arity::One));
    Body own;
    Body &target = hoisted ? own : body;
    const std::size_t blocks_mark = blocks_;
    if (block) blocks_ = hoisted ? 1 : blocks_ + 1;
    const std::size_t begin = target.size();
    if (block) target.emplace_back();

    NodeForm form{in_,         row,   type, type_span, name,  flow_scalar(name, name_plain),
                  path_text(), place, slot, target,    begin, usable,
                  custom};
    form.properties.values.resize(row ? row->properties.size() : 0);
    form.result.part = part;
    form.result.display = name;
    form.base_type = row ? row->name : type;
    if (event.kind == EventKind::MappingStart) {
        read_properties(std::move(event), row, type, target, form.kids, form.properties);
        event = in_.reader.next();
    }
    Span end = event.span;
    if (event.kind != EventKind::SequenceEnd && event.kind != EventKind::Broken &&
        event.kind != EventKind::End) {
        keep_extra(std::move(event));
        end = Span{in_.source_id, type_span.begin, type_span.begin};
    }
    blocks_ = blocks_mark;

    if (!row || row->children == Arity::Many || row->children == Arity::Two)
        form.combine();
    else if (row->children == Arity::One)
        form.transform();
    else
        form.leaf();

    if (!form.result.contributed) {
        in_.kept.resize(kept_mark);
        in_.ordinals = ordinals_mark;
        in_.out.resize(out_mark);
        target.resize(begin);
        const std::uint32_t stop = std::max(end.end, type_span.end);
        in_.kept.push_back(
            {"node",
             path_text(),
             {},
             Span{in_.source_id, first.span.begin,
                  in_.reader.broken() ? static_cast<std::uint32_t>(in_.source.text.size()) : stop},
             true});
        return {};
    }
    form.settle();
    Result &result = form.result;
    if (hoisted) {
        const std::string identifier =
            in_.names.unique(result.display.empty() ? type : result.display, "shape");
        const std::size_t out_begin = in_.out.size();
        print_body(own, "let " + identifier + " = ", in_.out);
        in_.out += '\n';
        last_ = Statement{identifier, std::move(own), out_begin, in_.out.size()};
        body.push_back({Piece::Kind::Line, identifier, {}});
    } else if (custom && !top) {
        add_comment(target[begin].kind == Piece::Kind::Open ? target[begin] : target.back(), name);
    }
    return result;
}

} // namespace fathom::save
