#include "viewer/camera.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace fathom::viewer {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double steepest = pi / 2 - 1e-3; // straight up, right and left would have no meaning

glm::dvec3 from_target(const Camera &camera) {
    return {std::sin(camera.yaw) * std::cos(camera.pitch), std::sin(camera.pitch),
            std::cos(camera.yaw) * std::cos(camera.pitch)};
}

} // namespace

Camera camera_of(const ir::View &view) {
    Camera camera;
    camera.orthographic = view.orthographic;
    camera.distance = std::max(view.focus, 1e-6);
    camera.target = view.origin + view.forward * camera.distance;
    // Looking along y there is no yaw in the direction; the picture's up still has one.
    glm::dvec3 level =
        std::abs(view.forward.y) < 1 - 1e-9
            ? glm::dvec3{-view.forward.x, 0, -view.forward.z}
            : glm::dvec3{-view.up.x * -view.forward.y, 0, -view.up.z * -view.forward.y};
    camera.yaw = std::atan2(level.x, level.z);
    camera.pitch =
        std::clamp(std::asin(std::clamp(-view.forward.y, -1.0, 1.0)), -steepest, steepest);
    camera.slope = view.orthographic ? view.extent / camera.distance : view.extent;
    return camera;
}

ir::View view_of(const Camera &camera) {
    const glm::dvec3 eye = camera.target + from_target(camera) * camera.distance;
    return ir::look_at(eye, camera.target,
                       camera.orthographic ? camera.slope * camera.distance : camera.slope,
                       camera.orthographic);
}

void orbit(Camera &camera, double dx, double dy) {
    camera.yaw = std::remainder(camera.yaw - dx * pi, 2 * pi);
    camera.pitch = std::clamp(camera.pitch + dy * pi, -steepest, steepest);
}

void pan(Camera &camera, double dx, double dy) {
    ir::View view = view_of(camera);
    double height = 2 * camera.slope * camera.distance; // of the window, at the target
    camera.target += view.right * (-dx * height) + view.up * (dy * height);
}

void dolly(Camera &camera, double steps) {
    camera.distance = std::clamp(camera.distance * std::pow(0.9, steps), 1e-4, 1e6);
}

void fly(Camera &camera, const glm::dvec3 &by) {
    ir::View view = view_of(camera);
    camera.target += (view.right * by.x + view.up * by.y + view.forward * by.z) * camera.distance;
}

void look_from(Camera &camera, Side side) {
    switch (side) {
    case Side::Front: camera.yaw = 0, camera.pitch = 0; break;
    case Side::Right: camera.yaw = pi / 2, camera.pitch = 0; break;
    case Side::Top: camera.yaw = 0, camera.pitch = steepest; break;
    }
}

void frame(Camera &camera, const glm::dvec3 &center, double radius, double aspect) {
    camera.target = center;
    // The narrower way across has to hold the sphere: sin of half the angle is radius over
    // distance.
    double slope = camera.slope * std::min(1.0, aspect);
    camera.distance =
        camera.orthographic ? radius / slope : radius * std::sqrt(1 + 1 / (slope * slope));
}

std::string camera_line(const Camera &camera) {
    const glm::dvec3 eye = camera.target + from_target(camera) * camera.distance;
    // To a thousandth of the distance: finer than the eye tells, and no digits that only rounding
    // made.
    double unit = std::pow(10, std::floor(std::log10(camera.distance)) - 3);
    auto number = [&](double x) { return std::round(x / unit) * unit + 0.0; };
    auto triple = [&](const glm::dvec3 &t) {
        return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", number(t.x), number(t.y), number(t.z));
    };
    return fmt::format("camera(at: {}, look_at: {}, fov: {:.4g}deg{})", triple(eye),
                       triple(camera.target), 2 * std::atan(camera.slope) * 180 / pi,
                       camera.orthographic ? ", orthographic: true" : "");
}

double isoline_step(const Camera &camera) {
    const double wanted = camera.slope * camera.distance / 12;
    const double power = std::pow(10, std::floor(std::log10(wanted)));
    for (double step : {2.0, 5.0})
        if (wanted <= step * power) return step * power;
    return 10 * power;
}

} // namespace fathom::viewer
