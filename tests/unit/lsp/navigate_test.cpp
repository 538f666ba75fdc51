// References, renames, symbols and structure by messages, in one file and in several.
#include "client.h"
#include "scenes.h"

#include "api/language/refactor.h"

namespace {

using namespace fathom::lsp;
using fathom::language::edited, fathom::language::TextEdit;

const std::string main_uri = "file:///scenes/a.sdf", part_uri = "file:///scenes/part.sdf";

// A text with a document's edits done.
std::string with_edits(const std::string &text, const Json &edits) {
    std::vector<TextEdit> all;
    for (const Json &edit : edits)
        all.push_back({{offset_at(text, position_of(edit.at("range").at("start"))),
                        offset_at(text, position_of(edit.at("range").at("end")))},
                       edit.at("newText")});
    return edited(text, all);
}

std::size_t references(Client &client, int line, int character, const std::string &uri = main_uri) {
    return client.result("textDocument/references", Client::at(line, character, uri)).size();
}

Json rename(Client &client, int line, int character, const std::string &name,
            const std::string &uri = main_uri) {
    Json params = Client::at(line, character, uri);
    params["newName"] = name;
    return client.request("textDocument/rename", params);
}

} // namespace

TEST_CASE("references know blocks, parameters and arguments") {
    Client client;
    client.open("let r = 1\n"
                "fn knob(r: float, h = r) = sphere(r).translate(y: h)\n"
                "knob(r, h: 2)\n"
                "knob(r: 3)\n"
                "for r in 0..2 { knob(r) }\n");
    CHECK(references(client, 0, 4) == 2); // itself, and the first call
    CHECK(references(client, 1, 8) == 4); // the parameter, its default, the body, `r:`
    CHECK(references(client, 1, 18) == 3);
    CHECK(references(client, 1, 3) == 4);
    CHECK(references(client, 4, 4) == 2);
    CHECK(references(client, 1, 30) == 0); // the library's
    CHECK(client.result("textDocument/documentHighlight", Client::at(0, 4)).size() == 2);
}

TEST_CASE("a rename goes through all files, and through none where it would change a meaning") {
    Client client;
    const std::string part = "let size = 0.3\nfn knob(radius) = sphere(radius * size)\n",
                      text =
                          "import \"part.sdf\"\nimport \"part.sdf\" as part\n"
                          "let ball = knob(radius: 1)\nball | part.knob(2)\ntorus(1, part.size)\n";
    client.open(part, part_uri);
    client.open(text);
    CHECK(references(client, 1, 4, part_uri) == 3);

    fathom::language::Workspace plain;
    const auto before = values_of(plain, "/scenes/a.sdf", text, {{"/scenes/part.sdf", part}});
    REQUIRE(before);
    for (const auto &[line, character, uri] : {std::tuple{1, 4, part_uri},
                                               {1, 10, part_uri},
                                               {0, 5, part_uri},
                                               {2, 12, main_uri},
                                               {2, 18, main_uri},
                                               {3, 1, main_uri},
                                               {4, 16, main_uri},
                                               {1, 23, main_uri}}) {
        INFO(uri << ":" << line << ":" << character);
        const Json answer = rename(client, line, character, "grip", uri);
        REQUIRE(answer.contains("result"));
        const Json changes = answer["result"].at("changes");
        const std::string new_part = with_edits(part, changes.value(part_uri, Json::array())),
                          new_text = with_edits(text, changes.value(main_uri, Json::array()));
        CHECK(new_part + new_text != part + text);
        INFO(new_part << new_text);
        CHECK(values_of(plain, "/scenes/a.sdf", new_text, {{"/scenes/part.sdf", new_part}}) ==
              before);
    }
    for (const char *refused : {"torus", "ball", "let", "2a", "a b", "", "size", "sphere"}) {
        INFO(refused);
        const Json answer = rename(client, 1, 4, refused, part_uri);
        REQUIRE(answer.contains("error"));
        CHECK_FALSE(answer["error"].at("message").get<std::string>().empty());
    }
    CHECK(rename(client, 4, 1, "ring").contains("error")); // the library's
    CHECK(client.result("textDocument/prepareRename", Client::at(4, 1)).is_null());
    CHECK(client.result("textDocument/prepareRename", Client::at(2, 5)).at("placeholder") ==
          "ball");
}

TEST_CASE("a rename that an inner block would capture is refused") {
    Client client;
    client.open("let a = 1\nfn f(b) = a + b\nsphere(f(1))\n");
    CHECK(rename(client, 0, 4, "b").contains("error"));
    CHECK(rename(client, 1, 5, "a").contains("error"));
    CHECK(rename(client, 1, 5, "c").contains("result"));
}

TEST_CASE("definitions lead to other files and into the library") {
    Client client;
    client.open("fn knob(r) = sphere(r)\n", part_uri);
    client.open("import \"part.sdf\"\nknob(1)\nbox(2)\n");
    const Json knob = client.result("textDocument/definition", Client::at(1, 1));
    CHECK(knob.at("uri") == part_uri);
    CHECK(knob.at("range") == range(0, 3, 7));
    CHECK(client.result("textDocument/definition", Client::at(0, 10)).at("uri") == part_uri);

    const std::filesystem::path cache =
        std::filesystem::temp_directory_path() / "fathom-lsp-test-cache";
    std::filesystem::remove_all(cache);
    setenv("XDG_CACHE_HOME", cache.c_str(), 1);
    const Json box = client.result("textDocument/definition", Client::at(2, 1));
    REQUIRE_FALSE(box.is_null());
    std::ifstream in(path_of(box.at("uri").get<std::string>()));
    std::string line;
    for (int i = 0; i <= box.at("range").at("start").at("line").get<int>(); ++i)
        std::getline(in, line);
    CHECK(line.starts_with("fn box("));
    std::filesystem::remove_all(cache);
}

TEST_CASE("files and folders get other names, and texts name them by these") {
    namespace fs = std::filesystem;
    const fs::path home = fs::temp_directory_path() / "fathom-lsp-test-names";
    fs::remove_all(home);
    fs::create_directories(home / "parts/stone");
    const auto write = [&](const char *name, const std::string &text) {
        std::ofstream(home / name) << text;
    };
    const auto uri = [&](const char *name) { return uri_of((home / name).string()); };
    const std::string scene = "import \"parts/knob.sdf\"\nimport \"parts/gone.sdf\" as gone\n"
                              "let skin = image(\"parts/stone/skin.png\")\n"
                              "print(\"parts/knob.sdf\")\nknob()\n",
                      knob = "import \"../top.sdf\" as top\nfn knob() = sphere(top.r)\n"
                             "fn rock() = distance_grid(\"stone/rock.nrrd\")\n";
    write("scene.sdf", scene), write("top.sdf", "let r = 1\n"), write("parts/knob.sdf", knob);
    write("parts/stone/skin.png", ""), write("parts/stone/rock.nrrd", "");
    Client client;
    const Json capabilities =
        client.result("initialize", {{"rootUri", uri_of(home.string())}}).at("capabilities");
    CHECK(capabilities.at("workspace").at("fileOperations").contains("willRename"));
    const auto after = [&](const char *from, const char *to, const char *file,
                           const std::string &text) {
        const Json changes =
            client
                .result("workspace/willRenameFiles",
                        {{"files", Json::array({{{"oldUri", uri(from)}, {"newUri", uri(to)}}})}})
                .at("changes");
        return changes.contains(uri(file)) ? with_edits(text, changes.at(uri(file))) : text;
    };
    const auto replaced = [](std::string text, const std::string &a, const std::string &b) {
        return text.replace(text.find(a), a.size(), b);
    };
    // a file: what imports it; a string that is no path stays
    CHECK(after("parts/knob.sdf", "parts/handle.sdf", "scene.sdf", scene) ==
          replaced(scene, "parts/knob.sdf", "parts/handle.sdf"));
    // to another folder: what it names itself
    CHECK(after("parts/knob.sdf", "knob.sdf", "parts/knob.sdf", knob) ==
          replaced(replaced(knob, "../top.sdf", "top.sdf"), "stone/rock", "parts/stone/rock"));
    // a folder: all that is in it; what moves with it stays as it is
    CHECK(after("parts", "lib/bits", "scene.sdf", scene) ==
          replaced(replaced(scene, "parts/knob.sdf", "lib/bits/knob.sdf"), "parts/stone",
                   "lib/bits/stone"));
    CHECK(after("parts", "lib/bits", "parts/knob.sdf", knob) ==
          replaced(knob, "../top.sdf", "../../top.sdf"));
    CHECK(after("top.sdf", "a\"b.sdf", "parts/knob.sdf", knob) == knob); // no string can say it
    // and their names are links, the grid's too
    client.open(knob, uri("parts/knob.sdf"));
    CHECK(client.result("textDocument/documentLink", Client::at(0, 0, uri("parts/knob.sdf")))
              .size() == 2);
    fs::remove_all(home);
}

TEST_CASE("symbols are nested, and found by their letters") {
    Client client;
    client.open("fn tower(n) {\n  let part = box(n)\n  part\n}\nlet base = 3\ntower(base)\n");
    const Json symbols = client.result("textDocument/documentSymbol", Client::at(0, 0));
    REQUIRE(symbols.size() == 2);
    CHECK(symbols[0].at("name") == "tower");
    CHECK(symbols[0].at("children")[0].at("name") == "part");
    const Json found = client.result("workspace/symbol", {{"query", "twr"}});
    REQUIRE(found.size() == 1);
    CHECK(found[0].at("name") == "tower");
    CHECK(client.result("workspace/symbol", {{"query", "zzz"}}).empty());
}

TEST_CASE("tokens say what words mean") {
    Client client;
    const Json legend = client.result("initialize", Json::object())
                            .at("capabilities")
                            .at("semanticTokensProvider")
                            .at("legend");
    const std::string text = "// \xf0\x9f\x98\x80\nfn f(x: float) = x * 45deg\n/* a\nb */\n"
                             "sphere(f(1)).translate(y: tau.x)\n";
    client.open(text);
    const Json data =
        client.result("textDocument/semanticTokens/full", Client::at(0, 0)).at("data");
    REQUIRE(data.size() % 5 == 0);
    std::map<std::string, std::string> types;
    Position at;
    for (std::size_t i = 0; i < data.size(); i += 5) {
        const int lines = data[i], characters = data[i + 1], length = data[i + 2];
        at = {at.line + lines, lines ? characters : at.character + characters};
        const std::size_t begin = offset_at(text, at),
                          end = offset_at(text, {at.line, at.character + length});
        types[text.substr(begin, end - begin)] =
            legend.at("tokenTypes")[data[i + 3].get<std::size_t>()];
    }
    CHECK(types["// \xf0\x9f\x98\x80"] == "comment");
    CHECK(types["/* a"] == "comment");
    CHECK(types["b */"] == "comment");
    CHECK(types["fn"] == "keyword");
    CHECK(types["f"] == "function");
    CHECK(types["x"] == "property"); // of `tau.x`, the last one
    CHECK(types["float"] == "type");
    CHECK(types["45deg"] == "number");
    CHECK(types["translate"] == "method");
    CHECK(types["y"] == "property");
    CHECK(types["tau"] == "variable");
    CHECK(types["*"] == "operator");
}

TEST_CASE("ranges fold and selections grow") {
    Client client;
    client.open("// a\n// b\nunion {\n  sphere(1 + 2)\n}\n");
    const Json folds = client.result("textDocument/foldingRange", Client::at(0, 0));
    REQUIRE(folds.size() == 2);
    CHECK(folds[0] == Json{{"startLine", 2}, {"endLine", 3}});
    CHECK(folds[1].at("kind") == "comment");

    Json params = Client::at(0, 0);
    params["positions"] = {{{"line", 3}, {"character", 9}}};
    const Json ranges = client.result("textDocument/selectionRange", params);
    std::vector<int> widths;
    for (const Json *at = &ranges[0];; at = &at->at("parent")) {
        const Json &span = at->at("range");
        if (span.at("start").at("line") == span.at("end").at("line"))
            widths.push_back(span.at("end").at("character").get<int>() -
                             span.at("start").at("character").get<int>());
        if (!at->contains("parent")) break;
    }
    CHECK(widths == std::vector<int>{1, 5, 13}); // `1`, `1 + 2`, `sphere(1 + 2)`
}

TEST_CASE("colours are shown and picked") {
    Client client;
    const std::string text = "let red = 2\nbox(red).paint(#ff8000)\nbox(1).paint(blue)\n";
    client.open(text);
    const Json colors = client.result("textDocument/documentColor", Client::at(0, 0));
    REQUIRE(colors.size() == 2); // `red` is the text's own
    CHECK(colors[0].at("color").at("green").get<double>() == Approx(128 / 255.0));
    CHECK(colors[1].at("color").at("blue") == 1);
    Json params = Client::at(0, 0);
    params["range"] = colors[1].at("range");
    params["color"] = colors[1].at("color");
    Json offered = client.result("textDocument/colorPresentation", params);
    REQUIRE(offered.size() == 2);
    CHECK(offered[0].at("label") == "#0000ff");
    CHECK(offered[1].at("label") == "blue");
    params["color"]["alpha"] = 0.5;
    offered = client.result("textDocument/colorPresentation", params);
    CHECK(offered[0].at("label") == "#0000ff80");
    CHECK(fathom::v1::compile_text("a.sdf",
                                   with_edits(text, Json::array({offered[0].at("textEdit")}))));
}

TEST_CASE("a range is formatted, and nothing beside it") {
    Client client;
    const std::string text = "let a  =  1\nlet b  =  2\nlet c  =  3\nsphere(a+b+c)\n";
    client.open(text);
    Json params = Client::at(0, 0);
    params["range"] = range(1, 0, 5);
    const Json edits = client.result("textDocument/rangeFormatting", params);
    CHECK(with_edits(text, edits) == "let a  =  1\nlet b = 2\nlet c  =  3\nsphere(a+b+c)\n");
    for (const SceneText &scene : scene_texts()) { // all gaps together are the whole
        const auto whole = fathom::v1::format_text(scene.text);
        if (!whole) continue;
        client.open(scene.text);
        INFO(scene.path);
        CHECK(with_edits(scene.text, client.result("textDocument/formatting", Client::at(0, 0))) ==
              *whole);
    }
    const std::string block = "fn f(x) {\n  let y  =  x\n  y+1\n}\nsphere(f( 1))\n";
    client.open(block);
    Json typed = Client::at(3, 1);
    typed["ch"] = "}";
    CHECK(with_edits(block, client.result("textDocument/onTypeFormatting", typed)) ==
          "fn f(x) {\n  let y = x\n  y + 1\n}\nsphere(f( 1))\n");
}

TEST_CASE("actions are offered where they compile, and their edits keep the field") {
    Client client;
    const std::string text = "let side = 1 + 1\n"
                             "rounded_box([side, 2, 2], 0.1).rotate(30deg, Y)\n"
                             "torus(1, 0.1).translate([1, 2, 3])\n";
    client.open(text);
    fathom::language::Workspace plain;
    const auto before = values_of(plain, "/scenes/a.sdf", text);
    REQUIRE(before);
    const auto offered = [&](int line, int from, int to, int trigger = 1) {
        Json params = Client::at(0, 0);
        params["range"] = range(line, from, to);
        params["context"] = {{"diagnostics", Json::array()}, {"triggerKind", trigger}};
        std::map<std::string, std::string> texts;
        for (const Json &action : client.result("textDocument/codeAction", params))
            texts[action.at("title")] =
                with_edits(text, action.at("edit").at("changes").at(main_uri));
        return texts;
    };
    const auto keeps = [&](std::map<std::string, std::string> texts, const std::string &title,
                           const std::string &part) {
        INFO(title << ":\n" << texts[title]);
        REQUIRE(texts.contains(title));
        CHECK(texts[title].find(part) != std::string::npos);
        const auto after = values_of(plain, "/scenes/a.sdf", texts[title]);
        REQUIRE(after);
        for (std::size_t i = 0; i < before->distances.size(); ++i)
            CHECK(after->distances[i] == Approx(before->distances[i]).margin(1e-5));
    };
    keeps(offered(0, 4, 4), "Inline `side`", "rounded_box([(1 + 1), 2, 2]");
    keeps(offered(0, 11, 16), "Extract into a `let`", "let value = 1 + 1\nlet side = value\n");
    keeps(offered(0, 11, 16), "Extract into a function", "fn part() = 1 + 1\n\nlet side = part()");
    keeps(offered(1, 26, 26), "Name this argument", "radius: 0.1");
    keeps(offered(1, 14, 14), "Name these arguments", "size: [side, 2, 2], radius: 0.1");
    const auto units = offered(1, 38, 38);
    const auto turn = std::ranges::find_if(
        units, [](const auto &one) { return one.first.find("turn") != std::string::npos; });
    REQUIRE(turn != units.end());
    keeps(units, turn->first, "rotate(0.0833333");
    keeps(offered(2, 6, 7), "Make a `param` of it", "torus(amount, 0.1)");
    CHECK(offered(0, 11, 15).empty());    // no whole expression
    CHECK(offered(1, 38, 38, 2).empty()); // a cursor that passes by
    CHECK(offered(2, 0, 5).empty());      // what is called
    client.open("torus(1, 0.1\n");        // nothing of a text with errors but their fixes
    const auto fixes = offered(0, 6, 7);
    REQUIRE(fixes.size() == 1);
    CHECK(fixes.begin()->first == "write `)`");
}

TEST_CASE("completion fits what stands before it, and half-typed calls have their signature") {
    Client client;
    const std::string head = "let ball = sphere(1)\nlet n = 2\n";
    const auto labels = [&](const std::string &line, int character = -1) {
        client.open(head + "torus(1, 0.1)\n");
        client.diagnostics(); // what it knows of the names is what it goes on with
        client.notify("textDocument/didChange",
                      {{"textDocument", {{"uri", main_uri}, {"version", 2}}},
                       {"contentChanges", {{{"text", head + line}}}}});
        std::vector<std::string> names;
        const int end = character < 0 ? static_cast<int>(line.size()) : character;
        for (const Json &item : client.result("textDocument/completion", Client::at(2, end)))
            names.push_back(item.at("label"));
        return names;
    };
    const auto has = [](const std::vector<std::string> &names, const std::string &name) {
        return std::ranges::find(names, name) != names.end();
    };
    CHECK(has(labels("ball."), "translate"));
    CHECK_FALSE(has(labels("ball."), "sin"));
    CHECK(has(labels("ball.translate(y: 1)."), "rotate"));
    CHECK_FALSE(has(labels("ball.translate(y: 1)."), "floor"));
    CHECK(has(labels("n."), "sin"));
    CHECK_FALSE(has(labels("n."), "translate"));
    CHECK(has(labels("torus("), "major:"));
    CHECK(has(labels("sphere(1).rotate(45"), "45deg"));
    CHECK(has(labels("let c = tom"), "tomato"));
    CHECK(has(labels("fn f(x: "), "float"));
    CHECK(labels("// ball.").empty());
    CHECK(has(labels("fn f(apple) = app"), "apple"));

    client.open(head + "rounded_box([1, 2, 3], ");
    const Json help = client.result("textDocument/signatureHelp", Client::at(2, 23));
    REQUIRE_FALSE(help.is_null());
    CHECK(help.at("signatures")[0].at("label").get<std::string>().starts_with("rounded_box("));
    CHECK(help.at("activeParameter") == 1);
    client.open(head + "ball.translate(y: ");
    CHECK(client.result("textDocument/signatureHelp", Client::at(2, 18)).at("activeParameter") ==
          3);
    CHECK(client.result("textDocument/signatureHelp", Client::at(1, 4)).is_null());
}

TEST_CASE("lenses explain bounds") {
    Client client;
    client.open("box([1, 3, 1]).twist(0.4, axis: Y)\n");
    const Json lenses = client.result("textDocument/codeLens", Client::at(0, 0));
    REQUIRE(lenses.size() == 2);
    CHECK(lenses[0].at("command").at("command") == "fathom.show"); // by who serves: no answer here
    const Json command = lenses[1].at("command");
    const auto messages = client.server.handle(Json{
        {"id", 77},
        {"method", "workspace/executeCommand"},
        {"params", {{"command", command.at("command")}, {"arguments", command.at("arguments")}}}}
                                                   .dump());
    REQUIRE(messages.size() == 2); // what is shown, and the answer
    const std::string said = Json::parse(messages[1]).at("result");
    CHECK(said.find("twist") != std::string::npos);
    CHECK(Json::parse(messages[0]).at("params").at("message") == said);
}
