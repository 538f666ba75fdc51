// The colours of rays, by ir/shading.h: normals, surfaces grouped by paint, lights with their shadows,
// occlusion. Names and order follow backend-glsl/marcher.cpp.
#include "backend-cpu/trace/rays.h"

#include "ir/shading.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace fathom::cpu {

namespace shading = ir::shading;

namespace {

struct Material {
    Vec diffuse, specular, emission;
    float exponent = 0;
    std::int32_t surface = 0;
};

// What is known of the points that were hit, one entry a hit.
struct Points {
    std::vector<std::size_t> ray;
    std::vector<Vec> p, n;
    std::vector<float> t, h, slope; // of the field (TRUE DISTANCE)
    std::vector<float> even;        // 1, or less at an edge (SHADING)
    std::vector<Material> material;
    std::size_t size() const { return ray.size(); }
};

// Nothing, then two axes across a ray, to and fro.
Vec beside(std::size_t i, const Vec &direction) {
    const Vec a = glm::normalize(
        glm::cross(direction, std::fabs(direction.x) < 0.6f ? Vec(1, 0, 0) : Vec(0, 1, 0)));
    if (i == 0) return Vec(0);
    return (i % 2 == 1 ? 1.0f : -1.0f) * (i < 3 ? a : glm::cross(direction, a));
}

// How far along rays beside these points a change of sign is, in arms of `beside`; NaN where none is.
std::vector<float> find_beside(Worker &worker, std::span<const RayState> rays, const Points &at,
                               std::span<const std::size_t> which, std::size_t side) {
    constexpr float reach = shading::beside_reach;
    const std::size_t count = which.size();
    std::vector<float> low(count, -reach), high(count, reach), here(count), f(count);
    const auto evaluate = [&] {
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t k = which[i];
            const Vec &direction = rays[at.ray[k]].direction;
            worker.points.set(0, i,
                              at.p[k] + shading::beside * at.h[k] *
                                            (beside(side, direction) + here[i] * direction));
        }
        shaded_values(worker, worker.points, f.data(), count);
    };
    std::vector<char> found(count);
    here = low;
    evaluate();
    for (std::size_t i = 0; i < count; ++i) found[i] = f[i] > 0;
    here = high;
    evaluate();
    for (std::size_t i = 0; i < count; ++i) found[i] = found[i] && !(f[i] > 0);
    for (int look = 2; look < shading::beside_looks; ++look) {
        for (std::size_t i = 0; i < count; ++i) here[i] = 0.5f * (low[i] + high[i]);
        evaluate();
        for (std::size_t i = 0; i < count; ++i) (f[i] > 0 ? low : high)[i] = here[i];
    }
    for (std::size_t i = 0; i < count; ++i)
        here[i] = found[i] ? 0.5f * (low[i] + high[i]) : std::numeric_limits<float>::quiet_NaN();
    return here;
}

// The normals of the surface beside points without a gradient (ir/shading.h, GRADIENT), where it is
// found.
void look_beside(Worker &worker, std::span<const RayState> rays, Points &at,
                 std::vector<std::size_t> which) {
    std::vector<float> middle = find_beside(worker, rays, at, which, 0);
    for (std::size_t i = which.size(); i-- > 0;)
        if (std::isnan(middle[i])) {
            which.erase(which.begin() + std::ptrdiff_t(i));
            middle.erase(middle.begin() + std::ptrdiff_t(i));
        }
    if (which.empty()) return;
    std::vector<std::array<float, 2>> rise(which.size()), rises(which.size());
    for (std::size_t side = 1; side < 5; ++side) {
        const std::vector<float> to = find_beside(worker, rays, at, which, side);
        const std::size_t axis = (side - 1) / 2;
        for (std::size_t i = 0; i < which.size(); ++i) {
            if (std::isnan(to[i])) continue;
            rise[i][axis] += (side % 2 == 1 ? 1.0f : -1.0f) * (to[i] - middle[i]);
            rises[i][axis] += 1;
        }
    }
    for (std::size_t i = 0; i < which.size(); ++i) {
        const Vec &direction = rays[at.ray[which[i]]].direction;
        if (!(rises[i][0] * rises[i][1] > 0)) continue;
        at.even[which[i]] = 1;
        at.n[which[i]] =
            glm::normalize(rise[i][0] / rises[i][0] * beside(1, direction) +
                           rise[i][1] / rises[i][1] * beside(3, direction) - direction);
    }
}

// The gradients and slopes anew, from farther in front of the surface, where their taps lay on both
// sides of a kink in the field (ir/shading.h, GRADIENT).
void take_in_front(Worker &worker, Points &at, std::vector<Vec> above, std::vector<Vec> &gradient) {
    const std::size_t count = at.size();
    std::vector<std::size_t> which;
    for (std::size_t k = 0; k < count; ++k) {
        bool behind = false;
        for (std::size_t i = 0; i < 4; ++i) behind |= worker.tap_values[i * count + k] < 0;
        const float square = at.slope[k] * at.slope[k];
        if (behind && square - dot(gradient[k], gradient[k]) > shading::kinked * square)
            which.push_back(k);
    }
    if (which.empty()) return;
    std::vector<Vec> place(which.size()), found(which.size());
    std::vector<float> g(which.size()), h(which.size()), slope(which.size());
    for (std::size_t i = 0; i < which.size(); ++i) {
        const std::size_t k = which[i];
        const float size = length(gradient[k]);
        h[i] = at.h[k];
        place[i] = above[k];
        if (size > 0) place[i] += shading::lift * h[i] / size * gradient[k];
        worker.points.set(0, i, place[i]);
    }
    shaded_values(worker, worker.points, g.data(), which.size());
    slopes(worker, place.data(), g.data(), h.data(), found.data(), slope.data(), which.size());
    for (std::size_t i = 0; i < which.size(); ++i)
        gradient[which[i]] = found[i], at.slope[which[i]] = slope[i];
}

void find_normals(Worker &worker, std::span<const RayState> rays, Points &at) {
    std::vector<Vec> gradient(at.size()), above(at.size());
    for (std::size_t k = 0; k < at.size(); ++k)
        above[k] = at.p[k] - shading::lift * at.h[k] * rays[at.ray[k]].direction;
    const ir::Frame &frame = worker.stage.frame;
    at.slope.assign(at.size(), 1.0f);
    if (frame.exact || frame.unit_slope) {
        gradients(worker, above.data(), at.h.data(), gradient.data(), at.size());
    } else {
        std::vector<float> g(at.size());
        for (std::size_t k = 0; k < at.size(); ++k) worker.points.set(0, k, above[k]);
        shaded_values(worker, worker.points, g.data(), at.size());
        slopes(worker, above.data(), g.data(), at.h.data(), gradient.data(), at.slope.data(),
               at.size());
        take_in_front(worker, at, std::move(above), gradient);
    }
    for (std::size_t k = 0; k < at.size(); ++k) {
        const float size = length(gradient[k]);
        at.n.push_back(size > 0 ? gradient[k] / size : -rays[at.ray[k]].direction);
        at.even.push_back(clamp(size / (at.slope[k] * shading::flat_from), shading::min_slope, 1));
    }
    if (frame.exact || frame.unit_slope) return;
    std::vector<std::size_t> faint;
    for (std::size_t k = 0; k < at.size(); ++k)
        if (length(gradient[k]) < shading::faint) faint.push_back(k);
    if (!faint.empty()) look_beside(worker, rays, at, std::move(faint));
}

constexpr std::size_t paint_row = 1, point_row = 2,
                      extra_row = 5; // of a hit: distance, paint, point, extra

void evaluate_hits(Worker &worker, std::span<const Vec> points) {
    for (std::size_t k = 0; k < points.size(); ++k) worker.points.set(0, k, points[k]);
    hits(worker, points.size());
}

void find_materials(Worker &worker, Points &at) {
    const Stage &stage = worker.stage;
    const std::size_t count = at.size();
    std::vector<Vec> local = at.n;
    if (stage.local_normals) { // the normal in the space where the paint stands
        std::vector<Vec> beside(count);
        for (std::size_t k = 0; k < count; ++k) beside[k] = at.p[k] + at.h[k] * at.n[k];
        evaluate_hits(worker, beside);
        for (std::size_t k = 0; k < count; ++k) local[k] = worker.hits.vec(point_row, k);
    }
    evaluate_hits(worker, at.p);
    if (stage.local_normals)
        for (std::size_t k = 0; k < count; ++k) {
            const Vec turned = local[k] - worker.hits.vec(point_row, k);
            const float size = length(turned);
            local[k] = size > 0 ? turned / size : at.n[k];
        }

    const auto last = static_cast<std::int32_t>(stage.surfaces.size()) - 1;
    std::vector<std::vector<std::size_t>> by_paint(stage.surfaces.size());
    for (std::size_t k = 0; k < count; ++k) {
        const auto paint = std::bit_cast<std::int32_t>(worker.hits[paint_row][k]);
        by_paint[static_cast<std::size_t>(paint < 0 || paint > last ? last : paint)].push_back(k);
    }
    Columns in(10, count), out(10, count);
    at.material.resize(count);
    for (std::size_t s = 0; s < by_paint.size(); ++s) {
        const std::vector<std::size_t> &group = by_paint[s];
        for (std::size_t i = 0; i < group.size(); ++i) {
            in.set(0, i, worker.hits.vec(point_row, group[i]));
            in.set(3, i, local[group[i]]);
            for (std::size_t c = 0; c < 4; ++c) in[6 + c][i] = worker.hits[extra_row + c][group[i]];
        }
        evaluate(stage.surfaces[s], worker.surfaces[s], in.pointers(), out.pointers(),
                 group.size());
        for (std::size_t i = 0; i < group.size(); ++i)
            at.material[group[i]] = {out.vec(0, i), out.vec(3, i), out.vec(7, i), out[6][i],
                                     static_cast<std::int32_t>(s)};
    }
}

constexpr auto looks = static_cast<std::size_t>(shading::occlusion_samples);

// How much of the surroundings five samples along the normal find closed (thesis, 4.2.1).
std::vector<float> find_occlusion(Worker &worker, const Points &at) {
    const Stage &stage = worker.stage;
    const Lengths lengths(stage);
    const float gap = stage.shading.occlusion_reach / static_cast<float>(looks);
    std::vector<float> sum(at.size(), 0.0f);
    std::vector<float> own = at.slope; // what the surface itself rises by: what rises so is open
    std::vector<Near> places;
    std::vector<std::size_t> of;
    float weight = 1, total = 0;
    for (std::size_t i = 0; i < looks; ++i) {
        weight *= 0.5f;
        total += weight;
        const float away = gap * static_cast<float>(i + 1), free = shading::nearly * away;
        for (std::size_t k = 0; k < at.size(); ++k) {
            worker.points.set(0, k, at.p[k] + away * at.n[k]);
            worker.limits[k] = away;
        }
        if (stage.shaded_apart)
            shaded_values(worker, worker.points, worker.values.data(), at.size());
        else
            distances(worker, worker.points, worker.values.data(), at.size(), worker.limits.data());
        places.clear(), of.clear();
        for (std::size_t k = 0; k < at.size(); ++k) {
            const float g = worker.values[k];
            if (stage.frame.exact || g < 0) {
                sum[k] += weight * clamp(1.0f - g / free, 0.0f, 1.0f);
                continue;
            }
            if (!stage.frame.unit_slope) own[k] = std::max(own[k], g / away);
            if (g >= own[k] * free) continue;
            const Vec from = at.p[k] + away * at.n[k];
            of.push_back(k);
            places.push_back({from, g, from, Vec(0), 0, 0, 0,
                              std::max(at.h[k], shading::occlusion_fine / weight * away),
                              0.25f * lengths.slack_at(at.t[k]), free});
        }
        const std::vector<float> found = find_nearest(worker, places);
        for (std::size_t j = 0; j < of.size(); ++j)
            sum[of[j]] += weight * clamp(1.0f - found[j] / free, 0.0f, 1.0f);
    }
    for (float &s : sum) s /= total;
    return sum;
}

// A point that faces a light.
struct Facing {
    std::size_t light, point;
    Vec l;
    float facing;
};

// Who faces which light, light by light, and the ways there.
std::vector<Facing> find_facing(const Worker &worker, const Points &at,
                                std::vector<ShadowRay> &ways) {
    const Stage &stage = worker.stage;
    const Lengths lengths(stage);
    std::vector<Facing> lit;
    for (std::size_t i = 0; i < stage.lights.size(); ++i)
        for (std::size_t k = 0; k < at.size(); ++k) {
            const ir::LightValue &light = stage.lights[i];
            const float margin = shading::shadow_bias * lengths.tolerance(at.t[k]);
            const Vec q = at.p[k] + margin * at.n[k];
            const Vec way = light.directional ? vec(light.position) : vec(light.position) - q;
            const float away = length(way);
            const Vec l = away > 0 ? way / away : at.n[k];
            const float facing = dot(at.n[k], l);
            if (!(facing > 0)) continue;
            lit.push_back({i, k, l, facing});
            const float sun_reach =
                stage.frame.boxed ? std::max(box(stage.frame, q, l).last, 0.0f) : lengths.far;
            ways.push_back({q, l, light.directional ? sun_reach : away, margin, at.h[k]});
        }
    return lit;
}

void add_lights(Worker &worker, std::span<const RayState> rays, const Points &at,
                std::span<Vec> colors) {
    const Stage::Shading &lighting = worker.stage.shading;
    std::vector<ShadowRay> ways;
    const std::vector<Facing> lit = find_facing(worker, at, ways);
    std::vector<float> shadow(lit.size(), 1.0f);
    if (lighting.shadow_darkness > 0)
        for (std::size_t first = 0; first < lit.size(); first += max_rays) {
            const std::size_t count = std::min(max_rays, lit.size() - first);
            shadows(worker, std::span(ways).subspan(first, count),
                    std::max(lighting.soft_shadows, shading::min_angle),
                    std::span(shadow).subspan(first, count));
        }
    for (std::size_t i = 0; i < lit.size(); ++i) {
        const auto [light, k, l, facing] = lit[i];
        const Material &m = at.material[k];
        const float seen = 1.0f - lighting.shadow_darkness * (1.0f - shadow[i]);
        const Vec r = 2.0f * facing * at.n[k] - l;
        const float spread = at.even[k] / (at.even[k] + m.exponent * (1 - at.even[k])),
                    exponent = m.exponent * spread;
        float gleam = std::max(-dot(r, rays[at.ray[k]].direction), 0.0f);
        gleam = gleam > 0 ? lighting.specular_intensity * (1 + exponent) / (1 + m.exponent) *
                                std::pow(gleam, exponent)
                          : 0.0f;
        Vec &sum = colors[at.ray[k]];
        sum = sum + seen * vec(worker.stage.lights[light].color) *
                        (facing * m.diffuse + gleam * m.specular);
    }
}

// How much of a ray's colour is the background: all where it misses; and what lies far off fades
// into it (shading.h, MISS, FADE).
float background_share(const Lengths &lengths, float t) {
    if (t < 0) return 1.0f;
    if (!lengths.fades) return 0.0f;
    const float x = clamp((t / lengths.far - shading::fade_from) / (1 - shading::fade_from), 0, 1);
    return x * x * (3 - 2 * x);
}

void see_background(Worker &worker, std::span<const RayState> rays,
                    std::span<const Landing> landings, std::span<Vec> colors) {
    const Lengths lengths(worker.stage);
    const auto share = [&](float t) { return background_share(lengths, t); };
    std::vector<std::size_t> seen;
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (share(landings[i].t) > 0) seen.push_back(i);
    for (std::size_t k = 0; k < seen.size(); ++k) worker.points.set(0, k, rays[seen[k]].direction);
    if (worker.stage.has_background)
        evaluate(worker.stage.background, worker.background, worker.points.pointers(),
                 worker.taps.pointers(), seen.size());
    for (std::size_t k = 0; k < seen.size(); ++k) {
        const Vec color =
            worker.stage.has_background ? worker.taps.vec(0, k) : vec(shading::background);
        const float part = share(landings[seen[k]].t);
        Vec &to = colors[seen[k]];
        to = part < 1 ? to + part * (color - to) : color;
    }
}

// Highlights that would be clamped bend instead (shading.h, SHADING).
float soft(float c) {
    constexpr float rest = 1 - shading::shoulder;
    return c > shading::shoulder
               ? shading::shoulder + rest * (1 - std::exp((shading::shoulder - c) / rest))
               : c;
}

void shade_hits(Worker &worker, std::span<const RayState> rays, std::span<const Landing> landings,
                std::span<Vec> colors) {
    const Stage &stage = worker.stage;
    const Lengths lengths(stage);
    Points at;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (landings[i].t < 0) continue;
        const float t = landings[i].t;
        at.ray.push_back(i);
        at.p.push_back(rays[i].origin + t * rays[i].direction);
        at.t.push_back(t);
        at.h.push_back(lengths.arm(t));
    }
    if (at.size() == 0) return;
    find_normals(worker, rays, at);
    find_materials(worker, at);
    if (stage.scene->lighting.skip) {
        for (std::size_t k = 0; k < at.size(); ++k)
            colors[at.ray[k]] = at.material[k].diffuse + at.material[k].emission;
        return;
    }
    std::vector<float> open(at.size(), 1.0f);
    if (stage.shading.ambient_occlusion > 0) {
        const std::vector<float> occlusion = find_occlusion(worker, at);
        for (std::size_t k = 0; k < at.size(); ++k)
            open[k] -= stage.shading.ambient_occlusion * occlusion[k];
    }
    const Vec ambient{stage.shading.ambient[0], stage.shading.ambient[1], stage.shading.ambient[2]};
    const bool classic = stage.scene->lighting.classic;
    const Vec soil = vec(shading::soil), sky = vec(shading::sky);
    for (std::size_t k = 0; k < at.size(); ++k) {
        const Material &m = at.material[k];
        Vec around = ambient;
        if (!classic) around = around * (soil + 0.5f * (1 + at.n[k].y) * (sky - soil));
        const float facing = std::max(-dot(at.n[k], rays[at.ray[k]].direction), 0.0f);
        colors[at.ray[k]] =
            open[k] * m.diffuse * (around + Vec(stage.shading.fill * facing)) + m.emission;
    }
    add_lights(worker, rays, at, colors);
    if (classic) return;
    for (std::size_t ray : at.ray)
        colors[ray] = {soft(colors[ray].x), soft(colors[ray].y), soft(colors[ray].z)};
}

} // namespace

void shade(Worker &worker, std::span<const RayState> rays, std::span<const Landing> landings,
           std::span<Vec> colors, std::span<float> cover) {
    shade_hits(worker, rays, landings, colors);
    if (cover.empty()) return see_background(worker, rays, landings, colors);
    const Lengths lengths(worker.stage);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        cover[i] = 1 - background_share(lengths, landings[i].t);
        colors[i] = cover[i] > 0 ? cover[i] * colors[i] : Vec(0);
    }
}

std::vector<Look> looks_at(const Stage &stage, std::span<const std::array<float, 3>> points,
                           std::span<const std::array<float, 3>> normals, float arm) {
    Worker worker(stage);
    std::vector<Look> looks;
    looks.reserve(points.size());
    const auto numbers = [](Vec v) { return std::array{v.x, v.y, v.z}; };
    for (std::size_t first = 0; first < points.size(); first += max_rays) {
        const std::size_t end = std::min(points.size(), first + max_rays);
        Points at;
        for (std::size_t k = first; k < end; ++k) {
            at.ray.push_back(k), at.h.push_back(arm);
            at.p.push_back(vec(points[k])), at.n.push_back(vec(normals[k]));
        }
        find_materials(worker, at);
        for (const Material &m : at.material)
            looks.push_back({m.surface, numbers(m.diffuse), numbers(m.specular),
                             numbers(m.emission), m.exponent});
    }
    return looks;
}

} // namespace fathom::cpu
