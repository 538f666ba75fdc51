// The properties of one node as they were read: by name, with the row's defaults, and as the
// language's text, where a number may follow parameters and time (`Varying`). Private to the
// importer.
#pragma once

#include "save-format/import/importer.h"

namespace fathom::save {

// One node's properties, read and checked.
class Reading {
  public:
    Reading(Importer &in, const NodeTypeRow &row, const Properties &properties, Span at)
        : in_(in), row_(row), properties_(properties), at_(at) {}

    const Property &operator[](std::string_view name) const {
        return properties_.values[index(name)];
    }
    double number(std::string_view name) const;
    void vector(std::string_view name, double (&out)[3]) const;
    std::string word(std::string_view name) const;

    // What the number follows, as an expression; empty where it is what it is.
    std::string formula(std::string_view name) const;
    bool varies(std::string_view name) const { return properties_.varying.find(name) != nullptr; }

    std::string text(std::string_view name) const; // a number, or its formula
    std::string vector_text(std::string_view name) const;

  private:
    std::size_t index(std::string_view name) const;

    Importer &in_;
    const NodeTypeRow &row_;
    const Properties &properties_;
    Span at_;
};

// The calls that need more than one line to write: a library's solid, a generalised distance
// function, a function of the point, a deformation. Empty where they cannot be read (reported).
std::string library_call(Importer &in, const Reading &reading, Properties &properties, Span at);
std::string gdf_call(Importer &in, const Reading &reading, Properties &properties, Span at);
std::string field_call(Importer &in, const Reading &reading, Span at);
std::string deformation_call(const Reading &reading, std::string &why);

} // namespace fathom::save
