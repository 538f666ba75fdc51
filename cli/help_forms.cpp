#include "cli/help_forms.h"

#include <fmt/format.h>

namespace fathom::cli {
namespace {

std::string replaced(std::string text, std::string_view what, std::string_view by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; at += by.size())
        text.replace(at, what.size(), by);
    return text;
}

// Text of a manual page: no backslash of ours, hyphens that can be copied, and no line that begins
// like a request.
std::string roff(const std::string &text) {
    const std::string plain = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
    return plain.starts_with('.') || plain.starts_with('\'') ? "\\&" + plain : plain;
}

// Within '…' of a shell.
std::string within_quotes(const std::string &text) { return replaced(text, "'", "'\\''"); }

std::string roff_option(const HelpOption &option) {
    std::string head;
    for (const std::string &name : option.names)
        head += (head.empty() ? "\\fB" : ", \\fB") + roff(name) + "\\fR";
    if (!option.type.empty())
        head += (head.empty() ? "\\fI" : " \\fI") + roff(option.type) + "\\fR";
    return ".TP\n" + head + "\n" + roff(option.what) + "\n";
}

std::vector<std::string> names_of(const std::vector<HelpOption> &options) {
    std::vector<std::string> names;
    for (const HelpOption &option : options)
        names.insert(names.end(), option.names.begin(), option.names.end());
    return names;
}

// A line of zsh's _arguments for an option; files are completed where it takes a word.
std::string zsh_option(const HelpOption &option) {
    std::string line;
    const std::string what = replaced(replaced(within_quotes(option.what), "[", "\\["), "]", "\\]");
    for (const std::string &name : option.names) {
        line += fmt::format("        '{}[{}]", name, what);
        if (!option.choices.empty())
            line += fmt::format(":{}:({})", option.type, fmt::join(option.choices, " "));
        else if (!option.type.empty())
            line += fmt::format(":{}:_files", replaced(within_quotes(option.type), ":", "\\:"));
        line += "' \\\n";
    }
    return line;
}

std::string fish_option(const std::string &condition, const HelpOption &option) {
    std::string line = "complete -c fathom" + condition;
    if (option.names.empty()) return "";
    for (const std::string &name : option.names)
        line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (!option.choices.empty())
        line += fmt::format(" -x -a '{}'", fmt::join(option.choices, " "));
    else if (!option.type.empty())
        line += " -r -F";
    return line +
           fmt::format(" -d '{}'\n", replaced(replaced(option.what, "\\", "\\\\"), "'", "\\'"));
}

} // namespace

std::string man_page(const HelpTable &table) {
    std::string text =
        fmt::format(".TH FATHOM 1 \"\" \"fathom {}\" \"User Commands\"\n.SH NAME\n"
                    "fathom \\- scenes as text, distance fields whose step is proved\n"
                    ".SH SYNOPSIS\n.B fathom\n.I COMMAND\n[\\fIOPTION\\fR]...\n"
                    ".SH DESCRIPTION\n{}\n.SH OPTIONS\n",
                    FATHOM_VERSION, roff(table.what));
    for (const HelpOption &option : table.everywhere) text += roff_option(option);
    text += ".SH COMMANDS\n";
    for (const HelpCommand &command : table.commands) {
        text += fmt::format(".SS fathom {}\n{}.\n", roff(command.name), roff(command.what));
        for (const HelpOption &option : command.options) text += roff_option(option);
    }
    return text + ".SH NOTES\n" + roff(replaced(table.footer, "\n", " ")) + "\n";
}

std::string bash_completion(const HelpTable &table) {
    std::string commands, by_command, by_option;
    for (const HelpCommand &command : table.commands) {
        commands += (commands.empty() ? "" : " ") + command.name;
        std::vector<std::string> names = names_of(command.options);
        for (const std::string &name : names_of(table.everywhere)) names.push_back(name);
        by_command +=
            fmt::format("        {}) words='{}' ;;\n", command.name, fmt::join(names, " "));
    }
    const auto add_choices = [&](const std::string &command, const HelpOption &option) {
        for (const std::string &name : option.names)
            if (!option.choices.empty())
                by_option += fmt::format(
                    "        {}:{}) COMPREPLY=($(compgen -W '{}' -- \"$current\")); return ;;\n",
                    command, name, fmt::join(option.choices, " "));
    };
    for (const HelpCommand &command : table.commands)
        for (const HelpOption &option : command.options) add_choices(command.name, option);
    for (const HelpOption &option : table.everywhere) add_choices("*", option);
    std::string one_of = replaced(commands, " ", "|");
    return fmt::format(R"(# Completion of fathom for bash, made by `fathom help --as bash`.
_fathom() {{
    local current=${{COMP_WORDS[COMP_CWORD]}} command= word words
    for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
        case $word in {}) command=$word; break ;; esac
    done
    case $command:${{COMP_WORDS[COMP_CWORD-1]}} in
{}    esac
    case $command in
{}        *) words='{} {}' ;;
    esac
    if [[ -z $command || $current == -* ]]; then
        COMPREPLY=($(compgen -W "$words" -- "$current"))
    elif [[ $command == help ]]; then
        COMPREPLY=($(compgen -W '{}' -- "$current"))
    else
        COMPREPLY=($(compgen -f -- "$current"))
    fi
}}
complete -o filenames -F _fathom fathom
)",
                       one_of, by_option, by_command, commands,
                       fmt::join(names_of(table.everywhere), " "), commands);
}

std::string zsh_completion(const HelpTable &table) {
    std::string commands, cases, everywhere;
    for (const HelpOption &option : table.everywhere) everywhere += zsh_option(option);
    for (const HelpCommand &command : table.commands) {
        commands += fmt::format("    '{}:{}'\n", command.name,
                                replaced(within_quotes(command.what), ":", "\\:"));
        cases += fmt::format("    {}) _arguments \\\n", command.name);
        for (const HelpOption &option : command.options) cases += zsh_option(option);
        cases += everywhere + "        '*:file:_files' ;;\n";
    }
    return "#compdef fathom\n# Completion of fathom for zsh, made by `fathom help --as zsh`.\n"
           "local -a commands=(\n" +
           commands +
           ")\nif (( CURRENT == 2 )); then\n    _describe command commands\nelse\n    local "
           "command=$words[2]\n    shift words\n    "
           "(( CURRENT-- ))\n    case $command in\n" +
           cases + "    esac\nfi\n";
}

std::string fish_completion(const HelpTable &table) {
    std::string text = "# Completion of fathom for fish, made by `fathom help --as fish`.\n";
    for (const HelpOption &option : table.everywhere) text += fish_option("", option);
    for (const HelpCommand &command : table.commands) {
        text +=
            fmt::format("complete -c fathom -n __fish_use_subcommand -f -a {} -d '{}'\n",
                        command.name, replaced(replaced(command.what, "\\", "\\\\"), "'", "\\'"));
        for (const HelpOption &option : command.options)
            text += fish_option(fmt::format(" -n '__fish_seen_subcommand_from {}'", command.name),
                                option);
    }
    return text;
}

} // namespace fathom::cli
