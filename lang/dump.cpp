// The tree as indented text, for goldens: one node a line, children below it, nothing about places.
// Two programs with the same dump have the same tree.
#include "lang/format.h"

#include "base/encode.h"
#include "base/text.h"

namespace fathom::lang {

namespace {

template <class... Ts> struct overloaded : Ts... { using Ts::operator()...; };
template <class... Ts> overloaded(Ts...) -> overloaded<Ts...>;

std::string_view op_text(BinaryOp op) {
    switch (op) {
    case BinaryOp::Union: return "|";
    case BinaryOp::Intersection: return "&";
    case BinaryOp::Or: return "or";
    case BinaryOp::And: return "and";
    case BinaryOp::Equal: return "==";
    case BinaryOp::NotEqual: return "!=";
    case BinaryOp::Less: return "<";
    case BinaryOp::LessEqual: return "<=";
    case BinaryOp::Greater: return ">";
    case BinaryOp::GreaterEqual: return ">=";
    case BinaryOp::Add: return "+";
    case BinaryOp::Sub: return "-";
    case BinaryOp::Mul: return "*";
    case BinaryOp::Div: return "/";
    case BinaryOp::Mod: return "%";
    case BinaryOp::Pow: return "^";
    }
    return "";
}

std::string type_text(const TypeExpr &type) {
    switch (type.kind) {
    case TypeExpr::Kind::Name:
        return std::string(type.name) +
               (type.lipschitz ? "<" + format_shortest(*type.lipschitz) + ">" : "");
    case TypeExpr::Kind::List: return "[" + type_text(type.items.at(0)) + "]";
    case TypeExpr::Kind::Function: break;
    }
    std::string out = "(";
    for (std::size_t i = 0; i + 1 < type.items.size(); ++i)
        out += (i ? ", " : "") + type_text(type.items[i]);
    return out + ") -> " + type_text(type.items.back());
}

std::string type_suffix(const TypeExpr *type) { return type ? ": " + type_text(*type) : ""; }

class Dump {
  public:
    explicit Dump(const Ast &ast) : ast_(ast) {}
    void block(BlockId id) {
        for (const Stmt &s : ast_.blocks[id].stmts) stmt(s);
    }
    std::string take() { return std::move(out_); }

  private:
    void line(std::string_view text) {
        out_.append(2 * depth_, ' ');
        out_ += text;
        out_ += '\n';
    }
    template <class Body> void node(std::string_view text, Body body) {
        line(text);
        ++depth_;
        body();
        --depth_;
    }
    void part(std::string_view name, ExprId id) {
        node(name, [&] { expr(id); });
    }
    void expr(ExprId id);
    void stmt(const Stmt &stmt);
    void call(const Call &call);
    void function(FunctionId id, std::string_view head);

    const Ast &ast_;
    std::string out_;
    std::size_t depth_ = 0;
};

void Dump::function(FunctionId id, std::string_view head) {
    const Function &f = ast_.functions[id];
    std::string text(head);
    if (f.name) text += " " + std::string(f.name->text);
    if (f.result) text += " -> " + type_text(*f.result);
    if (!f.doc.empty()) text += " doc " + for_json(f.doc);
    node(text, [&] {
        for (const Parameter &p : f.parameters) {
            node("parameter " + std::string(p.name.text) + type_suffix(p.type), [&] {
                if (p.default_value) expr(*p.default_value);
            });
        }
        node(f.body_is_expression ? "value" : "body", [&] { block(f.body); });
    });
}

void Dump::call(const Call &call) {
    node(call.has_parentheses ? "call" : "call without parentheses", [&] {
        expr(call.callee);
        for (const Argument &a : call.arguments)
            part(a.name ? "argument " + std::string(a.name->text) : "argument", a.value);
        if (call.trailing) node("block", [&] { block(*call.trailing); });
    });
}

// Long: an arm for each kind of expression.
void Dump::expr(ExprId id) {
    const Expr &e = ast_.exprs[id];
    std::visit(overloaded{
                   [&](const Poison &) { line("poison"); },
                   [&](const Number &n) {
                       std::string text =
                           (n.is_int ? "int " : "number ") + format_shortest(n.value);
                       if (!n.unit.empty()) text += " from " + std::string(n.unit);
                       line(text);
                   },
                   [&](const String &s) { line("string " + for_json(s.value)); },
                   [&](const Bool &b) { line(b.value ? "true" : "false"); },
                   [&](const Color &c) {
                       std::string text = "color";
                       for (const double channel : c.rgba) text += " " + format_shortest(channel);
                       line(text);
                   },
                   [&](const Name &n) { line("name " + std::string(n.text)); },
                   [&](const List &l) {
                       node("list", [&] {
                           for (const ExprId item : l.items) expr(item);
                       });
                   },
                   [&](const Comprehension &c) { node("comprehension", [&] { block(c.body); }); },
                   [&](const Range &r) {
                       node(r.inclusive ? "range ..=" : "range ..", [&] {
                           expr(r.first);
                           expr(r.last);
                       });
                   },
                   [&](const Unary &u) {
                       part(u.op == UnaryOp::Neg ? "unary -" : "unary not", u.operand);
                   },
                   [&](const Binary &b) {
                       std::string text = "binary";
                       for (std::size_t i = 1; i < b.operands.size(); ++i)
                           text += " " + std::string(op_text(b.operands[i].op));
                       node(text, [&] {
                           for (const Operand &operand : b.operands) expr(operand.value);
                       });
                   },
                   [&](const Call &c) { call(c); },
                   [&](const Index &i) {
                       node("index", [&] {
                           expr(i.object);
                           expr(i.index);
                       });
                   },
                   [&](const Member &m) { part("member " + std::string(m.name.text), m.object); },
                   [&](const Lambda &l) { function(l.function, "lambda"); },
                   [&](const If &i) {
                       node("if", [&] {
                           for (const IfBranch &branch : i.branches) {
                               part("condition", branch.condition);
                               node("then", [&] { block(branch.body); });
                           }
                           if (i.otherwise) node("else", [&] { block(*i.otherwise); });
                       });
                   },
                   [&](const BlockExpr &b) { node("block", [&] { block(b.block); }); },
               },
               e.kind);
}

void Dump::stmt(const Stmt &stmt) {
    std::visit(
        overloaded{
            [&](const Bad &) { line("bad"); },
            [&](const ExprStmt &s) { expr(s.value); },
            [&](const Let &s) {
                std::string text = "let " + std::string(s.name.text) + type_suffix(s.type);
                if (!s.doc.empty()) text += " doc " + for_json(s.doc);
                part(text, s.value);
            },
            [&](const Var &s) {
                part("var " + std::string(s.name.text) + type_suffix(s.type), s.value);
            },
            [&](const Assign &s) {
                node("assign " + (s.op ? std::string(op_text(*s.op)) : std::string()) + "=", [&] {
                    expr(s.target);
                    expr(s.value);
                });
            },
            [&](const FunctionDecl &s) { function(s.function, "fn"); },
            [&](const Param &s) {
                std::string text = "param " + std::string(s.name.text) + type_suffix(s.type);
                if (s.label) text += " " + for_json(*s.label);
                node(text, [&] {
                    expr(s.value);
                    if (s.low) part("low", *s.low);
                    if (s.high) part("high", *s.high);
                });
            },
            [&](const Import &s) {
                line("import " + for_json(s.path) + (s.as ? " as " + std::string(s.as->text) : ""));
            },
            [&](const For &s) {
                node("for " + std::string(s.variable.text), [&] {
                    expr(s.sequence);
                    node("body", [&] { block(s.body); });
                });
            },
            [&](const While &s) {
                node("while", [&] {
                    expr(s.condition);
                    if (s.limit) part("limit", *s.limit);
                    node("body", [&] { block(s.body); });
                });
            },
            [&](const Break &) { line("break"); },
            [&](const Return &s) {
                node("return", [&] {
                    if (s.value) expr(*s.value);
                });
            },
        },
        stmt.kind);
}

} // namespace

std::string dump(const Ast &ast) {
    Dump dump(ast);
    dump.block(ast.root);
    return dump.take();
}

} // namespace fathom::lang
