// Half-typed texts: what stands above the place where a text ends early is known as in the whole
// text. FATHOM_CUTS=all cuts at the end of every word; else a few of each text are tried.
#include "client.h"
#include "scenes.h"

#include "api/language/names.h"

#include <cstdlib>
#include <set>

namespace {

using namespace fathom::lsp;
using namespace fathom::language;
using fathom::lang::Tok;

std::string uri; // of the text that is open

Json place(const Lines &lines, std::size_t offset) {
    const Position at = position_at(lines, offset);
    return Client::at(at.line, at.character, uri);
}

// Once the proof is done, for which a hover waits a moment and no more.
std::string hover_at(Client &client, const Lines &lines, std::size_t offset) {
    constexpr int most = 200;
    std::string said;
    for (int asked = 0; asked < most; ++asked) {
        const Json hover = client.result("textDocument/hover", place(lines, offset));
        said = hover.is_null() ? "" : hover.at("contents").at("value").get<std::string>();
        if (said.find("not proved yet") == std::string::npos) break;
    }
    return said;
}

std::set<std::string> labels_at(Client &client, const Lines &lines, std::size_t offset) {
    std::set<std::string> labels;
    for (const Json &item : client.result("textDocument/completion", place(lines, offset)))
        labels.insert(item.at("label"));
    return labels;
}

bool holds(fathom::Span span, const Use &use) {
    return span.begin <= use.at.begin && use.at.end <= span.end;
}

// What a text says differently where it ends at a byte, by the number of the declaration: all but
// what ends before the statement that is cut, and reads nothing that is declared after.
std::set<std::size_t> lost_at(const Syntax &syntax, const Names &names, std::size_t cut) {
    std::size_t begin = cut;
    for (const auto &stmt : syntax.ast.blocks[syntax.ast.root].stmts)
        if (stmt.span.begin < cut && cut <= stmt.span.end) begin = stmt.span.begin;
    std::set<std::size_t> lost;
    for (bool more = true; more;) {
        more = false;
        for (std::size_t i = 0; i < names.declarations.size(); ++i) {
            const Declaration &declared = names.declarations[i];
            bool known = declared.statement.end <= begin;
            for (const Use &use : names.uses)
                known = known && !(holds(declared.statement, use) && use.declaration &&
                                   lost.contains(*use.declaration));
            if (!known) more = lost.insert(i).second || more;
        }
    }
    return lost;
}

// The part of a hover that says what is proved.
std::string proved_part(const std::string &hover) {
    const std::size_t at = hover.find("here: bound ");
    const std::size_t begin = at == hover.npos ? hover.find("This shape: ") : at;
    return begin == hover.npos ? "" : hover.substr(begin);
}

} // namespace

TEST_CASE("a text that ends early is known above its end") {
    const char *wanted = std::getenv("FATHOM_CUTS");
    const bool all = wanted && std::string(wanted) == "all";
    std::mt19937 random(7);
    std::size_t cuts = 0, names_seen = 0, shapes_seen = 0;
    for (const SceneText &scene : scene_texts()) {
        if (!all && scene.path.find("/examples/") == std::string::npos) continue;
        INFO(scene.path);
        uri = uri_of(scene.path);
        const Syntax syntax = read_syntax(scene.text);
        const Names names = names_of(syntax.ast);
        const Lines lines = lines_of(scene.text);
        Client whole;
        whole.open(scene.text, uri);
        std::map<std::size_t, std::string> hovers;
        const auto hover_of_whole = [&](std::size_t offset) -> const std::string & {
            const auto [found, is_new] = hovers.try_emplace(offset);
            if (is_new) found->second = hover_at(whole, lines, offset);
            return found->second;
        };
        std::vector<std::size_t> ends;
        for (const auto &token : syntax.words.tokens) ends.push_back(token.end);
        if (!all) {
            std::ranges::shuffle(ends, random);
            ends.resize(std::min<std::size_t>(ends.size(), 4));
        }
        for (const std::size_t cut : ends) {
            const std::string text = scene.text.substr(0, cut) + "\n";
            INFO(text.substr(text.size() > 200 ? text.size() - 200 : 0));
            const Lines cut_lines = lines_of(text);
            Client client;
            client.open(text, uri);
            ++cuts;
            const std::set<std::string> offered = labels_at(client, cut_lines, text.size());
            const Syntax half = read_syntax(text);
            const Tok last = half.words.tokens.empty() ? Tok::Name : half.words.tokens.back().kind;
            const bool type_is_next = last == Tok::Colon || last == Tok::Arrow;
            const std::set<std::size_t> lost = lost_at(syntax, names, cut);
            for (std::size_t i = 0; i < names.declarations.size(); ++i) {
                const Declaration &declared = names.declarations[i];
                if (!declared.top_level || declared.name.empty() || lost.contains(i)) continue;
                INFO(declared.name);
                CHECK(hover_at(client, cut_lines, declared.at.begin) ==
                      hover_of_whole(declared.at.begin));
                if (!type_is_next) CHECK(offered.contains(declared.name));
                ++names_seen;
            }
            if (scene.text.find("render(") != std::string::npos) continue; // says what times are
            for (const auto &stmt : syntax.ast.blocks[syntax.ast.root].stmts) {
                if (stmt.span.end >= cut) break;
                const bool reads_lost = std::ranges::any_of(names.uses, [&](const Use &use) {
                    return holds(stmt.span, use) && use.declaration &&
                           lost.contains(*use.declaration);
                });
                const std::string proved = proved_part(hover_of_whole(stmt.span.begin));
                if (proved.empty() || reads_lost) continue;
                CHECK(proved_part(hover_at(client, cut_lines, stmt.span.begin)) == proved);
                ++shapes_seen;
            }
        }
    }
    CHECK(cuts > 60);
    CHECK(names_seen > 200);
    CHECK(shapes_seen > 20);
}
