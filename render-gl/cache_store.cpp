#include "render-gl/cache_store.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <numeric>

namespace fathom::gl {

namespace {

constexpr auto count_words = static_cast<std::size_t>(glsl::Count::Total);

GLuint texture_3d(GLint format, int side, bool linear) {
    GLuint name = 0;
    const GLenum layout = format == GL_R32UI     ? GL_RED_INTEGER
                          : format == GL_RG32UI  ? GL_RG_INTEGER
                          : format == GL_RGBA32I ? GL_RGBA_INTEGER
                          : format == GL_R32F    ? GL_RED
                                                 : GL_RGBA;
    const GLenum type = format == GL_RGBA32I                        ? GL_INT
                        : format == GL_R32UI || format == GL_RG32UI ? GL_UNSIGNED_INT
                                                                    : GL_FLOAT;
    glGenTextures(1, &name);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_3D, name);
    glTexImage3D(GL_TEXTURE_3D, 0, format, side, side, side, 0, layout, type, nullptr);
    for (GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTexParameteri(GL_TEXTURE_3D, axis, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, linear ? GL_LINEAR : GL_NEAREST);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, linear ? GL_LINEAR : GL_NEAREST);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAX_LEVEL, 0);
    return name;
}

void fill_words(GLuint texture, int side, const std::vector<std::uint32_t> &words) {
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_3D, texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, 0, side, side, side, GL_RED_INTEGER, GL_UNSIGNED_INT,
                    words.data());
}

template <class T>
std::vector<T> read_3d(GLuint texture, std::size_t size, GLenum layout, GLenum type) {
    std::vector<T> values(size);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_3D, texture);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glGetTexImage(GL_TEXTURE_3D, 0, layout, type, values.data());
    return values;
}

CacheCounts counts_in(GLuint buffer) {
    std::array<std::uint32_t, count_words> words{};
    glBindBuffer(GL_COPY_READ_BUFFER, buffer);
    glGetBufferSubData(GL_COPY_READ_BUFFER, 0, sizeof words, words.data());
    const auto at = [&](glsl::Count count) { return words[static_cast<std::size_t>(count)]; };
    return {.inserted = at(glsl::Count::Inserted),
            .evicted = at(glsl::Count::Evicted),
            .deleted = at(glsl::Count::Deleted),
            .crowded = at(glsl::Count::Crowded),
            .full = at(glsl::Count::Full),
            .swept = at(glsl::Count::Swept),
            .paid = at(glsl::Count::Paid),
            .wasted = at(glsl::Count::Wasted),
            .left = at(glsl::Count::Left),
            .steps = at(glsl::Count::Steps)};
}

std::uint32_t place_of(std::uint32_t entry) { return entry & ((1u << glsl::cache_place_bits) - 1); }
int age_of(std::uint32_t entry) { return static_cast<int>(entry >> glsl::cache_place_bits & 7u); }

} // namespace

std::uint64_t CacheSize::bytes() const {
    return (std::uint64_t{1} << (3 * bits)) * (4 + 16 + 8 + 4 + 4 + 8 * 4 + (wide ? 8 * 16 : 0));
}

std::array<int, 3> cache_slot(const std::array<int, 4> &key, int age, int bits) {
    const std::uint32_t last = (1u << bits) - 1;
    std::array<int, 3> slot{};
    for (std::size_t i = 0; i < 3; ++i) // unsigned, so that what is too large wraps as on the card
        slot[i] = static_cast<int>(
            (static_cast<std::uint32_t>(key[i]) +
             static_cast<std::uint32_t>(glsl::cache_shifts[static_cast<std::size_t>(age)][i]) +
             static_cast<std::uint32_t>(key[3]) *
                 static_cast<std::uint32_t>(glsl::cache_field_shift[i])) &
            last);
    return slot;
}

CacheStore::~CacheStore() { release(); }

void CacheStore::release() {
    for (GLuint *texture :
         {&hash_, &keys_, &index_, &pool_, &wide_, &free_, &changed_, &counts_texture_}) {
        if (*texture) glDeleteTextures(1, texture);
        *texture = 0;
    }
    if (counts_) glDeleteBuffers(1, &counts_);
    if (aside_[0]) glDeleteBuffers(static_cast<GLsizei>(aside_.size()), aside_.data());
    counts_ = 0;
    aside_ = {};
    set_aside_ = 0;
}

bool CacheStore::make(const CacheSize &size) {
    release();
    while (glGetError() != GL_NO_ERROR) {
    } // what was wrong before is not ours to report
    size_ = size;
    hash_ = texture_3d(GL_R32UI, side(), false);
    keys_ = texture_3d(GL_RGBA32I, side(), false);
    index_ = texture_3d(GL_RG32UI, side(), false);
    free_ = texture_3d(GL_R32UI, side(), false);
    changed_ = texture_3d(GL_R32UI, side(), false);
    pool_ = texture_3d(GL_R32F, 2 * side(), true);
    if (size.wide) wide_ = texture_3d(GL_RGBA32F, 2 * side(), true);
    glGenBuffers(1, &counts_);
    glBindBuffer(GL_TEXTURE_BUFFER, counts_);
    glBufferData(GL_TEXTURE_BUFFER, count_words * 4, nullptr, GL_DYNAMIC_COPY);
    glGenTextures(1, &counts_texture_);
    glBindTexture(GL_TEXTURE_BUFFER, counts_texture_);
    glTexBuffer(GL_TEXTURE_BUFFER, GL_R32UI, counts_);
    glGenBuffers(static_cast<GLsizei>(aside_.size()), aside_.data());
    for (GLuint buffer : aside_) {
        glBindBuffer(GL_COPY_WRITE_BUFFER, buffer);
        glBufferData(GL_COPY_WRITE_BUFFER, count_words * 4, nullptr, GL_STREAM_READ);
    }
    if (glGetError() != GL_NO_ERROR) {
        release();
        return false;
    }
    clear();
    return glGetError() == GL_NO_ERROR;
}

void CacheStore::clear() {
    std::vector<std::uint32_t> words(cells());
    std::iota(words.begin(), words.end(), 0u);
    fill_words(free_, side(), words);
    std::fill(words.begin(), words.end(), glsl::cache_empty);
    fill_words(hash_, side(), words);
    words.resize(2 * cells(), glsl::cache_empty);
    glBindTexture(GL_TEXTURE_3D, index_);
    glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, 0, side(), side(), side(), GL_RG_INTEGER,
                    GL_UNSIGNED_INT, words.data());
    std::array<std::uint32_t, count_words> counts{};
    counts[static_cast<std::size_t>(glsl::Count::Tail)] = static_cast<std::uint32_t>(cells());
    glBindBuffer(GL_TEXTURE_BUFFER, counts_);
    glBufferSubData(GL_TEXTURE_BUFFER, 0, sizeof counts, counts.data());
}

void CacheStore::begin_frame() {
    constexpr auto at = [](glsl::Count count) { return static_cast<GLintptr>(count) * 4; };
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_COPY_READ_BUFFER, counts_);
    glBindBuffer(GL_COPY_WRITE_BUFFER, counts_);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, at(glsl::Count::Tail),
                        at(glsl::Count::Limit), 4);
    const std::array<std::uint32_t, count_words> zeros{};
    glBufferSubData(GL_COPY_WRITE_BUFFER, at(glsl::Count::Inserted),
                    at(glsl::Count::Total) - at(glsl::Count::Inserted), zeros.data());
}

void CacheStore::bind_textures(int first_unit) const {
    const GLuint all[] = {index_, pool_, wide_};
    for (GLuint texture : all) {
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(first_unit++));
        glBindTexture(GL_TEXTURE_3D, texture);
    }
}

CacheCounts CacheStore::read_counts() const {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    return counts_in(counts_);
}

void CacheStore::set_counts_aside() {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_COPY_READ_BUFFER, counts_);
    glBindBuffer(GL_COPY_WRITE_BUFFER, aside_[set_aside_++ % aside_.size()]);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, count_words * 4);
}

std::optional<CacheCounts> CacheStore::counts_before() const {
    if (set_aside_ < 3) return std::nullopt;
    return counts_in(aside_[set_aside_ % aside_.size()]);
}

CacheStore::Dump CacheStore::dump(bool with_pool) const {
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    Dump dump;
    dump.bits = size_.bits;
    dump.hash = read_3d<std::uint32_t>(hash_, cells(), GL_RED_INTEGER, GL_UNSIGNED_INT);
    dump.free = read_3d<std::uint32_t>(free_, cells(), GL_RED_INTEGER, GL_UNSIGNED_INT);
    dump.index =
        read_3d<std::array<std::uint32_t, 2>>(index_, cells(), GL_RG_INTEGER, GL_UNSIGNED_INT);
    dump.keys = read_3d<std::array<std::int32_t, 4>>(keys_, cells(), GL_RGBA_INTEGER, GL_INT);
    dump.counts.resize(count_words);
    glBindBuffer(GL_COPY_READ_BUFFER, counts_);
    glGetBufferSubData(GL_COPY_READ_BUFFER, 0, count_words * 4, dump.counts.data());
    if (with_pool) dump.pool = read_3d<float>(pool_, 8 * cells(), GL_RED, GL_FLOAT);
    if (with_pool && wide_)
        dump.wide = read_3d<std::array<float, 4>>(wide_, 8 * cells(), GL_RGBA, GL_FLOAT);
    return dump;
}

CacheOccupancy occupancy(const CacheStore::Dump &dump) {
    CacheOccupancy result;
    result.cells = dump.hash.size();
    for (std::uint32_t entry : dump.hash) {
        if (entry == glsl::cache_empty) continue;
        ++result.keys;
        ++result.ages[static_cast<std::size_t>(std::min(age_of(entry), glsl::cache_ages - 1))];
        ++result.fields[static_cast<std::size_t>(dump.keys[place_of(entry)][3] & 255)];
    }
    return result;
}

std::string check_cache(const CacheStore::Dump &dump) {
    const std::size_t cells = dump.hash.size();
    const int last = (1 << dump.bits) - 1;
    std::vector<int> owners(cells, 0);
    const auto text = [](const std::array<std::int32_t, 4> &key) {
        return fmt::format("{} {} {} of field {}", key[0], key[1], key[2], key[3]);
    };
    const auto word = [&](glsl::Count count) {
        return dump.counts[static_cast<std::size_t>(count)];
    };
    const std::uint32_t head = word(glsl::Count::Head), tail = word(glsl::Count::Tail);
    if (tail - head > cells)
        return fmt::format("the ring holds {} places of {}", tail - head, cells);
    for (std::uint32_t at = head; at != tail; ++at) {
        const std::uint32_t place = dump.free[at & static_cast<std::uint32_t>(cells - 1)];
        if (place >= cells) return fmt::format("the ring names place {}", place);
        if (++owners[place] > 1) return fmt::format("place {} is free twice", place);
    }
    std::map<std::array<std::int32_t, 4>, std::size_t> seen;
    for (std::size_t slot = 0; slot < cells; ++slot) {
        const std::uint32_t entry = dump.hash[slot];
        const std::array<std::uint32_t, 2> &index = dump.index[slot];
        if (entry == glsl::cache_empty) {
            if (index[1] != glsl::cache_empty) return "the index names what is not there";
            continue;
        }
        const std::uint32_t place = place_of(entry);
        if (place >= cells) return fmt::format("an entry names place {}", place);
        if (++owners[place] > 1) return fmt::format("place {} has two owners", place);
        std::array<std::int32_t, 4> key = dump.keys[place];
        key[3] &= 255;
        const std::array<int, 3> here{static_cast<int>(slot) & last,
                                      static_cast<int>(slot >> dump.bits) & last,
                                      static_cast<int>(slot >> (2 * dump.bits))};
        if (age_of(entry) >= glsl::cache_ages) return "the key " + text(key) + " is too old";
        if (cache_slot(key, age_of(entry), dump.bits) != here)
            return "the key " + text(key) + " does not lie where its age says";
        std::uint32_t tag = dump.keys[place][3] > 255 ? 0x80000000u : 0u;
        for (std::size_t i = 0; i < 3; ++i)
            tag |= (static_cast<std::uint32_t>(key[i] >> dump.bits) &
                    ((1u << glsl::cache_high_bits) - 1))
                   << (i * glsl::cache_high_bits);
        const std::uint32_t rest = place |
                                   static_cast<std::uint32_t>(key[3]) << glsl::cache_place_bits |
                                   static_cast<std::uint32_t>(age_of(entry)) << 29;
        if (index != std::array{tag, rest}) return "the index of " + text(key) + " is wrong";
        if (!seen.emplace(key, slot).second) return "the key " + text(key) + " is there twice";
    }
    for (std::size_t place = 0; place < cells; ++place)
        if (owners[place] == 0) return fmt::format("place {} is lost", place);
    return "";
}

} // namespace fathom::gl
