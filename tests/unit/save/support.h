// What the tests of the save format share: import and check of text in memory, and values compared
// as data.
#pragma once

#include "base/diagnostic.h"
#include "save-format/save_format.h"
#include "save-format/yaml_reader.h"
#include "typecheck/check.h"

#include <memory>
#include <string>

namespace save_test {

using namespace fathom;

struct Imported {
    std::unique_ptr<Sources> sources = std::make_unique<Sources>();
    Diagnostics diagnostics;
    save::ImportResult result;
    std::string said() const; // a line for each diagnostic: "line:column code message"
};
Imported import_text(std::string yaml, save::ImportOptions options = {});

struct CheckedText {
    std::unique_ptr<Sources> sources = std::make_unique<Sources>();
    Diagnostics diagnostics;
    typecheck::Checked checked;
    std::string errors() const;
};
CheckedText check_text(std::string sdf); // with the whole library; images are 1x1

std::string export_text(const ir::Scene &scene);

// The first place where two files differ as data ("1.0" is 1, a key's order in its mapping is
// nothing); empty for none.
std::string difference(const save::Value &a, const save::Value &b, const std::string &place = "");

// A file around a list of nodes, one a line, each in flow form.
std::string file_of(const std::string &nodes, const std::string &materials = "[]");

} // namespace save_test
