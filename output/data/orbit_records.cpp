#include "output/data/orbit_records.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numeric>

#include "output/json/tree.hpp"

namespace beamcam::output {

namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

Node state_node(const sim::PeriodicOrbit& orbit) {
    const sim::Initial& at = orbit.initial;
    Node state = object_node({{"cam_phase", orbit.cam_phase},
                              {"cam_angle", orbit.section},
                              {"theta", at.angle},
                              {"theta_dot", at.angular_velocity}});
    for (std::size_t k = 0; k < at.q.size(); ++k) {
        add(state, "q" + std::to_string(k + 1), at.q[k]);
        add(state, "q" + std::to_string(k + 1) + "_dot", at.q_dot[k]);
    }
    return state;
}

// `out`: the keys before those of the orbit.
Node orbit_node(const sim::PeriodicOrbit& orbit, Node out = object_node()) {
    add(out, "period", orbit.turns);
    add(out, "duration", orbit.period);
    add(out, "impacts", orbit.impacts.size());
    add(out, "stable", orbit.stable());
    add(out, "chatters", orbit.chatters());
    add(out, "always_touching", orbit.always_touching());
    add(out, "residual", orbit.residual);
    add(out, "multipliers", array_node(orbit.multipliers, [](const std::complex<double>& m) {
            return array_node({m.real(), m.imag()});
        }));
    add(out, "state", state_node(orbit));
    add(out, "touches", array_node(orbit.impacts, [](const sim::OrbitImpact& impact) {
            return object_node({{"cam_angle", impact.cam_angle}, {"approach", impact.approach}, {"x", impact.x}});
        }));
    return out;
}

Node branch_node(const sim::Branch& branch) {
    const sim::PeriodicOrbit& orbit = branch.points.front().orbit;
    return object_node({{"period", orbit.turns},
                        {"impacts", orbit.impacts.size()},
                        {"ends", array_node({branch.first_end, branch.last_end})},
                        {"points", array_node(branch.points, [](const sim::BranchPoint& point) {
                             return orbit_node(point.orbit, object_node({{"value", point.parameter}}));
                         })}});
}

void add_rows(ColumnTable& table, double branch, double index, double value, const sim::PeriodicOrbit& orbit) {
    const sim::Initial& at = orbit.initial;
    for (std::size_t i = 0; i < std::max<std::size_t>(1, orbit.impacts.size()); ++i) {
        const bool impact = i < orbit.impacts.size();
        std::vector<double> row = {branch,
                                   index,
                                   value,
                                   static_cast<double>(orbit.turns),
                                   orbit.stable() ? 1.0 : 0.0,
                                   orbit.largest_multiplier(),
                                   impact ? static_cast<double>(i + 1) : kUndefined,
                                   impact ? orbit.impacts[i].cam_angle : kUndefined,
                                   impact ? orbit.impacts[i].approach : kUndefined,
                                   impact ? orbit.impacts[i].x : kUndefined,
                                   orbit.cam_phase,
                                   at.angle,
                                   at.angular_velocity};
        for (std::size_t k = 0; k < at.q.size(); ++k) row.insert(row.end(), {at.q[k], at.q_dot[k]});
        row.resize(table.columns.size(), kUndefined);
        for (std::size_t c = 0; c < row.size(); ++c) table.columns[c].values.push_back(row[c]);
    }
}

}  // namespace

std::string exponents_json(const sim::Exponents& e) {
    Node all = array_node(), units = object_node();
    for (const char* rate : {"value", "error", "history", "sum", "impacts_per_second"}) add(units, rate, "1/s");
    add(units, "slowest_impact", "m/s");
    add(units, "doubt", "1/s");
    for (const char* time : {"time", "history_time"}) add(units, time, "s");
    for (std::size_t i = 0; i < e.lambda.size(); ++i)
        all.items.push_back(object_node({{"value", e.lambda[i]}, {"error", e.error[i]}, {"history", e.history[i]}}));
    return to_text(object_node({{"units", std::move(units)},
                                {"exponents", std::move(all)},
                                {"sum", std::accumulate(e.lambda.begin(), e.lambda.end(), 0.0)},
                                {"chaotic", e.chaos() == sim::Chaos::doubtful ? Node() : Node(e.chaotic())},
                                {"settled", e.settled},
                                {"transient", e.transient},
                                {"time", e.duration},
                                {"impacts", e.impacts},
                                {"impacts_per_second", static_cast<double>(e.impacts) / e.duration},
                                {"near_grazing", e.near_grazing},
                                {"slowest_impact", e.slowest_impact},
                                {"doubt", e.doubt},
                                {"history_time", e.time},
                                {"warnings", e.warnings}}));
}

std::string orbits_json(const BranchTable& table) {
    Node branches = array_node(), events = array_node();
    for (const sim::Branch& branch : table.branches) {
        for (const sim::SpecialPoint& point : branch.special)
            events.items.push_back(orbit_node(point.at.orbit, object_node({{"kind", name(point.change)},
                                                                           {"value", point.at.parameter},
                                                                           {"uncertainty", point.uncertainty},
                                                                           {"branch", branches.items.size()}})));
        branches.items.push_back(branch_node(branch));
    }
    const bool over = !table.key.empty();
    Node units = object_node({{"value", over ? Node(table.unit) : Node()},
                              {"period", "turns of the cam"},
                              {"duration", "s"},
                              {"cam_angle", "rad"},
                              {"approach", "m/s"},
                              {"x", "m"},
                              {"theta", "rad"},
                              {"theta_dot", "rad/s"}});
    return to_text(object_node(
        {{"units", std::move(units)},
         {"parameter", over ? Node(table.key) : Node()},
         {"start", over ? Node(table.start) : Node()},
         {"orbits", array_node(table.orbits, [](const sim::PeriodicOrbit& orbit) { return orbit_node(orbit); })},
         {"branches", std::move(branches)},
         {"events", std::move(events)}}));
}

ColumnTable orbit_columns(const BranchTable& branches, std::vector<std::pair<std::string, std::string>> attributes) {
    ColumnTable table;
    table.attributes = std::move(attributes);
    table.columns = {{"branch", "1", "Number of the branch; 0: an orbit that was not followed"},
                     {"point", "1", "Number of the point along the branch"},
                     {"value", branches.key.empty() ? "1" : branches.unit,
                      branches.key.empty() ? "No key was varied" : "Value of " + branches.key},
                     {"period", "1", "Period in turns of the cam"},
                     {"stable", "1", "1: the orbit is stable, 0: it is not"},
                     {"largest_multiplier", "1", "Largest magnitude of a multiplier"},
                     {"impact", "1", "Number of the impact"},
                     {"cam_angle", "rad", "Angle of the cam at the impact"},
                     {"approach", "m/s", "Approach speed of the impact"},
                     {"x", "m", "Place of the impact along the beam"},
                     {"cam_phase", "1", "Of the section: turns of the cam after the scene's start"},
                     {"theta", "rad", "Angle of the hub at the section"},
                     {"theta_dot", "rad/s", "Its rate"}};
    std::size_t modes = 0;
    for (const sim::PeriodicOrbit& orbit : branches.orbits) modes = std::max(modes, orbit.initial.q.size());
    for (std::size_t k = 1; k <= modes; ++k)
        for (const char* rate : {"", "_dot"})
            table.columns.push_back({"q" + std::to_string(k) + rate, *rate ? "m/s" : "m",
                                     *rate ? "Its rate" : "Modal coordinate at the section"});
    for (std::size_t b = 0; b < branches.branches.size(); ++b)
        for (std::size_t i = 0; i < branches.branches[b].points.size(); ++i) {
            const sim::BranchPoint& point = branches.branches[b].points[i];
            add_rows(table, static_cast<double>(b + 1), static_cast<double>(i + 1), point.parameter, point.orbit);
        }
    if (branches.branches.empty())
        for (std::size_t i = 0; i < branches.orbits.size(); ++i)
            add_rows(table, 0, static_cast<double>(i + 1), kUndefined, branches.orbits[i]);
    return table;
}

}  // namespace beamcam::output
