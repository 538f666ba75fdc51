#include "driver/scene_files.h"

#include "driver/image.h"

#include <algorithm>

namespace fathom::driver {

namespace fs = std::filesystem;
using typecheck::LoadedText;
using typecheck::LoadError;

SceneFiles::SceneFiles(fs::path scene_folder, std::vector<fs::path> include_folders,
                       const Limits &limits)
    : scene_folder_(std::move(scene_folder)), include_folders_(std::move(include_folders)),
      limits_(limits) {
    std::error_code error;
    auto add = [&](const fs::path &folder) {
        fs::path canonical = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
        if (!error) roots_.push_back(canonical);
    };
    add(scene_folder_);
    for (const fs::path &folder : include_folders_) add(folder);
}

std::string SceneFiles::add_root(const fs::path &file) {
    std::error_code error;
    fs::path canonical = fs::weakly_canonical(file, error);
    std::string identity = (error ? file : canonical).string();
    printed_[identity] = file;
    return identity;
}

bool SceneFiles::allowed(const fs::path &canonical) const {
    return std::any_of(roots_.begin(), roots_.end(), [&](const fs::path &root) {
        return std::mismatch(root.begin(), root.end(), canonical.begin(), canonical.end()).first ==
               root.end();
    });
}

std::variant<SceneFiles::Found, LoadError> SceneFiles::find(const std::string &path,
                                                            const std::string &from) {
    if (auto error = typecheck::too_long(path)) return *error;
    if (path.empty()) return LoadError{LoadError::Reason::NotFound, "a file has a name"};
    auto importer = printed_.find(from);
    fs::path beside = importer == printed_.end() ? scene_folder_ : importer->second.parent_path();
    const auto [answer, is_new] = answers_.try_emplace({beside.string(), path});
    if (is_new) answer->second = look_for(path, std::move(beside));
    return answer->second;
}

std::variant<SceneFiles::Found, LoadError> SceneFiles::look_for(const std::string &path,
                                                                fs::path beside) {
    std::vector<fs::path> folders{std::move(beside)};
    folders.insert(folders.end(), include_folders_.begin(), include_folders_.end());

    bool outside = false;
    for (const fs::path &folder : folders) {
        fs::path printed = (folder / path).lexically_normal();
        std::error_code error;
        // Of a name without a folder that does not exist, weakly_canonical makes nothing absolute.
        fs::path canonical = fs::weakly_canonical(fs::absolute(printed, error), error);
        // What lies outside is not even looked up: whether such a file exists is nobody's business.
        if (error || !allowed(canonical)) {
            outside = true;
            continue;
        }
        touch(printed);
        if (fs::is_regular_file(canonical, error)) return Found{canonical, printed};
        if (fs::exists(canonical, error))
            return LoadError{LoadError::Reason::Unreadable, "is not a regular file"};
    }
    if (outside)
        return LoadError{LoadError::Reason::Outside,
                         "leads out of the scene's folder and the -I folders"};
    return LoadError{LoadError::Reason::NotFound, "no such file"};
}

namespace {

LoadError unreadable(std::string why) { return {LoadError::Reason::Unreadable, std::move(why)}; }

} // namespace

typecheck::Loader SceneFiles::loader() {
    auto text = [this](const std::string &path,
                       const std::string &from) -> std::variant<LoadedText, LoadError> {
        auto found = find(path, from);
        if (auto *error = std::get_if<LoadError>(&found)) return *error;
        const Found &file = std::get<Found>(found);
        std::string error;
        std::optional<std::string> bytes = read_file(file.file, limits_.source * mebibyte, error);
        if (!bytes) return unreadable(error);
        std::string identity = file.file.string();
        auto [known, is_new] = printed_.try_emplace(identity, file.printed);
        return LoadedText{identity, known->second.string(), std::move(*bytes)};
    };
    auto identity = [this](const std::string &path,
                           const std::string &from) -> std::variant<std::string, LoadError> {
        auto found = find(path, from);
        if (auto *error = std::get_if<LoadError>(&found)) return *error;
        return std::get<Found>(found).file.string();
    };
    // Images and grids differ in the decoder alone.
    auto asset = [this]<class Data, class... More>(std::variant<Data, LoadError> (*decode)(
                     std::string_view, Room &, const More &...)) {
        return [this, decode](const std::string &path, const std::string &from, Room &room,
                              const More &...more) -> std::variant<Data, LoadError> {
            auto found = find(path, from);
            if (auto *error = std::get_if<LoadError>(&found)) return *error;
            const auto &[file, printed] = std::get<Found>(found);
            if (stamp_of(file).size > room.bytes)
                return LoadError{LoadError::Reason::TooLarge, "takes more memory than is left"};
            std::string error;
            std::optional<std::string> bytes = read_file(file, room.bytes, error);
            if (!bytes) return unreadable(error);
            std::variant<Data, LoadError> data = decode(*bytes, room, more...);
            if (auto *made = std::get_if<Data>(&data))
                made->name = path, made->file = printed.string();
            return data;
        };
    };
    return {identity, text, asset(decode_image), asset(decode_grid)};
}

} // namespace fathom::driver
