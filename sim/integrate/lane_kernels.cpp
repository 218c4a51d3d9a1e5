#include "sim/integrate/lane_kernels.hpp"

#include <array>

// The bodies are included, not called: the compiler lowers vector types to what the function's own target has
// before it inlines anything.
namespace beamcam::sim {
namespace {

// 1/j of the powers τʲ/j!.
constexpr auto kInverse = [] {
    std::array<double, 32> inverse{};
    for (int j = 1; j < 32; ++j) inverse[static_cast<std::size_t>(j)] = 1.0 / j;
    return inverse;
}();

}  // namespace
namespace baseline {
#define BEAMCAM_LANE_BYTES 16
#include "sim/integrate/lane_kernels_body.inc"
#undef BEAMCAM_LANE_BYTES
}  // namespace baseline
}  // namespace beamcam::sim

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define BEAMCAM_DISPATCH
#pragma GCC push_options
#pragma GCC target("avx2")
namespace beamcam::sim {
namespace avx2 {
#define BEAMCAM_LANE_BYTES 32
#include "sim/integrate/lane_kernels_body.inc"
#undef BEAMCAM_LANE_BYTES
}  // namespace avx2
}  // namespace beamcam::sim
#pragma GCC pop_options
#pragma GCC push_options
#pragma GCC target("avx512f")
namespace beamcam::sim {
namespace avx512 {
#define BEAMCAM_LANE_BYTES 64
#include "sim/integrate/lane_kernels_body.inc"
#undef BEAMCAM_LANE_BYTES
}  // namespace avx512
}  // namespace beamcam::sim
#pragma GCC pop_options
#endif

namespace beamcam::sim {

std::vector<LaneKernels> runnable_lane_kernels() {
    std::vector<LaneKernels> found{{baseline::multiply, baseline::propagate, baseline::propagate_rates,
                                    baseline::respond, baseline::combine, baseline::evolve, "baseline"}};
#ifdef BEAMCAM_DISPATCH
    if (__builtin_cpu_supports("avx2"))
        found.push_back({avx2::multiply, avx2::propagate, avx2::propagate_rates, avx2::respond, avx2::combine,
                         avx2::evolve, "avx2"});
    if (__builtin_cpu_supports("avx512f"))
        found.push_back({avx512::multiply, avx512::propagate, avx512::propagate_rates, avx512::respond, avx512::combine,
                         avx512::evolve, "avx512f"});
#endif
    return found;
}

const LaneKernels& lane_kernels() {
    static const LaneKernels fastest = runnable_lane_kernels().back();
    return fastest;
}

}  // namespace beamcam::sim
