#include "scenes/figures/series_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/figures/studies.hpp"
#include "sim/beam/modes.hpp"
#include "sim/observe/spectrum.hpp"

namespace beamcam::scenes {
namespace {

constexpr double kSamplesPerPeriod = 8;            // of the highest mode: its overtones in contact do not fold back
constexpr int kFewest = 1 << 12, kMost = 1 << 20;  // 1 << 20: 8 MB a curve

// A power of two: the fastest transform.
int samples(const sim::Problem& problem, double length) {
    double highest = 0;  // [Hz]
    for (const sim::Mode& mode : sim::natural_modes(problem))
        if (std::isfinite(mode.omega)) highest = std::max(highest, mode.omega / (2 * std::numbers::pi));
    int count = kFewest;
    while (count < kMost && count < kSamplesPerPeriod * highest * length) count *= 2;
    return count;
}

}  // namespace

std::vector<double> spectrum_instants(const sim::Problem& problem, double from, double to) {
    // Without the last instant, which begins the next period of the transform.
    const int count = samples(problem, to - from);
    std::vector<double> times = instants({from, to, count + 1});
    times.pop_back();
    return times;
}

sim::Table spectrum_table(const sim::Table& rows, std::optional<double> highest) {
    const std::vector<double>& t = rows.values.front();
    sim::Spectrum spectrum = sim::amplitude_spectrum(rows.values.back(), t[1] - t[0]);
    const double until = highest.value_or(0.375 * spectrum.frequency.back());
    const auto count = std::ranges::upper_bound(spectrum.frequency, until) - spectrum.frequency.begin();
    spectrum.frequency.resize(static_cast<std::size_t>(count));
    spectrum.amplitude.resize(static_cast<std::size_t>(count));
    sim::Table out;
    out.channels = rows.channels;
    out.values = {std::move(spectrum.frequency), std::move(spectrum.amplitude)};
    return out;
}

std::string spectrum_words(const sim::Problem& problem, double from, double to, Lang lang) {
    const int count = samples(problem, to - from);
    return filled(lang == Lang::en
                      ? "Amplitude spectrum of the stretch from {} s to {} s less its mean, {} samples, Hann window, "
                        "resolution {} Hz. "
                      : "{} s 至 {} s 区间（去均值）的幅值谱，{} 个样本，Hann 窗，分辨率 {} Hz。",
                  number(from, 4), number(to, 4), count, number(1.5 / (to - from), 2));
}

}  // namespace beamcam::scenes
