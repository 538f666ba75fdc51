// The server by its messages, as a client sends them.
#include "client.h"

#include "lsp/transport.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
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

TEST_CASE("a hover says where a bound is proved, and what an error was seen at") {
    Client client;
    client.open("let a = box([1, 3, 1]).twist(0.4, axis: Y)\n"
                "for i in 0..3 { a.translate(x: 3 * i) }\n"
                "implicit(p => p.x * p.y - 1, within: ball(3))\n"
                "implicit(p => sqrt(p.x), within: everywhere)\n");
    const auto hover = [&](int line, int character) {
        const Json answer = client.result("textDocument/hover", Client::at(line, character));
        return answer.is_null() ? "" : answer.at("contents").at("value").get<std::string>();
    };
    // also beside an error, which has its point
    CHECK(hover(0, 25).find("`twist` here: bound 1.1") != std::string::npos);
    CHECK(hover(0, 25).find("proved at all points; a ray takes up to 1.1") != std::string::npos);
    CHECK(hover(1, 18).find("The steepest of 3 shapes: bound 1.1") != std::string::npos);
    CHECK(hover(2, 3).find("proved in ball(3)") != std::string::npos);
    CHECK(hover(3, 15).find("near [") != std::string::npos);
    const Json lenses = client.result("textDocument/codeLens", Client::at(0, 0));
    CHECK(lenses.size() == 3); // the window, and one a statement, not one a copy
    const Json diagnostics = client.diagnostics();
    REQUIRE(diagnostics.size() == 1);
    const std::string page = diagnostics[0].at("codeDescription").at("href");
    CHECK(page.ends_with("/diagnostics/field-singular.md"));
    CHECK(std::filesystem::is_regular_file(path_of(page)));
}

TEST_CASE("files that a text names are links") {
    Client client;
    const std::string part = std::string(FATHOM_SOURCE_DIR) + "/examples/parts",
                      uri = uri_of(std::string(FATHOM_SOURCE_DIR) + "/examples/new.sdf");
    std::string name;
    for (const auto &entry : std::filesystem::directory_iterator(part))
        if (entry.path().extension() == ".sdf") name = entry.path().filename().string();
    REQUIRE_FALSE(name.empty());
    client.open("import \"parts/" + name + "\"\nimport \"none.sdf\" as none\n", uri);
    const Json links = client.result("textDocument/documentLink", Client::at(0, 0, uri));
    REQUIRE(links.size() == 1);
    CHECK(links[0].at("target") == uri_of(part + "/" + name));
    CHECK(links[0].at("range") == range(0, 8, 14 + static_cast<int>(name.size())));
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

TEST_CASE("completion offers the parts that a vector has, and functions that take it") {
    Client client;
    client.open("fn knob(r: float) = sphere(r)\nlet v = vec2(1, 2)\nlet q = v.\nlet r = [1, 2].\n"
                "let t = [1, 2, 3].\nlet u = 1.5.\nimplicit(p => p.\n");
    const std::string flat = "file:///scenes/flat.sdf";
    client.open("implicit2(q => q.\n", flat);
    const auto parts = [&](int line, int character,
                           const std::string &uri = "file:///scenes/a.sdf") {
        std::string letters;
        for (const Json &item :
             client.result("textDocument/completion", Client::at(line, character, uri))) {
            const std::string label = item.at("label");
            if (label.size() == 1 && std::string("xyzw").find(label) != std::string::npos)
                letters += label;
            if (label == "knob") letters += "!";
        }
        return letters;
    };
    CHECK(parts(2, 10) == "xy");
    CHECK(parts(3, 15) == "xy");
    CHECK(parts(4, 18) == "xyz");
    CHECK(parts(6, 16) == "xyz");
    CHECK(parts(0, 17, flat) == "xy");
}

// A field whose proof takes seconds.
constexpr const char *dear =
    "let size = 2.0\nimplicit(p => { var d = 0.0\nfor i in -2..=2 { for j in -2..=2 { for k in "
    "-2..=2 { let c = floor(p) + vec3(i,j,k)\n d += exp(-9 * length(p - c - vec3(hash(c), hash(c + "
    "7), hash(c + 13)))) } } }\n -log(d) / 9 - 0.2 }, within: ball(size))\n";

TEST_CASE("completion and hover do not wait for a long proof") {
    Client client;
    client.open(dear);
    const auto began = std::chrono::steady_clock::now();
    const Json items = client.result("textDocument/completion", Client::at(5, 0));
    const auto size =
        std::ranges::find_if(items, [](const Json &item) { return item.at("label") == "size"; });
    REQUIRE(size != items.end());
    CHECK(size->at("detail") == "float");
    const std::string said =
        client.result("textDocument/hover", Client::at(0, 5)).at("contents").at("value");
    CHECK(said.find("size: float") != std::string::npos);
    CHECK(said.find("not proved yet") != std::string::npos);
    // The proof takes 9 s of the processor, of which none is in the completion.
    CHECK(std::chrono::steady_clock::now() - began < std::chrono::seconds(8));
}

TEST_CASE("a request that lacks a parameter is told so in words") {
    Client client;
    client.open("sphere(1)\n");
    const Json error = client.request("textDocument/hover", Json::object()).at("error");
    CHECK(error.at("code") == -32602);
    CHECK(error.at("message") == "the parameters of textDocument/hover have no `textDocument`");
}

TEST_CASE("completion after a dot knows parameters and names of blocks by their types") {
    Client client;
    const auto offered = [&](const std::string &text, const std::string &name) {
        const std::size_t dot = text.find(".@");
        std::string typed = text;
        typed.erase(dot + 1, 1);
        client.open(typed);
        const Lines lines = lines_of(typed);
        const Position at = position_at(lines, dot + 1);
        for (const Json &item :
             client.result("textDocument/completion", Client::at(at.line, at.character)))
            if (item.at("label") == name) return true;
        return false;
    };
    for (const std::string text :
         {"fn f(s: shape) { s.@ }\n", "fn f(x) {\n  let s = box(x)\n  s.@\n}\n",
          "let s = 1\nfn f(s: shape) { s.@ }\n", "let s = box(1)\ns.@\n"}) {
        INFO(text);
        CHECK(offered(text, "twist"));
        CHECK_FALSE(offered(text, "x"));
        CHECK_FALSE(offered(text, "sqrt"));
    }
    for (const std::string text :
         {"fn f(v: vec3) { v.@ }\n", "fn f(s) {\n  let v = [1, 2, 3]\n  v.@\n}\n",
          "let s = box(1)\nfn f(s: vec2) { s.@ }\n"}) {
        INFO(text);
        CHECK(offered(text, "x"));
        CHECK_FALSE(offered(text, "twist"));
    }
    CHECK(offered("fn f(s: float) { s.@ }\n", "sqrt"));
    CHECK_FALSE(offered("fn f(s: float) { s.@ }\n", "x"));
    CHECK_FALSE(offered("fn f(s: float) { s.@ }\n", "twist"));
    // names that stand for each other end
    CHECK_FALSE(offered("fn f() {\n  let union = union { 1 }\n  union.@\n}\n", "none such"));
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

TEST_CASE("hover on an error says the point and the witness") {
    Client client;
    const auto said = [&](const std::string &text, int column = 3) {
        client.open(text);
        const Json hover = client.result("textDocument/hover", Client::at(0, column));
        return hover.at("contents").at("value").get<std::string>();
    };
    const std::string jump = said("implicit(p => p.z + step(0.3, p.x), within: ball(2))\n", 21);
    CHECK(jump.find("jumps near [0.3") != std::string::npos);
    CHECK(jump.find("it is ") != std::string::npos); // two values at two points
    CHECK(jump.find(" at [0.3") != std::string::npos);
    const std::string steep = said("implicit(p => 2 * p.x, within: everywhere, lipschitz: 1)\n");
    CHECK(steep.find("it is ") != std::string::npos);
    CHECK(steep.find("a slope of 2") != std::string::npos);
}
