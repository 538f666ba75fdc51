// The server by its messages, as a client sends them.
#include "client.h"

#include "lsp/transport.h"

#include <catch2/catch.hpp>

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <unistd.h>

namespace {

using namespace fathom::lsp;

} // namespace

TEST_CASE("what is advertised is answered") {
    Client client;
    const Json capabilities = client.result("initialize", Json::object()).at("capabilities");
    client.open("let r = 1\nsphere( r )\n");
    CHECK(capabilities.at("hoverProvider") == true);
    CHECK_FALSE(client.result("textDocument/hover", Client::at(1, 2)).is_null());
    CHECK(capabilities.contains("completionProvider"));
    CHECK_FALSE(client.result("textDocument/completion", Client::at(1, 2)).empty());
    CHECK(capabilities.at("definitionProvider") == true);
    CHECK_FALSE(client.result("textDocument/definition", Client::at(1, 9)).is_null());
    CHECK(capabilities.at("documentSymbolProvider") == true);
    CHECK_FALSE(client.result("textDocument/documentSymbol", Client::at(0, 0)).empty());
    CHECK(capabilities.at("documentFormattingProvider") == true);
    CHECK_FALSE(client.result("textDocument/formatting", Client::at(0, 0)).empty());
}

TEST_CASE("diagnostics come as one types, with their fixes") {
    Client client;
    client.open("// \xf0\x9f\x98\x80\nlet a = 1; shpere(a)\n");
    Json found = client.diagnostics();
    REQUIRE(found.size() == 1);
    CHECK(found[0].at("code") == "unknown-name");
    CHECK(found[0].at("severity") == 1);
    CHECK(found[0].at("range") == range(1, 11, 17));
    CHECK(client.diagnostics().is_null()); // said once

    Json params = Client::at(0, 0);
    params["range"] = range(1, 13, 13);
    const Json actions = client.result("textDocument/codeAction", params);
    REQUIRE(actions.size() == 1);
    const Json edit = actions[0].at("edit").at("changes").at("file:///scenes/a.sdf")[0];
    CHECK(edit.at("newText") == "sphere");
    CHECK(edit.at("range") == range(1, 11, 17));

    client.notify("textDocument/didChange",
                  {{"textDocument", {{"uri", "file:///scenes/a.sdf"}, {"version", 2}}},
                   {"contentChanges", {{{"range", edit.at("range")}, {"text", "sphere"}}}}});
    found = client.diagnostics();
    CHECK(found == Json::array());
}

TEST_CASE("an edit counts UTF-16 units") {
    Client client;
    client.open("// \xf0\x9f\x98\x80 x\nsphere(1)\n");
    client.notify("textDocument/didChange",
                  {{"textDocument", {{"uri", "file:///scenes/a.sdf"}, {"version", 2}}},
                   {"contentChanges",
                    {{{"range",
                       {{"start", {{"line", 0}, {"character", 6}}},
                        {"end", {{"line", 1}, {"character", 6}}}}},
                      {"text", "\nbox"}}}}});
    CHECK(client.diagnostics() == Json::array());
    const Json hover = client.result("textDocument/hover", Client::at(1, 1));
    CHECK(hover.at("contents").at("value").get<std::string>().find("box(") != std::string::npos);
}

TEST_CASE("a hover says what is proved") {
    Client client;
    client.open("let wave = p => 0.1 * sin(20 * p.x)\nsphere(1).displace(wave)\n");
    const std::string text =
        client.result("textDocument/hover", Client::at(1, 14)).at("contents").at("value");
    CHECK(text.find("displace(") != std::string::npos);
    CHECK(text.find("bound 3") != std::string::npos);
    CHECK(text.find("proved, a lower bound") != std::string::npos);
    Json params = Client::at(0, 0);
    params["range"] = range(1, 0, 30);
    const Json hints = client.result("textDocument/inlayHint", params);
    REQUIRE(hints.size() == 1);
    CHECK(hints[0].at("label").get<std::string>().starts_with("bound 3"));
    CHECK(hints[0].at("position").at("line") == 1);
}

TEST_CASE("open texts are what is imported") {
    Client client;
    client.open("import \"part.sdf\"\nknob(1)\n");
    CHECK(client.diagnostics().size() == 1); // there is no such file
    client.open("fn knob(r) = sphere(r)\n", "file:///scenes/part.sdf");
    CHECK(client.diagnostics() == Json::array());
    client.notify("textDocument/didChange",
                  {{"textDocument", {{"uri", "file:///scenes/part.sdf"}, {"version", 2}}},
                   {"contentChanges", {{{"text", "fn nob(r) = sphere(r)\n"}}}}});
    CHECK(client.diagnostics().size() == 1);
}

TEST_CASE("completion after a dot leaves out the text's own names") {
    Client client;
    client.open("let radius = 1\nsphere(radius).\n");
    const auto labels = [](const Json &items) {
        std::vector<std::string> names;
        for (const Json &item : items) names.push_back(item.at("label"));
        return names;
    };
    const auto has = [](const std::vector<std::string> &names, const std::string &name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    const auto dot = labels(client.result("textDocument/completion", Client::at(1, 15)));
    CHECK(has(dot, "translate"));
    CHECK_FALSE(has(dot, "radius"));
    const auto free = labels(client.result("textDocument/completion", Client::at(1, 0)));
    CHECK(has(free, "radius"));
    CHECK(has(free, "sphere"));
}

TEST_CASE("formatting changes the space between words, and nothing where nothing changes") {
    Client client;
    client.open("let a = 1\nlet b  =  2\nsphere(a + b)\n");
    const Json edits = client.result("textDocument/formatting", Client::at(0, 0));
    REQUIRE(edits.size() == 2); // on both sides of `=`
    for (const Json &edit : edits) {
        CHECK(edit.at("newText") == " ");
        CHECK(edit.at("range").at("start").at("line") == 1);
    }
    client.open("sphere(1)\n");
    CHECK(client.result("textDocument/formatting", Client::at(0, 0)).empty());
    client.open("sphere(");
    CHECK(client.result("textDocument/formatting", Client::at(0, 0)).empty());
}

TEST_CASE("nothing ends the server but exit") {
    Client client;
    client.open("sphere(1)\n");
    for (
        const std::string message :
        {"", "\xff\xfe\x80(\xc3", "[]", "{", "null", "{\"method\": 3}", "{\"id\": 1}",
         "{\"id\": 1, \"method\": \"textDocument/hover\"}",
         "{\"id\": {}, \"method\": \"textDocument/hover\", \"params\": []}",
         "{\"method\": \"textDocument/didChange\", \"params\": {\"textDocument\": 3}}",
         "{\"id\": 1, \"method\": \"textDocument/hover\", \"params\": {\"textDocument\": {\"uri\": "
         "\"file:///scenes/a.sdf\"}, \"position\": {\"line\": -5, \"character\": 1e30}}}",
         "{\"id\": 1, \"method\": \"textDocument/hover\", \"params\": {\"textDocument\": {\"uri\": "
         "\"file:///scenes/a.sdf\"}, \"position\": {\"line\": 2000000000, \"character\": 9}}}"}) {
        INFO(message);
        CHECK_NOTHROW(client.server.handle(message));
    }
    CHECK_FALSE(client.server.ended());
    // Each beginning of a text, and each byte on its own.
    const std::string text = "param k = 1 in 0..2\nfn f(x) = sphere(x) | box(2)\nf(k).twist(0.2)\n";
    for (std::size_t end = 0; end <= text.size(); ++end) {
        client.open(text.substr(0, end));
        client.diagnostics();
        CHECK(client.request("textDocument/hover", Client::at(1, 11)).contains("result"));
        CHECK(client.request("textDocument/completion", Client::at(2, 5)).contains("result"));
    }
    client.result("shutdown", nullptr);
    client.notify("exit", nullptr);
    CHECK(client.server.ended());
    CHECK(client.server.exit_status() == 0);
}

TEST_CASE("messages are cut by their lengths") {
    std::array<int, 2> in{}, out{};
    REQUIRE((pipe(in.data()) == 0 && pipe(out.data()) == 0));
    const std::string bytes =
        "garbage\r\n\r\nContent-Length: 2\r\n\r\n{}"
        "Content-Type: x\r\nContent-Length:3\r\n\r\n[1]Content-Length: 9\r\n\r\n12";
    REQUIRE(write(in[1], bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
    close(in[1]);
    Transport transport(in[0], out[1]);
    CHECK(transport.pending());
    CHECK(transport.read() == "{}");
    CHECK(transport.read() == "[1]");
    CHECK_FALSE(transport.read()); // the last is cut off
    CHECK(transport.write("{}"));
    std::array<char, 64> answer{};
    const ssize_t count = read(out[0], answer.data(), answer.size());
    CHECK(std::string(answer.data(), static_cast<std::size_t>(count)) ==
          "Content-Length: 2\r\n\r\n{}");
    for (int descriptor : {in[0], out[0], out[1]}) close(descriptor);
}
