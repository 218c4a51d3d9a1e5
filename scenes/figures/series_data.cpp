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

std::vector<Lost> unreliable(const sim::Result& result, double end) {
    std::vector<Lost> out;
    for (const sim::Interval& lost : result.not_reproducible)
        if (lost.from < end) out.push_back({lost.from, std::min(lost.to.value_or(end), end)});
    return out;
}

std::vector<Series> by_reliability(const Series& whole, const std::vector<double>& times,
                                   const std::vector<Lost>& intervals) {
    std::vector<Series> parts{whole, whole};
    for (Series& part : parts) part.x.clear(), part.y.clear(), part.t.clear();
    parts[0].faded = true;
    std::optional<bool> before;
    for (std::size_t i = 0; i < whole.x.size(); ++i) {
        const bool unsure = std::ranges::any_of(intervals, [&](const Lost& v) { return v.holds(times[i]); });
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

std::string horizon_text(const std::vector<std::pair<std::string, const sim::Result*>>& motions, double from,
                         double end, Lang lang) {
    std::vector<std::string> times;
    for (const auto& [name, result] : motions)
        for (Lost v : unreliable(*result, end)) {
            if (v.to <= from) continue;
            v.from = std::max(v.from, from);
            const std::string of = name.empty() ? "" : name + " ";
            times.push_back(v.to < end ? phrase(lang, "{}from {} s to {} s", "{}{} s 至 {} s", of, number(v.from, 3),
                                                number(v.to, 3))
                                       : phrase(lang, "{}from {} s on", "{}{} s 之后", of, number(v.from, 3)));
        }
    if (times.empty()) return {};
    return phrase(lang,
                  "Drawn lighter, {}, $θ$ is not reproducible to 10^{{−6}} rad: a run at a tighter tolerance "
                  "differs by more, because impacts multiply small differences. ",
                  "以浅色绘制的部分（{}）$θ$ 不能重现到 10^{{−6}} "
                  "rad：碰撞会放大微小差别，与更严容差的计算之差超过该值。",
                  listed(times, lang));
}

// ---- measured or foreign data ---------------------------------------------------------------------------

std::vector<Measured> measured(const Scene& scene, const std::vector<sim::Channel>& channels, double from, double to,
                               std::size_t study, Studies& studies) {
    std::vector<Measured> out;
    for (const Measurement& each : scene.data) {
        Measurement data = each.of(channels).within(from, to);
        if (data.columns.empty() || data.times.empty()) continue;
        const std::size_t table = studies.add_table(study, data.request());
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

std::string agreement_text(const std::vector<Measured>& all, const sim::Result& result, const Subject& subject) {
    const auto& [problem, units, lang, end] = subject;
    std::string text;
    for (const Measured& each : all)
        for (const output::Agreement& a : agreements(each.data, result.tables[each.table], result)) {
            const std::string symbol = render::print_symbol(a.channel);
            const Measure shown = measure_in(units, sim::unit(a.channel, problem));
            text += a.rows == 0
                        ? phrase(lang,
                                 "Data “{}”: at no reproducible instant {} has both a measured and a computed value. ",
                                 "{}：没有任何可重现时刻同时具有 {} 的测量值与计算值。", each.data.label, symbol)
                        : phrase(lang, "Data “{}”: at {} instants {} differs by {} (root mean square). ",
                                 "{}，{} 个时刻：{} 的均方根差为 {}。", each.data.label, a.rows, symbol,
                                 with_unit(number(shown.factor * a.rms, 2), shown.unit));
        }
    return text;
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

bool equally_spaced(const std::vector<double>& times) {
    if (times.size() < kFewestMeasured) return false;
    const double step = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
    for (std::size_t i = 0; i < times.size(); ++i)
        if (std::abs(times[i] - times.front() - static_cast<double>(i) * step) > kJitter * step) return false;
    return true;
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

std::string measured_spectrum_text(const std::vector<Measured>& all, Lang lang) {
    std::string text;
    for (const Measured& each : all) {
        const std::vector<double>& t = each.data.times;
        text += equally_spaced(t)
                    ? phrase(lang, "Data “{}”: {} samples, resolution {} Hz. ", "{}：{} 个样本，分辨率 {} Hz。",
                             each.data.label, t.size(), number(1.5 / (t.back() - t.front()), 2))
                    : phrase(lang, "Data “{}” have no spectrum: their instants are {}. ", "{}：{}，无频谱。",
                             each.data.label,
                             t.size() < kFewestMeasured ? phrase(lang, "too few", "时刻过少")
                                                        : phrase(lang, "not equally spaced", "时刻不等距"));
    }
    return text;
}

std::string spectrum_text(const sim::Problem& problem, double from, double to, Lang lang) {
    const int count = samples(problem, to - from);
    return phrase(lang,
                  "Amplitude spectrum of the interval from {} s to {} s less its mean, {} samples, Hann window, "
                  "resolution {} Hz. ",
                  "{} s 至 {} s 区间（去均值）的幅值谱，{} 个样本，Hann 窗，分辨率 {} Hz。", number(from, 4),
                  number(to, 4), count, number(1.5 / (to - from), 2));
}

}  // namespace beamcam::scenes
