// Diagnostics as text for people: the source lines with the places underlined, notes, and the fix
// as the line would read with it. Safe for any bytes: bad UTF-8, control characters, lines of a
// megabyte.
#include "base/diagnostic.h"
#include "base/encode.h"
#include "base/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace fathom {

namespace {

constexpr std::size_t tab_width = 4;
constexpr std::size_t widest_line = 100;   // columns; longer lines are cut around the place
constexpr std::size_t columns_before = 40; // how much of a cut line stands before the place

struct Style {
    std::string_view error = "\033[1;31m", warning = "\033[1;33m", note = "\033[1;36m";
    std::string_view bold = "\033[1m", gutter = "\033[1;34m", help = "\033[1;32m", end = "\033[0m";
};
constexpr Style coloured;
constexpr Style plain{"", "", "", "", "", "", ""};

std::string_view severity_style(const Style &style, Severity severity) {
    switch (severity) {
    case Severity::Error: return style.error;
    case Severity::Warning: return style.warning;
    case Severity::Note: return style.note;
    }
    return "";
}

std::string_view severity_word(Severity severity) {
    switch (severity) {
    case Severity::Error: return "error";
    case Severity::Warning: return "warning";
    case Severity::Note: return "note";
    }
    return "";
}

// A line as it is shown, and the column at which each of its bytes is shown. Where the line is too
// long, [begin, end) is the part that is shown, and bytes outside fall on the ellipsis.
struct ShownLine {
    std::string text;
    std::size_t begin = 0;
    std::vector<std::size_t> columns; // of bytes begin..end, the end too

    std::size_t column(std::size_t byte) const {
        if (byte < begin) return 0;
        const std::size_t i = byte - begin;
        return i < columns.size() ? columns[i] : columns.back() + 1;
    }
};

std::size_t width_at(std::string_view line, std::size_t byte, std::size_t column) {
    const std::uint32_t c = decode_utf8(line, byte).value;
    if (c == '\t') return tab_width - column % tab_width;
    return static_cast<std::size_t>(display_width(c));
}

std::size_t previous_code_point(std::string_view line, std::size_t byte) {
    for (std::size_t back = 1; back <= 4 && back <= byte; ++back)
        if (decode_utf8(line, byte - back).length == back) return byte - back;
    return byte - 1;
}

// Which bytes of a long line to show: a window around `focus`.
std::pair<std::size_t, std::size_t> window(std::string_view line, std::size_t focus) {
    std::size_t columns = 0, end = 0;
    while (end < line.size() && columns <= widest_line) {
        columns += width_at(line, end, columns);
        end += decode_utf8(line, end).length;
    }
    if (columns <= widest_line) return {0, line.size()};

    std::size_t begin = std::min(focus, line.size());
    columns = 0;
    while (begin > 0 && columns < columns_before) {
        begin = previous_code_point(line, begin);
        columns += std::max<std::size_t>(1, width_at(line, begin, 0));
    }
    // The zero-wide count as one, so that a line of combining marks is cut as well.
    columns = 0;
    for (end = begin; end < line.size() && columns < widest_line;) {
        columns += std::max<std::size_t>(1, width_at(line, end, columns));
        end += decode_utf8(line, end).length;
    }
    return {begin, end};
}

ShownLine show_line(std::string_view line, std::size_t focus) {
    const auto [begin, end] = window(line, focus);
    ShownLine shown;
    shown.begin = begin;
    std::size_t column = 0;
    if (begin > 0) shown.text += "…", ++column;
    for (std::size_t byte = begin; byte < end;) {
        const CodePoint c = decode_utf8(line, byte);
        const std::size_t width = width_at(line, byte, column);
        if (c.value == '\t')
            shown.text.append(width, ' ');
        else
            shown.text += for_terminal(line.substr(byte, c.length));
        shown.columns.insert(shown.columns.end(), c.length, column);
        column += width;
        byte += c.length;
    }
    shown.columns.push_back(column);
    if (end < line.size()) shown.text += "…";
    return shown;
}

// One underlined stretch of one line, in bytes of that line.
struct Mark {
    std::size_t begin = 0, end = 0;
    bool primary = false;
    std::string message;
};

// The lines with marks, file by file, the primary label's file first.
struct MarkedFile {
    SourceId source;
    std::map<std::uint32_t, std::vector<Mark>> lines;
};

void mark_span(MarkedFile &file, const Source &source, const Label &label, bool primary) {
    const std::uint32_t first = position(source, label.span.begin).line;
    // A span that takes in a line's end does not reach the next line.
    const std::uint32_t last_byte =
        std::max(label.span.begin, label.span.end ? label.span.end - 1 : 0);
    const std::uint32_t last = position(source, last_byte).line;
    const auto in_line = [&](std::uint32_t line, std::uint32_t byte) {
        return std::min<std::size_t>(byte - source.line_starts[line - 1],
                                     line_text(source, line).size());
    };
    const std::size_t begin =
        in_line(first, std::min(label.span.begin, static_cast<std::uint32_t>(source.text.size())));
    if (first == last) {
        const std::size_t end =
            std::max(begin, in_line(first, std::max(label.span.begin, label.span.end)));
        file.lines[first].push_back({begin, end, primary, label.message});
        return;
    }
    file.lines[first].push_back({begin, line_text(source, first).size(), primary, {}});
    const std::string_view text = line_text(source, last);
    const std::size_t end = in_line(last, label.span.end);
    const std::size_t indent = std::min(text.find_first_not_of(" \t"), end);
    file.lines[last].push_back({indent, end, primary, label.message});
}

std::vector<MarkedFile> marked_files(const Diagnostic &diagnostic, const Sources &sources) {
    std::vector<MarkedFile> files;
    const auto mark = [&](const Label &label, bool primary) {
        if (!label.span.source) return;
        auto file = std::find_if(files.begin(), files.end(), [&](const MarkedFile &f) {
            return f.source == label.span.source;
        });
        if (file == files.end()) file = files.insert(files.end(), {label.span.source, {}});
        mark_span(*file, sources[label.span.source], label, primary);
    };
    mark(diagnostic.primary, true);
    for (const Label &label : diagnostic.related) mark(label, false);
    return files;
}

class Printer {
  public:
    Printer(const Style &style, std::string_view mark_style, std::size_t gutter)
        : style_(style), mark_style_(mark_style), gutter_(gutter) {}

    void gutter(std::string_view number, std::string_view sign) {
        out_ += style_.gutter;
        out_.append(gutter_ > number.size() ? gutter_ - number.size() : 0, ' ');
        out_ += number;
        out_ += ' ';
        out_ += sign;
        out_ += style_.end;
    }
    void row(std::string_view number, std::string_view text) {
        gutter(number, "|");
        if (!text.empty()) out_ += ' ', out_ += text;
        out_ += '\n';
    }
    void marked_line(const Source &source, std::uint32_t line, std::vector<Mark> marks);
    void remark(std::string_view word, std::string_view style, std::string_view message);
    void new_lines(const std::string &lines, std::size_t number, std::size_t most);
    bool edited_block(const Fix &fix, const Sources &sources);
    void edited_lines(const Fix &fix, const Sources &sources);
    std::string &out() { return out_; }

  private:
    struct Placed {
        std::size_t begin, end; // columns
        bool primary;
        std::string message;
    };
    std::string underline(const std::vector<Placed> &placed) const;
    std::string hanging(const std::vector<Placed> &placed, std::size_t bars,
                        const Placed *message) const;

    const Style &style_;
    std::string_view mark_style_;
    std::size_t gutter_;
    std::string out_;
};

std::string Printer::underline(const std::vector<Placed> &placed) const {
    std::size_t width = 0;
    for (const Placed &p : placed) width = std::max(width, p.end);
    std::string signs(width, ' ');
    for (const bool primary : {false, true})
        for (const Placed &p : placed)
            if (p.primary == primary)
                std::fill(signs.begin() + static_cast<std::ptrdiff_t>(p.begin),
                          signs.begin() + static_cast<std::ptrdiff_t>(p.end), primary ? '^' : '-');
    std::string out;
    for (std::size_t i = 0; i < signs.size();) {
        const std::size_t end = std::min(signs.find_first_not_of(signs[i], i), signs.size());
        if (signs[i] != ' ') out += signs[i] == '^' ? mark_style_ : style_.gutter;
        out += signs.substr(i, end - i);
        if (signs[i] != ' ') out += style_.end;
        i = end;
    }
    return out;
}

// `|` under the first `bars` marks, then, in the place of its own bar, a message.
std::string Printer::hanging(const std::vector<Placed> &placed, std::size_t bars,
                             const Placed *message) const {
    std::string out;
    std::size_t column = 0;
    for (std::size_t i = 0; i < bars; ++i) {
        if (placed[i].message.empty() || placed[i].begin < column) continue;
        if (message && placed[i].begin >= message->begin) break;
        out.append(placed[i].begin - column, ' ');
        out += placed[i].primary ? mark_style_ : style_.gutter;
        out += '|';
        out += style_.end;
        column = placed[i].begin + 1;
    }
    if (!message) return out;
    out.append(std::max(message->begin, column) - column, ' ');
    out += message->primary ? mark_style_ : style_.gutter;
    out += message->message;
    out += style_.end;
    return out;
}

// The rightmost label stands behind its underline; the others hang below, from right to left:
//     |   sphere(radius: 1, radius: 2)
//     |          ------     ^^^^^^ again here
//     |          |
//     |          first given here
void Printer::marked_line(const Source &source, std::uint32_t line, std::vector<Mark> marks) {
    std::stable_sort(marks.begin(), marks.end(),
                     [](const Mark &a, const Mark &b) { return a.begin < b.begin; });
    const auto focus =
        std::find_if(marks.begin(), marks.end(), [](const Mark &m) { return m.primary; });
    const ShownLine shown =
        show_line(line_text(source, line), focus == marks.end() ? marks[0].begin : focus->begin);
    std::vector<Placed> placed;
    for (const Mark &mark : marks) {
        const std::size_t begin = shown.column(mark.begin);
        placed.push_back({begin, std::max(begin + 1, shown.column(mark.end)), mark.primary,
                          for_terminal(mark.message)});
    }

    row(fmt::to_string(line), shown.text);
    std::string first_row = underline(placed);
    const bool inline_message = !placed.back().message.empty();
    if (inline_message) {
        first_row += ' ';
        first_row += placed.back().primary ? mark_style_ : style_.gutter;
        first_row += placed.back().message;
        first_row += style_.end;
    }
    row("", first_row);

    std::size_t left = placed.size() - (inline_message ? 1 : 0);
    const auto hangs = [](const Placed &p) { return !p.message.empty(); };
    if (std::none_of(placed.begin(), placed.begin() + static_cast<std::ptrdiff_t>(left), hangs))
        return;
    row("", hanging(placed, left, nullptr));
    while (left-- > 0)
        if (hangs(placed[left])) row("", hanging(placed, left, &placed[left]));
}

void Printer::remark(std::string_view word, std::string_view style, std::string_view message) {
    // A message of several lines keeps them, each under the first.
    std::size_t begin = 0;
    for (bool first = true; begin <= message.size(); first = false) {
        const std::size_t end = std::min(message.find('\n', begin), message.size());
        const std::string line = for_terminal(message.substr(begin, end - begin));
        if (first) {
            gutter("", "= ");
            out_ += style;
            out_ += word;
            out_ += ':';
            out_ += style_.end;
            out_ += ' ';
        } else {
            out_.append(gutter_ + word.size() + 5, ' ');
        }
        out_ += line;
        out_ += '\n';
        begin = end + 1;
    }
}

// Lines that stand in place of others, from a number on.
void Printer::new_lines(const std::string &lines, std::size_t number, std::size_t most) {
    row("", "");
    for (std::size_t begin = 0; begin < lines.size(); ++number) {
        if (most-- == 0) {
            row("…", "");
            return;
        }
        const std::size_t end = std::min(lines.find('\n', begin), lines.size());
        row(fmt::to_string(number), for_terminal(lines.substr(begin, end - begin)));
        begin = end + 1;
    }
}

// What one edit over several lines gives: these lines as a whole. False where it is not such.
bool Printer::edited_block(const Fix &fix, const Sources &sources) {
    if (fix.edits.size() != 1 || !fix.edits[0].span.source) return false;
    const Edit &edit = fix.edits[0];
    const Source &source = sources[edit.span.source];
    const std::uint32_t first = position(source, edit.span.begin).line;
    const std::uint32_t last = position(source, std::max(edit.span.begin, edit.span.end)).line;
    const bool breaks = edit.replacement.find('\n') != std::string::npos;
    if (first == last && !breaks) return false;
    const bool all = edit.span.begin == 0 && edit.span.end == source.text.size();
    const std::string_view before = line_text(source, first), behind = line_text(source, last);
    constexpr std::size_t most = 4000; // bytes to show: a line may have millions
    if (!all && before.size() + edit.replacement.size() + behind.size() > most) return true;
    const std::size_t from = edit.span.begin - source.line_starts[first - 1];
    const std::size_t to = edit.span.end - source.line_starts[last - 1];
    const std::string lines = std::string(before.substr(0, std::min(from, before.size()))) +
                              edit.replacement +
                              std::string(behind.substr(std::min(to, behind.size())));
    if (lines.find_first_not_of(" \t\n") == std::string::npos) return true; // nothing stays
    new_lines(lines, first, all ? 60 : 12);
    return true;
}

// The lines as the edits would make them.
void Printer::edited_lines(const Fix &fix, const Sources &sources) {
    constexpr std::size_t max_lines = 4;
    if (edited_block(fix, sources)) return;
    std::vector<Edit> edits = fix.edits;
    std::stable_sort(edits.begin(), edits.end(),
                     [](const Edit &a, const Edit &b) { return a.span < b.span; });
    std::map<std::pair<SourceId, std::uint32_t>, std::vector<const Edit *>> by_line;
    for (const Edit &edit : edits) {
        if (!edit.span.source) return;
        const Source &source = sources[edit.span.source];
        const std::uint32_t line = position(source, edit.span.begin).line;
        const std::size_t line_end = source.line_starts[line - 1] + line_text(source, line).size();
        if (edit.span.end > line_end || edit.replacement.find('\n') != std::string::npos) return;
        by_line[{edit.span.source, line}].push_back(&edit);
    }
    if (by_line.empty() || by_line.size() > max_lines) return;

    row("", "");
    for (const auto &[place, line_edits] : by_line) {
        const Source &source = sources[place.first];
        const std::string_view old = line_text(source, place.second);
        std::string edited;
        std::vector<std::pair<std::size_t, std::size_t>> changed;
        std::string signs;
        std::size_t done = 0;
        for (const Edit *edit : line_edits) {
            const std::size_t begin = edit->span.begin - source.line_starts[place.second - 1];
            if (begin < done) return; // edits that overlap are no line that could be shown
            edited += old.substr(done, begin - done);
            changed.emplace_back(edited.size(), edited.size() + edit->replacement.size());
            signs += edit->span.begin == edit->span.end ? '+' : '~';
            edited += edit->replacement;
            done = begin + (edit->span.end - edit->span.begin);
        }
        edited += old.substr(std::min(done, old.size()));
        const ShownLine shown = show_line(edited, changed[0].first);
        std::string under;
        for (std::size_t i = 0; i < changed.size(); ++i) {
            const std::size_t begin = shown.column(changed[i].first),
                              end = shown.column(changed[i].second);
            if (begin == end || begin < under.size()) continue;
            under.append(begin - under.size(), ' ');
            under.append(end - begin, signs[i]);
        }
        row(fmt::to_string(place.second), shown.text);
        if (under.empty()) continue;
        const std::size_t indent = under.find_first_not_of(' ');
        row("", std::string(indent, ' ') + std::string(style_.help) + under.substr(indent) +
                    std::string(style_.end));
    }
}

// Wide enough for the largest line number that will be shown.
std::size_t gutter_width(const Diagnostic &diagnostic, const Sources &sources) {
    std::uint32_t largest = 1;
    const auto see = [&](Span span) {
        if (!span.source) return;
        const auto end = std::max(span.begin, span.end);
        largest = std::max(largest, position(sources[span.source], end).line);
    };
    see(diagnostic.primary.span);
    for (const Label &label : diagnostic.related) see(label.span);
    if (diagnostic.fix)
        for (const Edit &edit : diagnostic.fix->edits) {
            see(edit.span);
            const auto lines = std::ranges::count(edit.replacement, '\n');
            largest = std::max(largest, static_cast<std::uint32_t>(std::min<long>(lines, 60)));
        }
    return fmt::to_string(largest).size();
}

std::string place_text(const Source &source, std::uint32_t offset) {
    const Position at = position(source, offset);
    return fmt::format("{}:{}:{}", for_terminal(source.name), at.line, at.column);
}

} // namespace

std::string to_text(const Diagnostic &diagnostic, const Sources &sources, bool color) {
    const Style &style = color ? coloured : plain;
    const std::string_view severity = severity_style(style, diagnostic.severity);
    Printer printer(style, severity, gutter_width(diagnostic, sources));
    std::string &out = printer.out();

    const Span place = diagnostic.primary.span;
    if (place.source) {
        out += style.bold;
        out += place_text(sources[place.source], place.begin) + ": ";
        out += style.end;
    }
    out += severity;
    out += severity_word(diagnostic.severity);
    out += '[';
    out += code_name(diagnostic.code);
    out += "]";
    out += style.end;
    out += style.bold;
    out += ": " + for_terminal(diagnostic.message);
    out += style.end;
    out += '\n';

    for (const MarkedFile &file : marked_files(diagnostic, sources)) {
        const Source &source = sources[file.source];
        if (file.source != place.source) {
            const Mark &first = file.lines.begin()->second.front();
            const auto offset = source.line_starts[file.lines.begin()->first - 1] + first.begin;
            printer.gutter("", "::: ");
            out += place_text(source, static_cast<std::uint32_t>(offset)) + "\n";
        }
        printer.row("", "");
        std::uint32_t previous = 0;
        for (const auto &[line, marks] : file.lines) {
            if (previous && line == previous + 2) {
                printer.row(fmt::to_string(line - 1),
                            show_line(line_text(source, line - 1), 0).text);
            } else if (previous && line > previous + 2) {
                out += style.gutter;
                out += "...";
                out += style.end;
                out += '\n';
            }
            printer.marked_line(source, line, marks);
            previous = line;
        }
    }

    if (diagnostic.notes.empty() && !diagnostic.fix) return out;
    if (place.source) printer.row("", "");
    for (const std::string &note : diagnostic.notes) printer.remark("note", style.bold, note);
    if (diagnostic.fix) {
        printer.remark("help", style.help, diagnostic.fix->message);
        printer.edited_lines(*diagnostic.fix, sources);
    }
    return out;
}

} // namespace fathom
