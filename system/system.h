// What POSIX does not have, a function each, with a fallback where the system is not Linux (or with
// FATHOM_PORTABLE, for the test of those). Knows nothing of what it is for. Watches of folders and GL
// without a window have files of their own (driver/folder_events.cpp, render-gl/context.cpp).
#pragma once

#include <array>
#include <string>

namespace fathom::system {

// The file of the program that runs, to be run again: also once it was replaced or removed. Elsewhere
// "fathom", which is looked for as a shell does.
std::string own_program();

// Descriptors that programs which are started do not get. -1, or false, where there are none: `errno`
// says why.
bool open_pipe(std::array<int, 2> &ends); // to read from, to write to
int open_socket();                        // of the local kind, a stream
bool open_socket_pair(std::array<int, 2> &ends);
int accept_connection(int listening);
int open_memory(); // a file without a name, that is read and written

// Whether the other end of a local socket is of the same user. Where the system does not say it: true,
// so that the socket has to lie where no other user can come.
bool is_of_this_user(int socket);

// In a new process: it ends when the one that made it does, however that ends; at once, where that is
// so already. `parent` is what `getpid` said there. Elsewhere it may go on for a while.
void end_with(int parent);

// From here on what is freed of 8 MiB or more goes back to the system at once, for other programs and
// as whole room for what is made next. Where the C library cannot be told so, nothing.
void give_back_large_blocks();

} // namespace fathom::system
