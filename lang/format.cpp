// `fathom fmt`: the words of a text, laid out anew. Works on words and comments, not on the tree,
// so that nothing can be lost: it only chooses spaces and line ends. The writer's own line breaks
// are kept where they are meant (one style of indentation and spacing), lines of more than 100
// columns are broken, blank lines collapse to one. The breaks found are a fixed point: formatting
// again changes nothing.
#include "lang/format.h"

#include "base/text.h"
#include "lang/pieces.h"

#include <algorithm>
#include <limits>

namespace fathom::lang {

namespace {

constexpr std::size_t widest = 100;
constexpr std::size_t step = 2; // columns of one level

bool ends_operand(const Piece &p) {
    return is_one_of(p.kind, {Tok::Name, Tok::Number, Tok::String, Tok::Color, Tok::True,
                              Tok::False, Tok::Close, Tok::ListClose, Tok::BraceClose});
}

// How loosely a binary operator binds; 0 for what is none. `..` is no place for a break.
int looseness(Tok kind) {
    if (kind == Tok::Bar) return 8;
    if (kind == Tok::Amp) return 7;
    if (kind == Tok::Or) return 6;
    if (kind == Tok::And) return 5;
    if (is_one_of(kind, {Tok::EqualEqual, Tok::NotEqual, Tok::Less, Tok::LessEqual, Tok::Greater,
                         Tok::GreaterEqual}))
        return 4;
    if (is_one_of(kind, {Tok::Plus, Tok::Minus})) return 3;
    if (is_one_of(kind, {Tok::Star, Tok::Slash, Tok::Percent})) return 2;
    return kind == Tok::Caret ? 1 : 0;
}

bool is_keyword_before_operand(Tok kind) {
    return is_one_of(kind, {Tok::Let, Tok::Var, Tok::Fn, Tok::Param, Tok::Import, Tok::For, Tok::In,
                            Tok::If, Tok::Else, Tok::While, Tok::Limit, Tok::As, Tok::Not});
}

std::size_t display_columns(std::string_view text) {
    std::size_t columns = 0;
    for (std::size_t i = 0; i < text.size();) {
        const CodePoint c = decode_utf8(text, i);
        columns += static_cast<std::size_t>(display_width(c.value));
        i += c.length;
    }
    return columns;
}

class Formatter {
  public:
    explicit Formatter(std::vector<Piece> pieces) : pieces_(std::move(pieces)) {
        classify();
        keep_breaks();
        levels_.push_back({});
    }
    std::string run();

  private:
    struct Level { // an open bracket, or the file
        Tok kind = Tok::Body;
        std::size_t line_indent = 0;
        bool is_file = true;
        std::size_t head = 0;  // where the last line that begins no `.name(…)` begins
        std::size_t chain = 0; // where those that do begin
        bool in_chain = false;
    };

    const Piece &at(std::size_t i) const { return pieces_[i]; }
    std::size_t previous_word(std::size_t i) const { // or the size, where there is none
        while (i-- > 0)
            if (!pieces_[i].is_comment) return i;
        return pieces_.size();
    }
    void classify();
    void keep_breaks();
    void settle_group(std::size_t open);
    void open_block(std::size_t open);
    bool separated(std::size_t i) const;
    bool space_before(std::size_t i) const;
    std::string_view separator(std::size_t i) const;
    std::size_t line_end(std::size_t begin) const;
    std::size_t width(std::size_t begin, std::size_t end) const;
    std::size_t indent_of(std::size_t begin);
    void walk(std::size_t begin, std::size_t end, std::size_t indent);
    bool break_up(std::size_t begin, std::size_t end, std::size_t indent);
    bool add_break(std::size_t i);
    bool break_group(std::size_t open);

    std::vector<Piece> pieces_;
    std::vector<bool> edge_; // of a comment: no statement goes on behind it
    std::vector<Level> levels_;
};

void Formatter::classify() {
    std::size_t before = pieces_.size();
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        Piece &p = pieces_[i];
        if (p.is_comment) continue;
        const bool after_operand = before < i && ends_operand(at(before)) && !p.starts_statement;
        p.is_prefix = p.kind == Tok::Minus && !after_operand;
        p.is_call = (p.kind == Tok::Open || p.kind == Tok::ListOpen) && after_operand;
        before = i;
        // Comparisons do not chain, so that this can only be `shape<1>`.
        const bool bound = i + 3 < pieces_.size() && p.kind == Tok::Name &&
                           at(i + 1).kind == Tok::Less && at(i + 2).kind == Tok::Number &&
                           at(i + 3).kind == Tok::Greater;
        if (bound) pieces_[i + 1].in_type = pieces_[i + 2].in_type = pieces_[i + 3].in_type = true;
    }
    edge_.assign(pieces_.size(), true);
    bool edge = true;
    for (std::size_t i = pieces_.size(); i-- > 0;) {
        if (!at(i).is_comment) edge = at(i).starts_statement || at(i).kind == Tok::BraceClose;
        edge_[i] = edge;
    }
}

// The writer's line breaks, less those in places where none is wanted.
void Formatter::keep_breaks() {
    std::size_t before = pieces_.size();
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        Piece &p = pieces_[i];
        const bool has_before = before < i;
        p.breaks = i > 0 && p.newlines > 0;
        p.blank_above = i > 0 && p.newlines > 1;
        if (p.is_comment) continue;
        // A break around a sign that belongs to its neighbour moves over it.
        const bool after_comment = i > 0 && at(i - 1).is_comment;
        if (p.breaks && p.kind == Tok::Comma && !after_comment && i + 1 < pieces_.size()) {
            p.breaks = false;
            if (!at(i + 1).is_comment) pieces_[i + 1].newlines = std::max(1u, at(i + 1).newlines);
        }
        if (p.breaks && has_before && at(before).kind == Tok::Dot && !after_comment) {
            p.breaks = false;
            if (before > 0 && !at(before - 1).is_line_comment) pieces_[before].breaks = true;
        }
        if (is_one_of(p.kind, {Tok::Colon, Tok::Assign, Tok::FatArrow, Tok::Arrow, Tok::In,
                               Tok::Limit, Tok::As, Tok::Else}))
            p.breaks = false;
        if (has_before && (at(before).is_prefix || is_keyword_before_operand(at(before).kind)) &&
            !p.starts_statement)
            p.breaks = false;
        if (p.in_type || p.is_call || is_block_open(p.kind)) p.breaks = false;
        before = i;
    }
    for (std::size_t i = 0; i < pieces_.size(); ++i)
        if (i > 0 && at(i - 1).is_line_comment) pieces_[i].breaks = true;

    // Blocks: on one line as long as nothing in them breaks. Inner ones close first.
    std::vector<std::size_t> breaks_before(pieces_.size() + 1, 0);
    for (std::size_t i = 0; i < pieces_.size(); ++i)
        breaks_before[i + 1] = breaks_before[i] + at(i).breaks;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        Piece &p = pieces_[i];
        if (is_block_open(p.kind)) {
            p.inline_block = breaks_before[p.match + 1] == breaks_before[i + 1];
            if (!p.inline_block) open_block(i);
        } else if (is_group_open(p.kind)) {
            settle_group(i);
        }
    }
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        Piece &p = pieces_[i];
        if (is_close(p.kind)) open.pop_back();
        const bool in_lines =
            open.empty() || (is_block_open(at(open.back()).kind) && !at(open.back()).inline_block);
        if (i > 0 && p.starts_statement && in_lines && !at(i - 1).is_comment) p.breaks = true;
        if (is_open(p.kind)) open.push_back(i);
        const bool first = i == 0 || (is_open(at(i - 1).kind) && !at(i - 1).is_comment);
        if (first || is_close(p.kind) || !p.breaks) p.blank_above = false;
    }
}

// A group's closing bracket stands on a line of its own if and only if its opening one ends a line.
void Formatter::settle_group(std::size_t open) {
    Piece &close = pieces_[at(open).match];
    const std::size_t last = at(open).match - 1;
    if (at(last).is_line_comment) return;
    close.breaks = open + 1 < at(open).match && at(open + 1).breaks;
    if (open + 1 == at(open).match) close.breaks = false;
}

void Formatter::open_block(std::size_t open) {
    pieces_[open].inline_block = false;
    const std::size_t close = at(open).match;
    if (open + 1 == close) {
        if (!at(open).is_comment) pieces_[close].breaks = false;
        return;
    }
    // A comment behind the brace stays there.
    if (!at(open + 1).is_comment) pieces_[open + 1].breaks = true;
    pieces_[close].breaks = true;
    std::size_t depth = 0;
    for (std::size_t i = open + 1; i < close; ++i) {
        if (is_close(at(i).kind)) --depth;
        if (depth == 0 && at(i).starts_statement && !at(i - 1).is_comment) pieces_[i].breaks = true;
        if (is_open(at(i).kind)) ++depth;
    }
}

// -- spaces --------------------------------------------------------------------------------------

bool Formatter::space_before(std::size_t i) const {
    const Piece &p = at(i);
    const Piece &left = at(i - 1);
    if (is_group_open(left.kind)) return false;
    if (p.is_comment) return true;
    if (p.kind == Tok::Close || p.kind == Tok::ListClose || p.kind == Tok::Comma ||
        p.kind == Tok::Colon)
        return false;
    if (left.is_comment) return true;
    if (p.kind == Tok::Dot || left.kind == Tok::Dot) return false;
    if (p.kind == Tok::DotDot || p.kind == Tok::DotDotEqual || left.kind == Tok::DotDot ||
        left.kind == Tok::DotDotEqual)
        return false;
    if (left.is_prefix || p.is_call || p.in_type) return false;
    if (is_block_open(left.kind) && p.kind == Tok::BraceClose) return false;
    const std::size_t name = i >= 2 ? i - 2 : 0;
    const bool head = left.kind == Tok::Name && at(name).kind == Tok::Fn && p.kind == Tok::Open;
    return !head;
}

// Whether a piece begins another statement of a block on one line.
bool Formatter::separated(std::size_t i) const {
    const std::size_t before = previous_word(i);
    return at(i).starts_statement && before < i && !is_block_open(at(before).kind);
}

std::string_view Formatter::separator(std::size_t i) const {
    if (separated(i) && !at(i).breaks) return "; ";
    if (at(i).is_line_comment) return "  ";
    return space_before(i) ? " " : "";
}

// -- lines ---------------------------------------------------------------------------------------

std::size_t Formatter::line_end(std::size_t begin) const {
    std::size_t end = begin + 1;
    while (end < pieces_.size() && !at(end).breaks) ++end;
    return end;
}

// Without a comment at the end, which may be as long as it likes.
std::size_t Formatter::width(std::size_t begin, std::size_t end) const {
    std::size_t columns = 0;
    for (std::size_t i = begin; i < end && !at(i).is_line_comment; ++i)
        columns += (i > begin ? separator(i).size() : 0) + display_columns(at(i).text);
    return columns;
}

std::size_t Formatter::indent_of(std::size_t begin) {
    const Piece &p = at(begin);
    Level &level = levels_.back();
    if (is_close(p.kind) && !p.is_comment) return level.line_indent;
    const std::size_t base = level.is_file ? 0 : level.line_indent + step;
    const std::size_t before = previous_word(begin);
    // Calls stand under what they are calls of: a step to the right, or right below its `}`.
    if (p.kind == Tok::Dot && !p.is_comment) {
        const bool after_block =
            before < begin && at(before).kind == Tok::BraceClose && at(before).breaks;
        if (!level.in_chain) level.chain = std::max(level.head, base) + (after_block ? 0 : step);
        level.in_chain = true;
        return level.chain;
    }
    const auto begins_at = [&](std::size_t indent) {
        if (p.is_comment) return indent;
        level.in_chain = false;
        return level.head = indent;
    };
    if (is_group_open(level.kind)) {
        if (p.is_comment || before >= begin) return begins_at(base);
        const bool item = at(before).kind == Tok::Comma || is_open(at(before).kind);
        return begins_at(item ? base : base + step);
    }
    const bool fresh = p.is_comment ? edge_[begin] : p.starts_statement;
    return begins_at(fresh || p.kind == Tok::Else ? base : base + step);
}

void Formatter::walk(std::size_t begin, std::size_t end, std::size_t indent) {
    for (std::size_t i = begin; i < end; ++i) {
        const Piece &p = at(i);
        if (p.is_comment) continue;
        if (is_close(p.kind)) levels_.pop_back();
        if (p.starts_statement) levels_.back().head = 0, levels_.back().in_chain = false;
        if (is_open(p.kind))
            levels_.push_back(
                {is_block_open(p.kind) ? Tok::Body : p.kind, indent, false, 0, 0, false});
    }
}

std::string Formatter::run() {
    std::string out;
    for (std::size_t begin = 0; begin < pieces_.size();) {
        const std::size_t end = line_end(begin);
        const std::size_t indent = indent_of(begin);
        if (indent + width(begin, end) > widest && break_up(begin, end, indent)) continue;
        if (at(begin).blank_above) out += '\n';
        out.append(indent, ' ');
        for (std::size_t i = begin; i < end; ++i) {
            if (i > begin) out += separator(i);
            out += at(i).text;
        }
        out += '\n';
        walk(begin, end, indent);
        begin = end;
    }
    return out;
}

// -- lines that are too long ---------------------------------------------------------------------

bool Formatter::add_break(std::size_t i) {
    if (at(i).breaks || at(i).is_comment) return false;
    return pieces_[i].breaks = true;
}

bool Formatter::break_group(std::size_t open) {
    const std::size_t close = at(open).match;
    if (open + 1 >= close || at(open + 1).is_comment) return false;
    bool added = add_break(open + 1);
    if (at(open).kind == Tok::ListOpen || at(open).kind == Tok::FreshListOpen) {
        settle_group(open); // its items fill lines
        return added;
    }
    std::size_t depth = 0;
    for (std::size_t i = open + 1; i < close; ++i) {
        if (is_open(at(i).kind)) ++depth;
        if (is_close(at(i).kind)) --depth;
        const bool item_ends = depth == 0 && at(i).kind == Tok::Comma && i + 1 < close;
        if (item_ends && !at(i + 1).is_comment) added |= add_break(i + 1);
    }
    settle_group(open);
    return added;
}

// Breaks the line's pieces [begin, end) at the best place; false where there is none.
bool Formatter::break_up(std::size_t begin, std::size_t end, std::size_t indent) {
    // Only the outermost parts of the line count.
    std::vector<int> depths(end - begin);
    int depth = 0, outermost = 0;
    for (std::size_t i = begin; i < end; ++i) {
        if (is_close(at(i).kind)) outermost = std::min(outermost, --depth);
        depths[i - begin] = depth;
        if (is_open(at(i).kind)) ++depth;
    }
    const auto outer = [&](std::size_t i) { return depths[i - begin] == outermost; };

    // A block on this line gets lines of its own; all those of one `if` together. One that stands
    // in brackets waits until there is nothing better.
    const auto opens_here = [&](std::size_t i) {
        return is_block_open(at(i).kind) && at(i).inline_block && i + 1 < at(i).match;
    };
    const auto open_blocks = [&](int block_depth) {
        bool opened = false;
        for (std::size_t i = begin; i < end; ++i) {
            if (!opens_here(i) || depths[i - begin] != block_depth) continue;
            open_block(i);
            opened = true;
        }
        return opened;
    };
    if (open_blocks(outermost)) return true;

    bool added = false;
    int loosest = 0;
    for (std::size_t i = begin + 1; i < end; ++i)
        if (outer(i) && !at(i).is_prefix && !at(i).in_type)
            loosest = std::max(loosest, looseness(at(i).kind));
    // `|` and `&` lead their lines.
    if (loosest >= looseness(Tok::Amp)) {
        for (std::size_t i = begin + 1; i < end; ++i)
            if (outer(i) && looseness(at(i).kind) == loosest) added |= add_break(i);
        if (added) return true;
    }
    const bool in_list =
        levels_.back().kind == Tok::ListOpen || levels_.back().kind == Tok::FreshListOpen;
    const std::size_t room = widest - std::min(widest, indent);
    std::size_t last_item = begin;
    for (std::size_t i = begin + 1; i < end; ++i) {
        if (at(i - 1).kind != Tok::Comma || !outer(i - 1) || at(i).is_comment) continue;
        if (!in_list)
            added |= add_break(i);
        else if (width(begin, i) <= room || last_item == begin)
            last_item = i;
    }
    if (last_item > begin) added = add_break(last_item);
    if (added) return true;

    std::vector<std::size_t> links;
    for (std::size_t i = begin + 1; i + 2 < end; ++i) {
        const bool call = outer(i) && at(i).kind == Tok::Dot &&
                          (at(i + 2).is_call || at(i + 2).kind == Tok::Trailing);
        const bool first_of_name = at(i - 1).kind == Tok::Name && links.empty();
        if (call && !first_of_name) links.push_back(i);
    }
    const bool header = at(end - 1).kind == Tok::Body;
    if (links.size() >= 2 && loosest == 0 && !header) {
        for (const std::size_t link : links) added |= add_break(link);
        if (added) return true;
    }

    std::size_t group = end, group_width = 0;
    for (std::size_t i = begin; i < end; ++i) {
        if (!outer(i) || !is_group_open(at(i).kind) || at(i).match == i + 1) continue;
        const std::size_t columns = width(i, std::min(end, at(i).match + 1));
        if (columns > group_width) group = i, group_width = columns;
    }
    // What follows the group on this line would follow its bracket on a line of its own.
    const bool ends_line = group < end && (at(group).match + 1 >= end || header);
    const auto break_at_operators = [&] {
        for (std::size_t i = begin + 1; i + 1 < end; ++i)
            if (outer(i) && !at(i).is_prefix && !at(i).in_type && loosest > 0 &&
                looseness(at(i).kind) == loosest)
                added |= add_break(i + 1);
        return added;
    };
    // A body, or a value that no bracket could end, goes below its `=` where it fits there.
    const auto break_at_assign = [&](bool must_fit) {
        for (std::size_t i = begin; i + 1 < end; ++i) {
            if (!outer(i) || is_block_open(at(i + 1).kind)) continue;
            if (at(i).kind != Tok::Assign && (must_fit || at(i).kind != Tok::FatArrow)) continue;
            if (must_fit && (width(begin, i + 1) > room || width(i + 1, end) + step > room))
                continue;
            if (add_break(i + 1)) return true;
        }
        return false;
    };
    if (!header && (at(begin).kind == Tok::Fn || !ends_line) && break_at_assign(true)) return true;
    const bool sum = loosest >= looseness(Tok::Plus) && group_width + step <= room;
    if (!ends_line && !header && sum && break_at_operators()) return true;
    if (ends_line) {
        // A lambda's block, or one that is all there is, opens where its bracket stands.
        const std::size_t last = std::min(end, at(group).match) - 1;
        const std::size_t block = at(last).kind == Tok::BraceClose ? at(last).match : begin;
        bool alone = true;
        for (std::size_t i = group + 1; i < last; ++i)
            alone = alone &&
                    !(at(i).kind == Tok::Comma && depths[i - begin] == depths[group - begin] + 1);
        if (block > group && opens_here(block) && (alone || at(block - 1).kind == Tok::FatArrow) &&
            open_blocks(depths[block - begin]))
            return true;
    }
    constexpr std::size_t wide_group = 40;
    if (group < end && group_width >= wide_group && break_group(group)) return true;
    if (!header && break_at_operators()) return true;
    if (group < end && break_group(group)) return true;
    if (break_at_assign(false)) return true;
    int block_depth = std::numeric_limits<int>::max();
    for (std::size_t i = begin; i < end; ++i)
        if (opens_here(i)) block_depth = std::min(block_depth, depths[i - begin]);
    return open_blocks(block_depth);
}

} // namespace

std::string format(const Sources &sources, const Ast &ast) {
    const Source &source = sources[ast.source];
    Diagnostics diagnostics;
    const Words words = read_words(source, ast.source, diagnostics);
    const Tokens tokens = lay_out(source, ast.source, words, diagnostics);
    if (diagnostics.has_errors()) return source.text;
    return Formatter(read_pieces(source, tokens, words.comments)).run();
}

} // namespace fathom::lang
