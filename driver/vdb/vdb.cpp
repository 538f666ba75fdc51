#include "driver/vdb/vdb.h"

#include "driver/files.h"
#include "driver/grid.h"
#include "system/system.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <optional>

#include <dlfcn.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

namespace fathom::driver {
namespace {

// The folder of the file that this very code was loaded from.
std::filesystem::path folder_of_code() {
    static const char mark = 0;
    Dl_info info{};
    if (dladdr(&mark, &info) == 0 || !info.dli_fname) return {};
    std::error_code failed;
    // A program that the shell found is called by its bare name, which must not be looked for in the
    // current folder: what lies there may be a stranger's.
    std::filesystem::path file = info.dli_fname;
    if (!file.has_parent_path()) file = system::own_program();
    if (!file.has_parent_path()) return {};
    const std::filesystem::path whole = std::filesystem::canonical(file, failed);
    return failed ? std::filesystem::path() : whole.parent_path();
}

// A file of Fathom's own, or an empty path and why there is none.
std::filesystem::path companion(const char *name, std::string &why) {
    const std::filesystem::path here = folder_of_code();
    for (const std::filesystem::path &folder :
         {here, here / "fathom", here / ".." / FATHOM_LIBDIR / "fathom",
          std::filesystem::path(FATHOM_INSTALLED)}) { // for Python's module, which lies elsewhere
        std::error_code none;
        if (folder.is_absolute() && std::filesystem::exists(folder / name, none))
            return folder / name;
    }
    why =
        "this Fathom is without OpenVDB: install the package fathom-openvdb, or build Fathom where "
        "libopenvdb-dev and libboost-dev are";
    return {};
}

// Up to `count` bytes, fewer where the other side says no more.
std::size_t read_all(int from, void *to, std::size_t count) {
    std::size_t done = 0;
    while (done < count) {
        const ssize_t got = read(from, static_cast<char *>(to) + done, count - done);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        done += static_cast<std::size_t>(got);
    }
    return done;
}

// Words of others: what is no printable ASCII may be part of anything.
std::string printable(std::string words) {
    for (char &c : words)
        if (c < ' ' || c > '~') c = '?';
    return words;
}

// A program that reads a file of the given bytes, and answers.
struct Reader {
    pid_t process = -1;
    int answer = -1; // what it writes
};

std::optional<Reader> start(const std::string &program, std::string_view bytes, std::size_t memory,
                            std::string grid) {
    std::FILE *input = std::tmpfile();
    if (!input) return std::nullopt;
    int ends[2] = {-1, -1};
    std::optional<Reader> out;
    if (write_all(fileno(input), bytes) == 0 && lseek(fileno(input), 0, SEEK_SET) == 0 &&
        pipe(ends) == 0) {
        for (const int end : ends) fcntl(end, F_SETFD, FD_CLOEXEC);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, fileno(input), 0);
        posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
        posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
        std::string name = program, most = std::to_string(memory);
        char *const arguments[] = {name.data(), most.data(), grid.data(), nullptr};
        Reader reader;
        reader.answer = ends[0];
        if (posix_spawn(&reader.process, program.c_str(), &actions, nullptr, arguments, environ) ==
            0)
            out = reader;
        else
            close(ends[0]);
        posix_spawn_file_actions_destroy(&actions);
        close(ends[1]);
    }
    std::fclose(input);
    return out;
}

LoadError broken(std::string why) {
    return {LoadError::Reason::Unreadable, "OpenVDB: " + std::move(why)};
}

std::variant<ir::GridData, LoadError> answered(int from, const Room &room) {
    const char *ended =
        "the file is broken, or takes more than 10 s to read: OpenVDB stopped at it";
    FathomVdbAnswer answer{};
    if (read_all(from, &answer, sizeof answer) != sizeof answer) return broken(ended);
    if (answer.good == 0) {
        std::string words(512, '\0');
        words.resize(read_all(from, words.data(), words.size()));
        return broken(printable(std::move(words)));
    }
    const FathomVdbBox &box = answer.box;
    ir::GridData grid;
    if (auto refused = make_place({box.size[0], box.size[1], box.size[2]}, 0, room, grid))
        return *refused;
    std::copy_n(box.lo, 3, grid.lo.begin());
    std::copy_n(box.hi, 3, grid.hi.begin());
    grid.values.resize(box.size[0] * box.size[1] * box.size[2]);
    const std::size_t size = grid.values.size() * sizeof(float);
    if (read_all(from, grid.values.data(), size) != size) return broken(ended);
    return grid;
}

} // namespace

FathomWriteVdb vdb_writer(std::string &why) {
    const std::filesystem::path file = companion("libfathom-vdb.so", why);
    if (file.empty()) return nullptr;
    if (void *module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL))
        if (void *found = dlsym(module, "fathom_write_volume"))
            return reinterpret_cast<FathomWriteVdb>(found);
    const char *error = dlerror();
    why = fmt::format("{}: {}", file.string(), error ? error : "it is no module of Fathom's");
    return nullptr;
}

bool is_vdb(std::string_view bytes) {
    return bytes.starts_with(std::string_view(" BDV\0\0\0\0", 8));
}

std::variant<ir::GridData, LoadError> decode_vdb(std::string_view bytes, Room &room,
                                                 const std::string &name) {
    std::string without;
    const std::filesystem::path program = companion("fathom-read-vdb", without);
    if (program.empty())
        return LoadError{LoadError::Reason::Unreadable, without + ", or convert the file to .nrrd"};
    constexpr std::size_t own = std::size_t{512} * mebibyte, any = std::size_t(-1) / 4;
    const std::size_t memory = room.bytes < any ? own + 2 * room.bytes : 0;
    const std::optional<Reader> reader = start(program.string(), bytes, memory, name);
    if (!reader) return broken("fathom-read-vdb cannot be started");
    auto grid = answered(reader->answer, room);
    close(reader->answer); // what is not wanted ends it
    while (waitpid(reader->process, nullptr, 0) < 0 && errno == EINTR) {
    }
    if (const auto *made = std::get_if<ir::GridData>(&grid))
        if (std::optional<LoadError> wrong = take_grid(*made, room)) return *wrong;
    return grid;
}

} // namespace fathom::driver
