// Files, whole: reading with a limit, writing so that a target is either the old file or the new
// one. Knows nothing of what the bytes mean; reports failures as sentences, never by exceptions.
#pragma once

#include "base/limits.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fathom::driver {

// The largest text and the largest save file that is read where no option says another.
inline constexpr std::size_t max_source_bytes = Limits{}.source * mebibyte;
inline constexpr std::size_t max_save_bytes = 16 * max_source_bytes;

// What tells one state of a file from the next without reading it.
struct FileStamp {
    bool exists = false;
    std::uint64_t device = 0, inode = 0, size = 0;
    std::int64_t seconds = 0, nanoseconds = 0; // last change of its bytes
    friend bool operator==(const FileStamp &, const FileStamp &) = default;
};
FileStamp stamp_of(const std::filesystem::path &file);

using Stamps = std::map<std::filesystem::path, FileStamp>;

// Of the files of `after`, the one that was written last among those that are not as in `before`;
// an empty path where there is none, or where nothing was read before.
std::filesystem::path last_saved(const Stamps &before, const Stamps &after);

// The bytes of a regular file, or nothing and the reason ("no such file", "is a directory", …).
std::optional<std::string> read_file(const std::filesystem::path &path, std::size_t limit,
                                     std::string &error);
std::optional<std::string> read_standard_input(std::size_t limit, std::string &error);

// Writes beside the target, then renames: on any failure, a full disk included, the old file stays
// as it was and nothing is left behind. Interrupts wait until the rename is done; what a kill
// leaves, `.NAME.fathom-tmp…`, the next process that writes into the folder removes. Symbolic links
// are followed, also where they lead to nothing yet. A target that is no regular file (a pipe,
// /dev/null) is written in place. Returns an empty string, or the reason of the failure.
std::string write_file(const std::filesystem::path &target, std::string_view bytes);

// Several files so: each is written whole beside its target before the first is renamed, so that on a
// full disk all stay as they were. `failed`: which one failed.
struct FileBytes {
    std::filesystem::path target;
    std::string_view bytes;
};
std::string write_files(const std::vector<FileBytes> &files, std::size_t &failed);

// A new file beside the target, which no other process sweeps as long as it is open (it is locked), and
// its name; -1 and errno.
int make_temporary(const std::filesystem::path &target, std::string &name);

// Writes all of `bytes` to a descriptor; 0, or the errno of the failure.
int write_all(int descriptor, std::string_view bytes);

std::string
error_words(int error); // an errno in words, in lower case, without the C library's locale

} // namespace fathom::driver
