#include "sim/orbit/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "sim/beam/drive.hpp"
#include "sim/orbit/constants.hpp"

namespace beamcam::sim {
namespace {

// Two motions that start to both sides of another one.
struct Pair {
    FlowMap before, after;
    bool alike() const { return same_events(before, after); }
};

// Neighbours of the motion from one start.
class Surroundings {
  public:
    Surroundings(System& system, const InitialState& start, double duration, const Eigen::VectorXd& scale,
                 const Progress& progress)
        : system_(system), start_(start), duration_(duration), scale_(scale), progress_(progress) {}

    // The derivative along d from two neighbours. The distance h is reduced until both have the same events.
    Eigen::VectorXd central(const Eigen::VectorXd& d, double h) const {
        for (; h > kSmallestDifference; h *= 0.1) {
            const Pair pair = beside(d, h);
            if (forgets(pair)) return 0 * d;
            if (pair.alike()) return quotient(pair.after, pair.before, 2 * h);
        }
        return one_sided(d);
    }

    // From four, which err by h⁴. The distance is reduced until half of it changes little, or rounding prevails.
    Eigen::VectorXd extrapolated(const Eigen::VectorXd& d, double h) const {
        Eigen::VectorXd best;
        double least = std::numeric_limits<double>::infinity();
        while (h > kSmallestDifference) {
            const Pair far = beside(d, h);
            if (forgets(far)) return 0 * d;
            const Pair near = beside(d, h / 2);
            if (!far.alike() || !near.alike() || !same_events(far.after, near.after)) {
                if (best.size() > 0) break;
                h *= 0.1;
                continue;
            }
            const Eigen::VectorXd whole = quotient(far.after, far.before, 2 * h),
                                  half = quotient(near.after, near.before, h);
            const double change = (half - whole).norm(), bend = change / half.norm();
            if (!(change < least)) break;
            least = change;
            best = (4 * half - whole) / 3;
            if (!(bend > kLargestBend)) break;
            h *= std::max(0.1, 0.7 * std::sqrt(kLargestBend / bend));
        }
        return best.size() > 0 ? best : one_sided(d);
    }

  private:
    // Near grazing: from the side that has the events of the motion itself, if only one has.
    Eigen::VectorXd one_sided(const Eigen::VectorXd& d) const {
        const double h = kSmallestDifference;
        const FlowMap here = flow_map(system_, start_, duration_, progress_);
        const Pair pair = beside(d, h);
        const bool back = same_events(pair.before, here), forth = same_events(pair.after, here);
        if (back == forth) return quotient(pair.after, pair.before, 2 * h);
        return back ? quotient(here, pair.before, h) : quotient(pair.after, here, h);
    }

    // A rigid beam that has rested on the cam has forgotten its start.                                        (S72)
    bool forgets(const Pair& pair) const {
        return system_.coordinates() == 1 && pair.before.holds > 0 && pair.after.holds > 0;
    }

    Pair beside(const Eigen::VectorXd& d, double h) const {
        return {flow_map(system_, shifted(-h * d), duration_, progress_),
                flow_map(system_, shifted(h * d), duration_, progress_)};
    }

    Eigen::Index numbers() const { return 2 * system_.coordinates() + (system_.has_bristle() ? 1 : 0); }

    InitialState shifted(const Eigen::VectorXd& d) const {
        InitialState state = start_;
        for (Eigen::Index i = 0; i < numbers(); ++i) state.y[static_cast<std::size_t>(i)] += d[i] * scale_[i];
        if (state.phase.touching) state.phase.approach += d[d.size() - 1] * scale_[d.size() - 1];
        return state;
    }

    Eigen::VectorXd quotient(const FlowMap& a, const FlowMap& b, double h) const {
        Eigen::VectorXd d = Eigen::VectorXd::Zero(scale_.size());
        for (Eigen::Index i = 0; i < numbers(); ++i)
            d[i] = a.end.y[static_cast<std::size_t>(i)] - b.end.y[static_cast<std::size_t>(i)];
        if (a.end.phase.touching && b.end.phase.touching) d[d.size() - 1] = a.end.phase.approach - b.end.phase.approach;
        return d.cwiseQuotient(h * scale_);
    }

    System& system_;
    const InitialState& start_;
    double duration_;
    const Eigen::VectorXd& scale_;
    const Progress& progress_;
};

}  // namespace

Problem with_tight_tolerance(Problem problem) {
    problem.solver.rtol = std::min(problem.solver.rtol, kTightRtol);
    problem.solver.atol = std::min(problem.solver.atol, kTightAtol);
    return problem;
}

Problem begun_at(Problem problem, double t) {
    if (t == 0) return problem;
    problem.hub.drive = later(problem.hub.drive, t);
    if (problem.cam)
        problem.cam->phase = std::remainder(problem.cam->phase - problem.cam->speed * t, 2 * std::numbers::pi);
    return problem;
}

Eigen::VectorXd difference_units(const Problem& problem) {
    System system(problem);
    const Linearization about_rest = system.model().linearize();
    const int n = system.coordinates();
    const double speed = problem.cam ? std::fabs(problem.cam->speed) : 0;
    const double pendulum = std::sqrt(std::fabs(problem.gravity) / problem.beam.length);
    Eigen::VectorXd units = Eigen::VectorXd::Constant(2 * n + kMemories, std::sqrt(system.model().mass()));
    for (int i = 0; i < n; ++i) {
        units[n + i] = std::sqrt(about_rest.mass(i, i));
        units[i] =
            i == 0 ? units[n] * std::max({speed, pendulum, kSlowestMotion}) : std::sqrt(about_rest.stiffness(i, i));
    }
    if (system.has_bristle()) units[2 * n] = std::sqrt(system.friction().stiffness);
    return units;
}

double motion_size(const Problem& problem, const FlowMap& map, const InitialState& start) {
    double fastest = 0;
    for (const MotionTouch& touch : map.touches) fastest = std::max(fastest, touch.approach);
    if (fastest > 0) return fastest * std::sqrt(problem.beam.line_density() * problem.beam.length);
    const Eigen::VectorXd units = difference_units(problem);
    const Eigen::Index n = units.size() - kMemories;
    return units.head(n).cwiseProduct(Eigen::Map<const Eigen::VectorXd>(start.y.data(), n)).norm();
}

Neighbours::Neighbours(const Problem& problem, Eigen::VectorXd scale, Differences kind, Progress progress)
    : problem_(problem), scale_(std::move(scale)), kind_(kind), progress_(std::move(progress)) {}

Eigen::MatrixXd Neighbours::along(double t, const InitialState& start, double duration,
                                  const Eigen::MatrixXd& directions, double shortest) const {
    System system(begun_at(problem_, t));
    const Surroundings around(system, start, duration, scale_, progress_);
    // The hub moves by h/Ω while it rotates by the difference: touches must remain on their side of a pause.
    const Eigen::Index n = (scale_.size() - kMemories) / 2;
    const double h = std::min(kind_ == Differences::central ? kCentralStep : kExtrapolatedStep,
                              std::max(kFlightShare * shortest * scale_[n] / scale_[0], 2 * kSmallestDifference));
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(directions.rows(), directions.cols());
    for (Eigen::Index c = 0; c < directions.cols(); ++c) {
        const Eigen::VectorXd d = directions.col(c);
        if (d.isZero(0)) continue;
        out.col(c) = kind_ == Differences::central ? around.central(d, h) : around.extrapolated(d, h);
    }
    return out;
}

Eigen::MatrixXd Neighbours::along(double t, const InitialState& start, double duration, const FlowMap& map,
                                  Eigen::MatrixXd directions,
                                  const std::function<void(Eigen::MatrixXd&)>& at_pause) const {
    double since = 0, flight = std::numeric_limits<double>::infinity();
    const InitialState* from = &start;
    for (const Pause& pause : map.pauses) {
        directions = along(t + since, *from, pause.t - since, directions, std::min(flight, pause.flight));
        flight = pause.flight;
        if (at_pause) at_pause(directions);
        since = pause.t;
        from = &pause.state;
    }
    return along(t + since, *from, duration - since, directions, flight);
}

}  // namespace beamcam::sim
