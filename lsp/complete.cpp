// Completion and signature help.
#include "lsp/requests.h"

namespace fathom::lsp {
namespace {

using Item = v1::CompletionItem;

// In the protocol's numbers.
int kind_of(Item::Kind kind) {
    switch (kind) {
    case Item::Kind::Method: return 2;
    case Item::Kind::Function: return 3;
    case Item::Kind::Field: return 5;
    case Item::Kind::Variable: return 6;
    case Item::Kind::Module: return 9;
    case Item::Kind::Unit: return 11;
    case Item::Kind::Keyword: return 14;
    case Item::Kind::Color: return 16;
    case Item::Kind::File: return 17;
    case Item::Kind::Folder: return 19;
    case Item::Kind::Constant: return 21;
    case Item::Kind::Type: return 25;
    }
    return 1;
}

} // namespace

Json completion(Session &session, const Json &params) {
    constexpr int snippet = 2;
    OpenText &text = text_of(session, params);
    Json all = Json::array();
    for (const Item &item : taken(session.workspace.completion(
             text.path, offset_of(session, text, params.at("position")), session.snippets))) {
        Json one{{"label", item.label}, {"kind", kind_of(item.kind)}};
        if (!item.detail.empty()) one["detail"] = item.detail;
        if (!item.documentation.empty())
            one["documentation"] = item.kind == Item::Kind::Color ? Json(item.documentation)
                                                                  : markdown(item.documentation);
        if (!item.insert.empty()) one["insertText"] = item.insert;
        if (item.snippet) one["insertTextFormat"] = snippet;
        if (!item.sort.empty()) one["sortText"] = item.sort;
        all.push_back(std::move(one));
    }
    return all;
}

Json signature_help(Session &session, const Json &params) {
    OpenText &text = text_of(session, params);
    const v1::SignatureHelp help = taken(session.workspace.signature_help(
        text.path, offset_of(session, text, params.at("position"))));
    if (help.forms.empty()) return nullptr;
    Json all = Json::array();
    for (const v1::SignatureHelp::Form &form : help.forms) {
        Json parameters = Json::array();
        for (const std::string &parameter : form.parameters)
            parameters.push_back({{"label", parameter}});
        all.push_back({{"label", form.signature},
                       {"documentation", markdown(form.documentation)},
                       {"parameters", std::move(parameters)},
                       {"activeParameter", form.active}});
    }
    return {{"signatures", std::move(all)},
            {"activeSignature", help.active},
            {"activeParameter", help.forms[help.active].active}};
}

} // namespace fathom::lsp
