// Save files as text: values in block form, the way the thesis prints them. What it writes,
// yaml_reader reads back as the same. It does not use libyaml's emitter, which keeps neither the
// indentation of sequences below their key nor keys of more than 128 characters
// (docs/decisions/0006-our-own-yaml-writer.md).
#pragma once

#include "save-format/yaml_reader.h"

#include <initializer_list>
#include <string>
#include <utility>

namespace fathom::save {

// A number.
Value yaml_scalar(double number);
Value yaml_word(std::string_view text); // plain where it reads back as text
Value yaml_switch(bool on);             // True, False
// A mapping in the order given.
Value yaml_mapping(std::initializer_list<Entry> entries);
Value yaml_xyz(double x, double y, double z);
Value yaml_list(std::vector<Value> items);

// Appends the value behind what stands in the line (`- ` or `Key:`); `indent` is the column of its
// own lines.
void write_value(const Value &value, std::size_t indent, std::string &out);
// An item of a block sequence at `indent`.
void write_item(const Value &value, std::size_t indent, std::string &out);
std::string flow_text(const Value &value);

} // namespace fathom::save
