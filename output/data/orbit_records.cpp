#include "output/data/orbit_records.hpp"

#include <complex>
#include <numeric>

#include "output/json/tree.hpp"

namespace beamcam::output {

namespace {

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

}  // namespace beamcam::output
