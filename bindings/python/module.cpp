// The Python module fathom._core, over the public headers alone. Arrays go in and out without a copy where they are
// C-contiguous float32; the interpreter's lock is released while anything is computed.
#include "scene.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <mutex>

namespace py = pybind11;
using namespace pybind11::literals;

using namespace fathom_python;

namespace {

using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;

// Raises fathom.Error with the diagnostics, or gives the scene.
PyScene scene_of(fathom::CompileResult result) {
    if (result.scene)
        return {std::move(*result.scene), std::move(result.diagnostics), std::move(result.files)};
    const py::object error = py::module_::import("fathom").attr("Error");
    PyErr_SetObject(error.ptr(), error(py::cast(std::move(result.diagnostics))).ptr());
    throw py::error_already_set();
}

using Words = std::map<std::string, py::object>;

fathom::CompileOptions options_of(const std::vector<std::filesystem::path> &include,
                                  const Words &definitions, const Words &limits,
                                  const py::object &files) {
    fathom::CompileOptions options;
    options.include_folders = include;
    const auto word = [](const py::object &value) {
        return py::isinstance<py::bool_>(value) ? std::string(value.cast<bool>() ? "true" : "false")
                                                : std::string(py::str(value));
    };
    for (const auto &[name, value] : definitions) options.definitions[name] = word(value);
    for (const auto &[name, value] : limits) options.limits[name] = word(value);
    if (files.is_none()) return options;
    // Scenes are freed by any thread: the callable is, too, with the lock held.
    const std::shared_ptr<py::object> provider(new py::object(files), [](py::object *held) {
        const py::gil_scoped_acquire lock;
        delete held;
    });
    options.files = [provider](const std::string &path) -> std::optional<std::string> {
        const py::gil_scoped_acquire lock;
        const py::object bytes = (*provider)(path);
        if (bytes.is_none()) return std::nullopt;
        return bytes.cast<std::string>(); // of str or bytes
    };
    return options;
}

// What a compilation asks and tells: callables of Python, or None. What they raise ends the compilation and is raised
// after it; so does Ctrl-C, where one of them is given.
class Listener {
  public:
    Listener(const py::object &cancelled, const py::object &entered)
        : cancelled_(cancelled), entered_(entered) {}

    void listen(fathom::CompileOptions &options) {
        if (cancelled_.is_none() && entered_.is_none()) return;
        options.cancelled = [this] {
            if (raised_) return true;
            return call([this] {
                if (PyErr_CheckSignals() != 0) throw py::error_already_set();
                given_up_ = !cancelled_.is_none() && py::bool_(cancelled_());
                return given_up_;
            });
        };
        if (entered_.is_none()) return;
        options.entered = [this](fathom::Phase phase) {
            if (!raised_)
                call([&] {
                    entered_(name_of(phase));
                    return false;
                });
        };
    }

    void raise() {
        if (raised_) throw py::error_already_set(std::move(*raised_));
        if (!given_up_) return;
        PyErr_SetString(py::module_::import("fathom").attr("Cancelled").ptr(),
                        "given up by `cancelled`");
        throw py::error_already_set();
    }

  private:
    static const char *name_of(fathom::Phase phase) {
        switch (phase) {
        case fathom::Phase::Read: return "read";
        case fathom::Phase::Check: return "check";
        case fathom::Phase::Prove: return "prove";
        case fathom::Phase::Lower: return "lower";
        case fathom::Phase::Done: return "done";
        }
        return "";
    }
    template <class Work> bool call(Work work) {
        const py::gil_scoped_acquire lock;
        try {
            return work();
        } catch (py::error_already_set &error) {
            raised_ = std::make_unique<py::error_already_set>(std::move(error));
            return true;
        }
    }

    py::object cancelled_, entered_;
    std::unique_ptr<py::error_already_set> raised_;
    bool given_up_ = false;
};

// Compiles by `work`, without the interpreter's lock.
template <class Work> PyScene compiled(fathom::CompileOptions options,
                                       const fathom::ProofCache *cache, const py::object &cancelled,
                                       const py::object &entered, Work work) {
    Listener listener(cancelled, entered);
    listener.listen(options);
    if (cache) options.cache = *cache;
    fathom::CompileResult result;
    {
        const py::gil_scoped_release release;
        result = work(options);
    }
    listener.raise();
    return scene_of(std::move(result));
}

// The last axis has `width` numbers; gives the shape without it.
std::vector<py::ssize_t> shape_of(const Floats &array, py::ssize_t width, const char *what) {
    if (array.ndim() < 1 || array.shape(array.ndim() - 1) != width)
        throw py::value_error(std::string(what) + ": the last axis has to have " +
                              std::to_string(width) + " numbers");
    return {array.shape(), array.shape() + array.ndim() - 1};
}

template <class Item, class Array> std::span<const Item> items_of(const Array &array) {
    return {reinterpret_cast<const Item *>(array.data()),
            static_cast<std::size_t>(array.size()) * sizeof(float) / sizeof(Item)};
}

// Where results go: the caller's `out`, or an array of ours.
Floats target_of(const py::object &out, const std::vector<py::ssize_t> &shape) {
    if (out.is_none()) return Floats(shape);
    if (!py::isinstance<Floats>(out) || !py::array(out).writeable())
        throw py::type_error("out: wants a writeable C-contiguous array of float32");
    const Floats array = py::reinterpret_borrow<Floats>(out);
    if (!std::equal(shape.begin(), shape.end(), array.shape(), array.shape() + array.ndim()))
        throw py::value_error("out: has another shape than the points");
    return array;
}

Floats distance(PyScene &scene, const Floats &points, double time, const py::object &out) {
    check_time(scene, time);
    Floats distances = target_of(out, shape_of(points, 3, "points"));
    const auto in = items_of<fathom::Point>(points);
    const std::span<float> to(distances.mutable_data(), in.size());
    const py::gil_scoped_release release;
    if (!scene.field_at(time).distances(in, to)) throw std::bad_alloc();
    return distances;
}

py::tuple gradient(PyScene &scene, const Floats &points, double time) {
    check_time(scene, time);
    std::vector<py::ssize_t> shape = shape_of(points, 3, "points");
    Floats distances(shape);
    shape.push_back(3);
    Floats gradients(shape);
    const auto in = items_of<fathom::Point>(points);
    const std::span<float> to(distances.mutable_data(), in.size());
    const std::span<fathom::Point> along(
        reinterpret_cast<fathom::Point *>(gradients.mutable_data()), in.size());
    {
        const py::gil_scoped_release release;
        if (!scene.field_at(time).gradients(in, to, along)) throw std::bad_alloc();
    }
    return py::make_tuple(distances, gradients);
}

Floats interval(PyScene &scene, const Floats &boxes, double time) {
    check_time(scene, time);
    if (boxes.ndim() < 2 || boxes.shape(boxes.ndim() - 2) != 2 ||
        boxes.shape(boxes.ndim() - 1) != 3)
        throw py::value_error(
            "boxes: the last axes have to be 2 and 3, of the lower and the upper corner");
    Floats intervals(std::vector<py::ssize_t>(boxes.shape(), boxes.shape() + boxes.ndim() - 1));
    const auto in = items_of<fathom::Box>(boxes);
    const std::span<fathom::Interval> to(
        reinterpret_cast<fathom::Interval *>(intervals.mutable_data()), in.size());
    const py::gil_scoped_release release;
    if (!scene.field_at(time).intervals(in, to)) throw std::bad_alloc();
    return intervals;
}

py::array volume(PyScene &scene, const py::object &counts, const py::object &lo,
                 const py::object &hi, double time) {
    check_time(scene, time);
    const std::array<py::ssize_t, 3> n = three<py::ssize_t>(counts, "counts");
    fathom::Box box;
    if (lo.is_none() != hi.is_none()) throw py::value_error("lo and hi: give both, or none");
    if (!lo.is_none()) {
        box = {three<float>(lo, "lo"), three<float>(hi, "hi")};
    } else {
        if (!scene.scene.facts().bounds)
            throw py::value_error("the scene has no end: give lo and hi");
        box = *scene.scene.facts().bounds;
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (n[axis] < 2 || !(box.lo[axis] < box.hi[axis]))
            throw py::value_error("counts: 2 or more along each axis; lo: below hi");
    // Indexed by [x, y, z]; in memory x is the fastest, as in files of grids.
    const auto float_size = static_cast<py::ssize_t>(sizeof(float));
    py::array_t<float> made(
        std::vector<py::ssize_t>{n[0], n[1], n[2]},
        std::vector<py::ssize_t>{float_size, float_size * n[0], float_size * n[0] * n[1]});
    const std::span<float> to(made.mutable_data(), static_cast<std::size_t>(n[0] * n[1] * n[2]));
    {
        const py::gil_scoped_release release;
        const std::array<std::size_t, 3> count{static_cast<std::size_t>(n[0]),
                                               static_cast<std::size_t>(n[1]),
                                               static_cast<std::size_t>(n[2])};
        if (!scene.field_at(time).volume(box, count, to)) throw std::bad_alloc();
    }
    return made;
}

py::array render(PyScene &scene, int width, int height, int samples, double time, unsigned threads,
                 int max_steps, const py::object &progress) {
    check_time(scene, time);
    if (width < 1 || height < 1 || width > 65536 || height > 65536 || samples < 0)
        throw py::value_error("width and height: 1 to 65536; samples: 0 or more");
    Progress told(progress);
    fathom::PictureOptions options;
    options.width = width;
    options.height = height;
    options.samples = samples;
    options.time = time;
    options.threads = threads;
    options.max_steps = max_steps;
    options.progress = told.callback();
    std::unique_ptr<fathom::Picture> picture;
    {
        const py::gil_scoped_release release;
        picture = std::make_unique<fathom::Picture>(fathom::draw(scene.scene, options));
    }
    told.raise();
    if (!picture->complete) throw std::bad_alloc();
    if (picture->undecided > 0) {
        const std::string words =
            std::to_string(picture->undecided) +
            " rays are undecided; they show what they are nearest to (max_steps: allows more)";
        if (PyErr_WarnEx(PyExc_RuntimeWarning, words.c_str(), 1) != 0)
            throw py::error_already_set();
    }
    const std::uint8_t *bytes = picture->rgba.data();
    const py::capsule owner(picture.release(),
                            [](void *held) { delete static_cast<fathom::Picture *>(held); });
    return py::array_t<std::uint8_t>(std::vector<py::ssize_t>{height, width, 4}, bytes, owner);
}

fathom::Shader shader(const PyScene &scene, const std::string &target, bool field_only,
                      bool buffers, double time, const std::string &title) {
    fathom::ShaderOptions options{target, field_only, buffers, time, title};
    std::vector<fathom::Diagnostic> said;
    std::optional<fathom::Shader> made;
    {
        const py::gil_scoped_release release;
        made = fathom::make_shader(scene.scene, options, &said);
    }
    if (made) return std::move(*made);
    const py::object error = py::module_::import("fathom").attr("Error");
    PyErr_SetObject(error.ptr(), error(py::cast(std::move(said))).ptr());
    throw py::error_already_set();
}

// What a param is given: a number, or the parts of a vector.
std::vector<double> numbers_of(const std::string &name, py::handle value) {
    try {
        return py::isinstance<py::sequence>(value) ? value.cast<std::vector<double>>()
                                                   : std::vector<double>{value.cast<double>()};
    } catch (const py::cast_error &) {
        throw py::value_error("with_params(" + name +
                              "=…): a param takes a number, or a sequence of "
                              "numbers, not " +
                              py::repr(value).cast<std::string>());
    }
}

PyScene with_params(const PyScene &scene, const py::kwargs &values) {
    std::map<std::string, std::vector<double>> numbers;
    for (const auto &[name, value] : values)
        numbers[name.cast<std::string>()] = numbers_of(name.cast<std::string>(), value);
    fathom::CompileResult result;
    {
        const py::gil_scoped_release release;
        result = scene.scene.with(numbers);
    }
    return scene_of(std::move(result));
}

void add_scene(py::module_ &m) {
    py::class_<PyScene> scenes(m, "Scene",
                               "A scene that compiled. It never changes; threads may share it.");
    add_solids(scenes);
    scenes
        .def_property_readonly(
            "params", [](const PyScene &s) { return s.scene.params(); }, "the params, in order")
        .def_property_readonly(
            "facts", [](const PyScene &s) { return s.scene.facts(); }, "what was proved")
        .def_readonly("diagnostics", &PyScene::diagnostics, "warnings and notes")
        .def_readonly("files", &PyScene::files, "what was read or looked for")
        .def("with_params", &with_params,
             "The scene with other values of params: `scene.with_params(radius=1.5)`. Raises Error "
             "for a name that there "
             "is not or a value out of its range.")
        .def("distance", &distance, "points"_a, "time"_a = 0.0, "out"_a = py::none(),
             "The marched distance at points: (..., 3) to (...) float32. Negative inside, and "
             "never more than the "
             "distance to the surface. C-contiguous float32 is read where it lies; other arrays "
             "are converted.")
        .def("gradient", &gradient, "points"_a, "time"_a = 0.0,
             "Distances (...) and gradients (..., 3); at a kink, one side's.")
        .def("interval", &interval, "boxes"_a, "time"_a = 0.0,
             "What the distance lies within over boxes: (..., 2, 3) to (..., 2).")
        .def("volume", &volume, "counts"_a, "lo"_a = py::none(), "hi"_a = py::none(),
             "time"_a = 0.0,
             "Distances at a lattice that fills a box, its faces among them, indexed by [x, y, z]. "
             "The box is that of "
             "the solids unless said.")
        .def("render", &render, "width"_a = 640, "height"_a = 360, "samples"_a = 0, "time"_a = 0.0,
             "threads"_a = 0, "max_steps"_a = 0, "progress"_a = py::none(),
             "A picture: (height, width, 4) uint8, sRGB, rows from the top. `progress` is called "
             "with the share that "
             "is done; False gives up (Cancelled).")
        .def("shader", &shader, "target"_a = "glsl330", "field_only"_a = false, "buffers"_a = false,
             "time"_a = 0.0, "title"_a = "scene", "The scene as a shader for a target.")
        .def(
            "yaml", [](const PyScene &s) { return fathom::export_yaml(s.scene); },
            "The scene in the YAML save format.");
}

} // namespace

PYBIND11_MODULE(_core, m) {
    m.doc() = "Fathom's library; `import fathom` is the way in.";
    fathom_python::add_data(m);
    fathom_python::add_mesh(m);
    add_scene(m);
    py::class_<fathom::ProofCache>(m, "ProofCache",
                                   "What compilations found of fields, for the next ones of an "
                                   "edited text: given to each, only "
                                   "what an edit touches is proved anew. It changes nothing else.")
        .def(py::init(
                 [](std::size_t most_bytes) { return fathom::ProofCache::of_bytes(most_bytes); }),
             "most_bytes"_a = std::size_t{32} << 20)
        .def_property_readonly("searches", &fathom::ProofCache::searches,
                               "How many bounds were not in it when they were wanted.")
        .def_property_readonly("bytes", &fathom::ProofCache::bytes, "How many bytes it holds.");
    m.def(
        "compile",
        [](const std::string &text, const std::string &name,
           const std::vector<std::filesystem::path> &include, const Words &definitions,
           const Words &limits, const py::object &files, const fathom::ProofCache *cache,
           const py::object &cancelled, const py::object &entered) {
            return compiled(options_of(include, definitions, limits, files), cache, cancelled,
                            entered, [&](const fathom::CompileOptions &options) {
                                return fathom::compile_text(name, text, options);
                            });
        },
        "text"_a, "name"_a = "scene.sdf", "include"_a = std::vector<std::filesystem::path>(),
        "definitions"_a = Words(), "limits"_a = Words(), "files"_a = py::none(),
        "cache"_a = nullptr, "cancelled"_a = py::none(), "entered"_a = py::none(),
        "Compiles text; raises Error where it has an error. `files` gives the bytes of a path or "
        "None; without it "
        "imports are files. `definitions` sets params by expressions, `limits` what a scene may "
        "cost.");
    m.def(
        "load",
        [](const std::filesystem::path &path, const std::vector<std::filesystem::path> &include,
           const Words &definitions, const Words &limits, const fathom::ProofCache *cache,
           const py::object &cancelled, const py::object &entered) {
            return compiled(options_of(include, definitions, limits, py::none()), cache, cancelled,
                            entered, [&](const fathom::CompileOptions &options) {
                                return fathom::compile_file(path, options);
                            });
        },
        "path"_a, "include"_a = std::vector<std::filesystem::path>(), "definitions"_a = Words(),
        "limits"_a = Words(), "cache"_a = nullptr, "cancelled"_a = py::none(),
        "entered"_a = py::none(),
        "Compiles a .sdf file or a save file (.yaml); raises Error where it has an error.");
    m.def("format_text", py::overload_cast<std::string_view>(&fathom::format_text), "text"_a,
          "The text in its one form, or None where it cannot be parsed.");
    m.def("library_entries", &fathom::library_entries, "The functions of the standard library.");
    m.def("shader_targets", &fathom::shader_targets, "What `Scene.shader` can write.");
    m.attr("__version__") = std::string(fathom::version());
}
