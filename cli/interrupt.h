// Ctrl-C while something long is drawn: it is noticed and not obeyed at once, so that the terminal
// can be put in order first; a second Ctrl-C ends the program where it stands.
#pragma once

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

} // namespace fathom::cli
