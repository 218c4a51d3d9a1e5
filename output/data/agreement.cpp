#include "output/data/agreement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beamcam::output {
namespace {

class PartSums {
  public:
    void add(double t, double measured, double computed) {
        const double difference = measured - computed;
        ++part_.rows;
        squares_ += difference * difference;
        if (std::abs(difference) > std::abs(part_.largest)) part_.largest = difference, part_.t_largest = t;
        most_measured_ = std::max(most_measured_, measured);
        most_computed_ = std::max(most_computed_, computed);
    }
    Agreement::Part result() const {
        Agreement::Part out = part_;
        if (out.rows == 0) return out;
        out.rms = std::sqrt(squares_ / static_cast<double>(out.rows));
        out.highest = most_measured_ - most_computed_;
        return out;
    }

  private:
    static constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Agreement::Part part_;
    double squares_ = 0, most_measured_ = -kInfinity, most_computed_ = -kInfinity;
};

Agreement::Statistics statistics(const std::vector<double>& values) {
    const auto count = static_cast<double>(values.size());
    Agreement::Statistics out;
    for (const double v : values) out.mean += v / count;
    for (const double v : values) out.deviation += (v - out.mean) * (v - out.mean) / count;
    out.deviation = std::sqrt(out.deviation);
    return out;
}

bool is_reproducible(const sim::Result& result, double t) {
    return std::ranges::none_of(result.not_reproducible,
                                [&](const sim::Interval& lost) { return t > lost.from && !(lost.to && t > *lost.to); });
}

}  // namespace

Agreement agreement(const std::vector<double>& times, const std::vector<double>& measured,
                    const std::vector<double>& computed, const sim::Result& result) {
    PartSums whole;
    std::vector<PartSums> parts(result.collisions.size());
    std::vector<double> beyond_measured, beyond_computed;
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (!std::isfinite(measured[i]) || !std::isfinite(computed[i])) continue;
        if (!is_reproducible(result, times[i])) {
            beyond_measured.push_back(measured[i]);
            beyond_computed.push_back(computed[i]);
            continue;
        }
        whole.add(times[i], measured[i], computed[i]);
        const auto next = std::ranges::upper_bound(result.collisions, times[i], {}, &sim::Collision::t_start);
        if (next != result.collisions.begin())
            parts[static_cast<std::size_t>(next - result.collisions.begin()) - 1].add(times[i], measured[i],
                                                                                      computed[i]);
    }
    Agreement out;
    out.whole = whole.result();
    for (std::size_t k = 0; k < parts.size(); ++k)
        if (const Agreement::Part part = parts[k].result(); part.rows > 0)
            out.collisions.push_back({part, static_cast<int>(k) + 1, result.collisions[k].t_start});
    if (!beyond_measured.empty())
        out.beyond = {beyond_measured.size(), statistics(beyond_measured), statistics(beyond_computed)};
    return out;
}

}  // namespace beamcam::output
