#include "lsp/server.h"

#include "lsp/requests.h"

#include <algorithm>

namespace fathom::lsp {
namespace {

struct Row {
    const char *method;
    Json (*answer)(Session &, const Json &);
    const char *capability; // null: that of another row
    Json value;
};
const std::vector<Row> &rows() {
    static const std::vector<Row> all{
#define FATHOM_REQUEST(function, method, capability, ...)                                          \
    {method, function, capability, Json(__VA_ARGS__)},
#include "lsp/requests.def"
#undef FATHOM_REQUEST
    };
    return all;
}

// A member of members; null where one of them is not there.
Json at_path(const Json &json, std::initializer_list<const char *> path) {
    const Json *at = &json;
    for (const char *name : path) {
        if (!at->is_object() || !at->contains(name)) return nullptr;
        at = &(*at)[name];
    }
    return *at;
}

// What the parameters of a request lack.
std::string in_words(const std::string &method, const Json::exception &error) {
    constexpr int no_member = 403;
    const std::string_view what = error.what();
    const std::size_t begin = what.find('\''), end = what.rfind('\'');
    if (error.id != no_member || begin == what.npos || end <= begin)
        return "a parameter of " + method + " is of another type than the protocol has it";
    return "the parameters of " + method + " have no `" +
           std::string(what.substr(begin + 1, end - begin - 1)) + "`";
}

std::string failure(const Json &id, int code, const std::string &why) {
    return written({{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", code}, {"message", why}}}});
}

} // namespace

void Server::send(const char *method, Json params) {
    outbox_.push_back(
        written({{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(params)}}));
}

std::vector<std::string> Server::handle(const std::string &message) {
    outbox_.clear();
    session_.said.clear();
    const Json request = Json::parse(message, nullptr, false);
    if (request.is_discarded() || !request.is_object())
        return {failure(nullptr, parse_error, "this is no JSON object")};
    const Json id = request.value("id", Json());
    const bool wants_answer = request.contains("id");
    if (!request.contains("method") || !request["method"].is_string()) return {}; // an answer to us
    const std::string method = request["method"];
    const auto fail = [&](int code, const std::string &why) {
        if (wants_answer) outbox_.push_back(failure(id, code, why));
    };
    try {
        const Json params = request.value("params", Json::object());
        if (!wants_answer) {
            notified(method, params);
        } else if (cancelled_.erase(written(id))) {
            fail(request_cancelled, "cancelled");
        } else {
            bool known = true;
            Json result = answer(method, params, known);
            for (auto &[said, what] : std::exchange(session_.said, {}))
                send(said.c_str(), std::move(what));
            if (known)
                outbox_.push_back(
                    written({{"jsonrpc", "2.0"}, {"id", id}, {"result", std::move(result)}}));
            else
                fail(unknown_method, "there is no request " + method);
        }
    } catch (const Outdated &) {
        if (wanted_ == Wanted::TakenBack)
            fail(request_cancelled, "cancelled");
        else
            fail(content_modified, "the text has changed");
    } catch (const Refusal &refusal) {
        fail(request_failed, refusal.what());
    } catch (const UnknownDocument &unknown) {
        fail(invalid_params, unknown.what());
    } catch (const Json::exception &error) { // a field that is missing or of another type
        fail(invalid_params, in_words(method, error));
    } catch (const std::exception &error) {
        fail(internal_error, error.what());
    }
    return std::move(outbox_);
}

void Server::foresee(const std::string &message) {
    if (message.find("$/cancelRequest") == message.npos) return;
    const Json json = Json::parse(message, nullptr, false);
    const Json id = at_path(json, {"params", "id"});
    if (at_path(json, {"method"}) == "$/cancelRequest" && !id.is_null())
        cancelled_.insert(written(id));
}

std::vector<std::string> Server::idle() {
    outbox_.clear();
    cancelled_.clear(); // what was taken back too late
    for (auto &[uri, text] : session_.texts) {
        if (text.published) continue;
        text.published = true;
        try {
            send("textDocument/publishDiagnostics",
                 {{"uri", uri},
                  {"version", text.version},
                  {"diagnostics", diagnostics_of(session_, text)}});
        } catch (const Outdated &) {
            text.published = false;
            break;
        }
    }
    return std::move(outbox_);
}

Json Server::answer(const std::string &method, const Json &params, bool &known) {
    if (method == "initialize") return initialize(params);
    if (method == "shutdown") return shut_down_ = true, Json();
    const auto row = std::ranges::find(rows(), method, &Row::method);
    if (row != rows().end()) return row->answer(session_, params);
    known = false;
    return {};
}

Json Server::initialize(const Json &params) {
    const Json snippets = at_path(
        params, {"capabilities", "textDocument", "completion", "completionItem", "snippetSupport"});
    session_.snippets = snippets == true;
    watches_ = at_path(params, {"capabilities", "workspace", "didChangeWatchedFiles",
                                "dynamicRegistration"}) == true;
    const Json folders = at_path(params, {"workspaceFolders"}), root = at_path(params, {"rootUri"});
    std::vector<std::string> roots;
    if (folders.is_array())
        for (const Json &folder : folders)
            roots.push_back(path_of(folder.at("uri").get<std::string>()));
    else if (root.is_string())
        roots.push_back(path_of(root.get<std::string>()));
    std::erase(roots, "");
    session_.workspace.set_folders(std::move(roots));
    Json capabilities{{"positionEncoding", "utf-16"},
                      {"textDocumentSync", {{"openClose", true}, {"change", 2}}}};
    for (const Row &row : rows())
        if (row.capability) capabilities[row.capability] = row.value;
    return {{"capabilities", std::move(capabilities)},
            {"serverInfo", {{"name", "fathom"}, {"version", fathom::v1::version()}}}};
}

void Server::notified(const std::string &method, const Json &params) {
    if (method == "exit") ended_ = true;
    if (method == "initialized" && watches_)
        outbox_.push_back(written(
            {{"jsonrpc", "2.0"},
             {"id", "fathom-watches"},
             {"method", "client/registerCapability"},
             {"params",
              {{"registrations",
                {{{"id", "fathom-watches"},
                  {"method", "workspace/didChangeWatchedFiles"},
                  {"registerOptions",
                   {{"watchers", {{{"globPattern", "**/*.{sdf,png,jpg,jpeg,nrrd}"}}}}}}}}}}}}));
    if (method == "workspace/didChangeWatchedFiles") changed(session_.workspace.files_changed());
    if (method == "textDocument/didOpen") opened(params);
    if (method == "textDocument/didClose") {
        const std::string uri = params.at("textDocument").at("uri");
        if (const auto closed = session_.texts.find(uri); closed != session_.texts.end()) {
            const std::string path = closed->second.path;
            session_.texts.erase(closed);
            changed(session_.workspace.close(path));
        }
        send("textDocument/publishDiagnostics", {{"uri", uri}, {"diagnostics", Json::array()}});
    }
    if (method == "textDocument/didChange") edited(params);
}

void Server::opened(const Json &params) {
    const Json &given = params.at("textDocument");
    OpenText text;
    text.uri = given.at("uri");
    text.path = path_of(text.uri);
    if (text.path.empty()) text.path = text.uri; // a text that is no file yet
    text.version = given.value("version", 0);
    const std::string path = text.path;
    std::string words = given.at("text");
    session_.texts[text.uri] = std::move(text);
    changed(session_.workspace.set_text(path, std::move(words)));
}

void Server::edited(const Json &params) {
    OpenText &text = text_of(session_, params);
    std::string words(session_.workspace.text(text.path).value_or(""));
    change(words, params.at("contentChanges"));
    text.version = params.at("textDocument").value("version", text.version + 1);
    changed(session_.workspace.set_text(text.path, std::move(words)));
}

// The diagnostics of these are to be sent anew; and where their lines begin may have changed.
void Server::changed(const std::vector<std::string> &paths) {
    for (auto &[uri, text] : session_.texts)
        if (std::ranges::find(paths, text.path) != paths.end()) {
            text.published = false;
            text.lines.reset();
        }
}

} // namespace fathom::lsp
