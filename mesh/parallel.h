// Work that is divided into numbered pieces, for any number of threads. What a piece computes may
// depend on its number alone, so results are the same however many threads there are.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace fathom::mesh {

// How far a long piece of work is, and whether it is to go on. `report` is called by one thread at
// a time with the share that is done, 0 to 1; false cancels, for good.
struct Progress {
    Progress() = default;
    explicit Progress(std::function<bool(double)> reports, double begin = 0)
        : report(std::move(reports)), from(begin) {}
    std::function<bool(double done)> report;
    double from = 0, to = 1; // the part of the whole that the work at hand is
    double told = 0;         // never less than before
    std::atomic<bool> cancelled{false};
    std::mutex mutex;
    void phase(double until) { from = to, to = until; }
    void tell(double share) {
        told = std::max(told, from + share * (to - from));
        if (report && !cancelled && !report(told)) cancelled = true;
    }
};

// Calls work(memory, number) for all numbers below `count`, each once; `make` makes a thread's
// memory. An exception of any of them comes out of this call, after all have ended.
template <class Make, class Work>
void in_parallel(std::size_t count, unsigned threads, Progress &progress, Make make, Work work) {
    std::atomic<std::size_t> next{0};
    std::size_t finished = 0;
    std::exception_ptr failure;
    const auto run = [&]() noexcept {
        try {
            auto memory = make();
            while (!progress.cancelled) {
                const std::size_t number = next++;
                if (number >= count) break;
                work(memory, number);
                const std::lock_guard lock(progress.mutex);
                progress.tell(static_cast<double>(++finished) / static_cast<double>(count));
            }
        } catch (...) {
            next = count;
            const std::lock_guard lock(progress.mutex);
            failure = std::current_exception();
        }
    };
    std::vector<std::thread> others;
    try {
        for (unsigned k = 1; k < std::min<std::size_t>(threads, count); ++k)
            others.emplace_back(run);
    } catch (...) { // no more threads can be had: those that there are do the work
    }
    run();
    for (std::thread &thread : others) thread.join();
    if (failure) std::rethrow_exception(failure);
}

} // namespace fathom::mesh
