#include "scenes/figures/motion_requests.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "scenes/motions/identity.hpp"

namespace beamcam::scenes {

std::vector<double> instants(const Instants& grid) {
    std::vector<double> times;
    times.reserve(static_cast<std::size_t>(grid.count));
    for (int k = 0; k < grid.count; ++k)
        times.push_back(k + 1 == grid.count ? grid.to : grid.from + (grid.to - grid.from) * k / (grid.count - 1));
    return times;
}

std::size_t MotionRequests::motion(const sim::Problem& problem, double end_time) {
    MotionRequest& added = all_.emplace_back(MotionRequest{problem, motion_key(problem)});
    added.request.end_time = end_time;
    return all_.size() - 1;
}

std::size_t MotionRequests::table(std::size_t motion, const Instants& at,
                                  const std::vector<sim::ChannelKind>& channels) {
    sim::TableRequest table{instants(at), {}};
    for (const sim::ChannelKind kind : channels) table.channels.push_back({kind, 0});
    return add_table(motion, std::move(table));
}

std::size_t MotionRequests::curve(std::size_t motion, const Instants& at, sim::Channel x, sim::Channel y,
                                  const std::vector<sim::Channel>& also, const std::pair<double, double>& drawn) {
    const sim::Channel time{};
    // A quarter of a line's width in a column; less where limits enlarge loops, whose pieces would show.
    const bool enlarged = x != time && (std::isfinite(drawn.first) || std::isfinite(drawn.second));
    const double stray = enlarged ? 0.0005 : 0.002;
    sim::TableRequest table{instants(at), {time}, std::pair(x, y), stray, drawn};
    if (x != time) table.channels.push_back(x);
    table.channels.push_back(y);
    table.channels.insert(table.channels.end(), also.begin(), also.end());
    return add_table(motion, std::move(table));
}

std::size_t MotionRequests::add_table(std::size_t motion, sim::TableRequest table) {
    request(motion).tables.push_back(std::move(table));
    return request(motion).tables.size() - 1;
}

std::size_t MotionRequests::point(std::size_t motion, double x, const Instants& at) {
    std::vector<sim::PointRequest>& points = request(motion).points;
    points.push_back({x, instants(at)});
    return points.size() - 1;
}

const std::vector<double>& column(const sim::Table& table, sim::ChannelKind channel) {
    for (std::size_t i = 0; i < table.channels.size(); ++i)
        if (table.channels[i].kind == channel) return table.values[i];
    throw std::logic_error("a figure reads a channel that it did not request");
}

}  // namespace beamcam::scenes
