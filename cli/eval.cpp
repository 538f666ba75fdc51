// fathom eval: the marched distance and its gradient at points, on the CPU.
#include "cli/terminal.h"
#include "cli/words.h"

#include <fathom/field.h>

#include <cerrno>
#include <fmt/format.h>
#include <new>
#include <unistd.h>

namespace fathom::cli {
namespace {

// The field at any number of points: coordinates in, printed lines out. The distance is the one
// that is marched; where the field has a kink the gradient's numbers may have taken its other side.
class PointPrinter {
  public:
    explicit PointPrinter(v1::Field field) : field_(std::move(field)) {}

    void add(const std::array<double, 3> &point) {
        points_.push_back({static_cast<float>(point[0]), static_cast<float>(point[1]),
                           static_cast<float>(point[2])});
    }

    void print(Terminal &terminal) {
        distances_.resize(points_.size());
        gradients_.resize(points_.size());
        if (!field_.gradients(points_, distances_, gradients_) ||
            !field_.distances(points_, distances_))
            throw std::bad_alloc();
        for (std::size_t k = 0; k < points_.size(); ++k)
            terminal.put(fmt::format("{:.9g} {:.9g} {:.9g} {:.9g}\n", distances_[k] + 0.0f,
                                     gradients_[k][0] + 0.0f, gradients_[k][1] + 0.0f,
                                     gradients_[k][2] + 0.0f));
        points_.clear();
    }

  private:
    v1::Field field_;
    std::vector<v1::Point> points_, gradients_;
    std::vector<float> distances_;
};

// Three numbers, separated by blanks; false where the line is something else. An empty line is no
// point.
bool read_point(std::string_view line, std::array<double, 3> &point, bool &empty) {
    constexpr std::string_view blanks = " \t\r";
    std::size_t count = 0;
    for (;;) {
        std::size_t begin = line.find_first_not_of(blanks);
        if (begin == line.npos) break;
        line.remove_prefix(begin);
        std::string_view word = line.substr(0, line.find_first_of(blanks));
        line.remove_prefix(word.size());
        std::optional<double> number = read_coordinate(word);
        if (!number || count == 3) return false;
        point[count++] = *number;
    }
    empty = count == 0;
    return empty || count == 3;
}

// Answers each block of lines as it comes, so that a program may send a point, read the answer, and
// send again.
Exit answer_standard_input(PointPrinter &evaluator, Terminal &terminal) {
    std::string pending;
    std::array<char, 1 << 16> block;
    std::size_t line_number = 0;
    bool more = true;
    while (more && !terminal.reader_gone()) {
        ssize_t count = ::read(STDIN_FILENO, block.data(), block.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) {
            terminal.say("fathom: cannot read standard input");
            return device_error;
        }
        more = count > 0;
        pending.append(block.data(), static_cast<std::size_t>(count));
        if (!more && !pending.empty() && pending.back() != '\n') pending += '\n';
        std::string_view rest = pending;
        for (std::size_t end; (end = rest.find('\n')) != rest.npos; rest.remove_prefix(end + 1)) {
            ++line_number;
            std::array<double, 3> point{};
            bool empty = false;
            if (!read_point(rest.substr(0, end), point, empty)) {
                evaluator.print(terminal);
                terminal.flush();
                terminal.say(fmt::format(
                    "fathom: line {} of the points is not `X Y Z`, none beyond 1e18", line_number));
                return usage_error;
            }
            if (!empty) evaluator.add(point);
        }
        pending.erase(0, pending.size() - rest.size());
        evaluator.print(terminal);
        if (terminal.flush() != done) return device_error;
    }
    return done;
}

} // namespace

Exit run(const EvalCommand &command, Terminal &terminal) {
    const v1::CompileResult result = v1::compile_file(
        command.scene.file, library_options(command.scene, command.time, command.time));
    if (const Exit exit = report(result, terminal); exit != done) return exit;
    if (!in_proved_time(result.scene->facts(), command.time, command.time, terminal))
        return usage_error;
    std::optional<v1::Field> field = v1::make_field(*result.scene, command.time);
    if (!field) throw std::bad_alloc();
    PointPrinter evaluator(std::move(*field));
    for (std::size_t i = 0; i + 2 < command.coordinates.size(); i += 3)
        evaluator.add(
            {command.coordinates[i], command.coordinates[i + 1], command.coordinates[i + 2]});
    for (const std::array<double, 3> &point : command.at) evaluator.add(point);
    evaluator.print(terminal);
    return command.points ? answer_standard_input(evaluator, terminal) : done;
}

} // namespace fathom::cli
