#include "system/system.h"

#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>
#if defined(__GLIBC__) && !defined(FATHOM_PORTABLE)
#include <malloc.h>
#endif

#if defined(__linux__) && !defined(FATHOM_PORTABLE)
#include <csignal>
#include <sys/mman.h>
#include <sys/prctl.h>

namespace fathom::system {

std::string own_program() { return "/proc/self/exe"; }

bool open_pipe(std::array<int, 2> &ends) { return ::pipe2(ends.data(), O_CLOEXEC) == 0; }

int open_socket() { return ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0); }

bool open_socket_pair(std::array<int, 2> &ends) {
    return ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) == 0;
}

int accept_connection(int listening) {
    return ::accept4(listening, nullptr, nullptr, SOCK_CLOEXEC);
}

int open_memory() { return ::memfd_create("fathom", MFD_CLOEXEC); }

bool is_of_this_user(int socket) {
    ucred who{};
    socklen_t size = sizeof who;
    return ::getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &who, &size) == 0 && who.uid == ::getuid();
}

void end_with(int parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1); // it was gone before that
}

} // namespace fathom::system

#else

namespace fathom::system {
namespace {

// A program that another thread starts just now gets it all the same.
int kept_here(int descriptor) {
    if (descriptor >= 0) ::fcntl(descriptor, F_SETFD, FD_CLOEXEC);
    return descriptor;
}

bool kept_here(std::array<int, 2> &ends, bool open) {
    for (const int end : ends)
        if (open) kept_here(end);
    return open;
}

} // namespace

std::string own_program() { return "fathom"; }

bool open_pipe(std::array<int, 2> &ends) { return kept_here(ends, ::pipe(ends.data()) == 0); }

int open_socket() { return kept_here(::socket(AF_UNIX, SOCK_STREAM, 0)); }

bool open_socket_pair(std::array<int, 2> &ends) {
    return kept_here(ends, ::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) == 0);
}

int accept_connection(int listening) { return kept_here(::accept(listening, nullptr, nullptr)); }

int open_memory() {
    char name[] = "/tmp/fathom-XXXXXX";
    const int file = kept_here(::mkstemp(name));
    if (file >= 0) ::unlink(name);
    return file;
}

bool is_of_this_user(int) { return true; }

void end_with(int parent) {
    if (::getppid() != parent) ::_exit(1);
}

} // namespace fathom::system

#endif

namespace fathom::system {

void give_back_large_blocks() {
#if defined(__GLIBC__) && !defined(FATHOM_PORTABLE)
    ::mallopt(M_MMAP_THRESHOLD, 8 << 20);
#endif
}

} // namespace fathom::system
