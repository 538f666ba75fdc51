#include "cli/film.h"

#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "system/system.h"

#include <fathom/files.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace fathom::cli {
namespace {

namespace fs = std::filesystem;

// How ffmpeg writes a format.
struct Format {
    const char *suffix;
    bool even; // width and height have to be
    std::vector<std::string> words;
};

const std::vector<Format> &formats() {
    // yuv420p, as most players want it: colours at half the size, hence the even sides. A GIF has
    // 256 colours, which are chosen from all of its frames.
    static const std::vector<Format> all{
        {".mp4",
         true,
         {"-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f",
          "mp4"}},
        {".webm",
         true,
         {"-c:v", "libvpx-vp9", "-crf", "28", "-b:v", "0", "-pix_fmt", "yuv420p", "-f", "webm"}},
        {".gif",
         false,
         {"-vf", "split[a][b];[a]palettegen[p];[b][p]paletteuse", "-loop", "0", "-f", "gif"}},
        {".apng", false, {"-plays", "0", "-f", "apng"}}};
    return all;
}

const Format *format_of(const std::string &out) {
    const std::string suffix = suffix_of(out);
    for (const Format &format : formats())
        if (suffix == format.suffix) return &format;
    return nullptr;
}

bool is_installed(const char *program) {
    const char *path = std::getenv("PATH");
    std::string rest = path ? path : "";
    while (!rest.empty()) {
        const std::size_t colon = rest.find(':');
        const fs::path folder = rest.substr(0, colon);
        if (::access((folder / program).c_str(), X_OK) == 0) return true;
        rest = colon == rest.npos ? "" : rest.substr(colon + 1);
    }
    return false;
}

std::vector<std::string> words_for(const Format &format, int width, int height, double frame_rate,
                                   const std::string &file) {
    std::vector<std::string> words{"ffmpeg",
                                   "-nostdin",
                                   "-loglevel",
                                   "error",
                                   "-y",
                                   "-f",
                                   "rawvideo",
                                   "-pix_fmt",
                                   "rgba",
                                   "-s",
                                   fmt::format("{}x{}", width, height),
                                   "-r",
                                   fmt::format("{}", frame_rate),
                                   "-i",
                                   "-"};
    words.insert(words.end(), format.words.begin(), format.words.end());
    words.push_back(file);
    return words;
}

} // namespace

bool is_film(const std::string &out) { return format_of(out) != nullptr; }

std::string refused_film(const std::string &out, int width, int height) {
    const Format *format = format_of(out);
    if (!is_installed("ffmpeg"))
        return fmt::format("films are written by ffmpeg, which is not installed (Debian's package "
                           "`ffmpeg`); frames need none: -o {}_####.png",
                           fs::path(out).stem().string());
    if (format->even && (width % 2 != 0 || height % 2 != 0))
        return fmt::format("a film of the suffix {} has an even width and height, not {}x{}",
                           format->suffix, width, height);
    return "";
}

std::unique_ptr<Film> Film::open(const std::string &out, int width, int height, double frame_rate,
                                 std::string &error) {
    std::unique_ptr<Film> film(new Film);
    film->target_ = out;
    std::string name;
    film->lock_ = v1::make_temporary(out, name);
    if (film->lock_ < 0) {
        error = v1::error_words(errno);
        return nullptr;
    }
    film->temporary_ = name;
    remove_on_end(name);
    const mode_t mask = ::umask(0);
    ::umask(mask);
    (void)::fchmod(film->lock_, 0666 & ~mask);
    std::array<int, 2> frames{-1, -1};
    film->words_ = system::open_memory(); // who writes there never waits
    if (film->words_ < 0 || !system::open_pipe(frames)) {
        error = v1::error_words(errno);
        return nullptr;
    }
    std::vector<std::string> words =
        words_for(*format_of(out), width, height, frame_rate, fs::absolute(name).string());
    std::vector<char *> pointers;
    for (std::string &word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    film->process_ = ::fork();
    if (film->process_ == 0) {
        ::dup2(frames[0], STDIN_FILENO);
        ::dup2(film->words_, STDERR_FILENO);
        ::dup2(film->words_, STDOUT_FILENO);
        std::signal(SIGPIPE, SIG_DFL);
        std::signal(SIGXFSZ, SIG_DFL);
        std::signal(SIGINT, SIG_IGN); // the one who feeds it decides
        ::execvp("ffmpeg", pointers.data());
        ::_exit(127);
    }
    ::close(frames[0]);
    film->frames_ = frames[1];
    if (film->process_ < 0) {
        error = v1::error_words(errno);
        return nullptr;
    }
    return film;
}

std::string Film::why(const std::string &otherwise) {
    std::string said(4096, '\0');
    const ssize_t count = ::pread(words_, said.data(), said.size(), 0);
    said.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    while (!said.empty() && said.back() == '\n') said.pop_back();
    return "ffmpeg: " + (said.empty() ? otherwise : said);
}

std::string Film::add(std::span<const std::uint8_t> rgba) {
    const int error =
        v1::write_all(frames_, {reinterpret_cast<const char *>(rgba.data()), rgba.size()});
    if (error == 0) return "";
    int status = 0;
    if (error == EPIPE) ::waitpid(process_, &status, 0), process_ = -1;
    return why(v1::error_words(error));
}

std::string Film::finish() {
    ::close(frames_);
    frames_ = -1;
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        return why(fmt::format("it ended with status {}", status));
    if (::fsync(lock_) != 0 || ::rename(temporary_.c_str(), target_.c_str()) != 0)
        return v1::error_words(errno);
    temporary_.clear();
    remove_on_end("");
    return "";
}

Film::~Film() {
    if (frames_ >= 0) ::close(frames_);
    if (process_ > 0) {
        ::kill(process_, SIGKILL);
        ::waitpid(process_, nullptr, 0);
    }
    if (words_ >= 0) ::close(words_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
    remove_on_end("");
    if (lock_ >= 0) ::close(lock_);
}

} // namespace fathom::cli
