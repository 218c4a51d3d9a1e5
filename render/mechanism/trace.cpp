#include "render/mechanism/trace.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::render {
namespace {

const std::vector<double>* column(const sim::Table& table, sim::ChannelKind kind) {
    for (std::size_t c = 0; c < table.channels.size(); ++c)
        if (table.channels[c].kind == kind && c < table.values.size()) return &table.values[c];
    return nullptr;
}

std::size_t place(double share, std::size_t places) {
    const double at = std::floor(share * static_cast<double>(places));
    return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(places - 1)));
}

// In contact, with defined places.
std::vector<TraceSample> sampled_contacts(const sim::Table& table) {
    using Kind = sim::ChannelKind;
    const auto *t = column(table, Kind::t), *x = column(table, Kind::contact_x), *s = column(table, Kind::contact_s),
               *force = column(table, Kind::contact_force);
    std::vector<TraceSample> out;
    if (!t || !x || !s || !force) return out;
    for (std::size_t i = 0; i < table.rows(); ++i)
        if ((*force)[i] > 0 && !std::isnan((*x)[i]) && !std::isnan((*s)[i]))
            out.push_back({(*t)[i], (*x)[i], (*s)[i], (*force)[i]});
    std::ranges::stable_sort(out, {}, &TraceSample::t);
    return out;
}

}  // namespace

std::vector<TraceSample> contact_samples(const sim::Table& table, std::span<const sim::Impact> impacts) {
    std::vector<TraceSample> out = sampled_contacts(table);
    const auto* t = column(table, sim::ChannelKind::t);
    if (!t || t->empty()) return out;
    const double last = *std::ranges::max_element(*t);
    const std::size_t known = out.size();
    for (const sim::Impact& impact : impacts) {
        if (!impact.t_end || !(impact.force_peak > 0) || *impact.t_end > last) continue;
        const std::span sampled(out.data(), known);
        const auto first = std::ranges::lower_bound(sampled, impact.t_start, {}, &TraceSample::t);
        if (first != sampled.end() && first->t <= *impact.t_end) continue;
        out.push_back({impact.t_start, impact.x, impact.s, *impact.force_peak});
    }
    std::ranges::stable_sort(out, {}, &TraceSample::t);
    return out;
}

Trace trace_until(std::span<const TraceSample> samples, double t, double circumference, std::size_t rim_places,
                  double length, std::size_t beam_places) {
    Trace out{std::vector<float>(rim_places), std::vector<float>(beam_places)};
    for (const TraceSample& sample : samples) {
        if (sample.t > t) break;
        const double turns = sample.s / circumference;
        float& on_rim = out.rim[place(turns - std::floor(turns), rim_places)];
        float& on_beam = out.beam[place(sample.x / length, beam_places)];
        on_rim = std::max(on_rim, static_cast<float>(sample.force));
        on_beam = std::max(on_beam, static_cast<float>(sample.force));
    }
    return out;
}

}  // namespace beamcam::render
