#include "api/picture.h"

#include "backend-cpu/trace/march.h"
#include "base/picture.h"
#include "driver/image.h"

#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <span>

namespace fathom::v1 {
namespace {

cpu::Stage stage_of(const ir::Scene &scene, const PictureOptions &options, double time) {
    cpu::Stage stage =
        cpu::prepare(scene, view_of(scene, options, time), options.width, options.height, time);
    // A light that the scene leaves to the view stays where it is as the camera turns.
    stage.lights = ir::lights_of(scene, time, ir::view_of(scene, time, aspect_of(options)));
    if (options.max_steps > 0) stage.budget = options.max_steps;
    return stage;
}

Picture traced(const ir::Scene &scene, const PictureOptions &options, double time) {
    const cpu::Stage stage = stage_of(scene, options, time);
    cpu::PictureOptions to;
    to.samples = options.samples;
    to.first_sample = options.first_sample;
    if (options.region)
        to.region = {options.region->x, options.region->y, options.region->width,
                     options.region->height};
    to.sums = options.sums;
    to.linear = options.linear;
    to.alpha = options.alpha;
    to.jobs = options.threads;
    cpu::Picture made =
        cpu::render(stage, to, [&](double done, const cpu::Tile &tile, const cpu::Picture &so_far) {
            if (options.drawn)
                options.drawn({tile.x, tile.y, tile.width, tile.height}, so_far.rgba);
            return !options.progress || options.progress(done);
        });
    Picture picture{made.width,
                    made.height,
                    std::move(made.rgba),
                    made.complete,
                    made.work.undecided,
                    made.work.undecided_shadows,
                    made.work.passed,
                    std::move(made.linear),
                    std::move(made.sums),
                    made.work.rays,
                    made.work.steps,
                    made.work.evaluations,
                    ""};
    if (stage.pruning && made.work.near > 0)
        picture.remark =
            fmt::format("pruned: {:.0f} shapes to {:.0f} a cell", cpu::shapes_of(scene),
                        made.work.near_shapes / static_cast<double>(made.work.near));
    return picture;
}

// The moment of sample k of a pixel: its times are spread over the opening by the golden ratio, so
// that any number of them is spread evenly, and the first is at its beginning.
double time_of_sample(const PictureOptions &options, int k) {
    const double golden = k / std::numbers::phi;
    return options.time + options.shutter * (golden - std::floor(golden));
}

void add(const Picture &from, Picture &to) {
    for (std::size_t i = 0; i < from.sums.size(); ++i) to.sums[i] += from.sums[i];
    for (std::size_t i = 3; i < from.linear.size(); i += 4) to.linear[i] += from.linear[i];
    to.rays += from.rays;
    to.steps += from.steps;
    to.evaluations += from.evaluations;
    to.undecided += from.undecided;
    to.undecided_shadows += from.undecided_shadows;
    to.passed += from.passed;
    to.complete = to.complete && from.complete;
}

// With an open shutter each sample has a moment of its own.
Picture traced_open(const ir::Scene &scene, const PictureOptions &options) {
    const int samples = options.samples;
    PictureOptions each = options;
    each.samples = 1;
    each.sums = each.linear = true;
    Picture sum;
    for (int k = 0; k < samples; ++k) {
        each.first_sample = options.first_sample + k;
        if (options.progress)
            each.progress = [&](double done) { return options.progress((k + done) / samples); };
        Picture one = traced(scene, each, time_of_sample(options, each.first_sample));
        if (k == 0)
            sum = std::move(one);
        else
            add(one, sum);
        if (!sum.complete) break;
    }
    for (std::size_t i = 0; 4 * i < sum.linear.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            sum.linear[4 * i + c] = static_cast<float>(sum.sums[3 * i + c] / samples);
        sum.linear[4 * i + 3] /= static_cast<float>(samples);
    }
    const Region part = options.region.value_or(Region{});
    const auto row = 4 * static_cast<std::size_t>(sum.width);
    for (int y = 0; y < sum.height; ++y) {
        const std::size_t first = row * static_cast<std::size_t>(y);
        cpu::encode_linear(std::span(sum.linear).subspan(first, row), part.x, part.y + y,
                           std::span(sum.rgba).subspan(first, row));
    }
    if (!options.sums) sum.sums = {};
    if (!options.linear) sum.linear = {};
    return sum;
}

} // namespace

std::string refused(const Facts &facts, const PictureOptions &options) {
    const auto is_side = [](int pixels) { return pixels >= 1 && pixels <= 65536; };
    if (!is_side(options.width) || !is_side(options.height))
        return "a picture is 1 to 65,536 pixels wide and high";
    if (options.samples < 0 || options.first_sample < 0)
        return "the samples of a pixel are counted from 0";
    if (!(options.shutter >= 0)) return "a shutter is open for 0 seconds or more";
    if (!hold_at(facts, options.time) || !hold_at(facts, options.time + options.shutter))
        return beyond_proof(facts);
    if (!std::isfinite(options.turned)) return "the camera goes around by a finite angle";
    if ((options.sums || options.shutter > 0) &&
        (options.samples < 1 || options.samples > cpu::max_samples))
        return fmt::format("sums, and pictures with an open shutter, have 1 to {} samples",
                           cpu::max_samples);
    if (!options.region) return "";
    const Region &part = *options.region;
    const bool within = part.x >= 0 && part.y >= 0 && part.width >= 1 && part.height >= 1 &&
                        part.width <= options.width - part.x &&
                        part.height <= options.height - part.y;
    return within ? "" : "the part lies beyond the picture";
}

Picture without_picture(std::string why) {
    Picture none;
    none.remark = std::move(why);
    return none;
}

double aspect_of(const PictureOptions &options) {
    return static_cast<double>(options.width) / options.height;
}

ir::View view_of(const ir::Scene &scene, const PictureOptions &options, double time) {
    const ir::View view = ir::view_of(scene, time, aspect_of(options));
    return options.turned == 0 ? view : ir::turned(view, options.turned, 0, 1);
}

Picture draw(const Scene &scene, const PictureOptions &options) {
    if (std::string why = refused(scene.facts(), options); !why.empty())
        return without_picture(std::move(why));
    return guarded(
        [&] {
            return options.shutter > 0 ? traced_open(ir_of(scene), options)
                                       : traced(ir_of(scene), options, options.time);
        },
        [](Diagnostic why) { return without_picture(std::move(why.message)); });
}

std::vector<int> eye_steps(const Scene &scene, const PictureOptions &options) {
    if (!refused(scene.facts(), options).empty()) return {};
    return guarded(
        [&] {
            const cpu::Stage stage = stage_of(ir_of(scene), options, options.time);
            const Region part =
                options.region.value_or(Region{0, 0, options.width, options.height});
            std::vector<cpu::Ray> rays;
            for (int y = part.y; y < part.y + part.height; ++y)
                for (int x = part.x; x < part.x + part.width; ++x)
                    rays.push_back(cpu::eye_ray(stage, static_cast<float>(x) + 0.5f,
                                                static_cast<float>(y) + 0.5f));
            std::vector<int> steps;
            for (const cpu::Landing &landing : cpu::cast(stage, rays))
                steps.push_back(landing.steps);
            return steps;
        },
        [](const Diagnostic &) { return std::vector<int>(); });
}

Picture picture_of_sums(int width, int height, const std::vector<double> &sums, int samples) {
    return guarded(
        [&]() -> Picture {
            if (width < 1 || height < 1 || samples < 1 || samples > cpu::max_samples) return {};
            const std::size_t row = static_cast<std::size_t>(width);
            const std::size_t pixels = row * static_cast<std::size_t>(height);
            if (sums.size() != 3 * pixels) return {};
            Picture picture;
            picture.width = width;
            picture.height = height;
            picture.rgba.resize(4 * pixels);
            for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
                cpu::encode_sums(std::span(sums).subspan(3 * row * y, 3 * row), samples, 0,
                                 static_cast<int>(y),
                                 std::span(picture.rgba).subspan(4 * row * y, 4 * row));
            picture.complete = true;
            return picture;
        },
        [](const Diagnostic &) { return Picture(); });
}

namespace {

bool is_whole(const Picture &picture) {
    return picture.width > 0 && picture.height > 0 &&
           picture.rgba.size() == 4 * static_cast<std::size_t>(picture.width) *
                                      static_cast<std::size_t>(picture.height);
}

} // namespace

std::string encode_png(const Picture &picture, std::string_view note) {
    if (!is_whole(picture)) return "";
    return guarded(
        [&] { return fathom::encode_png(picture.width, picture.height, picture.rgba, note); },
        [](const Diagnostic &) { return std::string(); });
}

std::string encode_jpeg(const Picture &picture, int quality) {
    if (!is_whole(picture) || quality < 1 || quality > 100) return "";
    return guarded(
        [&] { return driver::encode_jpeg(picture.width, picture.height, picture.rgba, quality); },
        [](const Diagnostic &) { return std::string(); });
}

} // namespace fathom::v1
