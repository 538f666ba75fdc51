// What a scene may read: files below its own folder and the -I folders, each found, checked, read
// and remembered. A scene from a stranger reads nothing else, whatever `..` or symbolic links say.
#pragma once

#include "driver/files.h"
#include "typecheck/check.h"

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace fathom::driver {

// Resolves, checks and reads the files that one scene names, and remembers them.
class SceneFiles {
  public:
    // `scene_folder` as the user wrote it, for the names that are printed.
    SceneFiles(std::filesystem::path scene_folder,
               std::vector<std::filesystem::path> include_folders, const Limits &limits);

    // The scene's own file: registers the identity that its imports come back with.
    std::string add_root(const std::filesystem::path &file);

    typecheck::Loader loader(); // good while this lives

    // Every file that was looked up, with its state just before it was read; those that were not
    // found too, at each place where they were looked for.
    const std::map<std::filesystem::path, FileStamp> &touched() const { return touched_; }
    void touch(const std::filesystem::path &file) { touched_.try_emplace(file, stamp_of(file)); }

  private:
    struct Found {
        std::filesystem::path file;    // canonical
        std::filesystem::path printed; // as the user would write it
    };
    std::variant<Found, typecheck::LoadError> find(const std::string &path,
                                                   const std::string &from);
    std::variant<Found, typecheck::LoadError> look_for(const std::string &path,
                                                       std::filesystem::path beside);
    bool allowed(const std::filesystem::path &canonical) const;

    std::filesystem::path scene_folder_;
    std::vector<std::filesystem::path> include_folders_;
    Limits limits_;
    std::vector<std::filesystem::path> roots_;             // canonical
    std::map<std::string, std::filesystem::path> printed_; // by identity: how that file is printed
    std::map<std::filesystem::path, FileStamp> touched_;
    // What `find` said of a name beside a folder: the system is asked once.
    std::map<std::pair<std::string, std::string>, std::variant<Found, typecheck::LoadError>>
        answers_;
};

} // namespace fathom::driver
