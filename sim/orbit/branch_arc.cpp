#include "sim/orbit/branch_arc.hpp"

#include <cmath>
#include <limits>

#include "sim/base/linear_algebra.hpp"
#include "sim/base/ode.hpp"
#include "sim/orbit/constants.hpp"

namespace beamcam::sim {
namespace {

bool same_events(const FlowMap& a, const FlowMap& b) {
    return a.touches.size() == b.touches.size() && a.holds == b.holds && a.lifts == b.lifts;
}

}  // namespace

// The map at a parameter nearby; nothing where there is no problem or no motion.
std::optional<SectionMap::Value> BranchArc::beside(const Eigen::VectorXd& z, double shift) const try {
    const Eigen::Index n = z.size() - 1;
    return map(z[n] + shift).at(z.head(n), false);
} catch (const SolverError&) {
    return std::nullopt;
} catch (const StepFailure&) {
    return std::nullopt;
}

// ∂P/∂p by finite differences; one-sided where only one side has the same events, or exists.
Eigen::VectorXd BranchArc::slope(const Eigen::VectorXd& z, const SectionMap::Value& here) const {
    const auto before = beside(z, -kArcDifference), after = beside(z, kArcDifference);
    if (!before && !after) throw StepFailure("the parameter cannot be varied");
    const bool back = before && (!after || same_events(before->map, here.map));
    const bool forth = after && (!before || same_events(after->map, here.map));
    if (before && after && back == forth) return (after->image - before->image) / (2 * kArcDifference);
    return (back ? here.image - before->image : after->image - here.image) / kArcDifference;
}

// The ends of the range may be the last values with a problem: rounding must not pass them.
double BranchArc::parameter(double share) const {
    const double end = std::round(share);
    if (std::fabs(share - end) < kAtRangeEnd) share = end;
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
    Eigen::VectorXd by_parameter;
    double last = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kMaxArcNewton; ++i) {
        const Eigen::VectorXd y = z.head(n);
        const SectionMap section = map(z[n]);
        const SectionMap::Value value = section.at(y, true);
        if (i == 0) by_parameter = slope(z, value);
        Eigen::MatrixXd bordered(n + 1, n + 1);
        bordered << value.derivative - Eigen::MatrixXd::Identity(n, n), by_parameter, tangent.transpose();
        Eigen::VectorXd residual(n + 1);
        residual << value.image - y, tangent.dot(z - predicted);
        const double size = residual.norm();
        if (!std::isfinite(size)) return std::nullopt;
        if (size < kArcConverged || (size < kArcAcceptable && size > 0.5 * last)) {
            return ArcPoint{z, solve(bordered, Eigen::VectorXd::Unit(n + 1, n)).normalized(), value.derivative,
                            section.orbit(y, value)};
        }
        if (size > 2 * last) return std::nullopt;
        last = size;
        z -= solve(bordered, residual);
    }
    return std::nullopt;
} catch (const SolverError&) {
    return std::nullopt;
} catch (const StepFailure&) {
    return std::nullopt;
}

}  // namespace beamcam::sim
