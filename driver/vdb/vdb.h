// OpenVDB files. They are written by the module libfathom-vdb, which is loaded with the first of them,
// as OpenVDB takes longer to load than most commands run; and read by the program fathom-read-vdb, as
// OpenVDB crashes on some broken files (driver/vdb/module). Both are looked for beside the code that
// asks, in a folder `fathom` beside it, and where they are installed.
#pragma once

#include "driver/image.h"
#include "driver/vdb/module/interface.h"

#include <string>
#include <string_view>
#include <variant>

namespace fathom::driver {

// Null and words where there is no module: a build without OpenVDB, or one that cannot be loaded.
FathomWriteVdb vdb_writer(std::string &why);

// Does a file begin as OpenVDB's do?
bool is_vdb(std::string_view bytes);

// The grid of floats or doubles that is called `name` or, where that is empty, a file's only level
// set or its only grid of these, with the box of its voxels made dense. Takes as much off `room` as decode_grid does; the program that reads may take twice
// what is left there, and half a GiB, while it does.
std::variant<ir::GridData, LoadError> decode_vdb(std::string_view bytes, Room &room,
                                                 const std::string &name);

} // namespace fathom::driver
