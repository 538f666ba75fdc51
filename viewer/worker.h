// The thread that follows the file: compiles after each save, newest wins, and hands over what came of it. The window
// never waits for it. Knows no GL and no window.
#pragma once

#include "backend-glsl/emit.h"
#include "driver/compile.h"
#include "driver/watch.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>

namespace fathom::viewer {

// What came of one save.
struct Build {
    driver::Compilation compilation;
    glsl::Output shader;              // empty where there is an error
    std::vector<std::string> errors;  // as printed, without colours; the good picture stays while there are any
    std::vector<std::string> remarks; // warnings and notes
    double front_end_ms = 0;          // reading, checking, proving, lowering, emitting
    bool good() const { return errors.empty(); }
};

class Worker {
  public:
    // `ready` is called on the worker's thread when a build can be taken.
    Worker(std::filesystem::path file, driver::CompileOptions options, std::function<void()> ready);
    ~Worker();
    Worker(const Worker &) = delete;
    Worker &operator=(const Worker &) = delete;

    // The newest build that was not taken yet, or nothing.
    std::unique_ptr<Build> take();

    // Builds again with these values of structural params, over those of the command line.
    void rebuild(std::vector<driver::Override> overrides);

  private:
    void run();
    std::unique_ptr<Build> build();

    std::filesystem::path file_;
    driver::CompileOptions options_;
    std::function<void()> ready_;
    driver::Watcher watcher_;
    std::mutex mutex_; // over the two below
    std::unique_ptr<Build> finished_;
    std::vector<driver::Override> overrides_;
    std::atomic<bool> asked_ = false, ending_ = false;
    std::thread thread_; // last: starts when all else is there
};

} // namespace fathom::viewer
