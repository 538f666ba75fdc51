// fathom lsp: the language server, over standard input and output.
#include "lsp/serve.h"

#include "cli/terminal.h"

#include <unistd.h>

namespace fathom::cli {

Exit run(const LspCommand &, Terminal &) {
    return lsp::serve(STDIN_FILENO, STDOUT_FILENO) == 0 ? done : scene_error;
}

} // namespace fathom::cli
