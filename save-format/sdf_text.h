// Small pieces of the language's text that the importer writes: numbers, names, strings, and the
// layout of nested expressions. Knows only spellings, no grammar.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace fathom::save {

std::string sdf_number(double value);             // shortest exact form; `inf`
std::string sdf_vector(const double (&value)[3]); // "[1, 2, 3]"
std::string sdf_string(std::string_view text);    // in quotes
std::string sdf_color(double red, double green,
                      double blue); // 0..255 each: "#rrggbb", or rgb(…) for fractions

// Gives each thing a name of its own, made of what the file called it, that hides nothing of the
// language.
class Names {
  public:
    // `suffix` stands behind a name that the language already uses: "sphere" becomes
    // "sphere_shape".
    std::string unique(std::string_view wanted, std::string_view suffix);

  private:
    std::unordered_map<std::string, int> taken_; // and the last number that was appended
};

// An expression that may span lines, in order: the pieces of one statement. `chain_mark` stands in
// front of each `.call` that may begin a line of its own.
inline constexpr char chain_mark = '\x01';
// `part_mark`, a place in the file and `part_end` stand before what comes of the part there.
inline constexpr char part_mark = '\x02', part_end = '\x03';
inline constexpr std::uint32_t no_part = std::numeric_limits<std::uint32_t>::max();
std::string marked(std::uint32_t place, std::string text);
// Takes the marks out of a text; gives the places in order, by their offsets in what is left.
std::vector<std::pair<std::uint32_t, std::uint32_t>> take_marks(std::string &text);
struct Piece {
    enum class Kind { Nothing, Open, Line, Close };
    Kind kind = Kind::Nothing;
    std::string text;
    std::string comment;
};
using Body = std::vector<Piece>;

// Appends the statement to `out`: two blanks a level, chains broken where a line would pass 100
// columns.
void print_body(const Body &body, std::string_view head, std::string &out);

} // namespace fathom::save
