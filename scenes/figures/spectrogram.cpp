// The amplitudes of a channel by frequency and time: Hann windows that move along the motion.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/plot/channel_label.hpp"
#include "render/plot/lang.hpp"
#include "render/plot/ticks.hpp"
#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/figures/series.hpp"
#include "scenes/figures/series_data.hpp"
#include "sim/observe/spectrum.hpp"

namespace beamcam::scenes {
namespace {

constexpr std::size_t kSlices = 300, kLines = 240;  // a printed column resolves no more
constexpr double kDecades = 3;                      // of amplitude that the colours span

// Amplitudes by windows and groups of spectral lines: the largest of each group.
struct Spectrogram {
    double window = 0, hop = 0, first = 0;  // [s]: length, distance, begin of the first
    double line = 0;                        // height of a group [Hz]
    std::size_t lines = 0;
    std::vector<double> amplitude;  // window by window
    std::size_t windows() const { return amplitude.size() / lines; }
};

// Removes the slope of the straight line that fits best, which would spread over all frequencies; the spectrum removes
// the mean.
std::vector<double> without_trend(std::vector<double> v) {
    const double middle = 0.5 * (static_cast<double>(v.size()) - 1);
    double moment = 0, squares = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
        const double x = static_cast<double>(i) - middle;
        moment += x * v[i], squares += x * x;
    }
    for (std::size_t i = 0; i < v.size(); ++i) v[i] -= moment / squares * (static_cast<double>(i) - middle);
    return v;
}

// `rows`: equally spaced. The window's length becomes a power of two of samples.
Spectrogram spectrogram(const sim::Table& rows, double window, double highest) {
    const std::vector<double>&t = rows.values.front(), &v = rows.values.back();
    const double step = t[1] - t[0];
    std::size_t count = 16;
    while (count * 2 <= v.size() / 2 && static_cast<double>(count) * step < window / std::numbers::sqrt2) count *= 2;
    const std::size_t hop = std::max<std::size_t>(1, (v.size() - count) / kSlices);
    Spectrogram out;
    out.window = static_cast<double>(count) * step, out.hop = static_cast<double>(hop) * step, out.first = t[0];
    const auto shown = std::min(count / 2, static_cast<std::size_t>(highest * out.window)) + 1;
    const std::size_t group = (shown + kLines - 1) / kLines;
    out.lines = (shown + group - 1) / group, out.line = static_cast<double>(group) / out.window;
    for (std::size_t from = 0; from + count <= v.size(); from += hop) {
        const auto begin = v.begin() + static_cast<std::ptrdiff_t>(from);
        const sim::Spectrum one =
            sim::amplitude_spectrum(without_trend({begin, begin + static_cast<std::ptrdiff_t>(count)}), step);
        for (std::size_t k = 0; k < out.lines; ++k)
            out.amplitude.push_back(*std::max_element(
                one.amplitude.begin() + static_cast<std::ptrdiff_t>(k * group),
                one.amplitude.begin() + static_cast<std::ptrdiff_t>(std::min((k + 1) * group, shown))));
    }
    return out;
}

// Removes the highest frequencies, where no amplitude reaches `least`.
void shorten(Spectrogram& s, double least) {
    std::size_t shown = 4;
    for (std::size_t i = 0; i < s.amplitude.size(); ++i)
        if (s.amplitude[i] >= least) shown = std::max(shown, i % s.lines + 2);
    shown = std::min(shown, s.lines);
    std::vector<double> kept;
    for (std::size_t i = 0; i < s.amplitude.size(); ++i)
        if (i % s.lines < shown) kept.push_back(s.amplitude[i]);
    s.amplitude = std::move(kept), s.lines = shown;
}

// A twentieth of the interval, or four periods of the slowest vibration if four windows fit.
double usual_window(const std::vector<double>& frequencies, double length) {
    return frequencies.empty() ? length / 20 : std::clamp(4 / frequencies.front(), length / 20, length / 4);
}

render::figure::Cells cells_of(const Spectrogram& s, double most, double factor) {
    render::figure::Cells cells;
    for (std::size_t i = 0; i <= s.windows(); ++i)
        cells.x.push_back(s.first + s.window / 2 + (static_cast<double>(i) - 0.5) * s.hop);
    for (std::size_t k = 0; k <= s.lines; ++k)
        cells.y.push_back(std::max(0.0, static_cast<double>(k) * s.line - 0.5 / s.window));
    for (std::size_t k = 0; k < s.lines; ++k)
        for (std::size_t i = 0; i < s.windows(); ++i) {
            const double amplitude = s.amplitude[i * s.lines + k];
            const double share = amplitude > 0 ? 1 + std::log10(amplitude / most) / kDecades : -1;
            cells.colors.push_back(share < 0 ? render::Color{}.faded(0) : render::figure::map_color(share));
            cells.values.push_back(amplitude * factor);
        }
    return cells;
}

// The first one that the keys name, else the deflection of the tip.
sim::Channel channel_of(const SeriesKeys& keys) {
    if (!keys.panels.empty() && !keys.panels.front().channels.empty()) return keys.panels.front().channels.front();
    return {sim::ChannelKind::tip_deflection, 0};
}

// `measure`: of the amplitudes, of which `most` is the largest.
Panel spectrogram_panel(sim::Channel channel, const Spectrogram& s, double most, const Measure& measure, Lang lang) {
    const double largest = most * measure.factor;
    return {.title = phrase(lang, "windows of {}; dashed: natural frequencies", render::quantity(s.window, "s")),
            .x = {.label = "$t$ / s", .tight = true},
            .y = {.label = "$f$ / Hz", .tight = true},
            .cells = {cells_of(s, most, measure.factor)},
            .color_bar =
                render::figure::ColorBar{.label = axis_label("|" + render::print_symbol(channel) + "|", measure.unit),
                                         .scale = render::Scale::logarithmic,
                                         .from = largest * std::pow(10, -kDecades),
                                         .to = largest},
            .legend = false,
            .name = name(channel)};
}

FigureDrawing prepare_spectrogram(const Scene& scene, const FigureOutput& how, MotionRequests& requests) {
    const SeriesKeys& keys = how.series;
    const sim::Channel channel = channel_of(keys);
    const double from = keys.from, to = keys.to.value_or(scene.end_time);
    const std::vector<double> frequencies = frequencies_of(scene.problem);
    const double window = keys.window.value_or(usual_window(frequencies, to - from));
    if (!(window <= (to - from) / 2))
        throw render::PictureError(fmt::format(
            "figure spectrogram: windows of {:g} s do not move along {:g} s; at most half of it", window, to - from));
    const std::size_t motion = requests.motion(scene.problem, to);
    const std::size_t table =
        requests.add_table(motion, {spectrum_instants(scene.problem, from, to), {sim::Channel{}, channel}});
    const std::string unit = sim::unit(channel, scene.problem);
    return figure_of_motion(
        motion, [=, highest = keys.highest](const Subject& subject, const sim::Result& result) -> Figure {
            const sim::Table& rows = result.tables[table];
            const double rate = 1 / (rows.values[0][1] - rows.values[0][0]);
            Spectrogram s = spectrogram(rows, window, highest.value_or(0.1875 * rate));
            const double most = *std::ranges::max_element(s.amplitude);
            constexpr double kStill = 1e-3;  // of its magnitude
            if (!(most > kStill * largest_magnitude(rows.values.back())))
                throw render::PictureError(fmt::format("figure spectrogram: {} does not vibrate from {:g} s to {:g} s",
                                                       name(channel), from, to));
            if (!highest) shorten(s, most * std::pow(10, -kDecades));
            Panel panel = spectrogram_panel(channel, s, most, measure_of(unit, most, subject.units), subject.lang);
            for (const double frequency : frequencies)
                if (frequency < panel.cells.front().y.back()) panel.rules.push_back({.at = frequency});
            return {.title =
                        fmt::format("{}: amplitude by frequency and time, Hann windows of {} s, drawn at their middles",
                                    series_title({.panels = {{.channels = {channel}}}}), number(s.window, 3)),
                    .panels = {std::move(panel)}};
        });
}

}  // namespace

extern const FigureType kSpectrogram{.name = "spectrogram",
                                     .title = "Amplitudes by frequency and time",
                                     .refusal = no_refusal,
                                     .maker = prepare_spectrogram,
                                     .keys = {"channels", "from", "to", "window", "highest"}};

}  // namespace beamcam::scenes
