#include "cli/interrupt.h"

#include "cli/command.h"

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <unistd.h>

namespace fathom::cli {
namespace {

volatile std::sig_atomic_t seen = 0;

void notice(int signal) {
    seen = 1;
    std::signal(signal, SIG_DFL);
}

// What a signal handler may read: it is replaced whole, while SIGTERM waits.
char *file_to_remove = nullptr;

void end(int) {
    constexpr std::string_view words = "fathom: ended by SIGTERM; what was finished is kept\n";
    if (file_to_remove) ::unlink(file_to_remove);
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, words.data(), words.size());
    ::_exit(ended);
}

} // namespace

void end_by_term() {
    // Where it was ignored from the start, it stays so.
    if (std::signal(SIGTERM, end) == SIG_IGN) std::signal(SIGTERM, SIG_IGN);
}

void remove_on_end(const std::string &file) {
    sigset_t term, before;
    sigemptyset(&term);
    sigaddset(&term, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &term, &before);
    std::free(file_to_remove);
    file_to_remove = file.empty() ? nullptr : ::strdup(file.c_str());
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

// Where interrupts were ignored from the start, as behind `nohup`, they stay so.
Interrupts::Interrupts() {
    seen = 0;
    if (std::signal(SIGINT, notice) == SIG_IGN) std::signal(SIGINT, SIG_IGN);
}

Interrupts::~Interrupts() {
    if (std::signal(SIGINT, SIG_DFL) == SIG_IGN) std::signal(SIGINT, SIG_IGN);
}

bool Interrupts::noticed() { return seen != 0; }

void Interrupts::obey() {
    std::signal(SIGINT, SIG_DFL);
    if (file_to_remove) ::unlink(file_to_remove);
    std::raise(SIGINT);
    std::_Exit(130);
}

} // namespace fathom::cli
