#include "lsp/server.h"

#include "lsp/serve.h"
#include "lsp/transport.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

namespace fathom::lsp {

using fathom::v1::CompileResult;
using fathom::v1::Diagnostic;
using fathom::v1::Place;
using Json = nlohmann::json;

namespace {

// JSON-RPC's.
constexpr int parse_error = -32700, unknown_method = -32601, internal_error = -32603;

// A string of ours may hold bytes that are no UTF-8: they become U+FFFD.
std::string written(const Json &json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string notification(const char *method, Json params) {
    return written({{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(params)}});
}

Json json_of(const Range &range) {
    return {{"start", {{"line", range.start.line}, {"character", range.start.character}}},
            {"end", {{"line", range.end.line}, {"character", range.end.character}}}};
}

Position position_of(const Json &json) {
    return {json.at("line").get<int>(), json.at("character").get<int>()};
}

int severity_of(fathom::v1::Severity severity) {
    switch (severity) {
    case fathom::v1::Severity::Error: return 1;
    case fathom::v1::Severity::Warning: return 2;
    case fathom::v1::Severity::Note: return 3;
    }
    return 1;
}

// In the protocol's numbers.
constexpr int item_method = 2, item_function = 3, item_variable = 6;
constexpr int symbol_function = 12, symbol_variable = 13;

const char *word_of(fathom::v1::Status status) {
    switch (status) {
    case fathom::v1::Status::Proved: return "proved";
    case fathom::v1::Status::Assumed: return "assumed";
    case fathom::v1::Status::Estimated: return "estimated";
    }
    return "";
}

std::string facts_in_words(const fathom::v1::ShapeFacts &facts) {
    return fmt::format("bound {:.4g}, {}, {}", facts.lipschitz, word_of(facts.status),
                       facts.exact ? "exact" : "a lower bound of the distance");
}

std::string hover_text(const fathom::v1::LibraryEntry &entry) {
    const std::string module = entry.module.empty() ? "" : entry.module + ".";
    return fmt::format("```\n{}{}\n```\n{}", module, entry.signature, entry.doc);
}

// Whether a library function may stand after a dot: its first parameter is what stands before.
bool takes_first(const fathom::v1::LibraryEntry &entry) {
    const std::size_t open = entry.signature.find('(');
    return open != entry.signature.npos && open + 1 < entry.signature.size() &&
           entry.signature[open + 1] != ')';
}

std::optional<std::string> read_whole(const std::filesystem::path &file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
    std::ifstream in(file, std::ios::binary);
    if (!in) return std::nullopt;
    return std::string(std::istreambuf_iterator<char>(in), {});
}

} // namespace

Server::Server() : library_(fathom::v1::library_entries()) {}
Server::~Server() = default;

std::vector<std::string> Server::handle(const std::string &message) {
    const Json request = Json::parse(message, nullptr, false);
    const auto failure = [](const Json &id, int code, const std::string &why) {
        return written(
            {{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", code}, {"message", why}}}});
    };
    if (request.is_discarded() || !request.is_object())
        return {failure(nullptr, parse_error, "this is no JSON object")};
    const Json id = request.value("id", Json());
    const bool wants_answer = request.contains("id");
    if (!request.contains("method") || !request["method"].is_string()) return {}; // an answer to us
    const std::string method = request["method"];
    const Json params = request.value("params", Json::object());
    try {
        if (!wants_answer) {
            notified(method, params);
            return {};
        }
        bool known = true;
        Json result = answer(method, params, known);
        if (!known) return {failure(id, unknown_method, "there is no request " + method)};
        return {written({{"jsonrpc", "2.0"}, {"id", id}, {"result", std::move(result)}})};
    } catch (const std::exception &error) { // a field that is missing or of another type
        if (!wants_answer) return {};
        return {failure(id, internal_error, error.what())};
    }
}

std::vector<std::string> Server::idle() {
    std::vector<std::string> messages;
    for (auto &[uri, document] : documents_) {
        if (document.published) continue;
        document.published = true;
        Json all = Json::array();
        for (const Diagnostic &diagnostic : compiled(document).diagnostics)
            if (diagnostic.at.line == 0 || diagnostic.at.file == document.path)
                all.push_back(diagnostic_of(document, diagnostic));
        messages.push_back(notification(
            "textDocument/publishDiagnostics",
            {{"uri", uri}, {"version", document.version}, {"diagnostics", std::move(all)}}));
    }
    return messages;
}

Json Server::answer(const std::string &method, const Json &params, bool &known) {
    if (method == "initialize") return initialize();
    if (method == "shutdown") return shut_down_ = true, Json();
    if (method == "textDocument/hover") return hover(params);
    if (method == "textDocument/completion") return completion(params);
    if (method == "textDocument/definition") return definition(params);
    if (method == "textDocument/documentSymbol") return symbols(params);
    if (method == "textDocument/formatting") return formatting(params);
    if (method == "textDocument/codeAction") return code_actions(params);
    if (method == "textDocument/inlayHint") return inlay_hints(params);
    known = false;
    return {};
}

void Server::notified(const std::string &method, const Json &params) {
    if (method == "exit") ended_ = true;
    if (method == "textDocument/didOpen") {
        const Json &opened = params.at("textDocument");
        const std::string uri = opened.at("uri");
        Document document;
        document.path = path_of(uri);
        if (document.path.empty()) document.path = uri; // a text that is no file yet
        document.text = opened.at("text");
        document.version = opened.value("version", 0);
        changed(documents_[uri] = std::move(document));
    }
    if (method == "textDocument/didClose")
        documents_.erase(params.at("textDocument").at("uri").get<std::string>());
    if (method == "textDocument/didChange") {
        Document *document = document_of(params);
        if (!document) return;
        for (const Json &change : params.at("contentChanges")) {
            std::string text = change.at("text");
            if (!change.contains("range")) {
                document->text = std::move(text);
                continue;
            }
            const Json &range = change["range"];
            const std::size_t begin = offset_at(document->text, position_of(range.at("start"))),
                              end = offset_at(document->text, position_of(range.at("end")));
            if (begin <= end) document->text.replace(begin, end - begin, text);
        }
        document->version = params.at("textDocument").value("version", document->version + 1);
        changed(*document);
    }
}

// Others may import it.
void Server::changed(Document &) {
    for (auto &[uri, document] : documents_) {
        document.compiled.reset();
        document.published = false;
    }
}

const CompileResult &Server::compiled(Document &document) {
    if (!document.compiled) {
        const std::filesystem::path folder = std::filesystem::path(document.path).parent_path();
        fathom::v1::CompileOptions options;
        options.files = [this, folder](const std::string &name) -> std::optional<std::string> {
            const std::filesystem::path file = folder / name;
            for (const auto &[uri, open] : documents_)
                if (open.path == file.string()) return open.text;
            std::error_code error; // a link that leads out of the folder is not followed
            const std::filesystem::path real = std::filesystem::weakly_canonical(file, error),
                                        root = std::filesystem::weakly_canonical(folder, error);
            const std::filesystem::path way = real.lexically_relative(root);
            if (error || way.empty() || *way.begin() == "..") return std::nullopt;
            return read_whole(file);
        };
        document.compiled = fathom::v1::compile_text(document.path, document.text, options);
    }
    return *document.compiled;
}

Document *Server::document_of(const Json &params) {
    const auto found = documents_.find(params.at("textDocument").at("uri").get<std::string>());
    return found == documents_.end() ? nullptr : &found->second;
}

Json Server::place_of(const Document &document, const Place &place) const {
    if (place.line == 0) return json_of(Range{});
    if (place.file == document.path)
        return json_of(range_of(document.text, place.begin, place.end));
    return json_of(range_of(place));
}

Json Server::diagnostic_of(const Document &document, const Diagnostic &diagnostic) const {
    std::string message = diagnostic.message;
    for (const std::string &note : diagnostic.notes) message += "\nnote: " + note;
    if (!diagnostic.help.empty()) message += "\nhelp: " + diagnostic.help;
    Json related = Json::array();
    const std::filesystem::path folder = std::filesystem::path(document.path).parent_path();
    for (const fathom::v1::Label &label : diagnostic.related) {
        const std::string file = label.at.file == document.path
                                     ? document.path
                                     : (folder / label.at.file).lexically_normal().string();
        related.push_back(
            {{"location", {{"uri", uri_of(file)}, {"range", place_of(document, label.at)}}},
             {"message", label.message}});
    }
    return {{"range", place_of(document, diagnostic.at)},
            {"severity", severity_of(diagnostic.severity)},
            {"code", diagnostic.code},
            {"source", "fathom"},
            {"message", message},
            {"relatedInformation", std::move(related)}};
}

Json Server::initialize() const {
    return {{"capabilities",
             {{"positionEncoding", "utf-16"},
              {"textDocumentSync", {{"openClose", true}, {"change", 2}}},
              {"hoverProvider", true},
              {"completionProvider", {{"triggerCharacters", {"."}}}},
              {"definitionProvider", true},
              {"documentSymbolProvider", true},
              {"documentFormattingProvider", true},
              {"codeActionProvider", {{"codeActionKinds", {"quickfix"}}}},
              {"inlayHintProvider", true}}},
            {"serverInfo", {{"name", "fathom"}, {"version", fathom::v1::version()}}}};
}

// What a name is: of the text's own names the type, of the library's the entry. On a shape at the
// top level also what is proved of it.
Json Server::hover(const Json &params) {
    Document *document = document_of(params);
    if (!document) return {};
    const std::size_t offset = offset_at(document->text, position_of(params.at("position")));
    const Word word = word_at(document->text, offset);
    const std::string name = document->text.substr(word.begin, word.end - word.begin);
    const CompileResult &result = compiled(*document);
    std::string text;
    const auto add = [&](const std::string &part) {
        text += (text.empty() ? "" : "\n\n---\n\n") + part;
    };
    const auto own = std::ranges::find(result.names, name, &fathom::v1::Name::name);
    if (!name.empty() && own != result.names.end())
        add(fmt::format("```\n{}: {}\n```", own->name, own->type));
    else if (!name.empty())
        for (const fathom::v1::LibraryEntry &entry : library_)
            if (entry.name == name && entry.module.empty()) add(hover_text(entry));
    if (result.scene)
        for (const fathom::v1::ShapeFacts &shape : result.scene->facts().shapes)
            if (shape.at.file == document->path && shape.at.begin <= offset &&
                offset <= shape.at.end)
                add("This shape: " + facts_in_words(shape) + ".");
    if (text.empty()) return {};
    Json answer{{"contents", {{"kind", "markdown"}, {"value", text}}}};
    if (!name.empty()) answer["range"] = json_of(range_of(document->text, word.begin, word.end));
    return answer;
}

Json Server::completion(const Json &params) {
    Document *document = document_of(params);
    if (!document) return Json::array();
    const std::size_t offset = offset_at(document->text, position_of(params.at("position")));
    const Word word = word_at(document->text, offset);
    Json items = Json::array();
    if (!word.method)
        for (const fathom::v1::Name &name : compiled(*document).names)
            items.push_back({{"label", name.name},
                             {"kind", name.type == "function" ? item_function : item_variable},
                             {"detail", name.type}});
    std::string last;
    for (const fathom::v1::LibraryEntry &entry : library_) {
        if (!entry.module.empty() || entry.name == last) continue;
        if (word.method && !takes_first(entry)) continue;
        last = entry.name;
        items.push_back({{"label", entry.name},
                         {"kind", word.method ? item_method : item_function},
                         {"detail", entry.signature},
                         {"documentation", {{"kind", "markdown"}, {"value", entry.doc}}}});
    }
    return items;
}

Json Server::definition(const Json &params) {
    Document *document = document_of(params);
    if (!document) return {};
    const std::size_t offset = offset_at(document->text, position_of(params.at("position")));
    const Word word = word_at(document->text, offset);
    const std::string name = document->text.substr(word.begin, word.end - word.begin);
    // The last declaration before the place; else the first.
    const fathom::v1::Name *found = nullptr;
    for (const fathom::v1::Name &declared : compiled(*document).names) {
        if (declared.name != name || declared.at.file != document->path) continue;
        if (!found || declared.at.begin <= offset) found = &declared;
    }
    if (name.empty() || !found) return {};
    return {{"uri", params.at("textDocument").at("uri")},
            {"range", place_of(*document, found->at)}};
}

Json Server::symbols(const Json &params) {
    Document *document = document_of(params);
    Json all = Json::array();
    if (!document) return all;
    for (const fathom::v1::Name &name : compiled(*document).names) {
        if (name.at.file != document->path) continue;
        const Json range = place_of(*document, name.at);
        all.push_back({{"name", name.name},
                       {"detail", name.type},
                       {"kind", name.type == "function" ? symbol_function : symbol_variable},
                       {"range", range},
                       {"selectionRange", range}});
    }
    return all;
}

// One edit of the lines that differ, so that cursors elsewhere stay where they are.
Json Server::formatting(const Json &params) {
    Document *document = document_of(params);
    Json edits = Json::array();
    if (!document) return edits;
    const std::optional<std::string> formatted = fathom::v1::format_text(document->text);
    if (!formatted || *formatted == document->text) return edits;
    const std::string &old = document->text;
    std::size_t same = 0;
    const std::size_t least = std::min(old.size(), formatted->size());
    while (same < least && old[same] == (*formatted)[same]) ++same;
    while (same > 0 && old[same - 1] != '\n') --same;
    std::size_t tail = 0;
    while (tail < least - same &&
           old[old.size() - 1 - tail] == (*formatted)[formatted->size() - 1 - tail])
        ++tail;
    while (tail > 0 && old[old.size() - tail - 1] != '\n') --tail;
    edits.push_back({{"range", json_of(range_of(old, same, old.size() - tail))},
                     {"newText", formatted->substr(same, formatted->size() - tail - same)}});
    return edits;
}

// The fixes of the diagnostics that meet the range.
Json Server::code_actions(const Json &params) {
    Document *document = document_of(params);
    Json actions = Json::array();
    if (!document) return actions;
    const std::size_t begin =
                          offset_at(document->text, position_of(params.at("range").at("start"))),
                      end = offset_at(document->text, position_of(params.at("range").at("end")));
    for (const Diagnostic &diagnostic : compiled(*document).diagnostics) {
        if (diagnostic.edits.empty() || diagnostic.at.file != document->path ||
            diagnostic.at.end < begin || end < diagnostic.at.begin)
            continue;
        Json edits = Json::array();
        for (const fathom::v1::Edit &edit : diagnostic.edits) {
            if (edit.at.file != document->path) continue;
            edits.push_back(
                {{"range", place_of(*document, edit.at)}, {"newText", edit.replacement}});
        }
        if (edits.size() != diagnostic.edits.size()) continue; // of another file too
        actions.push_back(
            {{"title", diagnostic.help},
             {"kind", "quickfix"},
             {"diagnostics", {diagnostic_of(*document, diagnostic)}},
             {"edit",
              {{"changes",
                {{params.at("textDocument").at("uri").get<std::string>(), std::move(edits)}}}}}});
    }
    return actions;
}

// Where a shape's bound is above 1, the bound, at the end of its statement.
Json Server::inlay_hints(const Json &params) {
    Document *document = document_of(params);
    Json hints = Json::array();
    if (!document || !compiled(*document).scene) return hints;
    for (const fathom::v1::ShapeFacts &shape : compiled(*document).scene->facts().shapes) {
        if (shape.at.file != document->path || shape.lipschitz <= 1) continue;
        const Json range = place_of(*document, shape.at);
        hints.push_back({{"position", range["end"]},
                         {"label", fmt::format("bound {:.3g}", shape.lipschitz)},
                         {"tooltip", facts_in_words(shape)},
                         {"paddingLeft", true}});
    }
    return hints;
}

int serve(int in, int out) {
    Transport transport(in, out);
    Server server;
    const auto send = [&](const std::vector<std::string> &messages) {
        return std::ranges::all_of(messages,
                                   [&](const std::string &m) { return transport.write(m); });
    };
    while (!server.ended()) {
        if (!transport.pending() && !send(server.idle())) break;
        const std::optional<std::string> message = transport.read();
        if (!message || !send(server.handle(*message))) break;
    }
    return server.exit_status();
}

} // namespace fathom::lsp
