// Standard output for results, standard error for words; colours, the progress bar, and what the
// commands share in saying. A reader that goes away (`| head`) ends the program quietly.
#pragma once

#include "cli/command.h"

#include <fathom/scene.h>

#include <functional>
#include <string>
#include <string_view>

namespace fathom::cli {

// Both output streams of a command, with what it knows of them (colours, width).
class Terminal {
  public:
    explicit Terminal(ColorChoice color);

    // Buffered. Where standard output is a terminal its lines are encoded for that, so that no
    // bytes of a result steer it; a file or a pipe gets them as they are.
    void put(std::string_view results);
    void say(std::string_view words);     // a line, at once, encoded for a terminal
    void say_text(std::string_view text); // lines that are encoded already, with colours of ours
    Exit flush(); // of the results; device_error where they could not be written
    // The results are text to read: where standard output is a terminal that is too small for them,
    // `flush` gives them to the pager of the variable PAGER, else to less.
    void page() { pages_ = true; }

    bool color() const { return color_; }             // on standard error
    bool interactive() const { return interactive_; } // standard error is a terminal
    bool reader_gone() const { return gone_; }        // nobody reads the results any more

    // A bar on standard error, when that is a terminal; redrawn at most 20 times a second. `finish`
    // wipes it. `left`: seconds until the end; below 0: not known yet.
    void progress(std::string_view what, double share, double left = -1);
    void finish_progress();

    // A picture as it comes above the bar (preview.h), where the terminal can; at most five times a
    // second. `lines` makes its text, of `rows` lines. Wiped with the bar.
    void preview(int rows, const std::function<std::string()> &lines);

  private:
    std::string buffer_;
    bool color_ = false, interactive_ = false, gone_ = false, bar_shown_ = false, pages_ = false;
    int failure_ = 0;
    long long next_bar_ = 0, next_preview_ = 0;
    int preview_rows_ = 0; // shown
};

std::string duration_words(double seconds); // "3 min 20 s"

v1::CompileOptions library_options(const SceneArguments &scene);
// Proved for what is drawn: the params' values as given, and these times, in seconds.
v1::CompileOptions library_options(const SceneArguments &scene, double first, double last);
// CompileOptions::cells of what is drawn, and of a shader's text, which holds them as constants.
inline constexpr int cells_of_pictures = 16, cells_of_text = 8;

// Prints all diagnostics, and what else keeps a compilation from being good, and says how the
// command ends.
Exit report(const v1::CompileResult &result, Terminal &terminal);
// Whether the result is no verdict on a text: there was none to read, or the command line is wrong.
bool is_about_no_text(const v1::CompileResult &result);
// What is proved of a scene that moves holds for the seconds that its `render(time: …)` says.
// False, with the reason, where `first` to `last` leave them and the field reads the time.
bool in_proved_time(const v1::Facts &facts, double first, double last, Terminal &terminal);
void print_diagnostics(const std::vector<v1::Diagnostic> &diagnostics, std::size_t dropped,
                       const v1::Texts &texts, Terminal &terminal);
bool has_errors(const std::vector<v1::Diagnostic> &diagnostics);

// Compiles, acts, and does both again after every save of a file that the scene read; ends by an
// interrupt alone.
Exit watch_scene(const SceneArguments &scene, const v1::CompileOptions &options, Terminal &terminal,
                 const std::function<Exit(const v1::CompileResult &)> &act);

} // namespace fathom::cli
