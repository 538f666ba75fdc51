// The protocol's small objects. Knows nothing of requests.
#pragma once

#include "lsp/document.h"

#include <nlohmann/json.hpp>
#include <string>

namespace fathom::lsp {

using Json = nlohmann::json;

// The codes of errors: JSON-RPC's, and the protocol's own.
constexpr int parse_error = -32700, unknown_method = -32601, internal_error = -32603,
              invalid_params = -32602, request_cancelled = -32800, content_modified = -32801,
              request_failed = -32803;

// A string of ours may hold bytes that are no UTF-8: they become U+FFFD.
inline std::string written(const Json &json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}
inline Json json_of(const Position &at) { return {{"line", at.line}, {"character", at.character}}; }
inline Json json_of(const Range &range) {
    return {{"start", json_of(range.start)}, {"end", json_of(range.end)}};
}
inline Position position_of(const Json &json) {
    return {json.at("line").get<int>(), json.at("character").get<int>()};
}
inline Json markdown(std::string text) {
    return {{"kind", "markdown"}, {"value", std::move(text)}};
}

// Does the changes of a `textDocument/didChange` to a text. Throws where one is malformed.
void change(std::string &text, const Json &changes);

} // namespace fathom::lsp
