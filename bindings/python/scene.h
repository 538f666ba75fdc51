// What the module's files share: a scene as Python holds it, and callbacks of Python.
#pragma once

#include "data.h"

#include <fathom/fathom.h>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <mutex>

namespace fathom_python {

namespace py = pybind11;

// A scene with the field of the time that was asked for last.
struct PyScene {
    fathom::Scene scene;
    std::vector<fathom::Diagnostic> diagnostics;
    std::vector<std::filesystem::path> files;
    std::shared_ptr<std::mutex> mutex = std::make_shared<std::mutex>();
    std::optional<std::pair<double, fathom::Field>> field{};

    fathom::Field field_at(double time) {
        const std::lock_guard lock(*mutex);
        if (!field || field->first != time) {
            std::optional<fathom::Field> made = fathom::make_field(scene, time);
            if (!made) throw std::bad_alloc();
            field.emplace(time, std::move(*made));
        }
        return field->second;
    }
};

// A callback of Python as one of the library's. What it raises cancels the work and is raised after it; so does Ctrl-C.
class Progress {
  public:
    explicit Progress(const py::object &function) : function_(function) {}
    std::function<bool(double)> callback() {
        return [this](double done) {
            if (raised_) return false;
            const py::gil_scoped_acquire lock;
            try {
                if (PyErr_CheckSignals() != 0) throw py::error_already_set();
                if (function_.is_none()) return true;
                const py::object answer = function_(done);
                cancelled_ = !answer.is_none() && !answer.cast<bool>();
                return !cancelled_;
            } catch (py::error_already_set &error) {
                raised_ = std::make_unique<py::error_already_set>(std::move(error));
                return false;
            } catch (const py::cast_error &) {
                cancelled_ = true;
                return false;
            }
        };
    }
    void raise() {
        if (raised_) throw py::error_already_set(std::move(*raised_));
        if (!cancelled_) return;
        PyErr_SetString(py::module_::import("fathom").attr("Cancelled").ptr(),
                        "given up by `progress`");
        throw py::error_already_set();
    }

  private:
    py::object function_;
    std::unique_ptr<py::error_already_set> raised_;
    bool cancelled_ = false;
};

inline void check_time(const PyScene &scene, double time) {
    if (!fathom::hold_at(scene.scene.facts(), time))
        throw py::value_error("time: the scene is proved from 0 to " +
                              std::string(py::str(py::float_(scene.scene.facts().time_end))) +
                              " seconds");
}

// Numbers of a box and of a lattice, as sequences or one number for all axes.
template <class Number> std::array<Number, 3> three(const py::object &value, const char *what) {
    if (py::isinstance<py::int_>(value) || py::isinstance<py::float_>(value)) {
        const auto number = value.cast<Number>();
        return {number, number, number};
    }
    try {
        return value.cast<std::array<Number, 3>>();
    } catch (const py::cast_error &) {
        throw py::type_error(std::string(what) + ": wants three numbers, or one for all axes");
    }
}

void add_solids(py::class_<PyScene> &scene); // meshes, measures, parts

} // namespace fathom_python
