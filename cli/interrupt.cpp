#include "cli/interrupt.h"

#include <csignal>
#include <cstdlib>

namespace fathom::cli {
namespace {

volatile std::sig_atomic_t seen = 0;

void notice(int signal) {
    seen = 1;
    std::signal(signal, SIG_DFL);
}

} // namespace

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
    std::raise(SIGINT);
    std::_Exit(130);
}

} // namespace fathom::cli
