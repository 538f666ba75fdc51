// The thread that follows the file: compiles after each save, has the driver link what must be,
// newest wins, and hands over what came of it. The window never waits for it. Knows no window; GL
// only through a context that it is lent.
#pragma once

#include "backend-glsl/emit.h"
#include "driver/compile.h"
#include "driver/watch.h"
#include "render-gl/cache_passes.h"
#include "viewer/linker.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

namespace fathom::viewer {

// What came of one save.
struct Build {
    driver::Compilation compilation;
    glsl::Output picture;          // empty where there is an error
    glsl::Output probe;            // where it was wanted
    Link picture_link, probe_link; // where `linked`
    bool linked = false;           // else whoever takes it links
    std::size_t number = 0;        // of this build
    std::vector<std::string>
        errors; // as printed, without colours; the good picture stays while there are any
    std::vector<std::string> remarks; // warnings and notes
    std::vector<std::string> views;   // cameras beside the scene's own (driver::views_in)
    double front_end_ms = 0;          // reading, checking, proving, lowering, emitting
    bool good() const { return errors.empty(); }
};

// What the worker is at, and for how long it has been at work since the save.
enum class Stage { Rest, Reading, Checking, Proving, Lowering, Emitting, Linking };
struct Work {
    Stage stage = Stage::Rest;
    double seconds = 0;
};
const char *stage_words(Stage stage); // "proving how far a ray may step"; at rest nothing

// One a program kind.
struct Linkers {
    Linker picture, probe;
    void link(Build &build); // errors of the driver become the build's
};

// The worker thread and the newest of its builds.
class Worker {
  public:
    struct Hooks {
        std::function<void()>
            ready; // on the worker's thread: a build can be taken, or work() changed
        std::function<bool()>
            take_context; // makes a context current that shares with the window's; empty: none
        std::function<void()> leave_context;
    };
    Worker(std::filesystem::path file, driver::CompileOptions options, Hooks hooks);
    ~Worker();
    Worker(const Worker &) = delete;
    Worker &operator=(const Worker &) = delete;

    // The newest build that was not taken yet, or nothing.
    std::unique_ptr<Build> take();

    // The noise cache's programs for the build of that number, or why there are none, once they are
    // made; by a worker that has a context, after the build was handed over.
    using Kept = std::variant<gl::CachePrograms, std::string>;
    std::optional<Kept> take_cached(std::size_t number);

    // Bounds of the build of that number at those values of its params.
    struct PresentBounds {
        std::size_t number = 0;
        std::vector<ir::Param> params; // the user's
        proof::PresentBounds bounds;
        double milliseconds = 0; // that the proof took
    };
    // Proves them, unless a newer build or newer values are wanted before they are there.
    void prove_at(std::size_t number, std::vector<ir::Param> params);
    // The newest that were not taken yet, or nothing.
    std::optional<PresentBounds> take_bounds();

    // Builds again with these values of structural params, over those of the command line.
    void rebuild(std::vector<driver::Override> overrides);

    // Builds from this text from now on, as if the file held it.
    void show(std::string text);

    // From now on builds hold the probe too; one is made at once.
    void want_probe();

    // Whether it has a context of its own; else who takes a build links it. Known once there is
    // one.
    bool lent() const { return lent_; }

    Work work() const;

    // Why saves are not followed (no watches left), or nothing.
    std::string complaint();

  private:
    void run();
    std::unique_ptr<Build> build(int cells);
    void hand_over(std::unique_ptr<Build> made, Linkers &linkers);
    void prove_present(const ir::Scene &scene);
    void build_cached(const ir::Scene &scene, int part_stride, std::size_t number);
    void again();
    void enter(Stage stage); // and the window hears of it

    std::filesystem::path file_;
    driver::CompileOptions options_;
    proof::BoundCache bounds_; // from one edit to the next
    Hooks hooks_;
    driver::Watcher watcher_;
    std::mutex mutex_; // over the eight below
    std::unique_ptr<Build> finished_;
    std::optional<Kept> kept_;
    std::size_t cached_number_ = 0; // of the build that `kept_` is for
    std::vector<driver::Override> overrides_;
    std::string complaint_;
    std::optional<std::string> unsaved_;
    std::optional<PresentBounds> wanted_bounds_; // without the bounds
    std::optional<PresentBounds> present_bounds_;
    std::atomic<Stage> stage_ = Stage::Rest;
    std::atomic<std::chrono::steady_clock::time_point> begun_; // the work on the newest save
    std::atomic<bool> lent_ = false;
    std::atomic<bool> asked_ = false, ending_ = false, probe_ = false;
    std::atomic<bool> moved_ = false; // bounds are wanted for other values
    // The thread's own.
    bool pruning_ = false;
    bool saved_ = false;     // something changed since the newest build
    std::size_t number_ = 0; // of builds
    std::thread thread_;     // last: starts when all else is there
};

} // namespace fathom::viewer
