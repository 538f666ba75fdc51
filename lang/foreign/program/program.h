// Whole programs of other languages, as a tree that is written anew in ours. A reader fails
// (`Unsure`) at whatever it does not know: only what is certain is rewritten, all else is answered
// line by line (foreign/*.cpp).
#pragma once

#include "lang/foreign/foreign.h"

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace fathom::lang::program {

struct Unsure {}; // thrown where a text is not understood; never leaves rewrite()

enum class Of { Sdf, Jscad, Three, Script, Curv, Lisp };

// -- words ---------------------------------------------------------------------------------------

enum class Word { Name, Number, Text, Sign, End };

struct Piece {
    Word kind = Word::End;
    std::string text;
    std::string comment; // what stands above it, as lines of ours
    std::uint32_t begin = 0, column = 0;
    bool first = false;  // of its line
    bool spaced = false; // behind a blank
};

// The words of a text; `#` begins a comment in Python, `//` in the others.
std::vector<Piece> read_pieces(std::string_view text, bool python);

// -- the tree ------------------------------------------------------------------------------------

enum class Is {
    Number,
    Text,
    Name,
    List,
    Record,  // names[i]: parts[i]
    Call,    // parts[0](names[i] = parts[i + 1])
    Member,  // parts[0].text
    Index,   // parts[0][parts[1]]
    Column,  // parts[0][:, parts[1]] of arrays
    Unary,   // text parts[0]
    Binary,  // parts[0] text parts[1]
    Choice,  // parts[0] ? parts[1] : parts[2]
    Lambda,  // (names) => parts[0], or a body
    Spread,  // ...parts[0]
    ForEach, // [parts[0] for text in parts[1] if parts[2]]
    Ours     // text in our language, whose operators bind as tightly as a call
};

struct Statement;

struct Node {
    Is is = Is::Ours;
    std::string text;
    std::vector<Node> parts;
    std::vector<std::string> names;
    std::vector<Statement> body;
};

enum class Does { Nothing, Set, Function, For, If, Value, Return };

struct Statement {
    Does does = Does::Nothing;
    std::string name;               // of a function, of a loop's variable
    std::string sign;               // of Set: `=`, `+=` and the like
    std::vector<Node> targets;      // of Set, several where they are parted by commas
    std::vector<std::string> names; // of parameters
    std::vector<Node> defaults;     // of parameters; of kind Ours and empty where there is none
    Node value;
    std::vector<Statement> body, otherwise;
    std::string comment;
    int decorated = 0;
};

std::vector<Statement> read_script(const std::vector<Piece> &pieces, bool python);
std::vector<Statement> read_curv(const std::vector<Piece> &pieces);
// A form at the top level, a list by `(` or `[`, and the comments above and in it; the last has none,
// and what stands below all others.
struct TopForm {
    Node form;
    std::string comment;
};
std::vector<TopForm> read_lisp(std::string_view text);

Node node(Is is, std::string text, std::vector<Node> parts = {});
std::string lisp_head(const Node &form);
inline bool is_named(const Node &n, std::string_view name) {
    return n.is == Is::Name && n.text == name;
}

// -- writing -------------------------------------------------------------------------------------

enum class Kind { Unknown, Number, Vector, List, Flat, Solid, Function };

// A text of ours, how tightly its outermost operator binds, and what it is.
struct Written {
    std::string text;
    int binds = 12;
    Kind kind = Kind::Unknown;
};

constexpr int as_call = 12;
constexpr std::string_view defines_params = "getParameterDefinitions"; // of JSCAD
inline Written solid_of(std::string text) { return {std::move(text), as_call, Kind::Solid}; }
inline Written flat_of(std::string text) { return {std::move(text), as_call, Kind::Flat}; }

// What a call is given, by place and by name; what was not asked for is not understood.
struct Given {
    std::vector<Written> by_place;
    std::map<std::string, Written> by_name;
    std::set<std::string> asked;
};

// Of three.js: a mesh, a geometry or a material that a name stands for.
struct Thing {
    std::string text;                                         // the shape, or a material's colour
    std::map<std::string, std::string> moved, turned, scaled; // by `x`, `y`, `z`
    std::string paint;
    bool is_group = false, is_mesh = false, is_material = false;
};

// The first answer to a program of OpenSCAD that has sines of degrees; false where there is none.
bool answer_degrees(const Source &source, SourceId id, Diagnostics &diagnostics);
// The answer to a shader that another program has in a text; false where there is none.
bool answer_hosted(const Source &source, SourceId id, Diagnostics &diagnostics);

class Writer {
  public:
    explicit Writer(Of of) : of_(of) {}

    std::string program(const std::vector<Statement> &statements);
    std::string program(const std::vector<TopForm> &forms); // of Bauble and libfive
    const std::set<std::string> &lost() const { return lost_; }
    // Names of theirs that stand for nothing here: the text calls them by `name_of_curv` and the like.
    const std::set<std::string> &unread() const { return unread_; }

  private:
    struct Scope {
        std::map<std::string, Written> names; // what each name is called now, and what it is
        std::set<std::string> taken;
        std::map<std::string, Thing> things;
        std::vector<Node> added; // to a scene of three.js, shown where the block ends
    };

    // Forms of Bauble and libfive (lisp_shapes.cpp).
    struct Form {
        std::vector<std::pair<std::string, std::size_t>> axes; // and before which of the rest
        std::vector<const Node *> rest;
        std::map<std::string, const Node *> named;
    };
    Form form_of(const Node &n) const;
    void lisp_statement(const Node &form);
    Written lisp(const Node &n);
    std::string lisp_text(const Node &n, int needs = 0);
    std::string doubled(const Node &n);
    Written lisp_own(const Node &n);
    // Lists (lisp_lists.cpp).
    std::string lisp_declare(const Node &theirs, Kind kind);
    std::string lisp_range(const Node &n);
    Written lisp_for(const Node &name, const Node &list, const Node &body);
    Written lisp_list(const Node &n);
    Written lisp_apply(const Node &n);
    void lisp_spread(const Node &list, std::vector<Written> &into);
    static std::optional<Written> lisp_of_lists(const std::string &op, std::vector<Written> &parts,
                                                const std::string &k);
    std::optional<Written> lisp_number(const std::string &head, const Node &n);
    std::optional<Written> lisp_joined(const std::string &head, const Node &n);
    Written lisp_field(const Node &n, bool flat);
    std::optional<Written> lisp_profile(const std::string &name, const Form &f);
    std::optional<Written> lisp_solid(const std::string &name, const Form &f);
    // What is done to shapes (lisp_changes.cpp).
    bool is_by_point(const Node &n) const;
    std::string lisp_of_point(const Node &n);
    std::string lisp_color(const Node &n);
    Written lisp_painted(const Node &n);
    void lisp_setting(const Node &form);
    std::optional<Written> lisp_change(const std::string &name, const Node &n, const Form &given);

    // Statements (write.cpp).
    void block(const std::vector<Statement> &body, bool top);
    void statement(const Statement &s, bool top, bool last);
    void set(const Statement &s);
    void set_name(const std::string &name, const Node &value);
    void set_parts(const Statement &s);
    void imports(const Statement &s);
    void function(const Statement &s);
    bool function_of_points(const Statement &s);
    void loop(const Statement &s, bool top);
    void gather(const Statement &loop, const std::string &into, bool cut);
    void choice(const Statement &s, bool top);
    struct Gathering {
        std::string into; // empty where there is none
        const Node *added = nullptr;
        bool cut = false;
    };
    Gathering gathering(const Statement &s) const;
    Gathering gathering_in(const std::vector<Statement> &body) const;
    void line(const std::string &text);
    void comment(const std::string &lines);
    std::string declare(const std::string &name, Kind kind);
    std::string fresh(const std::string &name) const;
    std::string parameters(const Statement &s);
    const Written *find(const std::string &name) const;
    std::string range_of(const Node &list);
    void show(const Node &n, bool top, bool last);
    void inner(const std::vector<Statement> &body, bool top);

    // Values (values.cpp).
    Written value(const Node &n);
    std::string text(const Node &n, int tighter_than = 0);
    Written binary(const Node &n);
    Written call(const Node &n);
    Written call_of_ours(const Written &callee, const Node &n);
    Written method(const Node &n);
    std::optional<Written> shape(const std::string &name, const Node &n);
    Written for_each(const Node &n);
    std::string turn_of(const Node &lambda);
    Written lambda(const Node &n);
    std::optional<std::string> constant(const Node &n) const;
    Written unread_call(const std::string &name, const std::vector<std::string> &arguments);
    Written unread_change(const Written &of, const std::string &name,
                          const std::vector<std::string> &arguments);
    Written linspace(const Node &n);
    Written mathematics(const std::string &name, const Node &n);
    Given given(const Node &n, std::size_t first);
    std::string path(const Node &n) const; // `a.b.c`; empty where it is no such

    // What libraries have (sdf.cpp, jscad.cpp, three.cpp).
    std::optional<Written> sdf_shape(const std::string &name, Given &g);
    std::optional<Written> sdf_flat(const std::string &name, Given &g);
    std::optional<Written> sdf_change(const std::string &name, const Written &of, Given &g);
    Written combined(const std::string &name, std::vector<Written> parts, const std::string &k);
    Written joined(const std::string &name, const Node &n, std::size_t first,
                   std::optional<Written> before);
    std::optional<Written> jscad(const std::string &name, const Node &n);
    void jscad_params(const Statement &definitions);
    std::optional<Written> jscad_solid(const std::string &name, Given &g);
    std::optional<Written> jscad_change(const std::string &name, const Node &n);
    std::optional<Written> script_shape(const std::string &name, Given &g);
    std::optional<Written> script_change(const std::string &name, const Written &of, Given &g);
    Written curv_joined(const std::string &name, const Node &list, const std::string &k);
    std::optional<Written> curv_shape(const std::string &name, const Node &argument);
    Written curv_field(const Node &record);
    std::optional<std::string> curv_color(const Node &n);
    Written curv_changed(const Written &of, const std::string &name, const Node *argument);
    Written curv_pipe(const Node &n);
    Written curv_call(const Node &n);
    std::optional<Written> curv_constant(const Node &n);
    void curv_param(const Statement &s);
    bool three(const Statement &s);
    std::optional<Thing> thing(const Node &n);
    std::optional<Thing> thing_of(const std::string &name, const Node &n);
    std::optional<std::string> shown(const Thing &t) const;

    Of of_;
    std::vector<Scope> scopes_{1};
    std::map<std::string, std::size_t> arities_;  // of functions of Curv
    std::map<std::string, std::string> imported_; // what a name of theirs stands for
    std::string gathered_;                        // the name that the loop being written adds to
    std::string sliders_;                         // the argument of JSCAD's `main`, and its parts
    std::map<std::string, Written> slider_;
    std::string last_; // the shape named last
    bool shown_ = false;
    std::set<std::string> lost_, unread_, helpers_; // `helpers_`: functions of ours that it uses
    std::string out_;
    int depth_ = 0, nodes_ = 0, level_ = 0;
};

// The argument of that place or name, marked as asked for; none where it was not given.
std::optional<Written> taken(Given &g, std::size_t place, const std::string &name);
std::string call_text(std::string_view name, const std::vector<std::string> &arguments);
std::string halved(std::string_view value); // a size's half
std::string negated(std::string_view value);
std::string between_corners(std::string_view shape, const Written &low, const Written &high);
std::string wrapped(const Written &w, int tighter_than);
bool is_mathematical(std::string_view name); // what Writer::mathematics() knows

} // namespace fathom::lang::program
