/** @file
 *  Files, whole: read up to a limit, and written so that a target is either the old file or the new
 *  one. What fails is said in words, in lower case, without the name of the file.
 *
 *  @code
 *  #include <fathom/files.h>
 *  #include <cstdio>
 *
 *  int main() {
 *      const auto file = std::filesystem::temp_directory_path() / "fathom_files_example.sdf";
 *      std::string why = fathom::write_file(file, "sphere(1)\n");
 *      if (!why.empty()) return 1;
 *      const auto text = fathom::read_file(file, 1 << 20, why);
 *      std::filesystem::remove(file);
 *      if (!text) return 1;
 *      std::printf("%s", text->c_str());
 *      return fathom::read_file(file, 1 << 20, why) ? 1 : 0; // why: "no such file"
 *  }
 *  @endcode
 */
#pragma once

#include <fathom/export.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fathom::FATHOM_V1 {

/** The bytes of a regular file, or of standard input; or nothing, and in `why` the reason. More than
 *  `limit` bytes are refused. */
FATHOM_API std::optional<std::string> read_file(const std::filesystem::path &file,
                                                std::size_t limit, std::string &why);
FATHOM_API std::optional<std::string> read_standard_input(std::size_t limit, std::string &why);

/** Writes beside the target, then renames: on any failure, a full disk included, the old file stays
 *  as it was. Signals of the terminal wait until that is done. Symbolic links are followed; a target
 *  that is no regular file (a pipe) is written in place. An empty text, or why it could not be. */
FATHOM_API std::string write_file(const std::filesystem::path &file, std::string_view bytes);

/** Several files: each is written whole beside its target before the first is renamed, so that a full
 *  disk leaves all of them as they were. `failed`: which one could not be. */
struct FileBytes {
    std::filesystem::path file;
    std::string_view bytes;
};
FATHOM_API std::string write_files(const std::vector<FileBytes> &files, std::size_t &failed);

/** Writes all bytes to an open descriptor. 0, or the `errno` of the failure. */
FATHOM_API int write_all(int descriptor, std::string_view bytes);

/** A new file beside `target`, under a hidden name: a descriptor, and the name. It stays while it is open;
    what a kill leaves of it, the next write into the folder removes. -1, and `errno`. */
FATHOM_API int make_temporary(const std::filesystem::path &target, std::string &name);

/** An `errno` in words, the same in every locale. */
FATHOM_API std::string error_words(int error);

} // namespace fathom::FATHOM_V1
