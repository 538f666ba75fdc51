// The watcher as it is built for a system whose file watches are not known.
#include "tests/unit/driver/polled.h"

TEST_CASE("where the system's watches are not known the files are looked at, and it is said") {
    const ScratchFolder folder;
    const std::filesystem::path file = folder.write("scene.sdf", "sphere(1)");
    fathom::driver::Watcher watcher;
    CHECK(watcher.polls_because() ==
          "this system's file watches are not known: files are looked at twice a second instead");
    sees_saves_by_looking(watcher, folder, file);
}
