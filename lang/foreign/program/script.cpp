// Python and JavaScript as a tree: what programs that make shapes are written with.
#include "lang/foreign/program/reader.h"

#include <algorithm>
#include <array>

namespace fathom::lang::program {

Node node(Is is, std::string text, std::vector<Node> parts) {
    Node n;
    n.is = is;
    n.text = std::move(text);
    n.parts = std::move(parts);
    return n;
}

namespace {

struct BinarySign {
    std::string_view theirs, ours;
    int binds;
};
// As tightly as in Python; JavaScript has no `|` and `&` of shapes.
constexpr std::array<BinarySign, 23> binary_signs = {
    {{"or", "or", 1},  {"||", "or", 1}, {"and", "and", 2}, {"&&", "and", 2}, {"==", "==", 4},
     {"===", "==", 4}, {"!=", "!=", 4}, {"!==", "!=", 4},  {"is", "==", 4},  {"<", "<", 4},
     {">", ">", 4},    {"<=", "<=", 4}, {">=", ">=", 4},   {"|", "|", 5},    {"&", "&", 6},
     {"+", "+", 8},    {"-", "-", 8},   {"*", "*", 9},     {"/", "/", 9},    {"%", "%", 9},
     {"//", "div", 9}, {"@", "*", 9},   {"**", "^", 11}}};

class Reader : PieceReader {
  public:
    Reader(const std::vector<Piece> &pieces, bool python) : PieceReader(pieces), python_(python) {}

    std::vector<Statement> all() {
        std::vector<Statement> out;
        while (now().kind != Word::End) {
            if (python_ && now().column != 0) throw Unsure{};
            one(out);
        }
        return out;
    }

  private:
    bool line_ended() const { return now().kind == Word::End || (now().first && inside_ == 0); }
    void end_statement() {
        if (takes(";")) return;
        if (line_ended() || (!python_ && sees("}"))) return;
        throw Unsure{};
    }
    struct Inside { // brackets, where a line's end is nothing
        explicit Inside(Reader &r, bool is = true) : of(r), was(r.inside_) {
            of.inside_ = is ? was + 1 : 0;
        }
        ~Inside() { of.inside_ = was; }
        Reader &of;
        int was;
    };

    // -- statements --

    std::vector<Statement> body() {
        const Depth depth(*this);
        std::vector<Statement> out;
        if (!python_) {
            if (!takes("{")) {
                one(out);
                return out;
            }
            const Inside apart(*this, false);
            while (!takes("}")) {
                if (now().kind == Word::End) throw Unsure{};
                one(out);
            }
            return out;
        }
        want(":");
        if (!now().first) {
            one(out);
            return out;
        }
        const std::uint32_t column = now().column;
        if (column <= outer_) throw Unsure{};
        const std::uint32_t was = outer_;
        outer_ = column;
        while (now().kind != Word::End && now().column == column) one(out);
        outer_ = was;
        if (now().kind != Word::End && now().column > column) throw Unsure{};
        return out;
    }

    void one(std::vector<Statement> &out) {
        if (takes(";")) return;
        Statement s;
        const std::size_t before = at_;
        s.comment = now().comment;
        if (python_)
            python_statement(s);
        else
            script_statement(s);
        if (at_ == before) throw Unsure{}; // nothing was read, and nothing would be
        out.push_back(std::move(s));
    }

    void python_statement(Statement &s) {
        if (sees("from") || (sees("import") && next().kind == Word::Name)) {
            do ++at_;
            while (!line_ended());
            return;
        }
        if (takes("@")) {
            const std::string by = name();
            if (by != "sdf3" && by != "sdf2") throw Unsure{};
            if (!sees("def")) throw Unsure{};
            s.decorated = by == "sdf3" ? 3 : 2;
        }
        if (takes("def")) {
            s.does = Does::Function;
            s.name = name();
            want("(");
            parameters(s.names, s.defaults, ")");
            if (takes("->")) postfix();
            s.body = body();
            return;
        }
        if (takes("for")) {
            s.does = Does::For;
            s.name = name();
            want("in");
            s.value = expression();
            s.body = body();
            return;
        }
        if (takes("if")) return choice(s);
        if (takes("return")) {
            s.does = Does::Return;
            s.value = row_of_values();
            return end_statement();
        }
        if (takes("pass")) return end_statement();
        assignment(s);
    }

    void choice(Statement &s) {
        const Depth depth(*this);
        s.does = Does::If;
        if (!python_) want("(");
        s.value = expression();
        if (!python_) want(")");
        s.body = body();
        if (python_ && sees("elif") && now().column == outer_) {
            ++at_;
            Statement further;
            choice(further);
            s.otherwise.push_back(std::move(further));
        } else if (sees("else") && (!python_ || now().column == outer_)) {
            ++at_;
            if (!python_ && takes("if")) {
                Statement further;
                choice(further);
                s.otherwise.push_back(std::move(further));
            } else {
                s.otherwise = body();
            }
        }
    }

    void skip_import() {
        ++at_;
        while (!sees(";") && !line_ended()) ++at_;
        takes(";");
    }

    void script_statement(Statement &s) {
        if (sees("import")) return skip_import();
        if (sees("export") && (next().text == "const" || next().text == "function")) ++at_;
        if (sees("export") && next().text == "default" && next(2).text != "main") {
            at_ += 2;
            s.does = Does::Return;
            s.value = expression();
            return end_statement();
        }
        if (sees("export") || (sees("module") && next().text == ".")) {
            const bool record = next(2).text == "{" || next(1).text == "{" || next(4).text == "{";
            while (!(record ? sees("}") : line_ended() || sees(";"))) {
                if (now().kind == Word::End) throw Unsure{};
                ++at_;
            }
            if (record) ++at_;
            takes(";");
            return;
        }
        if (takes("const") || takes("let") || takes("var")) {
            s.does = Does::Set;
            s.sign = "=";
            s.targets.push_back(postfix());
            want("=");
            s.value = expression();
            return end_statement();
        }
        if (takes("function")) {
            s.does = Does::Function;
            s.name = name();
            want("(");
            parameters(s.names, s.defaults, ")");
            s.body = body();
            return;
        }
        if (takes("for")) return script_loop(s);
        if (takes("if")) return choice(s);
        if (takes("return")) {
            s.does = Does::Return;
            s.value = expression();
            return end_statement();
        }
        assignment(s);
    }

    // `for (const x of l)`, `for (let i = 0; i < n; i++)`.
    void script_loop(Statement &s) {
        s.does = Does::For;
        want("(");
        if (!takes("const") && !takes("let") && !takes("var")) throw Unsure{};
        s.name = name();
        if (takes("of")) {
            s.value = expression();
            want(")");
            s.body = body();
            return;
        }
        want("=");
        Node first = expression();
        want(";");
        if (name() != s.name) throw Unsure{};
        const bool with = takes("<=");
        if (!with) want("<");
        Node last = expression();
        want(";");
        Node step = node(Is::Number, "1");
        if (takes("++")) {
            if (name() != s.name) throw Unsure{};
        } else {
            if (name() != s.name) throw Unsure{};
            if (takes("+="))
                step = expression();
            else
                want("++");
        }
        want(")");
        s.value = node(Is::Ours, with ? "..=" : "..",
                       {std::move(first), std::move(last), std::move(step)});
        s.body = body();
    }

    void assignment(Statement &s) {
        Node left = expression();
        s.targets.push_back(left);
        while (python_ && sees(",")) {
            ++at_;
            s.targets.push_back(expression());
        }
        constexpr std::array<std::string_view, 7> assigns = {
            "=", "+=", "-=", "*=", "/=", "|=", "&="};
        for (const std::string_view sign : assigns)
            if (takes(sign)) {
                s.does = Does::Set;
                s.sign = std::string(sign);
                s.value = row_of_values();
                return end_statement();
            }
        if (s.targets.size() > 1) throw Unsure{};
        s.does = Does::Value;
        s.value = std::move(left);
        s.targets.clear();
        end_statement();
    }

    Node row_of_values() {
        Node first = expression();
        if (!python_ || !sees(",")) return first;
        Node list = node(Is::List, "", {std::move(first)});
        while (takes(",")) list.parts.push_back(expression());
        return list;
    }

    void parameters(std::vector<std::string> &names, std::vector<Node> &defaults,
                    std::string_view close) {
        const Inside inside(*this);
        while (!takes(close)) {
            names.push_back(name());
            if (python_ && takes(":")) postfix();
            defaults.push_back(takes("=") ? expression() : Node{});
            if (!takes(",") && !sees(close)) throw Unsure{};
        }
    }

    // -- values --

    bool is_lambda() const { // at `(` or a name
        std::size_t i = at_;
        if (pieces_[i].kind == Word::Name) return next().text == "=>";
        if (pieces_[i].text != "(") return false;
        for (++i; i < pieces_.size() && (pieces_[i].kind == Word::Name || pieces_[i].text == ",");)
            ++i;
        return pieces_[i].text == ")" && i + 1 < pieces_.size() && pieces_[i + 1].text == "=>";
    }

    Node lambda_value() {
        Node n = node(Is::Lambda, "");
        if (python_) { // behind `lambda`
            while (!takes(":")) {
                n.names.push_back(name());
                takes(",");
            }
        } else if (takes("(")) {
            while (!takes(")")) {
                n.names.push_back(name());
                takes(",");
            }
            want("=>");
        } else {
            n.names.push_back(name());
            want("=>");
        }
        if (!python_ && sees("{"))
            n.body = body();
        else
            n.parts.push_back(expression());
        return n;
    }

    Node expression() {
        const Depth depth(*this);
        if (!python_ && is_lambda()) return lambda_value();
        if (python_ && takes("lambda")) return lambda_value();
        Node value = row(0);
        if (python_ && sees("if") && !line_ended()) {
            ++at_;
            Node condition = row(0);
            want("else");
            return node(Is::Choice, "", {std::move(condition), std::move(value), expression()});
        }
        if (!python_ && takes("?")) {
            Node yes = expression();
            want(":");
            return node(Is::Choice, "", {std::move(value), std::move(yes), expression()});
        }
        return value;
    }

    Node row(int above) {
        const Depth depth(*this);
        Node left = prefix();
        for (int length = 0;; longer(length)) {
            if (now().kind == Word::Text || now().kind == Word::Number) return left;
            if (python_ && line_ended()) return left;
            const auto sign = std::ranges::find(binary_signs, now().text, &BinarySign::theirs);
            if (sign == binary_signs.end() || sign->binds <= above ||
                (sign->theirs == "//" && !python_) || now().kind == Word::End)
                return left;
            ++at_;
            const bool negated = sign->theirs == "is" && takes("not");
            Node right = row(sign->ours == "^" ? sign->binds - 1 : sign->binds);
            left = node(Is::Binary, negated ? "!=" : std::string(sign->ours),
                        {std::move(left), std::move(right)});
        }
    }

    Node prefix() {
        const Depth depth(*this);
        if (takes("-")) return node(Is::Unary, "-", {row(9)});
        if (takes("+")) return row(9);
        if (python_ ? takes("not") : takes("!")) return node(Is::Unary, "not", {row(3)});
        if (takes("...")) return node(Is::Spread, "", {expression()});
        if (python_ && takes("*")) return node(Is::Spread, "", {expression()});
        if (!python_ && takes("new")) return postfix();
        return postfix();
    }

    Node postfix() {
        Node n = operand();
        for (int length = 0;; longer(length)) {
            if (python_ && line_ended()) return n;
            if (sees(".") && next().kind == Word::Name) {
                ++at_;
                n = node(Is::Member, name(), {std::move(n)});
            } else if (sees("(") && !line_ended()) {
                ++at_;
                n = arguments(std::move(n));
            } else if (sees("[") && !line_ended()) {
                ++at_;
                const Inside inside(*this);
                const bool column = takes(":");
                if (column) want(",");
                n = node(column ? Is::Column : Is::Index, "", {std::move(n), expression()});
                want("]");
            } else {
                return n;
            }
        }
    }

    Node arguments(Node callee) {
        const Inside inside(*this);
        Node n = node(Is::Call, "", {std::move(callee)});
        while (!takes(")")) {
            std::string key;
            if (python_ && now().kind == Word::Name && next().text == "=") {
                key = name();
                want("=");
            }
            n.parts.push_back(expression());
            n.names.push_back(key);
            if (python_ && sees("for")) n.parts.back() = for_each(std::move(n.parts.back()));
            if (!takes(",") && !sees(")")) throw Unsure{};
        }
        return n;
    }

    Node for_each(Node value) {
        want("for");
        Node n = node(Is::ForEach, name());
        want("in");
        n.parts.push_back(std::move(value));
        n.parts.push_back(row(0));
        if (takes("if")) n.parts.push_back(row(0));
        return n;
    }

    Node list(std::string_view close) {
        const Inside inside(*this);
        Node n = node(Is::List, "");
        bool comma = false;
        while (!takes(close)) {
            n.parts.push_back(expression());
            if (python_ && sees("for")) {
                n = for_each(std::move(n.parts.back()));
                want(close);
                return n;
            }
            const bool more = takes(",");
            comma = comma || more;
            if (!more && !sees(close)) throw Unsure{};
        }
        if (close == ")" && n.parts.size() == 1 && !comma) {
            Node only = std::move(n.parts[0]);
            return only;
        }
        if (close == ")" && !python_) throw Unsure{};
        return n;
    }

    Node operand() {
        const Piece &p = now();
        if (p.kind == Word::Number) return ++at_, node(Is::Number, p.text);
        if (p.kind == Word::Text) return ++at_, node(Is::Text, p.text.substr(1, p.text.size() - 2));
        if (p.kind == Word::Name) return ++at_, node(Is::Name, p.text);
        if (takes("(")) return list(")");
        if (takes("[")) return list("]");
        if (!python_ && takes("{")) return record();
        throw Unsure{};
    }

    Node record() {
        const Inside inside(*this);
        Node n = node(Is::Record, "");
        while (!takes("}")) {
            const bool quoted = now().kind == Word::Text;
            n.names.push_back(quoted ? operand().text : name());
            n.parts.push_back(takes(":") ? expression() : node(Is::Name, n.names.back()));
            if (!takes(",") && !sees("}")) throw Unsure{};
        }
        return n;
    }

    bool python_;
    int inside_ = 0;
    std::uint32_t outer_ = 0; // the column of the block
};

} // namespace

std::vector<Statement> read_script(const std::vector<Piece> &pieces, bool python) {
    return Reader(pieces, python).all();
}

} // namespace fathom::lang::program
