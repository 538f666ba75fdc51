// The classes of Python that hold data alone.
#pragma once

#include <pybind11/pybind11.h>

namespace fathom_python {

void add_data(pybind11::module_ &m); // all but meshes
void add_mesh(pybind11::module_ &m);

} // namespace fathom_python
