// What the library gives out, as classes of Python: diagnostics, params, facts, shaders, meshes.
#include "data.h"

#include <fathom/fathom.h>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>

namespace py = pybind11;
using namespace pybind11::literals;

namespace fathom_python {
namespace {

// An array over what a value holds; the value lives as long as the array.
template <class Item, class Number>
py::array_t<Number> rows(const std::vector<Item> &items, const py::object &owner) {
    const auto width = static_cast<py::ssize_t>(sizeof(Item) / sizeof(Number));
    return py::array_t<Number>(
        std::vector<py::ssize_t>{static_cast<py::ssize_t>(items.size()), width},
        reinterpret_cast<const Number *>(items.data()), owner);
}

py::object value_of(const fathom::Param &param, const std::array<double, 4> &value) {
    const auto number = [&](std::size_t i) -> py::object {
        if (param.type == fathom::Param::Type::Bool) return py::bool_(value[i] != 0);
        if (param.type == fathom::Param::Type::Int && std::abs(value[i]) < 1e15)
            return py::int_(static_cast<long long>(value[i]));
        return py::float_(value[i]);
    };
    const auto count = static_cast<std::size_t>(components(param.type));
    if (count == 1) return number(0);
    py::tuple all(count);
    for (std::size_t i = 0; i < count; ++i) all[i] = number(i);
    return all;
}

const char *name_of(fathom::Severity severity) {
    switch (severity) {
    case fathom::Severity::Error: return "error";
    case fathom::Severity::Warning: return "warning";
    case fathom::Severity::Note: return "note";
    }
    return "";
}

const char *name_of(fathom::Status status) {
    switch (status) {
    case fathom::Status::Proved: return "proved";
    case fathom::Status::Assumed: return "assumed";
    case fathom::Status::Estimated: return "estimated";
    }
    return "";
}

} // namespace

void add_data(py::module_ &m) {
    py::class_<fathom::Place>(
        m, "Place", "A stretch of a text; lines and columns count from 1, line is 0 for no place.")
        .def_readonly("file", &fathom::Place::file)
        .def_readonly("line", &fathom::Place::line)
        .def_readonly("column", &fathom::Place::column)
        .def_readonly("end_line", &fathom::Place::end_line)
        .def_readonly("end_column", &fathom::Place::end_column);
    py::class_<fathom::Diagnostic>(m, "Diagnostic",
                                   "An error, a warning or a note, with its place.")
        .def_property_readonly("severity",
                               [](const fathom::Diagnostic &d) { return name_of(d.severity); })
        .def_readonly("code", &fathom::Diagnostic::code)
        .def_readonly("message", &fathom::Diagnostic::message)
        .def_readonly("at", &fathom::Diagnostic::at)
        .def_readonly("notes", &fathom::Diagnostic::notes)
        .def_readonly("help", &fathom::Diagnostic::help)
        .def("__repr__", [](const fathom::Diagnostic &d) {
            const std::string place = d.at.line ? d.at.file + ":" + std::to_string(d.at.line) +
                                                      ":" + std::to_string(d.at.column) + ": "
                                                : "";
            return place + name_of(d.severity) + "[" + d.code + "]: " + d.message +
                   (d.help.empty() ? "" : "; " + d.help);
        });
    py::class_<fathom::Param>(m, "Param", "A param of a scene, with its present value.")
        .def_readonly("name", &fathom::Param::name)
        .def_readonly("label", &fathom::Param::label)
        .def_readonly("color", &fathom::Param::color)
        .def_readonly("structural", &fathom::Param::structural)
        .def_property_readonly("value", [](const fathom::Param &p) { return value_of(p, p.value); })
        .def_property_readonly("initial",
                               [](const fathom::Param &p) { return value_of(p, p.initial); })
        .def_property_readonly("range", [](const fathom::Param &p) -> py::object {
            if (!p.ranged) return py::none();
            return py::make_tuple(value_of(p, p.lo), value_of(p, p.hi));
        });
    py::class_<fathom::Facts>(
        m, "Facts", "What is known of a scene, for all values of its params and all its times.")
        .def_readonly("lipschitz", &fathom::Facts::lipschitz)
        .def_property_readonly("status", [](const fathom::Facts &f) { return name_of(f.status); })
        .def_readonly("exact", &fathom::Facts::exact)
        .def_readonly("time_end", &fathom::Facts::time_end)
        .def_readonly("axioms", &fathom::Facts::axioms)
        .def_property_readonly("bounds", [](const fathom::Facts &f) -> py::object {
            if (!f.bounds) return py::none();
            return py::make_tuple(f.bounds->lo, f.bounds->hi);
        });
    py::class_<fathom::ShaderInput>(m, "ShaderInput", "A uniform that the host sets.")
        .def_readonly("type", &fathom::ShaderInput::type)
        .def_readonly("name", &fathom::ShaderInput::name)
        .def_readonly("value", &fathom::ShaderInput::value)
        .def_readonly("meaning", &fathom::ShaderInput::meaning)
        .def_readonly("param", &fathom::ShaderInput::param)
        .def_readonly("place", &fathom::ShaderInput::place);
    py::class_<fathom::Shader>(m, "Shader",
                               "A checked shader and what a host has to bind (docs/shaders.md).")
        .def_readonly("text", &fathom::Shader::text)
        .def_property_readonly("words",
                               [](const fathom::Shader &s) {
                                   return py::bytes(reinterpret_cast<const char *>(s.words.data()),
                                                    s.words.size() * sizeof(s.words[0]));
                               })
        .def_readonly("inputs", &fathom::Shader::inputs)
        .def_readonly("reads_time", &fathom::Shader::reads_time)
        .def_readonly("reflection", &fathom::Shader::reflection);
    py::class_<fathom::LibraryEntry>(m, "LibraryEntry", "A function of the standard library.")
        .def_readonly("name", &fathom::LibraryEntry::name)
        .def_readonly("signature", &fathom::LibraryEntry::signature)
        .def_readonly("doc", &fathom::LibraryEntry::doc)
        .def_readonly("module", &fathom::LibraryEntry::module);
    py::class_<fathom::MeshCertificate>(m, "MeshCertificate",
                                        "What is proved of a mesh (docs/meshes.md).")
        .def_readonly("certified", &fathom::MeshCertificate::certified)
        .def_readonly("mesh_to_surface", &fathom::MeshCertificate::mesh_to_surface)
        .def_readonly("surface_to_mesh", &fathom::MeshCertificate::surface_to_mesh)
        .def_readonly("least_volume", &fathom::MeshCertificate::least_volume)
        .def_readonly("largest_volume", &fathom::MeshCertificate::largest_volume)
        .def_readonly("least_area", &fathom::MeshCertificate::least_area)
        .def_readonly("largest_area", &fathom::MeshCertificate::largest_area)
        .def_readonly("components", &fathom::MeshCertificate::components)
        .def_readonly("genus", &fathom::MeshCertificate::genus)
        .def_readonly("shape_proved", &fathom::MeshCertificate::shape_proved)
        .def_readonly("shape_why", &fathom::MeshCertificate::shape_why)
        .def_readonly("area_why", &fathom::MeshCertificate::area_why)
        .def_readonly("shape_doubted", &fathom::MeshCertificate::shape_doubted);
}

void add_mesh(py::module_ &m) {
    const auto ends = [](const fathom::Enclosure &e) { return std::pair(e.lo, e.hi); };
    const auto rows_of = [ends](const std::array<fathom::Enclosure, 3> &rows) {
        return std::array{ends(rows[0]), ends(rows[1]), ends(rows[2])};
    };
    using fathom::Measures, fathom::Clearance;
    py::class_<Measures>(m, "Measures",
                         "What a solid measures: pairs are proved, what is named mesh is not.")
        .def_property_readonly(
            "volume", [ends](const Measures &of) { return ends(of.volume); },
            "the least that it can be, and the most")
        .def_property_readonly(
            "center", [rows_of](const Measures &of) { return rows_of(of.center); },
            "such a pair for x, y and z")
        .def_property_readonly(
            "least", [rows_of](const Measures &of) { return rows_of(of.least); },
            "of the box's least corner, for x, y and z")
        .def_property_readonly(
            "greatest", [rows_of](const Measures &of) { return rows_of(of.greatest); },
            "of the box's greatest corner, for x, y and z")
        .def_readonly("mesh_volume", &Measures::mesh_volume)
        .def_readonly("mesh_area", &Measures::mesh_area)
        .def_readonly("mesh_center", &Measures::mesh_center)
        .def_readonly("components", &Measures::components)
        .def_readonly("genus", &Measures::genus)
        .def_readonly("rests_on", &Measures::rests_on);
    py::class_<Clearance>(m, "Clearance", "How far two solids are apart.")
        .def_property_readonly(
            "distance", [ends](const Clearance &of) { return ends(of.distance); },
            "the least that it can be, and the most; (0, 0) where they have points in common")
        .def_readonly("near", &Clearance::near, "a point of each, so far apart as the most")
        .def_readonly("rests_on", &Clearance::rests_on);
    py::class_<fathom::Mesh>(m, "Mesh",
                             "A closed mesh; its arrays are the mesh's own memory, not copies.")
        .def_property_readonly(
            "vertices",
            [](const py::object &self) {
                return rows<fathom::Point, float>(self.cast<const fathom::Mesh &>().vertices, self);
            },
            "(n, 3) float32, in the scene's units")
        .def_property_readonly(
            "normals",
            [](const py::object &self) {
                return rows<fathom::Point, float>(self.cast<const fathom::Mesh &>().normals, self);
            },
            "(n, 3) float32, of length 1")
        .def_property_readonly(
            "triangles",
            [](const py::object &self) {
                return rows<std::array<std::uint32_t, 3>, std::uint32_t>(
                    self.cast<const fathom::Mesh &>().triangles, self);
            },
            "(m, 3) uint32, counterclockwise from outside")
        .def_property_readonly(
            "colors",
            [](const py::object &self) {
                return rows<std::array<float, 3>, float>(self.cast<const fathom::Mesh &>().colors,
                                                         self);
            },
            "(n, 3) float32, linear, 0..1: the surface's own colour at each vertex")
        .def_readonly("undecided_cells", &fathom::Mesh::undecided_cells,
                      "cells that may hold surface that the mesh does not show")
        .def_readonly("certificate", &fathom::Mesh::certificate)
        .def(
            "file",
            [](const fathom::Mesh &self, const std::string &suffix, const std::string &name) {
                const std::optional<fathom::MeshFormat> format =
                    fathom::mesh_format("mesh" + suffix);
                if (!format) throw py::value_error("suffix: .stl, .obj, .ply, .glb or .3mf");
                const std::string bytes = fathom::mesh_file(self, *format, name);
                if (bytes.empty()) throw py::value_error("the mesh is more than the format holds");
                return py::bytes(bytes);
            },
            "suffix"_a, "name"_a = "scene",
            "The bytes of a file: `suffix` is .stl, .obj, .ply, .glb or .3mf.");
}

} // namespace fathom_python
