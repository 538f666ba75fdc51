// The one table of what a scene tree of version 0.3 may hold: node types, their properties with
// defaults and limits, and the other spellings that are read. Both directions and
// docs/save-format.md follow it. A synonym is one line here; what differs in another version is
// told by `dialect_of`.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

namespace fathom::save {

// The node types of the format, the labelled ones of this project last.
enum class NodeType : std::uint8_t {
    Generic,
    Sphere,
    Torus,
    Cylinder,
    Cone,
    Box,
    MengerSponge,
    GeneralizedDistanceFunction,
    BlobbyObjects,
    ExplicitField,
    Union,
    Intersection,
    Difference,
    Blend,
    Translation,
    Rotation,
    Scaling,
    Twist,
    Turnaround,
    Repetition,
    Hyperize,
    Offset,
    Displacement,
    // What the language can say and 0.3 cannot: labelled nodes of this project.
    LibraryShape,
    ProfileBlend,
    PseudoNormBlend,
    Seam,
    Field,
    Distortion,
    Region,
    Complement,
    Deformation,
    Lighting
};

inline constexpr NodeType first_labelled = NodeType::LibraryShape;

// What values a property takes.
enum class PropertyKind : std::uint8_t {
    Number,
    Whole,
    Vector,   // {X, Y, Z}; a number stands for three equal ones, a sequence of three is read too
    Switch,   // True, False
    Word,     // free text
    Material, // a material's name
    Carried,  // the language has no word for it: kept, never shown
    Tree      // any value, read whole (field programs, argument lists)
};

// A property: its name, kind, default and limits.
struct PropertyType {
    const char *name = nullptr;
    PropertyKind kind = PropertyKind::Number;
    double fallback = 0;   // of Number, Whole, every component of Vector, Switch
    const char *word = ""; // of Word and Material; of Carried its usual value in flow form
    double minimum = -std::numeric_limits<double>::infinity();
    double maximum = std::numeric_limits<double>::infinity();
    bool open = false;     // `least` itself is not allowed
    bool labelled = false; // of this project: written only where it differs from the default
};

// How many children a node has.
enum class Arity : std::uint8_t { Leaf, One, Two, Many };

// A node type with its properties and spellings.
struct NodeTypeRow {
    NodeType type;
    const char *name;
    Arity children; // One: a transform; its children are united first
    std::span<const PropertyType> properties;
};

// All rows, in the order of NodeType.
std::span<const NodeTypeRow> node_types();
const NodeTypeRow &row_of(NodeType type);
const NodeTypeRow *find_node_type(std::string_view name); // any spelling; null for an unknown one
const PropertyType *find_property(const NodeTypeRow &row, std::string_view name);

// The sets of unit vectors of Akleman and Chen that 6.1 may use, by the name in `Shape`. -1:
// unknown. Three of them the library has turned by 90 degrees about x; those are module dfmodel's.
struct VectorSet {
    const char *name;     // "Truncated Octahedron"
    const char *function; // "gdf_truncated_octahedron"
    int number = 0;       // that module dfmodel counts them by
    bool turned() const { return number >= 7; }
};
std::span<const VectorSet> vector_sets();
int find_vector_set(std::string_view name);

bool is_library_solid(std::string_view function);       // what a `Library Shape` may call
bool is_library_deformation(std::string_view function); // what a `Deformation` may call

// What another version changes would be said here, and read by reader and writer; 0.3 is the
// only one known.
struct Dialect {
    bool known = true;      // false: read as 0.3 as far as it goes, with a warning
    bool is_version = true; // false: the item is no version number at all
};
inline constexpr std::string_view written_version = "0.3";
Dialect dialect_of(std::string_view version);

} // namespace fathom::save
