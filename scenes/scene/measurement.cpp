#include "scenes/scene/measurement.hpp"

#include <algorithm>

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
    std::vector<output::Agreement> out;
    for (std::size_t c = 0; c < measurement.columns.size(); ++c) {
        out.push_back(output::agreement(measurement.times, measurement.values[c], table.values[c + 1], result));
        out.back().label = render::to_plain(measurement.label);
        out.back().file = measurement.file;
        out.back().channel = measurement.columns[c].first;
    }
    return out;
}

}  // namespace beamcam::scenes
