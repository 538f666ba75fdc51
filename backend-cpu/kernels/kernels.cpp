// What is known of the kernels beside their loops: names, operands, variants; and which set of
// loops this processor runs.
#include "backend-cpu/kernels/kernels.h"

#include "backend-cpu/kernels/kernel_rows.h"

#include <bit>

namespace fathom::cpu {

namespace {

struct Info {
    const char *name;
    int inputs, outputs;
    ir::Type type;
    std::uint32_t first_variant;
};

template <class R> constexpr ir::Type type_of() {
    if constexpr (std::is_same_v<R, bool>) return ir::Type::Bool;
    if constexpr (std::is_same_v<R, std::int32_t>) return ir::Type::Int;
    return ir::Type::Float;
}
template <class R, class... P> constexpr Info info_of_run(const char *name, R (*)(P...)) {
    return {name, sizeof...(P), static_cast<int>(base::outputs_of<R>), type_of<R>(), 0};
}

constexpr auto make_infos() {
    std::array<Info, kernel_count> infos{};
    std::size_t at = 0;
    std::uint32_t variants = 0;
#define FATHOM_KERNEL(name, parameters, expression, ...)                                           \
    infos[at] = info_of_run(#name, &base::name##Row<float>::run);                                  \
    infos[at++].first_variant = variants;                                                          \
    variants += static_cast<std::uint32_t>(base::masks_of<base::name##Row<float>>().size());
#include "backend-cpu/kernels/kernels.def"
#undef FATHOM_KERNEL
    return infos;
}
constexpr auto infos = make_infos();

struct VariantInfo {
    Kernel kernel;
    Mask mask;
};
constexpr std::size_t variant_count = 0
#define FATHOM_KERNEL(name, parameters, expression, ...)                                           \
    +base::masks_of<base::name##Row<float>>().size()
#include "backend-cpu/kernels/kernels.def"
#undef FATHOM_KERNEL
    ;
constexpr auto make_variants() {
    std::array<VariantInfo, variant_count> variants{};
    std::size_t at = 0;
#define FATHOM_KERNEL(name, parameters, expression, ...)                                           \
    for (Mask mask : base::masks_of<base::name##Row<float>>())                                     \
        variants[at++] = {Kernel::name, mask};
#include "backend-cpu/kernels/kernels.def"
#undef FATHOM_KERNEL
    return variants;
}
constexpr auto variants = make_variants();

const Info &info(Kernel kernel) { return infos[static_cast<std::size_t>(kernel)]; }

} // namespace

const char *kernel_name(Kernel kernel) { return info(kernel).name; }
int kernel_inputs(Kernel kernel) { return info(kernel).inputs; }
int kernel_outputs(Kernel kernel) { return info(kernel).outputs; }
ir::Type kernel_output_type(Kernel kernel) { return info(kernel).type; }

Variant best_variant(Kernel kernel, Mask shared) {
    Variant best{info(kernel).first_variant, 0};
    for (std::uint32_t i = best.index; i < variants.size() && variants[i].kernel == kernel; ++i)
        if ((variants[i].mask & ~shared) == 0 &&
            std::popcount(variants[i].mask) > std::popcount(best.mask))
            best = {i, variants[i].mask};
    return best;
}
Kernel kernel_of_variant(std::uint32_t index) { return variants[index].kernel; }
Mask mask_of_variant(std::uint32_t index) { return variants[index].mask; }

namespace base {
Loops<std::uint32_t> point_loops();
RangeLoops range_loops();
} // namespace base
#ifdef FATHOM_WIDE
namespace avx2 {
Loops<std::uint32_t> point_loops();
RangeLoops range_loops();
} // namespace avx2
namespace avx512 {
Loops<std::uint32_t> point_loops();
RangeLoops range_loops();
} // namespace avx512
#endif

#ifdef FATHOM_WIDE
static bool has_avx2() {
    __builtin_cpu_init();
    return __builtin_cpu_supports("avx2");
}
static bool has_avx512() {
    __builtin_cpu_init();
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
}
#endif

std::vector<LoopSet> point_loop_sets() {
    std::vector<LoopSet> sets{{"base", base::point_loops()}};
#ifdef FATHOM_WIDE
    if (has_avx2()) sets.push_back({"avx2", avx2::point_loops()});
    if (has_avx512()) sets.push_back({"avx512", avx512::point_loops()});
#endif
    return sets;
}

std::vector<RangeLoops> range_loop_sets() {
    std::vector<RangeLoops> sets{base::range_loops()};
#ifdef FATHOM_WIDE
    if (has_avx2()) sets.push_back(avx2::range_loops());
    if (has_avx512()) sets.push_back(avx512::range_loops());
#endif
    return sets;
}

RangeLoops range_loops() {
    static const RangeLoops fastest = range_loop_sets().back();
    return fastest;
}

Loops<std::uint32_t> point_loops() {
    static const Loops<std::uint32_t> fastest = point_loop_sets().back().loops;
    return fastest;
}

} // namespace fathom::cpu
