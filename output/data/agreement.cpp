#include "output/data/agreement.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::output {
namespace {

bool is_reproducible(const sim::Result& result, double t) {
    return std::ranges::none_of(result.not_reproducible,
                                [&](const sim::Interval& lost) { return t > lost.from && !(lost.to && t > *lost.to); });
}

}  // namespace

Agreement agreement(const std::vector<double>& times, const std::vector<double>& measured,
                    const std::vector<double>& computed, const sim::Result& result) {
    Agreement out;
    double squares = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
        const double difference = measured[i] - computed[i];
        if (!std::isfinite(difference) || !is_reproducible(result, times[i])) continue;
        ++out.rows;
        squares += difference * difference;
    }
    if (out.rows > 0) out.rms = std::sqrt(squares / static_cast<double>(out.rows));
    return out;
}

}  // namespace beamcam::output
