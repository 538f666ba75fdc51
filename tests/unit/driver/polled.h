// What holds of a watcher that is told nothing, and looks at the files.
#pragma once

#include "driver/watch.h"
#include "scratch_folder.h"

#include <catch2/catch.hpp>
#include <thread>

inline void sees_saves_by_looking(fathom::driver::Watcher &watcher, const ScratchFolder &folder,
                                  const std::filesystem::path &file) {
    using fathom::driver::stamp_of;
    using std::chrono::milliseconds;
    constexpr milliseconds patience{5000};
    watcher.watch({{file, stamp_of(file)}});
    CHECK_FALSE(watcher.wait(milliseconds(0)));
    folder.write("scene.sdf", "sphere(2)  ");
    CHECK(watcher.wait(patience));
    CHECK_FALSE(watcher.wait(milliseconds(0)));
    std::filesystem::remove(file); // a rename into place, later
    std::thread later([&] {
        std::this_thread::sleep_for(milliseconds(100));
        std::filesystem::rename(folder.write("other", "sphere(3)"), file);
    });
    CHECK(watcher.wait(patience)); // it is gone, or already back
    later.join();
    while (watcher.wait(milliseconds(700))) {
    }
    folder.write("scene.sdf", "sphere(4)      ");
    CHECK(watcher.wait(patience));
    std::thread other([&] {
        std::this_thread::sleep_for(milliseconds(50));
        watcher.wake();
    });
    CHECK_FALSE(watcher.wait(std::chrono::hours(1)));
    other.join();
}
