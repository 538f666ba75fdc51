#include "viewer/worker.h"

#include <algorithm>
#include <chrono>

namespace fathom::viewer {
namespace {

void sort_out(const Diagnostics &diagnostics, const Sources &sources, Build &build) {
    for (const Diagnostic &diagnostic : diagnostics.sorted())
        (diagnostic.severity == Severity::Error ? build.errors : build.remarks)
            .push_back(to_text(diagnostic, sources, false));
}

} // namespace

Worker::Worker(std::filesystem::path file, driver::CompileOptions options, std::function<void()> ready)
    : file_(std::move(file)), options_(std::move(options)), ready_(std::move(ready)), thread_([this] { run(); }) {}

Worker::~Worker() {
    ending_ = true;
    watcher_.wake();
    thread_.join();
}

std::unique_ptr<Build> Worker::take() {
    std::lock_guard lock(mutex_);
    return std::move(finished_);
}

void Worker::rebuild(std::vector<driver::Override> overrides) {
    {
        std::lock_guard lock(mutex_);
        overrides_ = std::move(overrides);
    }
    asked_ = true;
    watcher_.wake();
}

std::unique_ptr<Build> Worker::build() {
    auto start = std::chrono::steady_clock::now();
    auto result = std::make_unique<Build>();
    driver::CompileOptions options = options_;
    {
        std::lock_guard lock(mutex_);
        for (const driver::Override &value : overrides_) {
            std::erase_if(options.overrides, [&](const auto &given) { return given.name == value.name; });
            options.overrides.push_back(value);
        }
    }
    result->compilation = driver::compile_file(file_, options);
    const driver::Compilation &compilation = result->compilation;
    sort_out(compilation.diagnostics, compilation.sources, *result);
    if (!compilation.unreadable.empty())
        result->errors.push_back("cannot read `" + file_.string() + "`: " + compilation.unreadable);
    for (const std::string &error : compilation.usage_errors) result->errors.push_back(error);
    if (result->good()) {
        glsl::Options target;
        target.target = glsl::Target::Glsl330;
        target.buffers = true; // no places in the text: a moved line changes nothing for the graphics driver
        Diagnostics emission;
        result->shader = glsl::emit(compilation.scene, target, emission);
        sort_out(emission, compilation.sources, *result);
    }
    result->front_end_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return result;
}

void Worker::run() {
    while (!ending_) {
        asked_ = false;
        std::unique_ptr<Build> made = build();
        watcher_.watch(made->compilation.files);
        {
            std::lock_guard lock(mutex_);
            finished_ = std::move(made);
        }
        ready_();
        while (!ending_ && !asked_ && !watcher_.wait(std::chrono::hours(1))) {}
    }
}

} // namespace fathom::viewer
