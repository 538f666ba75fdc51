// A client of the language server, by its messages alone.
#pragma once

#include "lsp/server.h"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>
#include <string>

using Json = nlohmann::json;
using fathom::lsp::Server;

struct Client {
    Server server;
    int number = 0;

    Json request(const std::string &method, Json params) {
        const auto answers = server.handle(Json{
            {"jsonrpc", "2.0"},
            {"id", ++number},
            {"method", method},
            {"params", std::move(params)}}.dump());
        REQUIRE(answers.size() == 1);
        Json answer = Json::parse(answers[0]);
        REQUIRE(answer.at("id") == number);
        return answer;
    }
    Json result(const std::string &method, Json params) {
        return request(method, std::move(params)).at("result");
    }
    void notify(const std::string &method, Json params) {
        for (const std::string &message :
             server.handle(Json{{"jsonrpc", "2.0"}, {"method", method}, {"params", params}}.dump()))
            CHECK_FALSE(Json::parse(message).contains("error"));
    }
    void open(const std::string &text, const std::string &uri = "file:///scenes/a.sdf") {
        notify("textDocument/didOpen",
               {{"textDocument",
                 {{"uri", uri}, {"languageId", "sdf"}, {"version", 1}, {"text", text}}}});
    }
    Json diagnostics(const std::string &uri = "file:///scenes/a.sdf") {
        for (const std::string &message : server.idle()) {
            const Json said = Json::parse(message);
            if (said.at("params").at("uri") == uri) return said.at("params").at("diagnostics");
        }
        return nullptr;
    }
    static Json at(int line, int character, const std::string &uri = "file:///scenes/a.sdf") {
        return {{"textDocument", {{"uri", uri}}},
                {"position", {{"line", line}, {"character", character}}}};
    }
};

inline Json range(int line, int from, int to) {
    return {{"start", {{"line", line}, {"character", from}}},
            {"end", {{"line", line}, {"character", to}}}};
}
