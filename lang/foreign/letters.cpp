// Names with letters beside a to z, as `größe` and `радиус`: which they are, and how they are spelled
// with the letters that a name may have.
#include "lang/lexer.h"

#include "base/text.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <span>

namespace fathom::lang {

static bool is_letter(std::uint32_t c);
static std::string plain_spelling(std::string_view name);

namespace {

struct Spelling {
    std::string_view theirs, ours;
};

// Of capital letters the small ones stand here alone.
constexpr Spelling spellings[] = {
    {"à", "a"},  {"á", "a"},  {"â", "a"},  {"ã", "a"},  {"ä", "ae"}, {"å", "a"},    {"æ", "ae"},
    {"ç", "c"},  {"è", "e"},  {"é", "e"},  {"ê", "e"},  {"ë", "e"},  {"ì", "i"},    {"í", "i"},
    {"î", "i"},  {"ï", "i"},  {"ð", "d"},  {"ñ", "n"},  {"ò", "o"},  {"ó", "o"},    {"ô", "o"},
    {"õ", "o"},  {"ö", "oe"}, {"ø", "o"},  {"ù", "u"},  {"ú", "u"},  {"û", "u"},    {"ü", "ue"},
    {"ý", "y"},  {"þ", "th"}, {"ß", "ss"}, {"ÿ", "y"},  {"ā", "a"},  {"ă", "a"},    {"ą", "a"},
    {"ć", "c"},  {"č", "c"},  {"ď", "d"},  {"đ", "d"},  {"ē", "e"},  {"ė", "e"},    {"ę", "e"},
    {"ě", "e"},  {"ğ", "g"},  {"ī", "i"},  {"į", "i"},  {"ı", "i"},  {"ľ", "l"},    {"ł", "l"},
    {"ń", "n"},  {"ň", "n"},  {"ō", "o"},  {"ő", "o"},  {"œ", "oe"}, {"ŕ", "r"},    {"ř", "r"},
    {"ś", "s"},  {"ş", "s"},  {"š", "s"},  {"ţ", "t"},  {"ť", "t"},  {"ū", "u"},    {"ů", "u"},
    {"ű", "u"},  {"ų", "u"},  {"ź", "z"},  {"ż", "z"},  {"ž", "z"},  {"ș", "s"},    {"ț", "t"},
    {"а", "a"},  {"б", "b"},  {"в", "v"},  {"г", "g"},  {"д", "d"},  {"е", "e"},    {"ё", "yo"},
    {"ж", "zh"}, {"з", "z"},  {"и", "i"},  {"й", "y"},  {"к", "k"},  {"л", "l"},    {"м", "m"},
    {"н", "n"},  {"о", "o"},  {"п", "p"},  {"р", "r"},  {"с", "s"},  {"т", "t"},    {"у", "u"},
    {"ф", "f"},  {"х", "kh"}, {"ц", "ts"}, {"ч", "ch"}, {"ш", "sh"}, {"щ", "shch"}, {"ъ", ""},
    {"ы", "y"},  {"ь", ""},   {"э", "e"},  {"ю", "yu"}, {"я", "ya"}, {"і", "i"},    {"ї", "yi"},
    {"є", "ye"}, {"ґ", "g"},  {"α", "a"},  {"β", "b"},  {"γ", "g"},  {"δ", "d"},    {"ε", "e"},
    {"ζ", "z"},  {"η", "i"},  {"θ", "th"}, {"ι", "i"},  {"κ", "k"},  {"λ", "l"},    {"μ", "m"},
    {"ν", "n"},  {"ξ", "x"},  {"ο", "o"},  {"π", "p"},  {"ρ", "r"},  {"σ", "s"},    {"ς", "s"},
    {"τ", "t"},  {"υ", "y"},  {"φ", "f"},  {"χ", "ch"}, {"ψ", "ps"}, {"ω", "o"},    {"ά", "a"},
    {"έ", "e"},  {"ή", "i"},  {"ί", "i"},  {"ό", "o"},  {"ύ", "y"},  {"ώ", "o"},    {"ϕ", "f"},
    {"₀", "0"},  {"₁", "1"},  {"₂", "2"},  {"₃", "3"},  {"₄", "4"},  {"₅", "5"},    {"₆", "6"},
    {"₇", "7"},  {"₈", "8"},  {"₉", "9"},  {"µ", "mu"}};

// Of a Greek letter that stands alone, as mathematics has it.
constexpr Spelling greek[] = {{"α", "alpha"}, {"β", "beta"},    {"γ", "gamma"},  {"δ", "delta"},
                              {"ε", "eps"},   {"ζ", "zeta"},    {"η", "eta"},    {"θ", "theta"},
                              {"ι", "iota"},  {"κ", "kappa"},   {"λ", "lambda"}, {"μ", "mu"},
                              {"ν", "nu"},    {"ξ", "xi"},      {"ρ", "rho"},    {"σ", "sigma"},
                              {"τ", "tau"},   {"υ", "upsilon"}, {"φ", "phi"},    {"ϕ", "phi"},
                              {"χ", "chi"},   {"ψ", "psi"},     {"ω", "omega"},  {"Δ", "Delta"},
                              {"Ω", "Omega"}, {"Φ", "Phi"},     {"Θ", "Theta"},  {"Λ", "Lambda"},
                              {"Σ", "Sigma"}, {"Γ", "Gamma"},   {"Π", "Pi"}};

// The small letter of a capital one, in the alphabets of the table.
std::uint32_t small_letter(std::uint32_t c) {
    const bool latin = (c >= 0xC0 && c <= 0xDE && c != 0xD7) || (c >= 0x391 && c <= 0x3A9) ||
                       (c >= 0x410 && c <= 0x42F);
    if (latin) return c + 32;
    if (c >= 0x400 && c <= 0x40F) return c + 80;
    const bool pairs = (c >= 0x100 && c <= 0x137) || (c >= 0x14A && c <= 0x177) ||
                       (c >= 0x218 && c <= 0x21B) || c == 0x490;
    if (pairs && c % 2 == 0) return c + 1;
    const bool odd = (c >= 0x139 && c <= 0x148) || (c >= 0x179 && c <= 0x17E);
    return odd && c % 2 == 1 ? c + 1 : c;
}

const Spelling *find_in(std::span<const Spelling> table, std::string_view letter) {
    const auto it = std::ranges::find(table, letter, &Spelling::theirs);
    return it == table.end() ? nullptr : &*it;
}

// A code point below 0x800 as UTF-8.
std::string encode(std::uint32_t c) {
    return {static_cast<char>(0xC0 | c >> 6), static_cast<char>(0x80 | (c & 0x3F))};
}

} // namespace

// A name with such letters that begins here: its end, or 0.
std::uint32_t ForeignWords::name_with_letters(std::uint32_t begin) {
    if (!beyond_ascii_) return 0;
    if (const std::uint32_t past = sum_sign(begin); past > 0) return past;
    const std::string_view all = source_.text;
    bool letters = false;
    std::uint32_t end = begin;
    while (end < all.size()) {
        const CodePoint c = decode_utf8(all, end);
        const bool plain = c.length == 1 && is_word_char(all[end]);
        if (!plain && (!c.valid || !is_letter(c.value))) break;
        if (end == begin && is_digit(all[end])) return 0;
        letters = letters || !plain;
        end += c.length;
    }
    const std::string_view name = all.substr(begin, end - begin);
    if (!letters || name == "π") return 0; // that is ours: `pi`
    add(Tok::Name, begin, end);
    if (told_before(begin, end, {})) return end; // one cause, one report
    Diagnostic &d = report(Code::BadCharacter, begin, end,
                           "names use the letters a to z, A to Z, digits and `_`");
    std::string ours = plain_spelling(name);
    if (is_keyword_text(ours)) ours += "_";
    if (ours.empty())
        d.help("spell it with these");
    else
        d.help("write `" + ours + "`", {{span(begin, end), ours}});
    d.note("comments and strings may hold any letters");
    return end;
}

// Letters of any script, and what mathematics writes behind one; no signs and no spaces.
static bool is_letter(std::uint32_t c) {
    if (c == 0xAA || c == 0xBA || c == 0xD7 || c == 0xF7) return false;
    return c == 0xB5 || (c >= 0xC0 && c <= 0x2AF) || (c >= 0x370 && c <= 0x1FFF && c != 0x37E) ||
           (c >= 0x2080 && c <= 0x2089) || (c >= 0x2C00 && c <= 0x2DFF) ||
           (c >= 0x3040 && c <= 0x318F) || (c >= 0x3400 && c <= 0x9FFF) ||
           (c >= 0xA000 && c <= 0xD7A3);
}

static std::string plain_spelling(std::string_view name) {
    if (const Spelling *letter = find_in(greek, name)) return std::string(letter->ours);
    std::string out;
    for (std::uint32_t i = 0; i < name.size();) {
        const CodePoint c = decode_utf8(name, i);
        const std::string_view here = name.substr(i, c.length);
        i += c.length;
        if (here.size() == 1) {
            out += here;
            continue;
        }
        const std::uint32_t small = small_letter(c.value);
        const Spelling *found =
            find_in(spellings, small == c.value ? std::string(here) : encode(small));
        if (!found) return {};
        std::string ours(found->ours);
        if (small != c.value && !ours.empty() && ours[0] >= 'a') ours[0] -= 'a' - 'A';
        out += ours;
    }
    return out.empty() || is_digit(out[0]) ? std::string() : out;
}

// Signs that turn the direction in which a text is shown.
static bool turns_text(std::uint32_t c) {
    return (c >= 0x202A && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
}

// Nothing is shown of them: spaces of no width, joiners, marks of direction and of byte order.
static bool is_invisible(std::uint32_t c) {
    return turns_text(c) || c == 0xAD || (c >= 0x200B && c <= 0x200F) ||
           (c >= 0x2060 && c <= 0x2064) || c == 0xFEFF || (c >= 0xE0000 && c <= 0xE007F);
}

// In comments, which could hide what is read beside them. Names of files and of save files' nodes,
// which stand in strings, may have such signs.
void ForeignWords::turned_text(std::uint32_t begin, std::uint32_t end) {
    constexpr std::size_t most_edits = 40;
    if (!beyond_ascii_) return;
    std::vector<Edit> edits;
    for (std::uint32_t at = begin; at < end && edits.size() < most_edits;) {
        const CodePoint c = decode_utf8(source_.text, at);
        if (c.valid && turns_text(c.value)) edits.push_back({span(at, at + c.length), ""});
        at += std::max<std::uint32_t>(c.length, 1);
    }
    if (edits.empty()) return;
    const Span first = edits[0].span;
    report(Code::BadCharacter, first.begin, first.end,
           "a sign that turns the direction of the text stands here")
        .help("leave it away: the text is shown otherwise than it is read", std::move(edits));
}

// Whether that is such a sign between words, which is then told.
bool ForeignWords::invisible_sign(std::uint32_t begin, std::uint32_t end, std::uint32_t sign) {
    const bool line = sign == 0x2028 || sign == 0x2029;
    if (!line && !is_invisible(sign)) return false;
    add(Tok::Bad, begin, end);
    Diagnostic &d =
        report(Code::BadCharacter, begin, end,
               line ? "this end of a line is none of the language's"
                    : fmt::format("a sign that is not seen stands here, U+{:04X}", sign));
    if (line)
        d.help("write an ordinary one", {{span(begin, end), "\n"}});
    else
        d.help("leave it away", {{span(begin, end), ""}});
    return true;
}

} // namespace fathom::lang
