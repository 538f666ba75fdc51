// Curv as a tree: one expression below definitions, functions applied by standing before a value.
#include "lang/foreign/program/reader.h"

#include <algorithm>
#include <array>

namespace fathom::lang::program {

namespace {

struct CurvSign {
    std::string_view theirs, ours;
    int binds;
};
constexpr std::array<CurvSign, 15> curv_signs = {{{">>", ">>", 1},
                                                  {"||", "or", 2},
                                                  {"&&", "and", 3},
                                                  {"==", "==", 4},
                                                  {"!=", "!=", 4},
                                                  {"<", "<", 4},
                                                  {">", ">", 4},
                                                  {"<=", "<=", 4},
                                                  {">=", ">=", 4},
                                                  {"..", "..=", 5},
                                                  {"..<", "..", 5},
                                                  {"+", "+", 6},
                                                  {"-", "-", 6},
                                                  {"*", "*", 7},
                                                  {"/", "/", 7}}};

class CurvReader : PieceReader {
  public:
    explicit CurvReader(const std::vector<Piece> &pieces) : PieceReader(pieces) {}

    std::vector<Statement> all() {
        std::vector<Statement> out;
        scope(out, Does::Value);
        if (now().kind != Word::End) throw Unsure{};
        return out;
    }

  private:
    // `let a = 1; f x = 2 * x; in e`, `parametric r :: slider[0, 2] = 1; in e`, or `e`.
    void scope(std::vector<Statement> &out, Does does) {
        constexpr int deepest = 20;
        if (++scopes_ > deepest) throw Unsure{};
        const std::string above = now().comment;
        while (sees("let") || sees("parametric")) {
            const bool params = takes("parametric");
            if (!params) want("let");
            while (!takes("in")) {
                if (takes(";")) continue;
                out.push_back(params ? param() : definition());
                if (!sees("in") && pieces_[at_ - 1].text != ";") want(";"); // a body takes its own
            }
        }
        Statement s;
        s.does = does;
        s.comment = out.empty() ? above : now().comment;
        s.value = expression(0);
        takes(";");
        out.push_back(std::move(s));
        --scopes_;
    }

    Statement param() {
        Statement s;
        s.comment = now().comment;
        s.does = Does::Set;
        s.sign = "param";
        s.targets.push_back(node(Is::Name, name()));
        want("::");
        s.name = name();
        const bool color = s.name == "colour_picker", check = s.name == "checkbox";
        if (!color && !check && s.name != "slider" && s.name != "int_slider" &&
            s.name != "scale_slider")
            throw Unsure{};
        if (!check && !(color && sees("="))) s.targets.push_back(atom());
        want("=");
        if (check) takes("#"); // `#true`
        s.value = expression(0);
        return s;
    }

    void patterns(Statement &s) { // of parameters
        const bool list = sees("[") || sees("("), record = sees("{");
        if (!list && !record) {
            s.names.push_back(name());
        } else {
            ++at_;
            while (!takes(list ? sees(")") ? ")" : "]" : "}")) {
                s.names.push_back(name());
                s.defaults.push_back(record && (takes(":") || takes("=")) ? expression(0) : Node{});
                takes(",");
            }
        }
        s.defaults.resize(s.names.size());
    }

    Statement definition() {
        Statement s;
        s.comment = now().comment;
        const std::string named = name();
        if (takes("=")) {
            s.does = Does::Set;
            s.sign = "=";
            s.targets.push_back(node(Is::Name, named));
            s.value = expression(0);
            return s;
        }
        s.does = Does::Function;
        s.name = named;
        patterns(s);
        want("=");
        scope(s.body, Does::Return);
        return s;
    }

    Node expression(int above) {
        const Depth deeper(*this);
        if (takes("if")) {
            want("(");
            Node test = expression(0);
            want(")");
            Node yes = expression(0);
            want("else");
            return node(Is::Choice, "", {std::move(test), std::move(yes), expression(0)});
        }
        if (now().kind == Word::Name && next().text == "->") {
            Node n = node(Is::Lambda, "");
            n.names.push_back(name());
            want("->");
            n.parts.push_back(expression(0));
            return n;
        }
        Node left = unary();
        for (int length = 0; now().kind == Word::Sign; longer(length)) {
            if (sees("`")) { // a `union` b
                if (above >= 1) return left;
                ++at_;
                Node f = node(Is::Name, name());
                want("`");
                Node right = expression(1);
                left =
                    node(Is::Call, "",
                         {std::move(f), node(Is::List, "", {std::move(left), std::move(right)})});
                left.names.emplace_back();
                continue;
            }
            const auto sign = std::ranges::find(curv_signs, now().text, &CurvSign::theirs);
            if (sign == curv_signs.end() || sign->binds <= above) return left;
            ++at_;
            left = node(Is::Binary, std::string(sign->ours),
                        {std::move(left), expression(sign->binds)});
        }
        return left;
    }

    Node unary() {
        const Depth deeper(*this);
        if (takes("-")) return node(Is::Unary, "-", {unary()});
        if (takes("!")) return node(Is::Unary, "not", {unary()});
        Node base = applied();
        if (takes("^")) return node(Is::Binary, "^", {std::move(base), unary()});
        return base;
    }

    bool begins_atom() const {
        const Piece &p = now();
        if (p.kind == Word::Name)
            return p.text != "in" && p.text != "else" && p.text != "for" && p.text != "if";
        return p.kind == Word::Number || p.kind == Word::Text || p.text == "(" || p.text == "[" ||
               p.text == "{";
    }

    Node applied() {
        Node n = atom();
        for (int length = 0;; longer(length)) {
            if (sees(".") && next().kind == Word::Name) {
                ++at_;
                n = node(Is::Member, name(), {std::move(n)});
            } else if (begins_atom() && n.is != Is::Number && n.is != Is::List) {
                n = node(Is::Call, "", {std::move(n), argument()});
                n.names.emplace_back();
            } else {
                return n;
            }
        }
    }

    Node argument() { // an atom with the parts that touch it
        Node n = atom();
        while (sees(".") && !now().spaced && next().kind == Word::Name) {
            ++at_;
            n = node(Is::Member, name(), {std::move(n)});
        }
        return n;
    }

    Node element() {
        if (!takes("for")) return expression(0);
        want("(");
        Node n = node(Is::ForEach, name());
        want("in");
        Node list = expression(0);
        want(")");
        n.parts.push_back(element());
        n.parts.push_back(std::move(list));
        return n;
    }

    Node atom() {
        const Depth deeper(*this);
        const Piece &p = now();
        if (p.kind == Word::Number) return ++at_, node(Is::Number, p.text);
        if (p.kind == Word::Text) return ++at_, node(Is::Text, p.text.substr(1, p.text.size() - 2));
        if (p.kind == Word::Name) {
            if (p.text == "let" || p.text == "in" || p.text == "for" || p.text == "match" ||
                p.text == "where")
                throw Unsure{};
            return ++at_, node(Is::Name, p.text);
        }
        const bool list = takes("[");
        if (list || takes("(")) {
            Node n = node(Is::List, "");
            while (!takes(list ? "]" : ")")) {
                n.parts.push_back(element());
                if (!takes(",") && !sees(list ? "]" : ")")) throw Unsure{};
            }
            if (list || n.parts.size() != 1) return n;
            Node only = std::move(n.parts[0]);
            // A list in parentheses is applied to nothing, so it stays what it was.
            return only;
        }
        want("{");
        Node n = node(Is::Record, "");
        while (!takes("}")) {
            n.names.push_back(name());
            if (sees("[") || sees("(")) { // `dist [x, y, z, t] = e`
                Statement head;
                patterns(head);
                Node f = node(Is::Lambda, "");
                f.names = head.names;
                want("=");
                f.parts.push_back(expression(0));
                n.parts.push_back(std::move(f));
            } else {
                if (!takes(":")) want("=");
                n.parts.push_back(expression(0));
            }
            if (!takes(",") && !takes(";") && !sees("}")) throw Unsure{};
        }
        return n;
    }

    int scopes_ = 0;
};

} // namespace

std::vector<Statement> read_curv(const std::vector<Piece> &pieces) {
    return CurvReader(pieces).all();
}

} // namespace fathom::lang::program
