// The root of the scene tree, and its children: one statement each.
#include "save-format/import/tree_reader.h"

namespace fathom::save {

void TreeReader::top_level(const Event &first) {
    Body body;
    blocks_ = 0;
    last_.reset();
    Result result = node(first, Place::United, body, true);
    if (!result.contributed) return;
    // A chain of calls on one named block continues that block's own statement.
    std::erase_if(body, [](const Piece &piece) { return piece.kind == Piece::Kind::Nothing; });
    const bool continues = last_ && last_->end == in_.out.size() && body.size() == 1 &&
                           body[0].text.starts_with(last_->identifier + chain_mark);
    if (continues) {
        in_.out.resize(last_->begin);
        last_->body.back().text += body[0].text.substr(last_->identifier.size());
        last_->body.back().comment = body[0].comment;
        body = std::move(last_->body);
    }
    for (Piece &piece : body) // the statement's own name says it
        if (piece.comment == result.display) piece.comment.clear();
    const std::string identifier =
        continues ? last_->identifier : in_.names.unique(result.display, "shape");
    print_body(body, "let " + identifier + " = ", in_.out);
    in_.scene.push_back(marked(result.part, identifier));
}

void TreeReader::root(const Event &first) {
    Event event = in_.reader.next();
    const NodeTypeRow *row = event.kind == EventKind::Scalar ? find_node_type(event.text) : nullptr;
    if (!row || row->type != NodeType::Generic) {
        in_.reader.break_off(first.span,
                             "the scene tree has to begin with its root, a `Generic` node");
        return;
    }
    event = in_.reader.next();
    std::string unknown;
    if (event.kind == EventKind::Scalar) {
        if (event.text != "Distance field") keep("name", flow_scalar(event.text, event.plain));
        event = in_.reader.next();
    }
    if (event.kind == EventKind::MappingStart) {
        const NodeTypeRow root{row->type, row->name, row->children, {}}; // it has no paint
        Properties properties;
        bool given = false;
        for (;;) {
            event = in_.reader.next();
            if (event.kind == EventKind::MappingEnd || event.kind == EventKind::Broken ||
                event.kind == EventKind::End)
                break;
            const std::string key =
                event.kind == EventKind::Scalar ? spelling_key(event.text) : std::string();
            if (!given && (key == "parameters" || key == "caches")) {
                const TakenValue taken = take_value(in_.reader, in_.reader.next(), 1u << 22);
                if (key == "parameters")
                    in_.read_parameters(taken.value);
                else
                    in_.read_caches(taken.value);
                continue;
            }
            if (key != "children" || given) {
                in_.read_property(root, event, properties, "the root");
                continue;
            }
            given = true;
            Event list = in_.reader.next();
            if (list.kind != EventKind::SequenceStart) {
                if (!(list.kind == EventKind::Scalar && list.plain && is_none(list.text))) {
                    in_.report.content(list.span, "`Children` has to be a list of nodes");
                }
                skip_value(in_.reader, list);
                continue;
            }
            for (std::size_t index = 0;; ++index) {
                Event child = in_.reader.next();
                if (child.kind == EventKind::SequenceEnd || child.kind == EventKind::Broken ||
                    child.kind == EventKind::End)
                    break;
                path_.assign(1, index);
                top_level(child);
            }
            path_.clear();
        }
        if (!properties.unknown.empty()) keep("properties", "{" + properties.unknown + "}");
        event = in_.reader.next();
    }
    if (event.kind != EventKind::SequenceEnd && event.kind != EventKind::Broken &&
        event.kind != EventKind::End) {
        in_.report
            .content(event.span,
                     "a node has a type, a name and one mapping of properties, and no more")
            .note("the rest is kept for an export");
        std::string flow = "[";
        take_flow(in_.reader, std::move(event), flow);
        in_.rest_of_sequence(flow);
        keep("extra", std::move(flow));
    }
}

void Importer::read_tree(const Event &first) { TreeReader(*this).root(first); }

} // namespace fathom::save
