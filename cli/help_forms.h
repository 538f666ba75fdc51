// What `fathom help` knows, as a table; and the table as a manual page and as completions of shells.
#pragma once

#include <string>
#include <vector>

namespace fathom::cli {

// A word of the command line. Without names it is what is given in its place, as FILE.
struct HelpOption {
    std::vector<std::string> names;   // "-h", "--help"
    std::string type, what;           // of the word behind it; empty: a flag
    std::vector<std::string> choices; // the words that it takes, where it takes a few
};

struct HelpCommand {
    std::string name, what;
    std::vector<HelpOption> options;
};

struct HelpTable {
    std::string what, footer;
    std::vector<HelpOption> everywhere;
    std::vector<HelpCommand> commands;
};

enum class HelpForm { Text, Man, Bash, Zsh, Fish };

std::string man_page(const HelpTable &table); // roff, of all commands
std::string bash_completion(const HelpTable &table);
std::string zsh_completion(const HelpTable &table);
std::string fish_completion(const HelpTable &table);

} // namespace fathom::cli
