// The reader of the scene tree: tree.cpp reads nodes, root.cpp the root and what
// stands right below it. Private to those two.
#pragma once

#include "save-format/import/importer.h"

#include <optional>

namespace fathom::save {

// Where a node stands decides what an export makes of a union there: see export/tree.cpp.
enum class Place : std::uint8_t {
    United,      // among siblings that are united: a union dissolves
    Intersected, // an intersection dissolves
    Alone        // an operand by itself
};

// What the importer made of a node.
struct Result {
    bool contributed = false;
    std::size_t base = 0; // nodes that an export has at this place before the records are applied
    std::string display;  // what a person would call it
    std::optional<Place> dissolves; // it would, where it stood at such a place
    std::uint32_t part = no_part;   // where it begins in the file
};

// How the children of a node came out.
struct Children {
    bool given = false;
    std::size_t read = 0;   // in the file
    std::size_t pieces = 0; // expressions
    std::size_t base = 0;
    std::optional<Place> dissolves; // of the only one
    bool first = false;             // the first one contributed (differences and blends need it)
    std::size_t first_base = 0, first_end = 0; // its nodes, and the piece behind it
    std::size_t rest_mark = 0;                 // the held piece before the second one
    std::size_t rest_pieces = 0;
    std::string display; // of the only one
    bool differ = false; // they are read as those of one copy, which knows its number
};

// Reads the scene tree of one file.
class TreeReader {
  public:
    explicit TreeReader(Importer &importer) : in_(importer) {}

    void root(const Event &first);

  private:
    Result node(const Event &first, Place place, Body &body, bool top);
    void report_type(const std::string &type, Span span, const NodeTypeRow *row,
                     const std::string *unusable);
    void keep_untyped(Event event);
    void keep_extra(Event event);
    void top_level(const Event &first);
    void children(const Event &key, const NodeTypeRow *row, Body &body, Children &into,
                  Properties &properties);
    void read_properties(Event event, const NodeTypeRow *row, const std::string &type, Body &body,
                         Children &into, Properties &properties);
    void keep(const char *label, std::string flow) {
        in_.keep(label, path_text(), std::move(flow));
    }
    std::string path_text() const;

    Importer &in_;
    struct Statement { // written before the present one, for a part of it
        std::string identifier;
        Body body;
        std::size_t begin = 0, end = 0; // in Importer::out
    };
    std::optional<Statement> last_;
    std::vector<std::size_t> path_;
    std::size_t blocks_ = 0; // that are open in the present statement
};

} // namespace fathom::save
