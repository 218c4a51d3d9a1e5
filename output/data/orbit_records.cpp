#include "output/data/orbit_records.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

namespace beamcam::output {

namespace {

using OrbitJson = nlohmann::ordered_json;

std::string records_text(const OrbitJson& json) { return json.dump(2) + "\n"; }

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

OrbitJson state_json(const sim::PeriodicOrbit& orbit) {
    const sim::Initial& at = orbit.initial;
    OrbitJson state = {{"cam_phase", orbit.cam_phase},
                       {"cam_angle", orbit.section},
                       {"theta", at.angle},
                       {"theta_dot", at.angular_velocity}};
    for (std::size_t k = 0; k < at.q.size(); ++k) {
        state["q" + std::to_string(k + 1)] = at.q[k];
        state["q" + std::to_string(k + 1) + "_dot"] = at.q_dot[k];
    }
    return state;
}

OrbitJson orbit_json(const sim::PeriodicOrbit& orbit) {
    OrbitJson touches = OrbitJson::array(), multipliers = OrbitJson::array();
    for (const sim::OrbitImpact& impact : orbit.impacts)
        touches.push_back({{"cam_angle", impact.cam_angle}, {"approach", impact.approach}, {"x", impact.x}});
    for (const std::complex<double>& m : orbit.multipliers) multipliers.push_back({m.real(), m.imag()});
    return {{"period", orbit.turns},           {"duration", orbit.period},
            {"impacts", orbit.impacts.size()}, {"stable", orbit.stable()},
            {"chatters", orbit.chatters()},    {"always_touching", orbit.always_touching()},
            {"residual", orbit.residual},      {"multipliers", std::move(multipliers)},
            {"state", state_json(orbit)},      {"touches", std::move(touches)}};
}

OrbitJson joined(OrbitJson head, const OrbitJson& tail) {
    head.update(tail);
    return head;
}

OrbitJson branch_json(const sim::Branch& branch) {
    OrbitJson points = OrbitJson::array();
    for (const sim::BranchPoint& point : branch.points)
        points.push_back(joined({{"value", point.parameter}}, orbit_json(point.orbit)));
    const sim::PeriodicOrbit& orbit = branch.points.front().orbit;
    return {{"period", orbit.turns},
            {"impacts", orbit.impacts.size()},
            {"ends", {branch.first_end, branch.last_end}},
            {"points", std::move(points)}};
}

void add_rows(ColumnTable& table, double branch, double index, double value, const sim::PeriodicOrbit& orbit) {
    const double largest = orbit.multipliers.empty() ? 0 : std::abs(orbit.multipliers.front());
    const sim::Initial& at = orbit.initial;
    for (std::size_t i = 0; i < std::max<std::size_t>(1, orbit.impacts.size()); ++i) {
        const bool impact = i < orbit.impacts.size();
        std::vector<double> row = {branch,
                                   index,
                                   value,
                                   static_cast<double>(orbit.turns),
                                   orbit.stable() ? 1.0 : 0.0,
                                   largest,
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
    OrbitJson all = OrbitJson::array();
    for (std::size_t i = 0; i < e.lambda.size(); ++i)
        all.push_back({{"value", e.lambda[i]}, {"error", e.error[i]}, {"history", e.history[i]}});
    return records_text({{"units",
                          {{"value", "1/s"},
                           {"error", "1/s"},
                           {"history", "1/s"},
                           {"sum", "1/s"},
                           {"impacts_per_second", "1/s"},
                           {"slowest_impact", "m/s"},
                           {"doubt", "1/s"},
                           {"time", "s"},
                           {"history_time", "s"}}},
                         {"exponents", std::move(all)},
                         {"sum", std::accumulate(e.lambda.begin(), e.lambda.end(), 0.0)},
                         {"chaotic", e.chaos() == sim::Chaos::doubtful ? OrbitJson(nullptr) : OrbitJson(e.chaotic())},
                         {"settled", e.settled},
                         {"transient", e.transient},
                         {"time", e.duration},
                         {"impacts", e.impacts},
                         {"impacts_per_second", static_cast<double>(e.impacts) / e.duration},
                         {"near_grazing", e.near_grazing},
                         {"slowest_impact", e.slowest_impact},
                         {"doubt", e.doubt},
                         {"history_time", e.time},
                         {"warnings", e.warnings}});
}

std::string orbits_json(const BranchTable& table) {
    OrbitJson orbits = OrbitJson::array(), branches = OrbitJson::array(), events = OrbitJson::array();
    for (const sim::PeriodicOrbit& orbit : table.orbits) orbits.push_back(orbit_json(orbit));
    for (const sim::Branch& branch : table.branches) {
        for (const sim::SpecialPoint& point : branch.special)
            events.push_back(joined({{"kind", name(point.change)},
                                     {"value", point.at.parameter},
                                     {"uncertainty", point.uncertainty},
                                     {"branch", branches.size()}},
                                    orbit_json(point.at.orbit)));
        branches.push_back(branch_json(branch));
    }
    const bool over = !table.key.empty();
    OrbitJson units = {{"value", over ? OrbitJson(table.unit) : OrbitJson(nullptr)},
                       {"period", "turns of the cam"},
                       {"duration", "s"},
                       {"cam_angle", "rad"},
                       {"approach", "m/s"},
                       {"x", "m"},
                       {"theta", "rad"},
                       {"theta_dot", "rad/s"}};
    return records_text({{"units", std::move(units)},
                         {"parameter", over ? OrbitJson(table.key) : OrbitJson(nullptr)},
                         {"start", over ? OrbitJson(table.start) : OrbitJson(nullptr)},
                         {"orbits", std::move(orbits)},
                         {"branches", std::move(branches)},
                         {"events", std::move(events)}});
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
                     {"cam_angle", "rad", "Angle of the cam at the impact, counted from the section"},
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
