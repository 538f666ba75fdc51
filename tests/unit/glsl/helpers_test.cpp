// Every helper of backend-glsl/helpers on its own, for each type that it is written for: with what
// it says that it needs, and nothing else, it is a shader that glslang takes.
#include "backend-glsl/helpers.h"
#include "backend-glsl/template.h"
#include "backend-glsl/validate.h"

#include <catch2/catch.hpp>

using namespace fathom;

namespace {

std::vector<std::string> types_of(const std::string &form) {
    if (form == "T" || form == "each") return {"float", "vec2", "vec3", "vec4"};
    return {form};
}

} // namespace

TEST_CASE("every helper is a shader on its own, for each of its types") {
    std::size_t tried = 0;
    for (const auto &[name, form] : glsl::helper_forms())
        for (const std::string &type : types_of(form))
            for (const char *version :
                 {"#version 330\n", "#version 300 es\nprecision highp float;\n"
                                    "precision highp sampler3D;\n"}) {
                const std::string helper = glsl::helper_text({{name, type}});
                CAPTURE(name, type, helper);
                CHECK(helper.find(name) != std::string::npos);
                CHECK(helper.find('$') == std::string::npos);
                CHECK(helper.starts_with("\n"));
                CHECK(helper.find("\n\n\n") == std::string::npos);
                const auto complaint = glsl::validate(version + glsl::expand("hit_type", {}) +
                                                      helper + "\nvoid main() {}\n");
                if (complaint) FAIL(complaint->line << ": " << complaint->message);
                ++tried;
            }
    CHECK(tried > 100);
}

TEST_CASE("a helper that needs others comes after them, each once") {
    const std::string text =
        glsl::helper_text({{"fathom_hash", "vec3"}, {"fathom_spot_noise", ""}});
    const auto at = [&](const std::string &what) {
        INFO(what);
        const std::size_t place = text.find(what);
        REQUIRE(place != std::string::npos);
        CHECK(text.find(what, place + 1) == std::string::npos);
        return place;
    };
    CHECK(at("uint fathom_scramble(uint h) {") < at("uint fathom_hash_more("));
    CHECK(at("uint fathom_hash_more(") < at("float fathom_hash(vec3 x) {"));
    CHECK(at("uvec3 fathom_lattice(") < at("vec3 fathom_worley_point("));
    CHECK(at("vec3 fathom_worley_point(") < at("float fathom_spot_noise("));
}
