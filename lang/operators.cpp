// Rows of operands and operators, by precedence; see builder.h.
#include "lang/builder.h"

#include <algorithm>

namespace fathom::lang {

namespace {

enum Precedence {
    UnionLevel = 1,
    IntersectionLevel,
    OrLevel,
    AndLevel,
    NotLevel,
    CompareLevel,
    RangeLevel,
    AddLevel,
    MulLevel,
    NegLevel,
    PowLevel
};

struct BinaryRow {
    Tok kind;
    BinaryOp op;
    int precedence;
};

constexpr BinaryRow binary_rows[] = {{Tok::Bar, BinaryOp::Union, UnionLevel},
                                     {Tok::Amp, BinaryOp::Intersection, IntersectionLevel},
                                     {Tok::Or, BinaryOp::Or, OrLevel},
                                     {Tok::And, BinaryOp::And, AndLevel},
                                     {Tok::EqualEqual, BinaryOp::Equal, CompareLevel},
                                     {Tok::NotEqual, BinaryOp::NotEqual, CompareLevel},
                                     {Tok::Less, BinaryOp::Less, CompareLevel},
                                     {Tok::LessEqual, BinaryOp::LessEqual, CompareLevel},
                                     {Tok::Greater, BinaryOp::Greater, CompareLevel},
                                     {Tok::GreaterEqual, BinaryOp::GreaterEqual, CompareLevel},
                                     {Tok::Plus, BinaryOp::Add, AddLevel},
                                     {Tok::Minus, BinaryOp::Sub, AddLevel},
                                     {Tok::Star, BinaryOp::Mul, MulLevel},
                                     {Tok::Slash, BinaryOp::Div, MulLevel},
                                     {Tok::Percent, BinaryOp::Mod, MulLevel},
                                     {Tok::Caret, BinaryOp::Pow, PowLevel}};

} // namespace

void Builder::expression_open(Index at) {
    deeper(at);
    frames_.push_back({items_.size(), ops_.size()});
}

void Builder::row_end() {
    reduce_above(0);
    frames_.pop_back();
}

void Builder::prefix(Index at) {
    Op op;
    op.is_prefix = true;
    op.at = at;
    op.unary = kind(at) == Tok::Minus ? UnaryOp::Neg : UnaryOp::Not;
    op.precedence = op.unary == UnaryOp::Neg ? NegLevel : NotLevel;
    const bool behind_tighter =
        ops_.size() > frames_.back().ops && ops_.back().precedence > op.precedence;
    if (op.unary == UnaryOp::Not && behind_tighter)
        diagnostics_.add(Code::SyntaxError, span(at), "`not` needs parentheses behind an operator")
            .note("`not` binds more loosely than comparisons and arithmetic");
    ops_.push_back(op);
}

void Builder::binary(Index at) {
    Op op;
    op.at = at;
    if (kind(at) == Tok::DotDot || kind(at) == Tok::DotDotEqual) {
        op.is_range = true;
        op.inclusive = kind(at) == Tok::DotDotEqual;
        op.precedence = RangeLevel;
    } else {
        const auto *row = std::find_if(std::begin(binary_rows), std::end(binary_rows),
                                       [&](const BinaryRow &r) { return r.kind == kind(at); });
        op.binary = row->op;
        op.precedence = row->precedence;
    }
    reduce_above(op.precedence);
    const bool chains = op.precedence == CompareLevel || op.precedence == RangeLevel;
    if (chains && ops_.size() > frames_.back().ops && ops_.back().precedence == op.precedence) {
        report_chain(ops_.back(), at);
        reduce_top();
        ast_.exprs[items_.back().id].kind = Poison{};
    }
    ops_.push_back(op);
}

void Builder::report_chain(const Op &first, Index second) {
    if (first.is_range) {
        diagnostics_.add(Code::SyntaxError, span(second), "a range has two ends")
            .label(span(first.at), "the range begins here")
            .help("with steps, write `range(from, to, step)`");
        return;
    }
    const Item &middle = items_.back();
    const std::string copy(text(middle.begin, middle.end)), name = brief(copy);
    const std::string signs =
        std::string(text(first.at)) + " " + name + " and " + name + " " + std::string(text(second));
    diagnostics_.add(Code::SyntaxError, span(second), "comparisons do not chain")
        .label(span(first.at), "the first comparison")
        .help("write `… " + signs + " …`", {{{id_, middle.end, middle.end}, " and " + copy}});
}

void Builder::reduce_above(int precedence) {
    while (ops_.size() > frames_.back().ops && ops_.back().precedence > precedence) reduce_top();
}

// Makes a node of the operators of one precedence on top: all of them where the node is n-ary.
void Builder::reduce_top() {
    const Op top = ops_.back();
    if (top.is_prefix) {
        ops_.pop_back();
        const Item operand = pop_item();
        push(Unary{top.unary, operand.id}, {id_, token(top.at).begin, operand.end},
             1 + height(operand.id));
        return;
    }
    std::size_t first = ops_.size() - 1;
    if (top.precedence != PowLevel)
        while (first > frames_.back().ops && !ops_[first - 1].is_prefix &&
               ops_[first - 1].precedence == top.precedence)
            --first;
    const std::size_t count = ops_.size() - first;
    const std::size_t base = items_.size() - count - 1;
    const Span whole{id_, items_[base].begin, items_.back().end};
    std::uint32_t tallest = 0;
    for (std::size_t i = base; i < items_.size(); ++i)
        tallest = std::max(tallest, height(items_[i].id));
    if (top.is_range) {
        const Range range{items_[base].id, items_[base + 1].id, top.inclusive};
        ops_.pop_back();
        items_.resize(base);
        push(range, whole, 1 + tallest);
        return;
    }
    Binary binary;
    binary.operands.reserve(count + 1);
    binary.operands.push_back({items_[base].id, {}, {}});
    for (std::size_t i = 0; i < count; ++i) {
        const Op &op = ops_[first + i];
        binary.operands.push_back({items_[base + 1 + i].id, op.binary, span(op.at)});
    }
    ops_.resize(first);
    items_.resize(base);
    push(std::move(binary), whole, 1 + tallest);
}

void Builder::ternary() {
    const Item otherwise = pop_item(), then = pop_item(), condition = pop_item();
    remembered_.pop_back(); // the `:`
    const Index question = take_back(remembered_);
    const std::string c = brief(text(condition.begin, condition.end)),
                      a = brief(text(then.begin, then.end)),
                      b = brief(text(otherwise.begin, otherwise.end));
    foreign(span(question), "a choice is written with `if`")
        .help("write `if " + c + " { " + a + " } else { " + b + " }`",
              {{{id_, condition.begin, condition.begin}, "if "},
               {{id_, condition.end, then.begin}, " { "},
               {{id_, then.end, otherwise.begin}, " } else { "},
               {{id_, otherwise.end, otherwise.end}, " }"}});
    If choice;
    const BlockId yes = value_block(then), no = value_block(otherwise);
    choice.branches.push_back({condition.id, yes});
    choice.otherwise = no;
    push(std::move(choice), {id_, condition.begin, otherwise.end},
         1 + std::max({height(condition.id), height(yes), height(no)}));
}

} // namespace fathom::lang
