// The grammar, in PEGTL, and parse(). Two small grammars: words over bytes, then statements and
// expressions over the kinds of words, one byte each. Every choice of the second is decided by its
// first token, so nothing is read twice and no action is ever undone. Precedence is settled by the
// builder. The only file that sees PEGTL.
#include "lang/parse.h"

#include "lang/builder.h"
#include "lang/lexer.h"

#include <fmt/format.h>
#include <tao/pegtl.hpp>

namespace fathom::lang {
namespace {

namespace pegtl = tao::pegtl;
using pegtl::at;
using pegtl::eof;
using pegtl::must;
using pegtl::not_at;
using pegtl::one;
using pegtl::opt;
using pegtl::plus;
using pegtl::seq;
using pegtl::sor;
using pegtl::star;
using pegtl::success;
using pegtl::until;

// -- words ---------------------------------------------------------------------------------------

namespace words {

using pegtl::digit;
using pegtl::string;

struct blank : plus<one<' ', '\t', '\r', '\f', '\v'>> {};
struct line_end : one<'\n'> {};
struct rest_of_line : star<pegtl::not_one<'\n'>> {};
struct line_comment : seq<string<'/', '/'>, rest_of_line> {};
struct block_comment : seq<string<'/', '*'>, until<string<'*', '/'>>> {};
struct unclosed_comment : seq<string<'/', '*'>, star<pegtl::any>> {};
struct word_char : pegtl::identifier_other {};
struct word : seq<pegtl::identifier_first, star<word_char>> {};

// Whatever touches a number belongs to its word: a unit, or a mistake to be explained.
struct fraction : seq<one<'.'>, plus<digit>> {};
struct exponent : seq<one<'e', 'E'>, opt<one<'+', '-'>>, plus<digit>> {};
struct lonely_point : seq<one<'.'>, not_at<sor<one<'.'>, pegtl::identifier_first>>> {};
struct suffix_point : seq<one<'.'>, one<'f', 'F'>, not_at<sor<word_char, one<'('>>>> {};
struct degree_sign : sor<string<'\xC2', '\xB0'>, string<'\xC2', '\xBA'>, string<'\xCB', '\x9A'>> {};
struct number_tail : seq<opt<exponent>, star<word_char>, opt<degree_sign>> {};
struct number : sor<seq<plus<digit>, opt<sor<fraction, lonely_point, suffix_point>>, number_tail>,
                    seq<fraction, number_tail>> {};

struct string_char : sor<pegtl::not_one<'"', '\\', '\n'>, seq<one<'\\'>, pegtl::not_one<'\n'>>> {};
struct text : seq<one<'"'>, star<string_char>, one<'"'>> {};
struct unclosed_text : seq<one<'"'>, rest_of_line> {};
template <char sign> struct quoted_by
    : seq<one<sign>, star<pegtl::not_one<sign, '\n'>>, one<sign>> {};
struct quoted : sor<quoted_by<'\''>, quoted_by<'`'>> {};
// The first alternative spares the signs that begin no longer one all other attempts.
struct sign
    : sor<seq<string<'?', '.'>, not_at<digit>>,
          one<'(', ')', '[', ']', '{', '}', ',', ':', ';', '?'>, string<'.', '.', '='>,
          string<'.', '.', '<'>, string<'.', '.', '.'>, string<'~', '='>, string<'=', '=', '='>,
          string<'!', '=', '='>, string<'-', '>'>, string<'=', '>'>, string<'.', '.'>,
          string<'=', '='>, string<'!', '='>, string<'<', '='>, string<'>', '='>, string<'<', '>'>,
          string<'&', '&'>, string<'|', '|'>, string<'*', '*'>, string<'+', '='>, string<'-', '='>,
          string<'*', '='>, string<'/', '='>, string<'%', '='>, string<'^', '='>, string<'|', '='>,
          string<'&', '='>, string<'+', '+'>,
          seq<string<'-', '-'>, at<star<one<' ', '\t', '\r'>>, sor<eof, one<'\n', ';', ')', '}'>>>>,
          one<'.', '=', '|', '&', '<', '>', '+', '-', '*', '/', '%', '^', '!'>> {};
// Bytes outside ASCII hang together, with what touches them.
struct strange
    : sor<seq<one<'$', '@', '~', '\\', '`'>, star<word_char>>,
          seq<pegtl::range<'\x80', '\xFF'>, star<sor<pegtl::range<'\x80', '\xFF'>>>>, pegtl::any> {
};

struct any_word : sor<blank, word, line_end, line_comment, block_comment, unclosed_comment, number,
                      sign, text, unclosed_text, quoted, strange> {};

template <class Rule> struct action : pegtl::nothing<Rule> {};

// An action that hands the matched bytes' offsets to a method of the lexer.
template <void (Lexer::*method)(std::uint32_t, std::uint32_t)> struct spanned {
    template <class Input> static void apply(const Input &in, Lexer &lexer, const char *start) {
        (lexer.*method)(static_cast<std::uint32_t>(in.begin() - start),
                        static_cast<std::uint32_t>(in.end() - start));
    }
};
template <> struct action<line_comment> : spanned<&Lexer::line_comment> {};
template <> struct action<block_comment> : spanned<&Lexer::block_comment> {};
template <> struct action<unclosed_comment> : spanned<&Lexer::unclosed_comment> {};
template <> struct action<word> : spanned<&Lexer::word> {};
template <> struct action<number> : spanned<&Lexer::number> {};
template <> struct action<text> : spanned<&Lexer::string> {};
template <> struct action<unclosed_text> : spanned<&Lexer::unclosed_string> {};
template <> struct action<quoted> : spanned<&Lexer::quoted> {};
template <> struct action<sign> : spanned<&Lexer::sign> {};
template <> struct action<strange> : spanned<&Lexer::strange> {};
template <> struct action<line_end> {
    static void apply0(Lexer &lexer, const char *) { lexer.line_end(); }
};

} // namespace words

// -- statements and expressions ------------------------------------------------------------------

namespace grammar {

template <Tok... kinds> struct tok : one<static_cast<char>(kinds)...> {};

struct expression;
struct block;
struct type;
struct statement;
template <class Rule> struct recovering;

// Signs that close or join; each its own rule, so that each can say what was wanted.
struct paren_close : tok<Tok::Close> {};
struct list_close : tok<Tok::ListClose> {};
struct brace_close : tok<Tok::BraceClose> {};
struct any_paren : tok<Tok::Open, Tok::FreshOpen, Tok::LambdaOpen> {};
struct any_list : tok<Tok::ListOpen, Tok::FreshListOpen> {};

// Types.
struct type_word : tok<Tok::Name> {};
struct type_number : tok<Tok::Number> {};
struct type_bound_end : tok<Tok::Greater> {};
struct type_name : seq<type_word, opt<tok<Tok::Less>, must<type_number>, must<type_bound_end>>> {};
struct type_list : seq<any_list, must<type>, must<list_close>> {};
struct type_function_open : any_paren {};
struct type_arrow : tok<Tok::Arrow> {};
struct type_function : seq<type_function_open, opt<type, star<tok<Tok::Comma>, must<type>>>,
                           must<paren_close>, must<type_arrow>, must<type>> {};
struct type_enter : success {};
struct type_leave : success {};
struct type_start : tok<Tok::Name, Tok::ListOpen, Tok::FreshListOpen, Tok::Open, Tok::FreshOpen,
                        Tok::LambdaOpen> {};
struct type
    : seq<at<type_start>, type_enter, sor<type_name, type_list, type_function>, type_leave> {};
struct some_type : seq<tok<Tok::Colon>, must<type>> {};
struct no_type : success {};
struct maybe_type : sor<some_type, no_type> {};

// Operands.
struct number : tok<Tok::Number> {};
struct text : tok<Tok::String> {};
struct color : tok<Tok::Color> {};
struct yes : tok<Tok::True> {};
struct no : tok<Tok::False> {};
struct name : tok<Tok::Name> {};
struct bad : tok<Tok::Bad> {};
struct paren : seq<tok<Tok::Open, Tok::FreshOpen>, must<expression>, must<paren_close>> {};

// A comma may stand before the closing bracket.
template <class Item, class Close> struct items
    : opt<Item, star<tok<Tok::Comma>, not_at<Close>, must<Item>>, opt<tok<Tok::Comma>>> {};

struct list_open : any_list {};
struct comprehension_open : at<tok<Tok::For>> {};
struct for_loop;
struct comprehension : seq<comprehension_open, for_loop> {};
struct plain_items : items<expression, list_close> {};
struct plain_list : success {};
struct list : seq<list_open, sor<comprehension, seq<plain_items, plain_list>>, must<list_close>> {};

// Functions.
struct declared_name : tok<Tok::Name, Tok::LambdaName> {};
struct parameter_name : tok<Tok::Name, Tok::LambdaName> {};
struct no_value : success {};
struct some_default : seq<tok<Tok::Assign>, must<expression>> {};
struct parameter : seq<parameter_name, maybe_type, sor<some_default, no_value>> {};
struct parameters_open : tok<Tok::Open> {};
struct parameters : seq<parameters_open, items<parameter, paren_close>, must<paren_close>> {};
struct lambda_name : tok<Tok::LambdaName> {};
struct lambda_open : tok<Tok::LambdaOpen> {};
struct lambda_head
    : sor<lambda_name, seq<lambda_open, items<parameter, paren_close>, must<paren_close>>> {};
struct lambda_arrow : tok<Tok::FatArrow> {};
struct block_body : seq<block> {};
struct value_body : seq<expression> {};
struct lambda_body : sor<block_body, value_body> {};
struct lambda : seq<lambda_head, must<lambda_arrow>, must<lambda_body>> {};

// Choice.
struct if_open : tok<Tok::If> {};
struct if_branch : seq<must<expression>, must<block>> {};
struct otherwise : seq<not_at<tok<Tok::If>>, must<block>> {};
struct else_if : seq<tok<Tok::If>, if_branch> {};
struct choice : seq<if_open, if_branch, star<tok<Tok::Else>, sor<else_if, otherwise>>> {};

// Postfix forms, in a loop.
struct operand_start
    : tok<Tok::Name, Tok::LambdaName, Tok::Number, Tok::String, Tok::Color, Tok::True, Tok::False,
          Tok::Bad, Tok::Open, Tok::FreshOpen, Tok::LambdaOpen, Tok::ListOpen, Tok::FreshListOpen,
          Tok::If, Tok::Minus, Tok::Not> {};
struct call_open : tok<Tok::Open> {};
struct argument_name : seq<tok<Tok::Name>, tok<Tok::Colon, Tok::Assign>> {};
struct no_name : success {};
struct argument : seq<sor<argument_name, seq<at<operand_start>, no_name>>, must<expression>> {};
struct call : seq<call_open, items<argument, paren_close>, must<paren_close>> {};
struct index : seq<tok<Tok::ListOpen>, must<expression>, must<list_close>> {};
struct member_name : tok<Tok::Name, Tok::LambdaName> {};
struct member : seq<tok<Tok::Dot>, must<member_name>> {};
struct trailing : seq<at<tok<Tok::Trailing>>, block> {};
struct step : tok<Tok::PlusPlus, Tok::MinusMinus> {};
struct postfix : sor<member, call, index, trailing, step> {};
struct primary : sor<name, number, paren, list, choice, text, color, yes, no, bad> {};

// Expressions: operands and operators in a row; the builder knows how tightly each binds.
struct prefix : tok<Tok::Minus, Tok::Not> {};
struct binary
    : tok<Tok::Bar, Tok::Amp, Tok::Or, Tok::And, Tok::EqualEqual, Tok::NotEqual, Tok::Less,
          Tok::LessEqual, Tok::Greater, Tok::GreaterEqual, Tok::DotDot, Tok::DotDotEqual, Tok::Plus,
          Tok::Minus, Tok::Star, Tok::Slash, Tok::Percent, Tok::Caret> {};
struct operand : sor<lambda, seq<primary, star<postfix>>, seq<plus<prefix>, must<operand>>> {};
struct enter : success {};
struct row_end : success {};
struct leave : success {};
struct question : tok<Tok::Question> {};
struct ternary_colon : tok<Tok::Colon> {};
struct ternary : seq<question, must<expression>, must<ternary_colon>, must<expression>> {};
struct expression : seq<at<operand_start>, enter, must<operand>, star<binary, must<operand>>,
                        row_end, opt<ternary>, leave> {};

// Statements.
struct assign_sign : tok<Tok::Assign> {};
struct let
    : seq<tok<Tok::Let>, must<declared_name>, maybe_type, must<assign_sign>, must<expression>> {};
struct var
    : seq<tok<Tok::Var>, must<declared_name>, maybe_type, must<assign_sign>, must<expression>> {};
struct function_open : tok<Tok::Fn> {};
struct some_result_type : seq<tok<Tok::Arrow>, must<type>> {};
struct function_head : success {};
struct function_value : seq<tok<Tok::Assign>, must<expression>> {};
struct function_body : sor<function_value, block_body> {};
struct function : seq<function_open, must<declared_name>, must<parameters>,
                      sor<some_result_type, no_type>, function_head, must<function_body>> {};
struct param_range : seq<tok<Tok::In>, must<expression>> {};
struct param_label : tok<Tok::String> {};
struct param : seq<tok<Tok::Param>, must<declared_name>, maybe_type, must<assign_sign>,
                   must<expression>, sor<param_range, no_value>, sor<param_label, no_name>> {};
struct import_path : tok<Tok::String> {};
struct import_as : seq<tok<Tok::As>, must<declared_name>> {};
struct import : seq<tok<Tok::Import>, must<import_path>, sor<import_as, no_name>> {};
struct loop_in : tok<Tok::In> {};
struct loop_open : tok<Tok::For, Tok::While> {};
struct for_loop : seq<at<tok<Tok::For>>, loop_open, must<declared_name>, must<loop_in>,
                      must<expression>, must<block>> {};
struct while_limit : seq<tok<Tok::Limit>, must<expression>> {};
struct while_loop : seq<at<tok<Tok::While>>, loop_open, must<expression>,
                        sor<while_limit, no_value>, must<block>> {};
struct break_loop : tok<Tok::Break> {};
struct returned : seq<expression> {};
struct return_value : seq<tok<Tok::Return>, sor<returned, no_value>> {};
struct assign_op
    : tok<Tok::Assign, Tok::PlusAssign, Tok::MinusAssign, Tok::StarAssign, Tok::SlashAssign> {};
struct assignment : seq<assign_op, must<expression>> {};
struct plain_value : success {};
struct value : seq<expression, sor<assignment, plain_value>> {};
struct any_statement : sor<value, let, function, for_loop, while_loop, var, return_value,
                           break_loop, param, import> {};
struct statement : must<any_statement> {};

struct block_open : tok<Tok::Body, Tok::Trailing> {};
struct in_block : star<sor<tok<Tok::End>, seq<not_at<brace_close>, recovering<statement>>>> {};
struct block : seq<block_open, in_block, must<brace_close>> {};
struct file : seq<star<sor<tok<Tok::End>, seq<not_at<eof>, recovering<statement>>>>, eof> {};

// A statement that cannot be read is reported once and stepped over.
template <class Rule> struct recovering {
    using rule_t = recovering;
    using subs_t = pegtl::type_list<Rule>;

    template <pegtl::apply_mode A, pegtl::rewind_mode M, template <class...> class Action,
              template <class...> class Control, class Input>
    static bool match(Input &in, Builder &builder) {
        const auto index = [&] {
            return static_cast<Builder::Index>(in.current() - in.begin_of_all());
        };
        const Builder::Mark mark = builder.mark();
        const Builder::Index first = index();
        Builder::Index next = first;
        if (builder.foreign_statement(first)) {
            in.go_to(builder.abandon(builder.mark(), first));
            return true;
        }
        try {
            const bool read = Control<Rule>::template match<A, M, Action, Control>(in, builder);
            if (read && builder.ends_statement(index())) return true;
            next = builder.junk(mark, first, index());
        } catch (const Abandon &) {
            next = builder.abandon(mark, first);
        }
        in.go_to(next);
        return true;
    }
};

// Tokens as PEGTL's input: a string of kinds in which we may step forward at will.
struct Input : pegtl::memory_input<pegtl::tracking_mode::lazy, pegtl::eol::lf> {
    explicit Input(const std::string &kinds)
        : memory_input(kinds.data(), kinds.data() + kinds.size(), std::string()) {}
    const char *begin_of_all() const { return begin(); }
    void go_to(Builder::Index index) {
        bump_in_this_line(static_cast<std::size_t>(begin() + index - current()));
    }
};

// What each rule that must match is for, so that its absence can be said in the user's words.
template <class Rule> constexpr Wanted wanted = Wanted::Expression;
template <> constexpr Wanted wanted<paren_close> = Wanted::CloseParen;
template <> constexpr Wanted wanted<list_close> = Wanted::CloseList;
template <> constexpr Wanted wanted<brace_close> = Wanted::CloseBrace;
template <> constexpr Wanted wanted<declared_name> = Wanted::Name;
template <> constexpr Wanted wanted<parameter> = Wanted::ParameterName;
template <> constexpr Wanted wanted<parameters> = Wanted::OpenParen;
template <> constexpr Wanted wanted<assign_sign> = Wanted::AssignSign;
template <> constexpr Wanted wanted<type> = Wanted::Type;
template <> constexpr Wanted wanted<type_bound_end> = Wanted::TypeEnd;
template <> constexpr Wanted wanted<type_number> = Wanted::TypeNumber;
template <> constexpr Wanted wanted<type_arrow> = Wanted::TypeArrow;
template <> constexpr Wanted wanted<function_body> = Wanted::FunctionBody;
template <> constexpr Wanted wanted<block> = Wanted::Block;
template <> constexpr Wanted wanted<loop_in> = Wanted::In;
template <> constexpr Wanted wanted<lambda_arrow> = Wanted::Arrow;
template <> constexpr Wanted wanted<member_name> = Wanted::MemberName;
template <> constexpr Wanted wanted<import_path> = Wanted::ImportPath;
template <> constexpr Wanted wanted<ternary_colon> = Wanted::TernaryColon;
template <> constexpr Wanted wanted<any_statement> = Wanted::Statement;

template <class Rule> struct control : pegtl::normal<Rule> {
    template <class In> [[noreturn]] static void raise(const In &in, Builder &builder) {
        builder.fail(wanted<Rule>, static_cast<Builder::Index>(in.current() - in.begin()));
    }
};

template <class Rule> struct action : pegtl::nothing<Rule> {};

// Actions by what they tell the builder: the first token, the first and the last, or nothing.
template <void (Builder::*method)(Builder::Index)> struct with_token {
    template <class In> static void apply(const In &in, Builder &builder) {
        (builder.*method)(static_cast<Builder::Index>(in.begin() - in.input().begin()));
    }
};
template <void (Builder::*method)(Builder::Index, Builder::Index)> struct with_range {
    template <class In> static void apply(const In &in, Builder &builder) {
        const char *start = in.input().begin();
        (builder.*method)(static_cast<Builder::Index>(in.begin() - start),
                          static_cast<Builder::Index>(in.end() - start - 1));
    }
};
template <void (Builder::*method)()> struct plain {
    static void apply0(Builder &builder) { (builder.*method)(); }
};

template <> struct action<type_enter> : with_token<&Builder::deeper> {};
template <> struct action<type_leave> : plain<&Builder::shallower> {};
template <> struct action<type_word> : with_token<&Builder::type_name> {};
template <> struct action<type_number> : with_token<&Builder::type_number> {};
template <> struct action<type_bound_end> : with_token<&Builder::type_bound_end> {};
template <> struct action<type_list> : with_range<&Builder::type_list> {};
template <> struct action<type_function_open> : plain<&Builder::type_function_open> {};
template <> struct action<type_function> : with_range<&Builder::type_function> {};
template <> struct action<some_type> : plain<&Builder::some_type> {};
template <> struct action<some_result_type> : plain<&Builder::some_type> {};
template <> struct action<no_type> : plain<&Builder::no_type> {};

template <> struct action<number> : with_token<&Builder::number> {};
template <> struct action<text> : with_token<&Builder::string> {};
template <> struct action<color> : with_token<&Builder::color> {};
template <> struct action<yes> : with_token<&Builder::yes> {};
template <> struct action<no> : with_token<&Builder::no> {};
template <> struct action<name> : with_token<&Builder::name> {};
template <> struct action<bad> : with_token<&Builder::poison> {};
template <> struct action<paren> : with_range<&Builder::parenthesized> {};
template <> struct action<list_open> : plain<&Builder::list_open> {};
template <> struct action<comprehension_open> : plain<&Builder::block_open> {};
template <> struct action<comprehension> : plain<&Builder::comprehension> {};
template <> struct action<list> : with_range<&Builder::list> {};

template <> struct action<declared_name> : with_token<&Builder::declared_name> {};
template <> struct action<parameter_name> : with_token<&Builder::declared_name> {};
template <> struct action<some_default> : plain<&Builder::some_value> {};
template <> struct action<no_value> : plain<&Builder::no_value> {};
template <> struct action<parameter> : plain<&Builder::parameter> {};
template <> struct action<lambda_name> : with_token<&Builder::lambda_name> {};
template <> struct action<lambda_open> : with_token<&Builder::function_open> {};
template <> struct action<lambda_arrow> : with_token<&Builder::function_head> {};
template <> struct action<block_body> : plain<&Builder::block_body> {};
template <> struct action<value_body> : plain<&Builder::value_body> {};
template <> struct action<lambda> : with_range<&Builder::lambda> {};

template <> struct action<if_open> : plain<&Builder::if_open> {};
template <> struct action<if_branch> : plain<&Builder::if_branch> {};
template <> struct action<otherwise> : plain<&Builder::otherwise> {};
template <> struct action<choice> : with_range<&Builder::choice> {};

template <> struct action<call_open> : plain<&Builder::call_open> {};
template <> struct action<argument_name> : with_token<&Builder::argument_name> {};
template <> struct action<no_name> : plain<&Builder::no_name> {};
template <> struct action<argument> : plain<&Builder::argument> {};
template <> struct action<call> : with_range<&Builder::call> {};
template <> struct action<index> : with_range<&Builder::index> {};
template <> struct action<member_name> : with_token<&Builder::member> {};
template <> struct action<trailing> : with_range<&Builder::trailing> {};
template <> struct action<step> : with_token<&Builder::step> {};

template <> struct action<enter> : with_token<&Builder::expression_open> {};
template <> struct action<row_end> : plain<&Builder::row_end> {};
template <> struct action<leave> : plain<&Builder::shallower> {};
template <> struct action<prefix> : with_token<&Builder::prefix> {};
template <> struct action<binary> : with_token<&Builder::binary> {};
template <> struct action<question> : with_token<&Builder::remember> {};
template <> struct action<ternary_colon> : with_token<&Builder::remember> {};
template <> struct action<ternary> : plain<&Builder::ternary> {};

template <> struct action<let> : with_range<&Builder::let> {};
template <> struct action<var> : with_range<&Builder::var> {};
template <> struct action<function_open> : with_token<&Builder::declaration_open> {};
template <> struct action<function_head> : with_token<&Builder::function_head> {};
template <> struct action<function_value> : plain<&Builder::value_body> {};
template <> struct action<function> : with_range<&Builder::function> {};
template <> struct action<param_range> : plain<&Builder::some_value> {};
template <> struct action<param_label> : with_token<&Builder::param_label> {};
template <> struct action<param> : with_range<&Builder::param> {};
template <> struct action<import> : with_range<&Builder::import> {};
template <> struct action<loop_open> : with_token<&Builder::deeper> {};
template <> struct action<for_loop> : with_range<&Builder::for_loop> {};
template <> struct action<while_limit> : plain<&Builder::some_value> {};
template <> struct action<while_loop> : with_range<&Builder::while_loop> {};
template <> struct action<returned> : plain<&Builder::some_value> {};
template <> struct action<break_loop> : with_token<&Builder::break_loop> {};
template <> struct action<return_value> : with_range<&Builder::return_value> {};
template <> struct action<assign_op> : with_token<&Builder::remember> {};
template <> struct action<assignment> : plain<&Builder::assignment> {};
template <> struct action<plain_value> : plain<&Builder::plain_value> {};
template <> struct action<block_open> : plain<&Builder::block_open> {};
template <> struct action<block> : with_range<&Builder::block_close> {};

} // namespace grammar

} // namespace

static Words read_words(const Source &source, SourceId id, std::uint32_t begin, std::uint32_t end,
                        Diagnostics &diagnostics, std::size_t most_words) {
    Lexer lexer(source, id, diagnostics);
    const char *start = source.text.data();
    pegtl::memory_input<pegtl::tracking_mode::lazy, pegtl::eol::lf> in(start + begin, start + end,
                                                                       std::string());
    while (!in.empty()) {
        if (lexer.count() >= most_words) {
            const auto at = static_cast<std::uint32_t>(in.current() - start);
            diagnostics
                .add(Code::MemoryLimit, {id, at, at + 1},
                     fmt::format("this text has more than {} words, and its tree has no room in "
                                 "memory",
                                 most_words))
                .note(
                    "the limit `memory` counts what scene time makes, and half of it is for texts")
                .help("make many like shapes by a loop; `--limit memory=N` allows N MiB");
            return Lexer(source, id, diagnostics).take(); // one cause, one report
        }
        const auto at = static_cast<std::uint32_t>(in.current() - start);
        if (const std::uint32_t past = lexer.by_hand(at); past > 0)
            in.bump_in_this_line(past - at);
        else
            pegtl::parse<words::any_word, words::action>(in, lexer, start);
    }
    return lexer.take();
}

Words read_words(const Source &source, SourceId id, Diagnostics &diagnostics) {
    return read_words(source, id, 0, static_cast<std::uint32_t>(source.text.size()), diagnostics,
                      std::size_t(-1));
}

Ast parse_part(const Sources &sources, SourceId id, std::uint32_t begin, std::uint32_t end,
               Diagnostics &diagnostics, std::size_t most_words, Words *words) {
    const Source &source = sources[id];
    Diagnostics before = diagnostics;
    Words read = read_words(source, id, begin, end, diagnostics, most_words);
    const Tokens tokens = lay_out(source, id, read, diagnostics);
    if (words) *words = std::move(read);
    read = {}; // the tree takes its room
    Builder builder(source, id, tokens, diagnostics);
    grammar::Input in(tokens.kinds);
    pegtl::parse<grammar::file, grammar::action, grammar::control>(in, builder);
    Ast ast = builder.finish();
    if (diagnostics.errors() == before.errors() || begin > 0 || end < source.text.size())
        return ast;
    if (!program::answer(source, id, before)) return ast;
    diagnostics = std::move(before); // nothing else is to be said
    return parse_part(sources, id, 0, 0, diagnostics, most_words, words);
}

} // namespace fathom::lang
