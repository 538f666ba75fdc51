// A picture as tiles over threads: eye rays in, sRGB out. Each thread takes the next tile that no
// one has; a finished one is reported under a lock, so that the caller's function runs once at a
// time.
#include "base/picture.h"
#include "backend-cpu/trace/rays.h"

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
    passed += other.passed;
    far += other.far, near += other.near;
    near_shapes += other.near_shapes;
    return *this;
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

// Samples of pixels: which pixel, and which of its samples.
struct Places {
    std::vector<int> x, y, sample;
    std::size_t size() const { return x.size(); }
    void add(int px, int py, int s) { x.push_back(px), y.push_back(py), sample.push_back(s); }
    void clear() { x.clear(), y.clear(), sample.clear(); }
};

Places first_of(const Tile &tile) {
    Places places;
    for (int y = tile.y; y < tile.y + tile.height; ++y)
        for (int x = tile.x; x < tile.x + tile.width; ++x) places.add(x, y, 0);
    return places;
}

// Where samples land, at most max_rays, and in colour what they see there. With alpha `cover` is how
// much of that is no background.
struct Seen {
    std::vector<Landing> landings;
    std::vector<Vec> colors;
    std::vector<float> cover;
};
Seen look(Worker &worker, const Places &places, const PictureOptions &options) {
    const Stage &stage = worker.stage;
    std::vector<RayState> rays;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto offset = ir::sample_offset(places.sample[i]);
        rays.push_back(eye(stage, static_cast<float>(places.x[i] + offset[0]),
                           static_cast<float>(places.y[i] + offset[1])));
    }
    Seen seen{std::vector<Landing>(places.size()), std::vector<Vec>(places.size()),
              std::vector<float>(options.alpha ? places.size() : 0)};
    march(worker, rays, seen.landings, false);
    if (options.mode == PictureMode::Color)
        shade(worker, rays, seen.landings, seen.colors, seen.cover);
    return seen;
}

// Of samples: three colours and what covers them (summand).
struct Sum {
    std::array<double, 4> numbers{};
    void add(const Seen &seen, std::size_t i) {
        for (std::size_t c = 0; c < 3; ++c)
            numbers[c] += summand(seen.colors[i][static_cast<int>(c)]);
        numbers[3] += seen.cover.empty() ? 1 : summand(seen.cover[i]);
    }
};

// The picture that is being made of a part of the whole one.
struct PartPicture {
    Tile region;
    const PictureOptions &options;
    Picture &picture;
    std::size_t place(int x, int y) const { // of a pixel of the whole picture
        return static_cast<std::size_t>(y - region.y) * static_cast<std::size_t>(region.width) +
               static_cast<std::size_t>(x - region.x);
    }
    std::uint8_t *pixel(int x, int y) { return picture.rgba.data() + 4 * place(x, y); }
    void put(int x, int y, const Sum &sum, int samples) {
        std::array<float, 4> linear;
        for (std::size_t c = 0; c < 4; ++c)
            linear[c] = static_cast<float>(sum.numbers[c] / samples);
        encode_linear(linear, x, y, {pixel(x, y), 4});
        const auto to = [&](auto &numbers, std::size_t each) {
            return numbers.begin() + static_cast<std::ptrdiff_t>(each * place(x, y));
        };
        if (options.linear) std::ranges::copy(linear, to(picture.linear, 4));
        if (options.sums) std::copy_n(sum.numbers.begin(), 3, to(picture.sums, 3));
    }
};

// Samples on the way to their pixels' sums, as many at once as a worker takes.
class Summing {
  public:
    Summing(Worker &worker, const PictureOptions &options, std::vector<Sum> &sums)
        : worker_(worker), options_(options), sums_(sums) {}
    void add(std::size_t pixel, int x, int y, int sample) {
        pixels_.push_back(pixel);
        places_.add(x, y, sample);
        if (places_.size() == max_rays) finish();
    }
    void finish() {
        const Seen seen = look(worker_, places_, options_);
        for (std::size_t i = 0; i < pixels_.size(); ++i) sums_[pixels_[i]].add(seen, i);
        pixels_.clear(), places_.clear();
    }

  private:
    Worker &worker_;
    const PictureOptions &options_;
    std::vector<Sum> &sums_;
    Places places_;
    std::vector<std::size_t> pixels_; // by place
};

// All samples of a tile, which lies in the region.
void draw(Worker &worker, const PictureOptions &options, const Tile &tile, PartPicture &part) {
    const Places places = first_of(tile);
    if (options.mode == PictureMode::Steps) {
        const Seen seen = look(worker, places, options);
        for (std::size_t i = 0; i < places.size(); ++i) {
            std::uint8_t *pixel = part.pixel(places.x[i], places.y[i]);
            const Vec c = heat(seen.landings[i]);
            for (int k = 0; k < 3; ++k) pixel[k] = byte(c[k]);
            pixel[3] = 255;
        }
        return;
    }
    std::vector<Sum> sums(places.size());
    const int samples = std::max(options.samples, 1);
    Summing summing(worker, options, sums);
    for (int sample = 0; sample < samples; ++sample)
        for (std::size_t i = 0; i < places.size(); ++i)
            summing.add(i, places.x[i], places.y[i], options.first_sample + sample);
    summing.finish();
    for (std::size_t i = 0; i < places.size(); ++i)
        part.put(places.x[i], places.y[i], sums[i], samples);
}

// One sample of each pixel, and where it is rough more.
class Smooth {
  public:
    Smooth(const Stage &stage, PartPicture &part) : part_(part), area_(part.region) {
        // How rough a pixel at the edge of the region is is told by its neighbours outside, and theirs.
        constexpr int beside = busy_around + 1;
        const int left = std::max(area_.x - beside, 0), top = std::max(area_.y - beside, 0),
                  right = std::min(area_.x + area_.width + beside, stage.width),
                  bottom = std::min(area_.y + area_.height + beside, stage.height);
        area_ = {left, top, right - left, bottom - top};
        const auto pixels =
            static_cast<std::size_t>(area_.width) * static_cast<std::size_t>(area_.height);
        first_.resize(4 * pixels), close_.resize(pixels);
    }
    const Tile &area() const { return area_; } // what has to be drawn once
    void draw_first(Worker &worker, const Tile &tile) {
        const Places places = first_of(tile);
        const Seen seen = look(worker, places, part_.options);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const int x = places.x[i], y = places.y[i];
            float *color = first_.data() + 4 * place(x, y);
            for (int c = 0; c < 3; ++c) color[c] = seen.colors[i][c];
            color[3] = seen.cover.empty() ? 1 : seen.cover[i];
            close_[place(x, y)] = seen.landings[i].close;
            Sum sum;
            sum.add(seen, i);
            if (is_inside(x, y)) part_.put(x, y, sum, 1);
        }
    }
    void find_rough() {
        rough_ = rough_pixels(area_.width, area_.height, first_, part_.options.alpha);
        for (std::size_t i = 0; i < rough_.size(); ++i)
            if (close_[i]) rough_[i] = std::max<std::uint8_t>(rough_[i], 2);
    }
    void draw_more(Worker &worker, const Tile &tile) {
        Places places;
        for (int y = tile.y; y < tile.y + tile.height; ++y)
            for (int x = tile.x; x < tile.x + tile.width; ++x)
                if (is_inside(x, y) && rough_[place(x, y)]) places.add(x, y, 0);
        if (places.size() == 0) return;
        std::vector<Sum> sums(places.size());
        Summing summing(worker, part_.options, sums);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const float *first = first_.data() + 4 * place(places.x[i], places.y[i]);
            for (std::size_t c = 0; c < 4; ++c) sums[i].numbers[c] = summand(first[c]);
            for (int sample = 1; sample < samples(places.x[i], places.y[i]); ++sample)
                summing.add(i, places.x[i], places.y[i], sample);
        }
        summing.finish();
        for (std::size_t i = 0; i < places.size(); ++i)
            part_.put(places.x[i], places.y[i], sums[i], samples(places.x[i], places.y[i]));
    }

  private:
    std::size_t place(int x, int y) const {
        return static_cast<std::size_t>(y - area_.y) * static_cast<std::size_t>(area_.width) +
               static_cast<std::size_t>(x - area_.x);
    }
    int samples(int x, int y) const { return ir::shading::rough_samples[rough_[place(x, y)]]; }
    bool is_inside(int x, int y) const {
        const Tile &r = part_.region;
        return x >= r.x && x < r.x + r.width && y >= r.y && y < r.y + r.height;
    }

    PartPicture &part_;
    Tile area_;
    std::vector<float> first_;        // linear, four a pixel of the area
    std::vector<std::uint8_t> rough_; // as rough_pixels tells
    std::vector<std::uint8_t> close_; // 1 or 0
};

std::vector<Tile> tiles_of(const Tile &area, unsigned threads) {
    const auto tiles = [&](int side) {
        return static_cast<unsigned>((area.width + side - 1) / side) *
               static_cast<unsigned>((area.height + side - 1) / side);
    };
    int side = max_tile_side;
    while (side > min_tile_side && tiles(side) < tiles_a_thread * threads) side /= 2;
    std::vector<Tile> made;
    const int right = area.x + area.width, bottom = area.y + area.height;
    for (int y = area.y; y < bottom; y += side)
        for (int x = area.x; x < right; x += side)
            made.push_back({x, y, std::min(side, right - x), std::min(side, bottom - y)});
    return made;
}

// What of a tile lies in the region, from the region's corner.
Tile within(const Tile &tile, const Tile &region) {
    const int left = std::max(tile.x, region.x), top = std::max(tile.y, region.y),
              right = std::min(tile.x + tile.width, region.x + region.width),
              bottom = std::min(tile.y + tile.height, region.y + region.height);
    return {left - region.x, top - region.y, std::max(right - left, 0), std::max(bottom - top, 0)};
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

void encode_linear(std::span<const float> linear, int x, int y, std::span<std::uint8_t> rgba) {
    for (std::size_t i = 0; 4 * i < linear.size(); ++i, ++x) {
        const float add = dither(x, y), alpha = linear[4 * i + 3];
        for (std::size_t c = 0; c < 3; ++c) {
            const float color = linear[4 * i + c];
            rgba[4 * i + c] = srgb_byte(alpha > 0 && alpha < 1 ? color / alpha : color, add);
        }
        rgba[4 * i + 3] = byte(alpha);
    }
}

void encode_sums(std::span<const double> sums, int samples, int x, int y,
                 std::span<std::uint8_t> rgba) {
    for (std::size_t i = 0; 3 * i < sums.size(); ++i, ++x) {
        const std::array<float, 4> linear{static_cast<float>(sums[3 * i] / samples),
                                          static_cast<float>(sums[3 * i + 1] / samples),
                                          static_cast<float>(sums[3 * i + 2] / samples), 1};
        encode_linear(linear, x, y, rgba.subspan(4 * i, 4));
    }
}

Picture render(const Stage &stage, const PictureOptions &options, const Progress &progress) {
    Picture picture;
    const Tile region = options.region.value_or(Tile{0, 0, stage.width, stage.height});
    picture.width = region.width;
    picture.height = region.height;
    const std::size_t pixels =
        static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
    picture.rgba.resize(4 * pixels);
    if (options.sums) picture.sums.resize(3 * pixels);
    if (options.linear) picture.linear.resize(4 * pixels);
    PartPicture part{region, options, picture};
    std::mutex report;

    // Every tile of an area once, by all threads. Whether the caller wants to go on.
    const unsigned jobs =
        options.jobs > 0 ? options.jobs : std::max(std::thread::hardware_concurrency(), 1u);
    const auto each_tile = [&](const Tile &area, double begin, double end, const auto &draw_tile) {
        const std::vector<Tile> tiles = tiles_of(area, jobs);
        std::atomic<std::size_t> next{0};
        std::atomic<bool> cancelled{false};
        std::size_t finished = 0;
        auto work = [&] {
            Worker worker(stage);
            while (!cancelled) {
                const std::size_t i = next++;
                if (i >= tiles.size()) break;
                draw_tile(worker, tiles[i]); // tiles share no pixel
                const std::lock_guard lock(report);
                ++finished;
                const double done =
                    static_cast<double>(finished) / static_cast<double>(tiles.size());
                if (progress && !cancelled &&
                    !progress(begin + done * (end - begin), within(tiles[i], region), picture))
                    cancelled = true;
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
        std::vector<std::thread> threads;
        for (unsigned j = 1; j < std::min<std::size_t>(jobs, tiles.size()); ++j)
            threads.emplace_back(work);
        work();
        for (std::thread &thread : threads) thread.join();
        picture.complete = finished == tiles.size() && !cancelled;
        return picture.complete;
    };

    if (options.samples > 0 || options.mode == PictureMode::Steps) {
        each_tile(region, 0, 1,
                  [&](Worker &worker, const Tile &tile) { draw(worker, options, tile, part); });
        return picture;
    }
    Smooth smooth(stage, part);
    if (!each_tile(smooth.area(), 0, 0.5,
                   [&](Worker &worker, const Tile &tile) { smooth.draw_first(worker, tile); }))
        return picture;
    smooth.find_rough();
    each_tile(region, 0.5, 1,
              [&](Worker &worker, const Tile &tile) { smooth.draw_more(worker, tile); });
    return picture;
}

} // namespace fathom::cpu
