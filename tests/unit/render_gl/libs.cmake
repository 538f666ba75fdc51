find_package(PkgConfig REQUIRED)
pkg_check_modules(epoxy REQUIRED IMPORTED_TARGET GLOBAL epoxy)
set(libs fathom_gl PkgConfig::epoxy)
