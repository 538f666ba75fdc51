// The entries of the standard library, each by the example in its doc comment. What an example needs
// of files lies in examples/parts.
#pragma once

#include "driver/compile.h"

#include <set>
#include <string>
#include <vector>

namespace fathom::test {

struct LibraryExample {
    std::string name, text; // "dfmodel.blobby"; a whole program
};

// `/// Example: `…`` above `fn NAME` or `let NAME`.
inline std::vector<LibraryExample> library_examples() {
    std::vector<LibraryExample> out;
    for (const typecheck::LibraryFile &file : driver::standard_library()) {
        std::string example;
        std::set<std::string> seen;
        for (std::size_t at = 0; at < file.text.size();) {
            const std::size_t end = std::min(file.text.find('\n', at), file.text.size());
            const std::string line(file.text.substr(at, end - at));
            at = end + 1;
            const std::string mark = "/// Example: `";
            if (line.starts_with(mark))
                example = line.substr(mark.size(), line.rfind('`') - mark.size());
            for (const std::string head : {"fn ", "let "}) {
                if (!line.starts_with(head) || example.empty()) continue;
                const std::string name =
                    line.substr(head.size(), line.find_first_of("( :=", head.size()) - head.size());
                const bool own = example.find("dfmodel.") != std::string::npos;
                if (seen.insert(name).second)
                    out.push_back({(own ? "dfmodel." : "") + name,
                                   (own ? "import \"dfmodel\" as dfmodel\n" : "") + example});
                example.clear();
            }
        }
    }
    return out;
}

} // namespace fathom::test
