/** @file
 *  Tells when a file that a scene was made from was saved: the scene's own, an import, an image or a
 *  grid. It watches folders, so that editors which save by renaming are seen, and takes a burst of
 *  changes as one.
 *
 *  @code
 *  #include <fathom/files.h>
 *  #include <fathom/watch.h>
 *  #include <cstdio>
 *
 *  int main() {
 *      const auto file = std::filesystem::temp_directory_path() / "fathom_watch_example.sdf";
 *      if (!fathom::write_file(file, "sphere(1)\n").empty()) return 1;
 *      fathom::Watcher watcher;
 *      watcher.watch(fathom::compile_file(file));
 *      fathom::write_file(file, "sphere(20)\n"); // as an editor does
 *      const bool saved = watcher.wait(std::chrono::seconds(10));
 *      std::printf("%s\n", saved ? "saved" : "nothing happened");
 *      std::filesystem::remove(file);
 *      return saved ? 0 : 1;
 *  }
 *  @endcode
 */
#pragma once

#include <fathom/scene.h>

#include <chrono>

namespace fathom::FATHOM_V1 {

/** Waits until a file is saved. One thread at a time uses it, but for `wake`. Without memory to watch
 *  with it takes it, twice a second, that something has changed. */
class FATHOM_API Watcher {
  public:
    Watcher();
    ~Watcher();
    Watcher(const Watcher &) = delete;
    Watcher &operator=(const Watcher &) = delete;

    /** Watches the files of this result from now on, in place of those before. What was saved since
     *  they were read is news too. Files that do not exist are fine. */
    void watch(const CompileResult &result);

    /** Waits until one has changed and is written to its end, or `timeout` has passed, or `wake` is
     *  called. True: something changed. */
    bool wait(std::chrono::milliseconds timeout);

    /** Ends a `wait` in another thread, now or the next one. */
    void wake();

    /** Why it looks at the files twice a second instead of being told of changes (the system's limits
     *  are reached), or an empty text. */
    std::string polls_because() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace fathom::FATHOM_V1
