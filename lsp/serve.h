// The language server as a program's last act.
#pragma once

namespace fathom::lsp {

// Serves over two file descriptors until the client says `exit` or goes; gives the program's exit
// status.
int serve(int in, int out);

} // namespace fathom::lsp
