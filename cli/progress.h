// How far a command of many frames is: a bar on a terminal, or lines of JSON on standard error.
#pragma once

#include "cli/terminal.h"

#include <chrono>
#include <string>

namespace fathom::cli {

class Progress {
  public:
    Progress(ProgressFormat format, std::size_t frames, Terminal &terminal);
    // Within the frame that is made now: the share of it that is done.
    void share(const std::string &file, double share);
    // A frame is done, or `kept` as it was found.
    void finished(int frame, const std::string &file, bool kept);

  private:
    double seconds() const; // since the begin
    double left(double frames_made) const;
    ProgressFormat format_;
    std::size_t frames_, done_ = 0, kept_ = 0;
    Terminal &terminal_;
    std::chrono::steady_clock::time_point begin_, next_;
};

} // namespace fathom::cli
