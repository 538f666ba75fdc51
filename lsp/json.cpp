#include "lsp/json.h"

namespace fathom::lsp {

void change(std::string &text, const Json &changes) {
    for (const Json &change : changes) {
        std::string with = change.at("text");
        if (!change.contains("range")) {
            text = std::move(with);
            continue;
        }
        const Json &range = change["range"];
        const std::size_t begin = offset_at(text, position_of(range.at("start"))),
                          end = offset_at(text, position_of(range.at("end")));
        if (begin <= end) text.replace(begin, end - begin, with);
    }
}

} // namespace fathom::lsp
