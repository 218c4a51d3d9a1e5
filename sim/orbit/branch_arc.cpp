#include "sim/orbit/branch_arc.hpp"

#include <cmath>
#include <limits>

#include "sim/base/linear_algebra.hpp"
#include "sim/base/numerics.hpp"
#include "sim/base/ode.hpp"

namespace beamcam::sim {
namespace {

constexpr int kMaxArcNewton = 8;  // iterations; if a prediction needs more, the step is shortened
// The finite difference for ∂P/∂p, as a share of the range, affects the tangent and the corrector's convergence.
constexpr double kArcDifference = 1e-6;
constexpr double kNearFold = 0.1;  // of the unit tangent: its part along the parameter is smaller near a fold

bool same_events(const FlowMap& a, const FlowMap& b) {
    return a.touches.size() == b.touches.size() && a.holds == b.holds && a.lifts == b.lifts;
}

}  // namespace

// The map at a point; nothing where there is no problem or no motion.
std::optional<SectionMap::Value> BranchArc::image(const Eigen::VectorXd& z) const try {
    const Eigen::Index n = z.size() - 1;
    return map(z[n]).at(z.head(n), false);
} catch (const SolverError&) {
    return std::nullopt;
} catch (const StepFailure&) {
    return std::nullopt;
}

// ∂P/∂p by finite differences along the tangent, on which the image of an unstable orbit remains as near as the orbit:
// dP = P_y dy + P_p dp. At folds, and where the tangent is not known yet, with y constant. One-sided where only one
// side has the same events, or exists.
Eigen::VectorXd BranchArc::slope(const Eigen::VectorXd& z, const Eigen::VectorXd& tangent,
                                 const SectionMap::Value& here) const {
    const Eigen::Index n = z.size() - 1;
    Eigen::VectorXd along = Eigen::VectorXd::Unit(n + 1, n);
    if (std::fabs(tangent[n]) > kNearFold) along = tangent / tangent[n];
    const auto before = image(z - kArcDifference * along), after = image(z + kArcDifference * along);
    if (!before && !after) throw StepFailure("the parameter cannot be varied");
    const bool back = before && (!after || same_events(before->map, here.map));
    const bool forth = after && (!before || same_events(after->map, here.map));
    const bool both = before && after && back == forth;
    const Eigen::VectorXd low = both || back ? before->image : here.image,
                          high = both || !back ? after->image : here.image;
    return (high - low) / (both ? 2 * kArcDifference : kArcDifference) - here.derivative * along.head(n);
}

// The ends of the range may be the last values with a problem: rounding must not pass them.
double BranchArc::parameter(double share) const {
    const double end = std::round(share);
    if (std::fabs(share - end) < kLongRounding) share = end;
    return std::lerp(request_.from, request_.to, share);
}

Progress BranchArc::poll(double p) const {
    return [progress = progress_, p](double) { return !progress || progress(p); };
}

SectionMap BranchArc::map(double share) const {
    const double p = parameter(share);
    return {for_orbits(family_(p)), like_.section, turns_, like_.start, scale_, poll(p)};
}

BranchArc BranchArc::recentred(const BranchPoint& point) const {
    const double p = point.parameter;
    return {family_, request_, sim::recentred(family_(p), point.orbit, poll(p)), turns_, scale_, progress_};
}

Eigen::VectorXd BranchArc::place(const BranchPoint& point) const {
    const double at = share(point.parameter);
    Eigen::VectorXd z(scale_.units.size() + 1);
    z << map(at).scaled(point.orbit.start), at;
    return z;
}

Eigen::MatrixXd BranchArc::derivative_at(const BranchPoint& point) const {
    const SectionMap here = map(share(point.parameter));
    return here.at(here.scaled(point.orbit.start), true).derivative;
}

// Newton's method for P(y, p) = y on the plane through z perpendicular to the tangent.                         (S76)
std::optional<ArcPoint> BranchArc::correct(Eigen::VectorXd z, const Eigen::VectorXd& tangent) const try {
    const Eigen::Index n = z.size() - 1;
    const Eigen::VectorXd predicted = z;
    double last = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kMaxArcNewton; ++i) {
        const Eigen::VectorXd y = z.head(n);
        const SectionMap section = map(z[n]);
        const SectionMap::Value value = section.at(y, true);
        const Eigen::VectorXd by_parameter = slope(z, tangent, value);
        Eigen::MatrixXd bordered(n + 1, n + 1);
        bordered << value.derivative - Eigen::MatrixXd::Identity(n, n), by_parameter, tangent.transpose();
        Eigen::VectorXd residual(n + 1);
        residual << value.image - y, tangent.dot(z - predicted);
        const double size = residual.norm();
        if (!std::isfinite(size)) return std::nullopt;
        const Eigen::VectorXd step = solve(bordered, residual);
        // An unstable orbit amplifies rounding in the residual, not in z.
        const bool rounding = size > 0.5 * last && (size < kNegligible || step.norm() < kOrbitConverged);
        if (size < kOrbitConverged || rounding) {
            return ArcPoint{z, solve(bordered, Eigen::VectorXd::Unit(n + 1, n)).normalized(), value.derivative,
                            section.orbit(y, value)};
        }
        if (size > 2 * last) return std::nullopt;
        last = size;
        z -= step;
    }
    return std::nullopt;
} catch (const SolverError&) {
    return std::nullopt;
} catch (const StepFailure&) {
    return std::nullopt;
}

}  // namespace beamcam::sim
