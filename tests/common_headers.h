// What nearly every test includes of other projects and the standard library, compiled once for all of them
// (tests/CMakeLists.txt). A test includes what it uses nevertheless.
#pragma once

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <sstream>
#include <string>
#include <variant>
#include <vector>
