// What the scene paints with, as textures and materials of a save file: those that were kept from
// an import under their names, and behind them what else the scene has by now. Private to
// save-format.
#pragma once

#include "save-format/export/tree.h"

#include <map>

namespace fathom::save {

double channel_of(double linear); // 0..255 by sRGB's curve; whole where it is one up to rounding
// A colour as the save format writes it, sRGB 0..255.
Value color_value(const std::array<double, 3> &channels, double alpha);

// The textures and materials of one export.
class Appearances {
  public:
    Appearances(const ir::Scene &scene, Numbers &numbers, const FileNames &files,
                std::vector<Value> textures, std::vector<Value> materials);

    // A material's name, by its index into Shapes::materials; empty where its appearances depend on
    // the point.
    std::string material(std::uint32_t index);
    std::string texture(std::int32_t image); // the name of an image's file
    // Whether a material of the file displaces what it is on by this map.
    bool displaces(const std::string &material, const ir::DisplacementMap &map, double by) const;

    Value textures() const;
    const FileNames &files() const { return files_; }
    const std::vector<Value> &materials() const { return materials_; }

  private:
    struct Appearance {
        std::array<double, 3> diffuse{}, specular{}, emission{};
        double exponent = 32;
        std::string texture; // a name, empty for none
        std::array<double, 2> texture_scale{1, 1};
    };
    std::optional<Appearance> appearance_of(const ir::Material &material);
    bool same(const Value &item, const Appearance &appearance) const;
    void update(Value &item, const Appearance &appearance) const;

    const ir::Scene &scene_;
    Numbers &numbers_;
    const FileNames &files_;
    std::vector<Entry> textures_;                       // name -> file, as the scene calls it
    std::map<std::string, std::size_t> texture_images_; // by name, of those that the scene has
    std::vector<Value> materials_;
    std::map<std::string, std::size_t, std::less<>> by_name_;
};

} // namespace fathom::save
