#include "scenes/figures/series_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/base/error.hpp"
#include "render/plot/channel_label.hpp"
#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/figure_types.hpp"
#include "sim/observe/spectrum.hpp"

namespace beamcam::scenes {

// ---- the intervals in which θ is not reproducible -----------------------------------------------------

std::vector<UnreliableInterval> unreliable_intervals(const sim::Result& result, double end) {
    std::vector<UnreliableInterval> out;
    for (const sim::Interval& lost : result.not_reproducible)
        if (lost.from < end) out.push_back({lost.from, std::min(lost.to.value_or(end), end)});
    return out;
}

std::vector<Series> by_reliability(const Series& whole, const std::vector<double>& times,
                                   const std::vector<UnreliableInterval>& intervals) {
    std::vector<Series> parts{whole, whole};
    for (Series& part : parts) part.x.clear(), part.y.clear(), part.t.clear();
    parts[0].faded = true;
    std::optional<bool> before;
    for (std::size_t i = 0; i < whole.x.size(); ++i) {
        const bool unsure =
            std::ranges::any_of(intervals, [&](const UnreliableInterval& v) { return v.holds(times[i]); });
        Series& part = parts[unsure ? 0 : 1];
        if (before && *before != unsure) {
            if (!part.x.empty()) part.add(whole.x[i - 1], std::nan("")), part.t.push_back(times[i - 1]);
            part.add(whole.x[i - 1], whole.y[i - 1]), part.t.push_back(times[i - 1]);
        }
        part.add(whole.x[i], whole.y[i]), part.t.push_back(times[i]);
        before = unsure;
    }
    std::erase_if(parts, [](const Series& part) { return part.x.empty(); });
    return parts;
}

// ---- measured or foreign data ---------------------------------------------------------------------------

std::vector<Measured> measured(const Scene& scene, const std::vector<sim::Channel>& channels, double from, double to,
                               std::size_t motion, MotionRequests& requests) {
    std::vector<Measured> out;
    for (const Measurement& each : scene.data) {
        Measurement data = each.of(channels).within(from, to);
        if (data.columns.empty() || data.times.empty()) continue;
        const std::size_t table = requests.add_table(motion, data.request());
        out.push_back({std::move(data), table});
    }
    return out;
}

Series measured_series(const Measurement& data, std::vector<double> x, std::vector<double> y, int look) {
    const bool line = data.is_line(x.size());
    return {.label = data.label,
            .x = std::move(x),
            .y = std::move(y),
            .look = look,
            .line = line,
            .every_point = !line,
            .weight = 0.7};
}

// ---- amplitude spectra ----------------------------------------------------------------------------------

namespace {

constexpr double kSamplesPerPeriod = 8;            // of the highest mode: its overtones in contact do not fold back
constexpr int kFewest = 1 << 12, kMost = 1 << 20;  // 1 << 20: 8 MB a curve

// A power of two: the fastest transform.
int samples(const sim::Problem& problem, double length) {
    const std::vector<double> frequencies = frequencies_of(problem);
    const double highest = frequencies.empty() ? 0 : frequencies.back();
    int count = kFewest;
    while (count < kMost && count < kSamplesPerPeriod * highest * length) count *= 2;
    return count;
}

sim::Table until(double highest, sim::Spectrum spectrum) {
    const auto count = std::ranges::upper_bound(spectrum.frequency, highest) - spectrum.frequency.begin();
    spectrum.frequency.resize(static_cast<std::size_t>(count));
    spectrum.amplitude.resize(static_cast<std::size_t>(count));
    sim::Table out;
    out.values = {std::move(spectrum.frequency), std::move(spectrum.amplitude)};
    return out;
}

constexpr std::size_t kFewestMeasured = 16;  // below, Hann's window leaves hardly a line
constexpr double kJitter = 0.02;             // of the step: clocks of instruments, and times with few digits

}  // namespace

bool equally_spaced(const std::vector<double>& times) {
    if (times.size() < kFewestMeasured) return false;
    const double step = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
    for (std::size_t i = 0; i < times.size(); ++i)
        if (std::abs(times[i] - times.front() - static_cast<double>(i) * step) > kJitter * step) return false;
    return true;
}

std::vector<double> spectrum_instants(const sim::Problem& problem, double from, double to) {
    // The last instant is left out: it begins the next period of the transform.
    const int count = samples(problem, to - from);
    std::vector<double> times = instants({from, to, count + 1});
    times.pop_back();
    return times;
}

sim::Table spectrum_table(const sim::Table& rows, std::optional<double> highest) {
    const std::vector<double>& t = rows.values.front();
    sim::Spectrum spectrum = sim::amplitude_spectrum(rows.values.back(), t[1] - t[0]);
    const double most = highest.value_or(0.375 * spectrum.frequency.back());
    sim::Table out = until(most, std::move(spectrum));
    out.channels = rows.channels;
    if (out.values[0].size() < 2)
        throw render::PictureError(
            fmt::format("series: there is no frequency up to x_high = {:g} Hz; those of {:g} s are {:.3g} Hz apart",
                        most, t.back() + t[1] - 2 * t[0], 1 / (t.back() + t[1] - 2 * t[0])));
    if (std::ranges::none_of(out.values[1], [](double a) { return a > 0; }))
        throw render::PictureError(fmt::format("series: {} does not change from {:g} s to {:g} s: it has no spectrum",
                                               name(rows.channels.back()), t.front(), t.back()));
    return out;
}

std::optional<sim::Table> measured_spectrum(const Measurement& data, sim::Channel channel, double highest) {
    const std::vector<double>* values = data.find(channel);
    if (!values || !equally_spaced(data.times)) return std::nullopt;
    const double step = (data.times.back() - data.times.front()) / static_cast<double>(data.times.size() - 1);
    return until(highest, sim::amplitude_spectrum(*values, step));
}

}  // namespace beamcam::scenes
