// Of scenes: meshes, measures and parts.
#include "scene.h"

using namespace pybind11::literals;

namespace fathom_python {
namespace {

// What a mesh and its measures share. `told` has to outlive the options.
fathom::MeshOptions mesh_options(PyScene &scene, int resolution, double tolerance, double time,
                                 const py::object &lo, const py::object &hi, unsigned threads,
                                 Progress &told) {
    check_time(scene, time);
    if (lo.is_none() != hi.is_none()) throw py::value_error("lo and hi: give both, or none");
    fathom::MeshOptions options;
    options.resolution = resolution;
    options.tolerance = tolerance;
    options.time = time;
    options.threads = threads;
    options.progress = told.callback();
    if (!lo.is_none()) options.bounds = fathom::Box{three<float>(lo, "lo"), three<float>(hi, "hi")};
    return options;
}

fathom::Mesh mesh(PyScene &scene, int resolution, double tolerance, double time,
                  const py::object &lo, const py::object &hi, bool certify, bool colors,
                  double simplify, unsigned threads, const py::object &progress) {
    Progress told(progress);
    fathom::MeshOptions options =
        mesh_options(scene, resolution, tolerance, time, lo, hi, threads, told);
    options.certify = certify;
    options.colors = colors;
    options.simplify = simplify;
    fathom::Mesh made;
    {
        const py::gil_scoped_release release;
        made = fathom::make_mesh(scene.scene, options);
    }
    told.raise();
    if (!made) throw py::value_error("no mesh: " + made.message);
    return made;
}

PyScene part(const PyScene &scene, const std::string &name) {
    std::optional<fathom::Scene> made = fathom::part_of(scene.scene, name);
    if (made) return PyScene{std::move(*made), {}, scene.files};
    std::string known;
    for (const fathom::Part &one : fathom::parts_of(scene.scene))
        known += (known.empty() ? "" : ", ") + one.name;
    throw py::value_error("there is no part `" + name + "`; this scene has " + known);
}

fathom::Measures measure(PyScene &scene, int resolution, double tolerance, double time,
                         const py::object &lo, const py::object &hi, unsigned threads,
                         const py::object &progress) {
    Progress told(progress);
    const fathom::MeshOptions options =
        mesh_options(scene, resolution, tolerance, time, lo, hi, threads, told);
    fathom::Measures made;
    {
        const py::gil_scoped_release release;
        made = fathom::measure(scene.scene, options);
    }
    told.raise();
    if (!made) throw py::value_error("no measures: " + made.message);
    return made;
}

fathom::Clearance clearance(const PyScene &scene, const PyScene &other, double tolerance,
                            double time, const py::object &progress) {
    check_time(scene, time);
    Progress told(progress);
    fathom::Clearance made;
    {
        const auto callback = told.callback();
        const py::gil_scoped_release release;
        made = fathom::clearance(scene.scene, other.scene, tolerance, time, callback);
    }
    told.raise();
    if (!made) throw py::value_error("no clearance: " + made.message);
    return made;
}

} // namespace

void add_solids(py::class_<PyScene> &scene) {
    scene
        .def("mesh", &mesh, "resolution"_a = 128, "tolerance"_a = 0.0, "time"_a = 0.0,
             "lo"_a = py::none(), "hi"_a = py::none(), "certify"_a = false, "colors"_a = false,
             "simplify"_a = 0.0, "threads"_a = 0, "progress"_a = py::none(),
             "The surface as triangles. Raises ValueError where there is none, and says why.")
        .def_property_readonly(
            "parts",
            [](const PyScene &s) {
                std::vector<std::string> names;
                for (const fathom::Part &part : fathom::parts_of(s.scene))
                    names.push_back(part.name);
                return names;
            },
            "the names of the parts, in the order of the text")
        .def("part", &part, "name"_a,
             "The scene with that part alone. Raises ValueError where there is none.")
        .def("measure", &measure, "resolution"_a = 128, "tolerance"_a = 0.0, "time"_a = 0.0,
             "lo"_a = py::none(), "hi"_a = py::none(), "threads"_a = 0, "progress"_a = py::none(),
             "Volume, centre and box, each between two numbers that are proved. Raises ValueError "
             "where there is no solid, or none with an end.")
        .def("clearance", &clearance, "other"_a, "tolerance"_a, "time"_a = 0.0,
             "progress"_a = py::none(), "How far this solid and another scene's are apart.");
}

} // namespace fathom_python
