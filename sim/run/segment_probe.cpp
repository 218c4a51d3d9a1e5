#include "sim/run/segment_probe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace beamcam::sim {

constexpr double kLebesgue = 2.6;  // ≥ 1 + (2/π) ln 12, Lebesgue constant of 13 Chebyshev points

int SegmentProbe::pieces(const Segment& segment) const {
    return static_cast<int>(
        std::clamp(std::ceil((segment.t1 - segment.t0) * system.highest_frequency()), 2.0, double(kMaxPieces)));
}

// A polynomial deviates from the middle of its values at Chebyshev points by at most half of their range times the
// Lebesgue constant of the points.
SegmentProbe::Range SegmentProbe::range(const Segment& segment) {
    constexpr int kDegree = Segment::kDegree;
    const auto n = static_cast<std::size_t>(system.coordinates());
    std::array<double, kMaxSize> low, high;
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    for (int k = 0; k <= kDegree; ++k) {
        const double share = 0.5 * (1 - std::cos(std::numbers::pi * k / kDegree));
        segment.value(k == kDegree ? segment.t1 : segment.t0 + share * (segment.t1 - segment.t0), y_.data());
        for (std::size_t i = 0; i < n; ++i) {
            low[i] = std::min(low[i], y_[i]);
            high[i] = std::max(high[i], y_[i]);
        }
    }
    Range range;
    for (std::size_t i = 0; i < n; ++i) {
        range.middle[i] = 0.5 * (low[i] + high[i]);
        range.spread[i] = kLebesgue * 0.5 * (high[i] - low[i]);
    }
    return range;
}

int SegmentProbe::pieces_by_travel(const Segment& segment, const Range& range) {
    const CamShape& shape = system.cam().shape();
    const double half = 0.5 * (segment.t1 - segment.t0);
    const double travel = 2 * (system.gap_bound().travel(range.spread.data()) +
                               half * std::fabs(system.cam().speed()) * shape.largest_slope());
    return limited(std::max(travel / (0.5 * shape.inner_radius()), 2 * half * system.cam_rate()));
}

int SegmentProbe::limited(double pieces) {
    if (pieces > kPieceLimit) ++coarse;
    return static_cast<int>(std::clamp(std::ceil(pieces), 2.0, kPieceLimit));
}

}  // namespace beamcam::sim
