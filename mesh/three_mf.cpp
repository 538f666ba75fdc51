// A 3MF: a ZIP archive of a model in XML, with its type and the place of the model in it (3MF Core
// Specification 1.3; colours by its Materials Extension 1.2). Equal meshes are equal bytes: no date.
#include "base/encode.h"
#include "base/picture.h"
#include "mesh/write.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <zip.h>

namespace fathom::mesh {
namespace {

constexpr std::string_view types =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
)";
constexpr std::string_view relations =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
)";

std::string_view word_of(Unit unit) {
    switch (unit) {
    case Unit::Micron: return "micron";
    case Unit::Unsaid:
    case Unit::Millimetre: return "millimeter";
    case Unit::Centimetre: return "centimeter";
    case Unit::Metre: return "meter";
    case Unit::Inch: return "inch";
    case Unit::Foot: return "foot";
    }
    return "millimeter";
}

// Text of an attribute. Control characters, which XML has no way to write, become spaces or U+FFFD.
std::string attribute_of(std::string_view text) {
    std::string out;
    for (const char c : for_terminal(text)) switch (c) {
        case '&': out += "&amp;"; break;
        case '<': out += "&lt;"; break;
        case '"': out += "&quot;"; break;
        default: out += c;
        }
    return out;
}

using Text = fmt::memory_buffer;

// The colours that there are, each once, and by object, triangle and corner which.
struct Palette {
    std::vector<std::uint32_t> colors; // 0xRRGGBB
    std::vector<std::vector<Triangle>> places;
};
Palette palette_of(std::span<const Surface> objects) {
    Palette palette;
    std::map<std::uint32_t, std::uint32_t> known;
    for (const Surface &mesh : objects) {
        std::vector<Triangle> &places = palette.places.emplace_back();
        if (mesh.colors.empty()) continue;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            Triangle &place = places.emplace_back();
            for (std::size_t c = 0; c < 3; ++c) {
                std::uint32_t word = 0;
                for (const float x : corner_color(mesh, t, c)) word = word << 8 | srgb_byte(x);
                const auto [at, fresh] =
                    known.try_emplace(word, static_cast<std::uint32_t>(palette.colors.size()));
                if (fresh) palette.colors.push_back(word);
                place[c] = at->second;
            }
        }
    }
    return palette;
}

// An object takes its colour as a whole from its first corner; only other corners name their own.
void put_object(Text &text, std::size_t id, const Surface &mesh,
                const std::vector<Triangle> &places, std::size_t palette) {
    const auto to = std::back_inserter(text);
    fmt::format_to(to, "<object id=\"{}\" type=\"model\" name=\"{}\"", id, attribute_of(mesh.name));
    const bool colored = !places.empty();
    const std::uint32_t first = colored ? places[0][0] : 0;
    const bool one = std::ranges::all_of(places, [&](const Triangle &place) {
        return place == Triangle{first, first, first};
    });
    if (colored) fmt::format_to(to, " pid=\"{}\" pindex=\"{}\"", palette, first);
    fmt::format_to(to, ">\n<mesh>\n<vertices>\n");
    for (const Point &p : mesh.vertices)
        fmt::format_to(to, "<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>\n", double(p[0]), 0.0 - p[2],
                       double(p[1]));
    fmt::format_to(to, "</vertices>\n<triangles>\n");
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto &[a, b, c] = mesh.triangles[t];
        fmt::format_to(to, "<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"", a, b, c);
        if (!one)
            fmt::format_to(to, " pid=\"{}\" p1=\"{}\" p2=\"{}\" p3=\"{}\"", palette, places[t][0],
                           places[t][1], places[t][2]);
        fmt::format_to(to, "/>\n");
    }
    fmt::format_to(to, "</triangles>\n</mesh>\n</object>\n");
}

// Several objects are the components of one, so that they stay where they are to each other.
void put_model(Text &text, std::span<const Surface> objects, const FileOptions &options) {
    const auto to = std::back_inserter(text);
    const Palette palette = palette_of(objects);
    fmt::format_to(to,
                   "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                   "<model unit=\"{}\" xml:lang=\"en\" "
                   "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
                   "xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\">\n"
                   "<metadata name=\"Application\">Fathom</metadata>\n<resources>\n",
                   word_of(options.unit));
    const std::size_t palette_id = objects.size() + 1;
    if (!palette.colors.empty()) {
        fmt::format_to(to, "<m:colorgroup id=\"{}\">\n", palette_id);
        for (const std::uint32_t color : palette.colors)
            fmt::format_to(to, "<m:color color=\"#{:06X}\"/>\n", color);
        fmt::format_to(to, "</m:colorgroup>\n");
    }
    for (std::size_t k = 0; k < objects.size(); ++k)
        put_object(text, k + 1, objects[k], palette.places[k], palette_id);
    std::size_t built = 1;
    if (objects.size() > 1) {
        built = palette_id + 1;
        fmt::format_to(to, "<object id=\"{}\" type=\"model\" name=\"{}\">\n<components>\n", built,
                       attribute_of(options.name));
        for (std::size_t k = 0; k < objects.size(); ++k)
            fmt::format_to(to, "<component objectid=\"{}\"/>\n", k + 1);
        fmt::format_to(to, "</components>\n</object>\n");
    }
    fmt::format_to(to, "</resources>\n<build><item objectid=\"{}\"/></build>\n</model>\n", built);
}

// Adds a file without a date; the bytes have to live until the archive is closed.
bool add(zip_t *archive, const char *name, std::string_view bytes) {
    zip_source_t *source = zip_source_buffer(archive, bytes.data(), bytes.size(), 0);
    if (!source) return false;
    const zip_int64_t index = zip_file_add(archive, name, source, ZIP_FL_ENC_UTF_8);
    if (index < 0) {
        zip_source_free(source);
        return false;
    }
    constexpr zip_uint16_t first_day = 1 << 5 | 1; // 1 January 1980, the least that a ZIP holds
    return zip_file_set_dostime(archive, static_cast<zip_uint64_t>(index), 0, first_day, 0) == 0;
}

} // namespace

std::string three_mf_of(std::span<const Surface> objects, const FileOptions &options) {
    Text model;
    put_model(model, objects, options);
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t *whole = zip_source_buffer_create(nullptr, 0, 0, &error);
    if (!whole) return "";
    const std::unique_ptr<zip_source_t, void (*)(zip_source_t *)> kept(whole, zip_source_free);
    zip_source_keep(whole); // the archive gives up its own when it is closed
    zip_t *archive = zip_open_from_source(whole, ZIP_CREATE | ZIP_TRUNCATE, &error);
    if (!archive) {
        zip_source_free(whole);
        return "";
    }
    if (!add(archive, "[Content_Types].xml", types) || !add(archive, "_rels/.rels", relations) ||
        !add(archive, "3D/3dmodel.model", {model.data(), model.size()}) ||
        zip_close(archive) != 0) {
        zip_discard(archive);
        return "";
    }
    zip_stat_t stat;
    if (zip_source_stat(whole, &stat) != 0 || !(stat.valid & ZIP_STAT_SIZE)) return "";
    std::string bytes(stat.size, '\0');
    if (zip_source_open(whole) != 0) return "";
    const zip_int64_t read = zip_source_read(whole, bytes.data(), bytes.size());
    zip_source_close(whole);
    return read == static_cast<zip_int64_t>(bytes.size()) ? bytes : "";
}

} // namespace fathom::mesh
