// A million points of a scene.
#include <fathom/fathom.h>

#include <cmath>
#include <cstdio>

int main(int, char **arguments) {
    const auto result = fathom::compile_file(arguments[1]);
    for (const fathom::Diagnostic &d : result.diagnostics) std::puts(d.message.c_str());
    if (!result) return 1;
    const auto field = fathom::make_field(*result.scene);
    std::vector<fathom::Point> points(1'000'000);
    for (std::size_t i = 0; i < points.size(); ++i) points[i][0] = static_cast<float>(i) * 1e-6f;
    std::vector<float> distances(points.size());
    if (!field || !field->distances(points, distances)) return 1;
    std::printf("%g %g\n", distances.front(), distances.back());
    return std::fabs(distances.back()) < 1e-5f ? 0 : 1;
}
