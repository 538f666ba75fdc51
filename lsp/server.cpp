#include "lsp/server.h"

#include "lsp/requests.h"

#include <algorithm>

namespace fathom::lsp {
namespace {

struct Row {
    const char *method;
    Json (*answer)(Workspace &, const Json &);
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

std::string failure(const Json &id, int code, const std::string &why) {
    return written({{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", code}, {"message", why}}}});
}

} // namespace

Server::Server() : workspace_(workspace_with_library()) {
    workspace_.proofs = fathom::v1::ProofCache::of_bytes();
}

void Server::send(const char *method, Json params) {
    outbox_.push_back(
        written({{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(params)}}));
}

std::vector<std::string> Server::handle(const std::string &message) {
    outbox_.clear();
    workspace_.said.clear();
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
            for (auto &[said, what] : std::exchange(workspace_.said, {}))
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
        fail(invalid_params, error.what());
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
    for (auto &[uri, document] : workspace_.documents) {
        if (document.published) continue;
        document.published = true;
        try {
            send("textDocument/publishDiagnostics",
                 {{"uri", uri},
                  {"version", document.version},
                  {"diagnostics", diagnostics_of(workspace_, document)}});
        } catch (const Outdated &) {
            document.published = false;
            break;
        }
    }
    return std::move(outbox_);
}

Json Server::answer(const std::string &method, const Json &params, bool &known) {
    if (method == "initialize") return initialize(params);
    if (method == "shutdown") return shut_down_ = true, Json();
    const auto row = std::ranges::find(rows(), method, &Row::method);
    if (row != rows().end()) return row->answer(workspace_, params);
    known = false;
    return {};
}

Json Server::initialize(const Json &params) {
    const Json snippets = at_path(
        params, {"capabilities", "textDocument", "completion", "completionItem", "snippetSupport"});
    workspace_.snippets = snippets == true;
    watches_ = at_path(params, {"capabilities", "workspace", "didChangeWatchedFiles",
                                "dynamicRegistration"}) == true;
    const Json folders = at_path(params, {"workspaceFolders"}), root = at_path(params, {"rootUri"});
    if (folders.is_array())
        for (const Json &folder : folders)
            workspace_.roots.push_back(path_of(folder.at("uri").get<std::string>()));
    else if (root.is_string())
        workspace_.roots.push_back(path_of(root.get<std::string>()));
    std::erase(workspace_.roots, "");
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
    if (method == "workspace/didChangeWatchedFiles")
        for (auto &[uri, document] : workspace_.documents) changed(document);
    if (method == "textDocument/didOpen") {
        const Json &opened = params.at("textDocument");
        const std::string uri = opened.at("uri");
        Document document;
        document.uri = uri;
        document.path = path_of(uri);
        if (document.path.empty()) document.path = uri; // a text that is no file yet
        document.text = opened.at("text");
        document.version = opened.value("version", 0);
        changed(workspace_.documents[uri] = std::move(document));
    }
    if (method == "textDocument/didClose") {
        const std::string uri = params.at("textDocument").at("uri");
        if (const auto closed = workspace_.documents.find(uri);
            closed != workspace_.documents.end()) {
            changed(closed->second); // who imports it sees the file again
            workspace_.documents.erase(closed);
        }
        send("textDocument/publishDiagnostics", {{"uri", uri}, {"diagnostics", Json::array()}});
    }
    if (method == "textDocument/didChange") edited(params);
}

void Server::edited(const Json &params) {
    Document &document = document_of(workspace_, params);
    change(document.text, params.at("contentChanges"));
    document.version = params.at("textDocument").value("version", document.version + 1);
    changed(document);
}

// What imports the text may compile differently now.
void Server::changed(Document &document) {
    document.reading.reset();
    for (auto &[uri, other] : workspace_.documents) {
        if (&other != &document && !other.asked_for.contains(document.path)) continue;
        if (other.compiled) other.replaced = std::move(other.compiled);
        other.compiled.reset();
        other.published = false;
    }
}

} // namespace fathom::lsp
