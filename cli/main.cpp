// The program: reads the command line, runs one command, tells by the exit status how it went.
#include "cli/terminal.h"
#include "system/system.h"

#include <csignal>
#include <new>

int main(int count, char **arguments) {
    using namespace fathom::cli;
    std::signal(SIGPIPE, SIG_IGN); // a reader that goes away is seen at the write
    std::signal(SIGXFSZ, SIG_IGN); // and so is a file that may not grow further
    fathom::system::give_back_large_blocks();
    std::variant<Invocation, Answer> line = read_arguments(count, arguments);
    if (const auto *answer = std::get_if<Answer>(&line)) {
        Terminal terminal(ColorChoice::Auto);
        terminal.put(answer->results);
        if (!answer->words.empty()) terminal.say_text(answer->words);
        Exit flushed = terminal.flush();
        return flushed != done ? flushed : answer->exit;
    }
    const Invocation &invocation = std::get<Invocation>(line);
    Terminal terminal(invocation.color);
    Exit exit = device_error;
    try {
        exit = std::visit([&](const auto &command) { return run(command, terminal); },
                          invocation.command);
    } catch (const std::bad_alloc &) {
        terminal.say("fathom: the system has no memory left for this");
    }
    Exit flushed = terminal.flush();
    return flushed != done ? flushed : exit;
}
