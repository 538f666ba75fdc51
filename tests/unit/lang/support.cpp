#include "support.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace lang_test {

using namespace fathom;
using namespace fathom::lang;

std::vector<std::string> Parsed::codes() const {
    std::vector<std::string> codes;
    for (const Diagnostic &d : diagnostics.sorted()) codes.emplace_back(code_name(d.code));
    return codes;
}

std::string Parsed::report() const {
    std::string out;
    for (const Diagnostic &d : diagnostics.sorted()) out += to_text(d, sources, false);
    return out;
}

std::string tree_of(const std::string &text) {
    const Parsed parsed(text);
    if (!parsed.diagnostics.items().empty()) return parsed.report();
    std::string out;
    std::size_t depth = 0;
    const std::string tree = parsed.tree();
    for (std::size_t begin = 0; begin < tree.size();) {
        const std::size_t end = tree.find('\n', begin);
        const std::size_t word = tree.find_first_not_of(' ', begin);
        const std::size_t level = (word - begin) / 2;
        if (level > depth)
            out += '(';
        else {
            out.append(depth - level, ')');
            if (begin > 0) out += level == 0 ? "; " : ", ";
        }
        out += tree.substr(word, end - word);
        depth = level;
        begin = end + 1;
    }
    return out + std::string(depth, ')');
}

std::string apply_fix(const std::string &text, const Diagnostic &diagnostic) {
    std::vector<Edit> edits = diagnostic.fix->edits;
    std::stable_sort(edits.begin(), edits.end(),
                     [](const Edit &a, const Edit &b) { return a.span < b.span; });
    std::string out = text;
    for (auto edit = edits.rbegin(); edit != edits.rend(); ++edit)
        out.replace(edit->span.begin, edit->span.end - edit->span.begin, edit->replacement);
    return out;
}

namespace {

template <class... Ts> struct overloaded : Ts... { using Ts::operator()...; };
template <class... Ts> overloaded(Ts...) -> overloaded<Ts...>;

class TreeCheck {
  public:
    explicit TreeCheck(const Parsed &parsed)
        : ast_(parsed.ast), size_(parsed.text().size()), seen_(ast_.exprs.size()),
          seen_blocks_(ast_.blocks.size()), seen_functions_(ast_.functions.size()) {}

    std::string run() {
        block(ast_.root);
        return defect_;
    }

  private:
    void fail(std::string what) {
        if (defect_.empty()) defect_ = std::move(what);
    }
    void place(Span span) {
        if (span.source != ast_.source || span.begin > span.end || span.end > size_)
            fail("a place outside the text");
    }
    void block(BlockId id) {
        if (id.index >= ast_.blocks.size() || seen_blocks_[id.index])
            return fail("a block out of range or used twice");
        seen_blocks_[id.index] = true;
        if (++depth_ > 4000) return fail("a tree that is too deep");
        place(ast_.blocks[id].span);
        for (const Stmt &s : ast_.blocks[id].stmts) stmt(s);
        --depth_;
    }
    void function(FunctionId id) {
        if (id.index >= ast_.functions.size() || seen_functions_[id.index])
            return fail("a function out of range or used twice");
        seen_functions_[id.index] = true;
        const Function &f = ast_.functions[id];
        place(f.span);
        place(f.head);
        for (const Parameter &p : f.parameters) {
            place(p.name.span);
            if (p.default_value) expr(*p.default_value);
        }
        block(f.body);
    }
    void expr(ExprId id) {
        if (id.index >= ast_.exprs.size()) return fail("an expression out of range");
        if (seen_[id.index]) return fail("an expression used twice");
        seen_[id.index] = true;
        if (++depth_ > 4000) return fail("a tree that is too deep");
        const Expr &e = ast_.exprs[id];
        place(e.span);
        std::visit(overloaded{
                       [](const Poison &) {},
                       [](const Number &) {},
                       [](const String &) {},
                       [](const Bool &) {},
                       [](const Color &) {},
                       [&](const Name &n) {
                           if (n.text.empty()) fail("a name without letters");
                       },
                       [&](const List &l) {
                           for (const ExprId item : l.items) expr(item);
                       },
                       [&](const Comprehension &c) { block(c.body); },
                       [&](const Range &r) { expr(r.first), expr(r.last); },
                       [&](const Unary &u) { expr(u.operand); },
                       [&](const Binary &b) {
                           if (b.operands.size() < 2) fail("an operator without its operands");
                           for (std::size_t i = 1; i < b.operands.size(); ++i)
                               place(b.operands[i].op_span);
                           for (const Operand &operand : b.operands) expr(operand.value);
                       },
                       [&](const Call &c) {
                           expr(c.callee);
                           for (const Argument &a : c.arguments) expr(a.value);
                           if (c.trailing) block(*c.trailing);
                       },
                       [&](const Index &i) { expr(i.object), expr(i.index); },
                       [&](const Member &m) { expr(m.object), place(m.name.span); },
                       [&](const Lambda &l) { function(l.function); },
                       [&](const If &i) {
                           if (i.branches.empty()) fail("an `if` without a branch");
                           for (const IfBranch &b : i.branches) expr(b.condition), block(b.body);
                           if (i.otherwise) block(*i.otherwise);
                       },
                       [&](const BlockExpr &b) { block(b.block); },
                   },
                   e.kind);
        --depth_;
    }
    void stmt(const Stmt &s) {
        place(s.span);
        std::visit(overloaded{
                       [](const Bad &) {},
                       [&](const ExprStmt &x) { expr(x.value); },
                       [&](const Let &x) { place(x.name.span), expr(x.value); },
                       [&](const Var &x) { place(x.name.span), expr(x.value); },
                       [&](const Assign &x) { expr(x.target), expr(x.value); },
                       [&](const FunctionDecl &x) { function(x.function); },
                       [&](const Param &x) {
                           expr(x.value);
                           if (x.low.has_value() != x.high.has_value()) fail("half a range");
                           if (x.low) expr(*x.low), expr(*x.high);
                       },
                       [&](const Import &x) { place(x.path_span); },
                       [&](const For &x) { expr(x.sequence), block(x.body); },
                       [&](const While &x) {
                           expr(x.condition);
                           if (x.limit) expr(*x.limit);
                           block(x.body);
                       },
                       [](const Break &) {},
                       [&](const Return &x) {
                           if (x.value) expr(*x.value);
                       },
                   },
                   s.kind);
    }

    const Ast &ast_;
    std::size_t size_;
    std::vector<bool> seen_, seen_blocks_, seen_functions_;
    std::string defect_;
    int depth_ = 0;
};

} // namespace

std::string defect(const Parsed &parsed) { return TreeCheck(parsed).run(); }

std::vector<File> corpus() {
    namespace fs = std::filesystem;
    std::vector<File> files;
    for (const char *folder : {"examples", "stdlib", "tests/golden"}) {
        const fs::path root = fs::path(FATHOM_SOURCE_DIR) / folder;
        if (!fs::exists(root)) continue;
        for (const auto &entry : fs::recursive_directory_iterator(root)) {
            if (entry.path().extension() != ".sdf") continue;
            std::ifstream in(entry.path(), std::ios::binary);
            std::string text{std::istreambuf_iterator<char>(in), {}};
            // A golden's program ends where its expectations begin.
            if (const auto end = text.find("//===="); end != std::string::npos) text.resize(end);
            files.push_back(
                {fs::relative(entry.path(), FATHOM_SOURCE_DIR).string(), std::move(text)});
        }
    }
    std::sort(files.begin(), files.end(),
              [](const File &a, const File &b) { return a.path < b.path; });
    return files;
}

} // namespace lang_test
