#include "scenes/scene/measurement.hpp"

#include <algorithm>
#include <cmath>

#include "render/draw/markup.hpp"

namespace beamcam::scenes {

const std::vector<double>* Measurement::find(sim::Channel channel) const {
    const auto found = std::ranges::find(columns, channel, &std::pair<sim::Channel, std::string>::first);
    return found == columns.end() ? nullptr : &values[static_cast<std::size_t>(found - columns.begin())];
}

Measurement Measurement::of(const std::vector<sim::Channel>& channels) const {
    Measurement out = *this;
    out.columns.clear(), out.values.clear();
    for (std::size_t c = 0; c < columns.size(); ++c)
        if (std::ranges::find(channels, columns[c].first) != channels.end())
            out.columns.push_back(columns[c]), out.values.push_back(values[c]);
    return out;
}

Measurement Measurement::within(double from, double to) const {
    const auto begin = std::ranges::lower_bound(times, from) - times.begin(),
               end = std::max(std::ranges::upper_bound(times, to) - times.begin(), begin);
    Measurement out = *this;
    out.times = {times.begin() + begin, times.begin() + end};
    for (std::size_t c = 0; c < values.size(); ++c)
        out.values[c] = {values[c].begin() + begin, values[c].begin() + end};
    return out;
}

bool Measurement::is_line(std::size_t rows) const {
    constexpr std::size_t kManyPoints = 300;  // more marks would overlap
    return drawn == Drawn::line || (drawn == Drawn::automatic && rows > kManyPoints);
}

sim::TableRequest Measurement::request() const {
    sim::TableRequest out{times, {{sim::ChannelKind::t, 0}}};
    for (const auto& [channel, column] : columns) out.channels.push_back(channel);
    return out;
}

std::vector<output::Agreement> agreements(const Measurement& measurement, const sim::Table& table,
                                          const sim::Result& result) {
    const auto is_reproducible = [&](double t) {
        return std::ranges::none_of(result.not_reproducible, [t](const sim::Interval& lost) {
            return t > lost.from && !(lost.to && t > *lost.to);
        });
    };
    std::vector<output::Agreement> out;
    for (std::size_t c = 0; c < measurement.columns.size(); ++c) {
        output::Agreement& each = out.emplace_back(
            output::Agreement{render::to_plain(measurement.label), measurement.file, measurement.columns[c].first});
        double squares = 0;
        for (std::size_t i = 0; i < measurement.times.size(); ++i) {
            const double difference = measurement.values[c][i] - table.values[c + 1][i];
            if (!std::isfinite(difference) || !is_reproducible(measurement.times[i])) continue;
            ++each.rows;
            squares += difference * difference;
        }
        if (each.rows > 0) each.rms = std::sqrt(squares / static_cast<double>(each.rows));
    }
    return out;
}

}  // namespace beamcam::scenes
