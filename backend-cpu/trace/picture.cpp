// A picture as tiles over threads: eye rays in, sRGB out. Each thread takes the next tile that no
// one has; a finished one is reported under a lock, so that the caller's function runs once at a
// time.
#include "backend-cpu/trace/rays.h"
#include "base/srgb.h"

#include "ir/shading.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>

namespace fathom::cpu {

Work &Work::operator+=(const Work &other) {
    rays += other.rays;
    hits += other.hits;
    steps += other.steps;
    shadow_steps += other.shadow_steps;
    evaluations += other.evaluations;
    undecided += other.undecided;
    undecided_shadows += other.undecided_shadows;
    far += other.far;
    near += other.near;
    near_shapes += other.near_shapes;
    return *this;
}

namespace {

float number_of(const ir::Scene &scene, ir::NodeId id, double time) {
    return static_cast<float>(ir::value_of(scene, id, time)[0]);
}

// Whether a surface looks different with another normal.
bool reads_normal(const ir::Graph &graph, const ir::Surface &surface) {
    for (ir::NodeId root : {surface.diffuse, surface.specular, surface.exponent, surface.emission})
        for (ir::NodeId var : graph.free_vars(root))
            if (var == surface.normal) return true;
    return false;
}

} // namespace

namespace {

// Smaller cells have shorter tapes, but fewer points of a tile fall into each: measured.
constexpr double cell_pixels = 16;

// What holds all that rays can come to.
void prune(Stage &stage, Prune how) {
    if (how == Prune::Never) return;
    const ir::Scene &scene = *stage.scene;
    Program distance = compile(scene, scene.distance, Choices::Apart);
    if (how == Prune::Auto &&
        whole_tape(prune_program_of(distance, stage.inputs)).shapes < prune_from)
        return;
    stage.distance = std::move(distance);
    stage.hit = compile(scene, scene.hit, Choices::Apart);
    const ir::Frame &frame = stage.frame;
    Cube cube;
    double side = 2.1 * frame.far;
    glm::dvec3 middle = frame.center;
    if (frame.boxed) {
        side = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            side = std::max(side, 1.001 * (frame.hi[i] - frame.lo[i]));
            middle[i] = (frame.hi[i] + frame.lo[i]) / 2;
        }
    }
    const double pixel = frame.pixel * (stage.view.orthographic ? 1 : stage.view.focus);
    const double cell = cell_pixels * pixel;
    PruneSettings settings;
    settings.depth = std::clamp(static_cast<int>(std::ceil(std::log2(side / cell) / 2)), 1, 10);
    side = std::max(side, std::ldexp(cell, 2 * settings.depth));
    cube.side = static_cast<float>(side);
    for (std::size_t i = 0; i < 3; ++i) cube.lo[i] = static_cast<float>(middle[i] - side / 2);
    stage.pruning = std::make_shared<Pruning>(stage.distance, stage.inputs, cube, settings);
    settings.far_cells = false;
    stage.hit_pruning = std::make_shared<Pruning>(stage.hit, stage.inputs, cube, settings);
    if (!stage.shaded_apart) return;
    stage.shaded = compile(scene, scene.shaded, Choices::Apart);
    stage.shaded_pruning = std::make_shared<Pruning>(stage.shaded, stage.inputs, cube, settings);
}

} // namespace

float shapes_of(const ir::Scene &scene) {
    return whole_tape(prune_program_of(compile(scene, scene.distance, Choices::Apart), {})).shapes;
}

Stage prepare(const ir::Scene &scene, const ir::View &view, int width, int height, double time,
              Prune how) {
    Stage stage;
    stage.scene = &scene;
    stage.width = width;
    stage.height = height;
    stage.view = view;
    stage.budget = ir::budget_of(scene);
    stage.frame = ir::frame_of(scene, view, height);
    stage.inputs = inputs_of(scene, time);
    stage.distance = compile(scene, scene.distance);
    stage.hit = compile(scene, scene.hit);
    stage.shaded_apart = scene.shaded != scene.distance;
    if (stage.shaded_apart) stage.shaded = compile(scene, scene.shaded);
    prune(stage, how);
    stage.has_safe_radius = scene.safe_radius && !stage.pruning;
    if (stage.has_safe_radius) stage.safe_radius = compile(scene, scene.safe_radius);
    stage.has_background = static_cast<bool>(scene.background_function);
    if (stage.has_background) stage.background = compile(scene, scene.background_function);
    for (const ir::Surface &surface : scene.surfaces) {
        const ir::NodeId params[] = {surface.point, surface.normal, surface.extra};
        const ir::NodeId results[] = {surface.diffuse, surface.specular, surface.exponent,
                                      surface.emission};
        stage.surfaces.push_back(compile(scene, params, results));
        stage.local_normals = stage.local_normals || reads_normal(scene.graph, surface);
    }
    stage.lights = ir::lights_of(scene, time, view);
    const ir::Lighting &lighting = scene.lighting;
    const auto ambient = ir::value_of(scene, lighting.ambient, time);
    for (std::size_t c = 0; c < 3; ++c) stage.shading.ambient[c] = static_cast<float>(ambient[c]);
    stage.shading.ambient_occlusion = number_of(scene, lighting.ambient_occlusion, time);
    stage.shading.shadow_darkness = number_of(scene, lighting.shadow_darkness, time);
    stage.shading.soft_shadows = number_of(scene, lighting.soft_shadows, time);
    stage.shading.specular_intensity = number_of(scene, lighting.specular_intensity, time);
    return stage;
}

Worker::Worker(const Stage &s)
    : stage(s), distance(make_scratch(s.distance, s.inputs)), hit(make_scratch(s.hit, s.inputs)) {
    if (s.shaded_apart) shaded = make_scratch(s.shaded, s.inputs);
    if (s.has_safe_radius) safe_radius = make_scratch(s.safe_radius, s.inputs);
    if (s.has_background) background = make_scratch(s.background, s.inputs);
    for (const Program &surface : s.surfaces) surfaces.push_back(make_scratch(surface, s.inputs));
    if (s.pruning) evaluator.emplace(*s.pruning, s.inputs);
    if (s.hit_pruning) hit_evaluator.emplace(*s.hit_pruning, s.inputs);
    if (s.shaded_pruning) shaded_evaluator.emplace(*s.shaded_pruning, s.inputs);
}

namespace {

RayState eye(const Stage &stage, float x, float y) {
    const auto width = static_cast<float>(stage.width), height = static_cast<float>(stage.height);
    const ir::View &view = stage.view;
    const float u = (2.0f * x / width - 1.0f) * width / height, v = 1.0f - 2.0f * y / height;
    const Vec aside = static_cast<float>(view.extent) * (u * vec(view.right) + v * vec(view.up));
    Vec origin = vec(view.origin), direction = vec(view.forward);
    if (view.orthographic) {
        origin = origin + aside;
    } else {
        direction = direction + aside;
        direction = direction / length(direction);
    }
    return clipped(stage, origin, direction);
}

float encoded(float linear) { return srgb_of_linear(clamp(linear, 0.0f, 1.0f)); }

std::uint8_t byte(float x) {
    return static_cast<std::uint8_t>(clamp(x, 0.0f, 1.0f) * 255.0f + 0.5f);
}

// Blue for few steps, through green and yellow to red for shading.h's `many_steps`; magenta for
// undecided rays.
Vec heat(const Landing &landing) {
    if (landing.end == RayEnd::Undecided) return {1, 0, 1};
    const float x = std::log2(1.0f + static_cast<float>(landing.steps)) /
                    std::log2(1.0f + static_cast<float>(ir::shading::many_steps));
    return {clamp(2.0f * x - 0.6f, 0, 1), clamp(1.6f - std::fabs(3.2f * x - 1.6f), 0, 1),
            clamp(1.0f - 2.2f * x, 0, 1)};
}

void put_pixel(std::uint8_t *pixel, float r, float g, float b) {
    pixel[0] = byte(r);
    pixel[1] = byte(g);
    pixel[2] = byte(b);
    pixel[3] = 255;
}

void draw(Worker &worker, const PictureOptions &options, const Tile &tile, Picture &picture) {
    const Stage &stage = worker.stage;
    const auto count = static_cast<std::size_t>(tile.width * tile.height);
    std::vector<RayState> rays(count);
    std::vector<Landing> landings(count);
    std::vector<Vec> colors(count);
    std::vector<double> sums(3 * count);
    const Tile region = options.region.value_or(Tile{});
    const int samples = options.mode == PictureMode::Color ? std::max(options.samples, 1) : 1;
    for (int sample = 0; sample < samples; ++sample) {
        const auto offset = ir::sample_offset(options.first_sample + sample);
        for (std::size_t i = 0; i < count; ++i) {
            const int x = region.x + tile.x + static_cast<int>(i) % tile.width,
                      y = region.y + tile.y + static_cast<int>(i) / tile.width;
            rays[i] =
                eye(stage, static_cast<float>(x + offset[0]), static_cast<float>(y + offset[1]));
        }
        march(worker, rays, landings, false);
        if (options.mode == PictureMode::Color) shade(worker, rays, landings, colors);
        for (std::size_t i = 0; i < count; ++i) {
            sums[3 * i] += summand(colors[i].x);
            sums[3 * i + 1] += summand(colors[i].y);
            sums[3 * i + 2] += summand(colors[i].z);
        }
    }
    for (int row = 0; row < tile.height; ++row) {
        const auto from = static_cast<std::size_t>(row) * static_cast<std::size_t>(tile.width),
                   to = static_cast<std::size_t>(tile.y + row) *
                            static_cast<std::size_t>(picture.width) +
                        static_cast<std::size_t>(tile.x),
                   width = static_cast<std::size_t>(tile.width);
        const std::span<const double> line = std::span(sums).subspan(3 * from, 3 * width);
        const std::span<std::uint8_t> pixels = std::span(picture.rgba).subspan(4 * to, 4 * width);
        if (options.sums)
            std::ranges::copy(line, picture.sums.begin() + static_cast<std::ptrdiff_t>(3 * to));
        if (options.mode == PictureMode::Color) {
            encode_sums(line, samples, pixels);
            continue;
        }
        for (std::size_t i = 0; i < width; ++i) {
            const Vec c = heat(landings[from + i]);
            put_pixel(pixels.data() + 4 * i, c.x, c.y, c.z);
        }
    }
}

std::vector<Tile> tiles_of(int width, int height) {
    std::vector<Tile> tiles;
    for (int y = 0; y < height; y += tile_side)
        for (int x = 0; x < width; x += tile_side)
            tiles.push_back(
                {x, y, std::min(tile_side, width - x), std::min(tile_side, height - y)});
    return tiles;
}

} // namespace

Ray eye_ray(const Stage &stage, float x, float y) {
    const RayState ray = eye(stage, x, y);
    return {{ray.origin.x, ray.origin.y, ray.origin.z},
            {ray.direction.x, ray.direction.y, ray.direction.z}};
}

std::vector<Landing> cast(const Stage &stage, std::span<const Ray> rays, bool brute) {
    Worker worker(stage);
    std::vector<Landing> landings(rays.size());
    std::vector<RayState> states;
    for (const Ray &ray : rays)
        states.push_back(clipped(stage, {ray.origin[0], ray.origin[1], ray.origin[2]},
                                 {ray.direction[0], ray.direction[1], ray.direction[2]}));
    for (std::size_t first = 0; first < rays.size(); first += max_rays) {
        const std::size_t count = std::min(max_rays, rays.size() - first);
        march(worker, std::span(states).subspan(first, count),
              std::span(landings).subspan(first, count), brute);
    }
    return landings;
}

double summand(float linear) {
    const double limited = std::clamp(static_cast<double>(linear), -0x1p12, 0x1p12); // keeps a NaN
    return std::nearbyint(limited * 0x1p32) * 0x1p-32;
}

void encode_sums(std::span<const double> sums, int samples, std::span<std::uint8_t> rgba) {
    const auto channel = [&](std::size_t i) {
        return encoded(static_cast<float>(sums[i] / samples));
    };
    for (std::size_t i = 0; 3 * i < sums.size(); ++i)
        put_pixel(rgba.data() + 4 * i, channel(3 * i), channel(3 * i + 1), channel(3 * i + 2));
}

Picture render(const Stage &stage, const PictureOptions &options, const Progress &progress) {
    Picture picture;
    picture.width = options.region ? options.region->width : stage.width;
    picture.height = options.region ? options.region->height : stage.height;
    const std::size_t pixels =
        static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
    picture.rgba.resize(4 * pixels);
    if (options.sums) picture.sums.resize(3 * pixels);
    const std::vector<Tile> tiles = tiles_of(picture.width, picture.height);
    std::atomic<std::size_t> next{0};
    std::atomic<bool> cancelled{false};
    std::size_t finished = 0;
    std::mutex report;

    auto work = [&] {
        Worker worker(stage);
        while (!cancelled) {
            const std::size_t i = next++;
            if (i >= tiles.size()) break;
            draw(worker, options, tiles[i], picture); // tiles share no pixel
            const std::lock_guard lock(report);
            ++finished;
            const double done = static_cast<double>(finished) / static_cast<double>(tiles.size());
            if (progress && !cancelled && !progress(done, tiles[i], picture)) cancelled = true;
        }
        const std::lock_guard lock(report);
        if (worker.evaluator) {
            const CellEvaluator::Tally &tally = worker.evaluator->tally;
            worker.work.far = tally.far;
            worker.work.near = tally.near;
            worker.work.near_shapes = tally.shapes;
        }
        picture.work += worker.work;
    };
    const unsigned jobs =
        options.jobs > 0 ? options.jobs : std::max(std::thread::hardware_concurrency(), 1u);
    std::vector<std::thread> threads;
    for (unsigned j = 1; j < std::min<std::size_t>(jobs, tiles.size()); ++j)
        threads.emplace_back(work);
    work();
    for (std::thread &thread : threads) thread.join();
    picture.complete = finished == tiles.size() && !cancelled;
    return picture;
}

} // namespace fathom::cpu
