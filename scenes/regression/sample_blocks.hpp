// Means over the samples of a motion and their standard errors, by batch means.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace beamcam::scenes {

// A mean over blocks and its standard error.
struct MeanEstimate {
    double value = 0, error = 0;
};

// The samples of one point in equal blocks of the time: their number, and the mean of a function of each.
class SampleBlocks {
  public:
    static constexpr std::size_t kBlocks = 10;
    static constexpr std::size_t kFewestBlocks = 5;  // with samples; fewer give no estimate of the error

    SampleBlocks(std::span<const double> t, double from, double to) {
        for (const double at : t) {
            const double block = (at - from) / (to - from) * kBlocks;
            block_.push_back(block > 0 ? static_cast<std::size_t>(std::min(block, kBlocks - 1.0)) : 0);
        }
    }
    template <class Function>
    MeanEstimate mean(std::span<const double> samples, Function&& of) const {
        std::array<double, kBlocks> sum{}, count{};
        for (std::size_t i = 0; i < samples.size(); ++i) sum[block_[i]] += of(samples[i]), ++count[block_[i]];
        std::vector<double> means;
        for (std::size_t b = 0; b < kBlocks; ++b)
            if (count[b] > 0) means.push_back(sum[b] / count[b]);
        return estimate(means);
    }
    MeanEstimate number() const {
        std::vector<double> count(kBlocks);
        for (const std::size_t block : block_) ++count[block];
        return estimate(count);
    }

  private:
    static MeanEstimate estimate(const std::vector<double>& blocks) {
        if (blocks.size() < kFewestBlocks) return {0, INFINITY};
        const auto n = static_cast<double>(blocks.size());
        double sum = 0, squares = 0;
        for (const double x : blocks) sum += x;
        for (const double x : blocks) squares += (x - sum / n) * (x - sum / n);
        return {sum / n, std::sqrt(squares / (n * (n - 1)))};
    }

    std::vector<std::size_t> block_;
};

}  // namespace beamcam::scenes
