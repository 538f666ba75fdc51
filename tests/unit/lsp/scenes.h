// Texts that compile: the examples and the golden cases; and whether two give the same
// field.
#pragma once

#include "api/language/workspace.h"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

struct SceneText {
    std::string path, text;
};

inline std::vector<SceneText> scene_texts() {
    std::vector<SceneText> all;
    for (const char *folder : {"/examples", "/tests/golden/cases"})
        for (const auto &entry :
             std::filesystem::directory_iterator(std::string(FATHOM_SOURCE_DIR) + folder)) {
            if (entry.path().extension() != ".sdf" ||
                entry.path().filename().string().starts_with("fail_"))
                continue;
            std::ifstream in(entry.path(), std::ios::binary);
            std::string text(std::istreambuf_iterator<char>(in), {});
            text.erase(std::min(text.find("//===="), text.size()));
            all.push_back({entry.path().string(), std::move(text)});
        }
    std::ranges::sort(all, {}, &SceneText::path);
    REQUIRE(all.size() > 80);
    return all;
}

// Distances at points of a cube, and the bound that they are divided by.
struct Values {
    std::vector<float> distances;
    double bound = 0;
    friend bool operator==(const Values &, const Values &) = default;
};

// Nothing where the text does not compile.
inline std::optional<Values> values_of(fathom::language::Workspace &workspace,
                                       const std::string &path, const std::string &text,
                                       const std::map<std::string, std::string> &instead = {}) {
    const auto result = fathom::language::compile_as(workspace, path, text, instead);
    if (!result) return std::nullopt;
    std::mt19937 random(1);
    std::vector<fathom::v1::Point> points(40);
    for (fathom::v1::Point &point : points)
        for (float &x : point) x = static_cast<float>(random() % 8001) / 1000.0f - 4;
    Values values{std::vector<float>(points.size()), result.scene->facts().lipschitz.value_or(0)};
    const auto field = fathom::v1::make_field(*result.scene);
    REQUIRE(field);
    REQUIRE(field->distances(points, values.distances));
    return values;
}
