// One simulation: a Problem and what is wanted of it go in, exactly that comes out.
//
// Nothing is computed because it might be wanted: no table, no pose, no ledger beyond the request
// (the energy ledger is always kept; it never changes a step). What is asked for never changes the
// trajectory: asking for more or less leaves every bit of it as it was, and a shorter run is a
// prefix of a longer one.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sim/channels.hpp"
#include "sim/pose.hpp"
#include "sim/problem.hpp"

namespace beamcam::sim {

// One touch, from approach to release. Speeds: v_n < 0 approaches; v_t is beam minus cam material.
struct Impact {
    double t_start = 0;                          // [s]
    std::optional<double> t_end;                 // absent: still touching at the end of the run
    double x = 0;                                // contact_x at touch [m]
    double cam_angle = 0;                        // ψ at touch [rad]
    double v_n_before = 0, v_t_before = 0;       // at touch [m/s]
    std::optional<double> v_n_after, v_t_after;  // at release [m/s]
    std::optional<double> duration;              // [s]
    std::optional<double> force_peak;            // [N]; absent: a pure impulse has no finite force
    double penetration_peak = 0;                 // [m]
    double impulse_n = 0, impulse_t = 0;         // [N s]
    std::optional<double> restitution;           // −v_n_after / v_n_before
    double energy_lost = 0;                      // contact + friction losses between touch and release [J]
    int collision = 0;                           // 0-based index into the collisions
};

// Impacts closer than contact.collision_gap.
struct Collision {
    double t_start = 0;
    std::optional<double> t_end;
    int count = 0;  // of impacts
    double x = 0, v_n_before = 0;
    std::optional<double> v_n_after, restitution;
    std::optional<double> force_peak;  // [N]
    double energy_lost = 0;
};

struct ZeroCrossing {
    double t = 0, theta_dot = 0;
};
struct Apex {  // a maximum of theta, ripple included
    double t = 0, theta = 0;
};
struct Extremum {
    double min = 0, t_min = 0, max = 0, t_max = 0;
};

// From the last instant before it; no end: up to that of the run.
struct Interval {
    double from = 0;
    std::optional<double> to;
};

struct Counters {
    long steps = 0;  // accepted
    long rejected = 0;
    long rhs_evaluations = 0;
    long gap_evaluations = 0;
    long jacobians = 0;
};

// What is wanted. Times may lie in any order, must be >= 0, and the run extends to the largest of
// them and of `end_time`.
struct TableRequest {
    std::vector<double> times;  // [s]; rows come in this order
    std::vector<Channel> channels;
    // Abscissa and ordinate of a curve that is to be drawn: rows are added between the times until pieces between
    // neighbouring rows follow it. All rows then come in the order of time.
    std::optional<std::pair<Channel, Channel>> curve = {};
};
struct PoseRequest {
    std::vector<double> times;  // [s]
    int stations = 97;          // points along the centre line, >= 2
    // Takes each pose, by the row of its time, as soon as it is known: then Result::poses keeps none. A row may be told
    // again, and not all are told when the run fails.
    std::function<void(std::size_t row, const Pose& pose)> take{};
    // Also so many poses in contact, between the first and the last of the times: at each touch and within the steps
    // that follow it. Their rows go on from those of the times, and begin anew when those do.
    std::size_t contacts = 0;
};
// The path of a material point of the centre line.
struct PointRequest {
    double x = 0;               // arc position, 0…L [m]
    std::vector<double> times;  // [s]
};
struct Request {
    double end_time = 0;  // [s]
    std::vector<TableRequest> tables;
    std::vector<PoseRequest> poses;
    std::vector<PointRequest> points;
    std::vector<Channel> extrema;  // located on the dense output
    bool turning_points = true;    // apexes and zero crossings of θ, which need a look at every ripple
    bool horizon = false;          // during which intervals θ is reproducible (horizon.hpp); costs a second run
};

struct Result {
    double end_time = 0;                    // reached [s]
    std::vector<Table> tables;              // one per TableRequest
    std::vector<std::vector<Pose>> poses;   // one per PoseRequest, in the order of its times, then those in contact
    std::vector<std::vector<Vec2>> points;  // one per PointRequest [m]
    std::vector<Impact> impacts;
    std::vector<Collision> collisions;
    std::vector<ZeroCrossing> theta_zero;
    std::vector<Apex> apexes;
    std::vector<Extremum> extrema;   // one per Request::extrema
    double energy_residual_max = 0;  // [J]
    double energy_scale = 0;         // [J]
    // With Request::horizon:
    std::optional<double> reproducible_until;       // the first loss, or the end [s]
    std::vector<Interval> not_reproducible;         // [s]
    std::optional<double> reproducible_again_from;  // after the last of these, where it ends before the run [s]
    std::string compared_with;                      // method and tolerance of the second run
    std::string reproducibility;                    // all of it in a sentence
    Counters counters;
    double wall_seconds = 0;
    bool beyond_model = false;          // it bends through angles that its model does not hold for
    std::vector<std::string> warnings;  // in the user's terms
};

// The integration could not go on (exit code 4). `partials` hold what was reached by then.
struct SolverError : std::runtime_error {
    SolverError(const std::string& what, double last_good_time, std::vector<Result> partial_results);
    double last_time;
    std::vector<Result> partials;  // one per Request; none where no state to start from was found
};
struct Interrupted : std::runtime_error {
    Interrupted() : std::runtime_error("interrupted") {}
};

// Called now and then with the time reached; returning false ends the run with `Interrupted`.
using Progress = std::function<bool(double t)>;

// What was really done, by one call or several: nothing for what came from a kept trajectory.
struct Effort {
    long integrations = 0;
    Counters spent;
    void add(const Counters& counters);  // of one integration
    void add(const Effort& more);
};

class Trajectory;
class TrajectoryWriter;

// Throws SolverError, Interrupted; std::invalid_argument when `validate(problem)` has fatal findings.
Result simulate(const Problem& problem, const Request& request, const Progress& progress = {});

// One integration for several requests. Each result has the same bits as if its request had been alone. `keep`
// takes the trajectory down (trajectory.hpp).
std::vector<Result> simulate(const Problem& problem, std::span<const Request> requests, const Progress& progress = {},
                             TrajectoryWriter* keep = nullptr, Effort* effort = nullptr);

// The same from a trajectory that was kept, which must reach as far as the requests: the same bits again. A
// horizon still costs its second run.
std::vector<Result> replay(const Problem& problem, const Trajectory& trajectory, std::span<const Request> requests,
                           const Progress& progress = {}, Effort* effort = nullptr);

}  // namespace beamcam::sim
