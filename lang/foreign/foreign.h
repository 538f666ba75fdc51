// Other languages: all that the rest of lang calls of this folder, and (by the classes of reading.h,
// which those here are made on) all that the folder touches of the rest. Each answer says what to
// write instead, with the edit where that is mechanical. No file outside of the folder includes another
// of its headers (tests/style).
#pragma once

#include "lang/reading.h"

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace fathom::lang {

// -- what the rest of lang calls -----------------------------------------------------------------

// Names that other languages have for what is spelled otherwise here: `True`, `None`; `math`.
bool is_foreign_value(std::string_view name);
bool is_foreign_module(std::string_view name);
bool is_foreign_transform(std::string_view name); // what OpenSCAD writes before a shape
bool is_clock(std::string_view name);             // of the seconds of a shader, as `iTime`

// A string with values in it, as `f"r = {r}"` and `${r}` of JavaScript, as a sum; empty where it
// holds none, or what is not plain. `opening` is what stands before a value.
std::string joined_string(std::string_view quoted, std::string_view opening);

// A word that begins like a number and is none (numbers.cpp).
struct BadNumber {
    std::string message, help, replacement;
};
std::size_t number_length(std::string_view word); // of the digits that it begins with
BadNumber explain_bad_number(std::string_view word, bool named);
bool is_length_unit(std::string_view word); // `mm`, `in`: elsewhere
bool is_degree_word(std::string_view word);

// The words with functions of other languages read as ours, reported; empty where there are none
// (lambdas.cpp).
std::vector<Token> read_foreign_lambdas(const Source &source, SourceId id,
                                        const std::vector<Token> &words, Diagnostics &diagnostics);
// The same for types, casts, macros and declarations (forms.cpp), and for Rust's `match`
// (match.cpp).
std::vector<Token> read_foreign_forms(const Source &source, SourceId id,
                                      const std::vector<Token> &words, Diagnostics &diagnostics);
std::vector<Token> read_foreign_matches(const Source &source, SourceId id,
                                        const std::vector<Token> &words, Diagnostics &diagnostics);
// Whole statements, as OpenSCAD's `intersection_for`, and brackets that are missing
// (blocks.cpp).
std::vector<Token> read_foreign_blocks(const Source &source, SourceId id,
                                       const std::vector<Token> &words, Diagnostics &diagnostics);
// Casts and calls that name a type (casts.cpp).
std::vector<Token> read_foreign_casts(const Source &source, SourceId id,
                                      const std::vector<Token> &words, Diagnostics &diagnostics);

namespace program {
// Answers a program of another language that is understood as a whole by one edit, which writes all
// of it anew; false where it is none.
bool answer(const Source &source, SourceId id, Diagnostics &diagnostics);
} // namespace program

// Whether all of a text may be looked at for one report: not where there are many reports.
inline bool are_few(const Diagnostics &reports) {
    constexpr std::size_t most = 100;
    return reports.items().size() < most;
}

// What the reader of words asks; see lexer.h.
class ForeignWords : protected WordReading {
  protected:
    ForeignWords(const Source &source, SourceId id, Diagnostics &diagnostics)
        : WordReading(source, id, diagnostics),
          beyond_ascii_(std::any_of(source.text.begin(), source.text.end(),
                                    [](char c) { return (c & 0x80) != 0; })) {}

    std::uint32_t name_with_letters(std::uint32_t begin);
    std::uint32_t define(std::uint32_t begin, std::uint32_t end);
    void directive(std::uint32_t begin, std::uint32_t end, std::uint32_t line_end);
    bool lisp_vector(std::uint32_t begin) const;
    void shown_alone(std::uint32_t begin, std::uint32_t end);
    void turned_text(std::uint32_t begin, std::uint32_t end);
    bool invisible_sign(std::uint32_t begin, std::uint32_t end, std::uint32_t sign);
    bool strange_sign(std::uint32_t begin, std::uint32_t end, std::uint32_t code_point);
    bool sign_of_mathematics(std::uint32_t begin, std::uint32_t end);
    std::optional<Span> assignment_from(std::uint32_t begin, std::uint32_t end) const;
    // What `, $fn = 6` says that would be lost: of a solid whose call is written anew, and of another
    // call, which may hand it to one.
    enum class Faces { None, OfSolid, HandedOn };
    Faces faces_of(Span assignment) const;
    bool told_before(std::uint32_t begin, std::uint32_t end, const std::vector<Edit> &edits);
    bool may_look_far() const { return are_few(diagnostics_); }
    bool mark_of_wgsl(std::uint32_t begin, std::uint32_t end);
    std::vector<Edit> chosen_lines(std::uint32_t begin) const;

    struct ToldName {
        Span first;
        std::size_t uses = 0;
    };
    // Names with letters that no name has, and signs.
    std::unordered_map<std::string_view, ToldName> told_names_;

  private:
    void root_sign(std::uint32_t begin, std::uint32_t end);
    bool paired_sign(std::uint32_t begin, std::uint32_t end);
    std::uint32_t sum_sign(std::uint32_t begin);
    void composition_sign(std::uint32_t begin, std::uint32_t end);
    bool product_of_rows(std::uint32_t begin, std::uint32_t end, bool cross);

    const bool beyond_ascii_;                     // the text has other letters somewhere
    std::unordered_set<std::uint32_t> pair_ends_; // signs that close the `‖` before them
    std::uint32_t open_choices_ = 0;              // `#if`s whose `#endif` is yet to come
    std::uint32_t marked_until_ = 0;              // of WGSL: the end of what was told last
};

// What the builder of the tree asks; see builder.h.
class ForeignSyntax : protected TokenReading {
  protected:
    using TokenReading::TokenReading;

    bool foreign_statement(Index first);           // true: reported, and to be abandoned
    bool foreign_failure(Wanted wanted, Index at); // by rule (failures.cpp)
    bool foreign_junk(Index first, Index at);
    bool foreign_record(Index brace);
    bool foreign_concat(Index at);
    bool call_of_row(Index open);
    bool range_of_param(Index comma);
    bool set_of_points(Index brace);
    bool equation(Span statement);
    bool formula_bound(Index let, std::uint32_t end);
    bool runs_on(Index name, std::uint32_t end);
    bool setting_assigned(std::string_view name, Span target, Span value);
    void settle_foreign_names();
    bool may_be_declared(std::string_view name);
    std::string transform_text(Index name, bool flat) const;
    std::string_view lost_of_transform(Index name) const;

    // Names that other languages have, to be reported unless the file declares them.
    struct ForeignName {
        ExprId expr; // the name, or the member that it qualifies
        Span span;
    };
    std::vector<ForeignName> foreign_names_;
    std::unordered_set<Index> renamed_; // keywords that an edit makes names of
    Index let_until_ = 0;               // the `in` of a Curv `let` whose names were told

  private:
    // Each reports and returns true where the form is the one that it knows.
    bool foreign_operand(Wanted wanted, Index at);
    bool foreign_list(Index at);
    bool foreign_group(Index at, bool list);
    bool is_body_of_lambda(Index open, Index at) const;
    bool foreign_binding(Index at);
    bool foreign_name(Index at);
    std::vector<Edit> names_of_let(Index let);
    bool foreign_count(Index at);
    bool foreign_in(Index at);
    void changed_parameter(Index word, Index type);
    void note_changed(Index open, Diagnostic &d) const;
    struct Changed {
        std::size_t place; // among the parameters
        Index type, name;
        bool is_fresh; // `out`, without a value before
    };
    std::optional<Changed> changed_by(Index open) const;
    std::vector<Edit> returned_instead(Index name, Index body, std::string &head) const;
    bool foreign_function_body(Index at);
    bool foreign_instead(Index at, std::string message, const std::string &replacement);
    bool foreign_loop(Index at);
    bool foreign_head(Index first);
    Edit without_statement(Index first) const;
    void foreign_param(Index first, Index name);
    bool hinted_param(Index first, Index name);
    bool foreign_stream(Index first, Index name);
    void foreign_unbound(Index first, Index name, std::string_view type);
    void foreign_name_parts(Index left, Index right);
    bool is_used_after(Index name) const;
    bool arguments_by_space(Index first);
    void foreign_curried(Index first, Index name, Index past);
    std::string shape_of_field(Index name) const;
    bool names_vector(std::string_view name) const;
    void foreign_function(Index first, Index name, bool has_type);
    bool is_assigned_after(Index name) const;
    bool foreign_body(Index at);
    bool goes_on_with_else(Index end) const;
    bool colon_range(Index at);
    void foreign_then(Index at);
    bool foreign_lambda(Index at);
    bool separated_unit(Index at);
    std::string parameters_text(Index open) const;
    bool junk_by_sign(Index first, Index at);
    bool remark(Index first, Index at);
    bool where_clause(Index first, Index at);
    void destructuring(Index first, Index from, Index past, Index assign);
    bool shape_behind_call(Index first, Index at);
    Index body_below(Index at) const;
    bool foreign_import(Index at);
    bool foreign_slice(Index at);
    // Transforms of OpenSCAD (transforms.cpp).
    std::string value_text(Index from, Index to) const;
    std::string degrees_text(Index from, Index to) const;
    std::string cut_of_revolution(Index name) const;
    // Solids of OpenSCAD (solids.cpp).
    struct Solid {
        std::string text;            // as it is written here
        std::string_view told, lost; // how theirs differs, and what ours has not
        bool is_centered = false;
    };
    Solid solid_of(Index name, bool certain) const;
    int faces_of_file() const;
    mutable std::optional<int> faces_of_file_; // looked for once: a file may have many solids
    bool of_openscad(Index first);
    bool is_openscad() const;
    bool foreign_solid(Index first);
    struct ModuleBody {
        bool takes_shapes = false, has_many = false;
    };
    ModuleBody module_body(Index open) const;
    void module_head(Index first, Index after, std::string &head) const;
    bool foreign_minkowski(Index first);
    bool foreign_hull(Index first);
    bool hull_of_loops(Index first, Index begin);
    std::vector<std::pair<std::string, std::string>> named_arguments(Index open) const;
    std::string radius_of(Index shape) const;
    bool foreign_modifier(Index at);
    void forget_arguments(Index open) const;
    std::string lisp_value(Index &at) const;
    std::string lisp_part(Index at, Index end) const;
    std::string lisp_form(Index open) const;
    std::string lisp_thread(Index open) const;
    std::string lisp_function(Index open) const;
    bool lisp_arrow(Index at);
    bool lisp_binding(Index open);
    bool lisp_call(Index at);
    bool lisp_let(Index open);
    bool asks_for_type(Index at);
    std::string joined_list(Index open) const;
    bool list_spread(Index at);
    bool loop_among_entries(Index at);
    bool column_of_rows(Index at);
    bool counted_block(Index first, Index at);
    bool range_in_parentheses(Index at);
    bool foreign_for_words(Index at);
    bool python_import(Index first);
    bool of_other_program(Index first);
    bool joined_by_space(Index at, bool list);
    bool pipe_edits(Index sign, std::vector<Edit> &edits) const;
    std::string nested_loops(Index open, Index at) const;
    std::string scad_heads(Index name, Index close) const;
    bool nothing_compared(Index at);
    bool applied_without_dot(Index at);
    void enumeration(Index first);
    std::vector<Edit> further_names(Index first, Index from);

    // Calls by a space (spaced.cpp); `apart` becomes true where there is one.
    std::string spaced_row(Index first, Index past, bool &apart) const;
    std::string spaced_atom(Index &at, Index past, bool &apart) const;
    std::string spaced_call(Index &at, Index past, bool &apart) const;
    std::string spaced_value(Index first, Index past, bool &apart) const;
    bool foreign_parameter(Index at);
    bool sentence(Index first, Index past);
    bool word_of_sentence(Index at);
    bool parted_by_semicolon(Index at, Index open);
    bool spaced_statement(Index at);
    bool values_side_by_side(Index first, Index past);
    bool holds_comma(Index open) const;

    bool may_look_far() const { return are_few(diagnostics_); }
    bool bars_of_amount(Index at);
    std::vector<Edit> parts_of_point(Index first, Index past);
    std::vector<Edit> shape_of_equation(Index first, Index past);
    void tell_equation(Span where, bool compares, std::vector<Edit> edits);
    bool keyword_as_name(Index at);
    bool tried_block(Index first);
    bool named_group(Index first);
    bool loop_of_tuple(Index open, Diagnostic &d);
    bool head_of_loop(Index at);
    std::string loop_of_parts(Index open, std::string list, std::string &lets) const;

    // Records of theirs (records.cpp).
    bool foreign_struct(Index first);
    std::string zero_record(std::string_view type) const;
    bool c_statement(Index first);
    bool let_of_value(Index at);
    bool switch_choice(Index first);
    bool do_loop(Index first);
    bool named_record(Index brace);
    bool called_record(Index made);
    bool parameters_in_braces(Index brace);

    // Operators of theirs, and what is missing beside one (operators.cpp).
    bool touch(Index first, Index second) const; // with nothing between
    bool foreign_word_operator(Index at);
    bool foreign_comparison(Index at);
    bool foreign_scope(Index colon);
    bool foreign_percent(Index at);
    bool is_amount_of_vector(Index bar) const;
    bool missing_operand(Index at);
    bool wanted_at_start(Index at) const;
    bool foreign_product(Index at);
    bool juxtaposed_arguments(Index at);

    // Statements of theirs, each of its own kind (statements.cpp).
    bool mistyped_keyword(Index first);
    bool print_stream(Index first);
    bool block_until_end(Index at);
    void loop_over_pairs(Index at);
    bool label_of_param(Index at);
    bool words_of_range(Index first, Index at);

    // Bodies without braces (bodies.cpp).
    bool begins_body(Index at) const;
    bool indented_body(Index colon, std::vector<Edit> &edits);
    void foreign_colon(Index at);

    // Words and blocks of theirs (words.cpp).
    void withdraw_quotes(Index first);
    void foreign_choice(Index start, Index at);
    Index value_start(Index first, Index at) const;
    void foreign_pipe(Index at);
    bool curv_slider(Index first);
    bool curv_block(Index first);
    std::string slider_text(Index name, Index &value) const;
    bool juxtaposed_calls(Index first, Index at);

    // All names that the text declares; made when it is first needed.
    std::optional<std::unordered_set<std::string_view>> all_declared_;
    bool has_import_ = false;
};

// -- within the folder ---------------------------------------------------------------------------

bool is_type_word(std::string_view word); // of any language

inline constexpr std::string_view changes_nothing =
    "a function changes none of its arguments: it returns what is new, several numbers as a "
    "vector, "
    "`fn f(p: vec3) = vec2(d, id)`, whose parts are `f(p).x` and `f(p).y`";

// A range for a number that has none: from half to twice the number, so that no size is 0. The number
// is without its sign.
std::string range_around(std::string_view number, bool negative);

// What a variable of a type of ours holds before it is given a value; empty where that is not known.
std::string_view zero_of(std::string_view type);

// Half of a value that stands in a text; a shape of OpenSCAD that has two dimensions.
std::string half_of(std::string_view value);
bool is_flat_shape(std::string_view name);

} // namespace fathom::lang
