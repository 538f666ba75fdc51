// Windows of the viewer that follow texts as they are typed. Each is a process of this program,
// `fathom view --editor SOCKET`, on a socket in a folder that only the same user can enter; who
// connects as another user is refused. Knows the client's requests by their methods; compiles
// nothing.
#pragma once

#include "lsp/json.h"
#include "system/system.h"

#include <list>
#include <map>
#include <optional>
#include <poll.h>
#include <string>
#include <sys/types.h>
#include <vector>

namespace fathom::lsp {

class Previews {
  public:
    explicit Previews(std::string program = system::own_program());
    ~Previews(); // the windows close
    Previews(const Previews &) = delete;
    Previews &operator=(const Previews &) = delete;

    // True where the message is a request for a window, which is answered from here: `out` has it.
    // `texts`: `textDocument` of each open text, by its address.
    bool handle(const Json &message, const std::map<std::string, Json> &texts,
                std::vector<std::string> &out);
    // What a message means for the windows, once the texts are as it wants them.
    void follow(const Json &message, const std::map<std::string, Json> &texts);

    // Descriptors to wait for beside the client's, and what to tell the client once one is ready: a
    // place that was clicked, why a window did not open.
    void wait_for(std::vector<pollfd> &all) const;
    std::vector<std::string> heard();

  private:
    struct Window {
        std::string uri, folder, shown; // shown: the text that it has
        pid_t process = 0;
        int listening = -1, connected = -1, errors = -1;
        std::string received, said; // of its socket, of its standard error
    };
    std::string open(const std::string &uri, const std::string &text); // empty, or why not
    void close(Window &window);
    void show(Window &window, const std::string &text);
    void hear(Window &window, std::vector<std::string> &messages);

    std::string program_;
    std::list<Window> windows_;
    bool shows_documents_ = false; // the client puts its cursor where it is asked to
    int requests_ = 0;
};

} // namespace fathom::lsp
