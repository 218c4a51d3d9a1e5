#include "scenes/figures/studies.hpp"

#include <algorithm>
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

std::size_t Studies::of(const sim::Problem& problem, double end_time) {
    std::string key = motion_key(problem);
    const auto found = std::ranges::find(all_, key, &MotionRequest::key);
    const auto index = static_cast<std::size_t>(found - all_.begin());
    if (found == all_.end()) all_.push_back({problem, std::move(key)});
    sim::Request& request = all_[index].request;
    request.end_time = std::max(end_time, request.end_time);
    return index;
}

std::size_t Studies::table(std::size_t study, const Instants& at, const std::vector<sim::ChannelKind>& channels) {
    grids_.resize(std::max(grids_.size(), study + 1));
    std::vector<sim::TableRequest>& tables = request(study).tables;
    auto grid = std::find_if(grids_[study].begin(), grids_[study].end(), [&](const auto& g) { return g.first == at; });
    if (grid == grids_[study].end()) {
        tables.push_back({instants(at), {}});
        grids_[study].emplace_back(at, tables.size() - 1);
        grid = grids_[study].end() - 1;
    }
    std::vector<sim::Channel>& all = tables[grid->second].channels;
    for (const sim::ChannelKind kind : channels)
        if (std::ranges::find(all, sim::Channel{kind, 0}) == all.end()) all.push_back({kind, 0});
    return grid->second;
}

std::size_t Studies::curve(std::size_t study, const Instants& at, sim::Channel x, sim::Channel y,
                           const std::vector<sim::Channel>& also, const std::pair<double, double>& drawn) {
    const sim::Channel time{};
    // A quarter of a line's width in a column; less where limits enlarge loops, whose pieces would show.
    const bool enlarged = x != time && (std::isfinite(drawn.first) || std::isfinite(drawn.second));
    const double stray = enlarged ? 0.0005 : 0.002;
    sim::TableRequest table{instants(at), {time}, std::pair(x, y), stray, drawn};
    if (x != time) table.channels.push_back(x);
    table.channels.push_back(y);
    table.channels.insert(table.channels.end(), also.begin(), also.end());
    return add_table(study, std::move(table));
}

std::size_t Studies::add_table(std::size_t study, sim::TableRequest table) {
    request(study).tables.push_back(std::move(table));
    return request(study).tables.size() - 1;
}

std::size_t Studies::point(std::size_t study, double x, const Instants& at) {
    std::vector<sim::PointRequest>& points = request(study).points;
    points.push_back({x, instants(at)});
    return points.size() - 1;
}

const std::vector<double>& column(const sim::Table& table, sim::ChannelKind channel) {
    for (std::size_t i = 0; i < table.channels.size(); ++i)
        if (table.channels[i].kind == channel) return table.values[i];
    throw std::logic_error("a figure reads a channel that it did not request");
}

}  // namespace beamcam::scenes
