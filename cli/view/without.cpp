// fathom view, of a program that is built without the viewer.
#include "cli/terminal.h"

namespace fathom::cli {

Exit run(const ViewCommand &, Terminal &terminal) {
    terminal.say("fathom: this fathom was built without its viewer (-DFATHOM_VIEWER=ON builds with "
                 "it); `fathom render` makes pictures");
    return device_error;
}

} // namespace fathom::cli
