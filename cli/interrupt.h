// Ctrl-C while something long is drawn: it is noticed and not obeyed at once, so that the terminal
// can be put in order first; a second Ctrl-C ends the program where it stands.
#pragma once

#include <string>

namespace fathom::cli {

// While it lives, the first Ctrl-C sets a flag instead of ending the program.
class Interrupts {
  public:
    Interrupts(); // from now on they are noticed
    ~Interrupts();
    Interrupts(const Interrupts &) = delete;
    Interrupts &operator=(const Interrupts &) = delete;
    static bool noticed();
    [[noreturn]] static void obey(); // ends as an interrupted program ends: by the signal
};

// From now on SIGTERM ends the program at once with the status `ended`, with a word. It and
// Interrupts::obey remove the file of remove_on_end. Results are written beside their targets and renamed, so nothing is half
// written; a result that is being written is finished first.
void end_by_term();
void remove_on_end(const std::string &file); // empty: none

} // namespace fathom::cli
