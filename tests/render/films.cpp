#include "tests/render/films.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/render/drawing.hpp"
#include "tests/render/synthetic.hpp"

namespace beamcam::render {

using sim::ChannelKind;

LayoutNode leaf(PanelSpec spec, double share) { return {.share = share, .panel = std::move(spec)}; }
LayoutNode grid(LayoutNode::Kind kind, std::vector<LayoutNode> children, double share) {
    return {.kind = kind, .share = share, .children = std::move(children)};
}
PanelSpec strip(ChannelKind kind) { return {.kind = PanelKind::strip, .channels = {{kind, 0}}}; }

FilmSetup everything() {
    FilmSetup setup = test::flat_film({.duration = 0.8}, 1920, 1080);
    setup.chart.channels.push_back({ChannelKind::theta_dot, 0});
    setup.chart.channels.push_back({ChannelKind::energy_kinetic, 0});
    setup.chart.channels.push_back({ChannelKind::energy_potential, 0});
    std::vector<double> rate, kinetic, potential;
    for (double t : setup.chart.values[0]) {
        rate.push_back(std::sin(9 * t)), kinetic.push_back(std::pow(std::sin(7 * t), 2));
        potential.push_back(std::pow(std::cos(7 * t), 2));
    }
    for (auto* values : {&rate, &kinetic, &potential}) setup.chart.values.push_back(*values);
    PanelSpec by_collision = strip(ChannelKind::contact_force), moving = strip(ChannelKind::theta_dot);
    by_collision.by_collision = true;
    moving.window = 0.1;
    using enum LayoutNode::Kind;
    setup.layout =
        grid(columns, {grid(rows, {leaf({.kind = PanelKind::mechanism}, 2), leaf({.kind = PanelKind::energy})}, 1.5),
                       grid(rows, {leaf({.kind = PanelKind::phase}), leaf({.kind = PanelKind::close_up})}),
                       grid(rows, {leaf(strip(ChannelKind::theta)), leaf(by_collision), leaf(moving)})});
    setup.speeds.assign(setup.poses.size(), 1);
    setup.speeds[20] = 0.02, setup.speeds[21] = 0;
    setup.callouts = {{15, 30, "first touch"}};
    return setup;
}

FilmSetup with_data() {
    FilmSetup setup = everything();
    FilmData rig, other;
    rig.label = "rig", other.label = "other", other.line = true;
    for (const double t : setup.chart.values[0])
        if (t < 0.5) rig.t.push_back(t + 0.01), other.t.push_back(t);
    rig.values = {{{ChannelKind::theta, 0}, std::vector<double>(rig.t.size(), 0.55)}};
    other.values = {{{ChannelKind::theta_dot, 0}, std::vector<double>(other.t.size(), 0.2)}};
    setup.data = {rig, other};
    return setup;
}

FilmSetup compared(Comparison how) {
    FilmSetup setup = test::synthetic_film({.duration = 0.8});
    const FilmSetup faster = test::synthetic_film({.duration = 0.8, .amplitude = 4e-3, .speed = 2});
    setup.width = 1280, setup.height = 720;
    setup.view.style = Style::flat;
    setup.label = "ω = 5";
    setup.others.push_back(faster);
    setup.others.back().label = "ω = 2";
    setup.comparison = how;
    return setup;
}

void same_in_any_order(FilmSetup setup) {
    Film film(std::move(setup));
    const int frames[] = {0, 7, 20, 21, 33, 47};
    std::vector<Image> forward;
    for (int k : frames) forward.push_back(drawn(film, k));
    Film fresh = film.for_thread();
    for (int i = 5; i >= 0; --i) EXPECT_EQ(drawn(fresh, frames[i]), forward[std::size_t(i)]) << frames[i];
    for (int i = 1; i < 6; ++i) EXPECT_NE(forward[std::size_t(i)], forward[std::size_t(i) - 1]) << frames[i];
}

}  // namespace beamcam::render
