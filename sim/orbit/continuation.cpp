#include "sim/orbit/continuation.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/base/numerics.hpp"
#include "sim/orbit/section_map.hpp"

namespace beamcam::sim {
namespace {

constexpr int kMostArcNewton = 8;
// Residual of the corrector, in sizes of the orbit: converged; still taken where rounding allows no better.
constexpr double kArcConverged = 1e-11, kArcAcceptable = 1e-9;
constexpr double kArcDifference =
    1e-6;                              // of the range: the derivative by the parameter, which only steers the corrector
constexpr double kSmallestArc = 1e-9;  // of the range: what stops the branch is located so far
constexpr double kArcShrink = 0.3, kArcGrowth = 1.4,
                 kLeastCosine = 0.98;     // of a step; cosine between neighbouring tangents
constexpr double kRealMultiplier = 1e-9;  // of the imaginary part: rounding
constexpr double kOnCircle = 1e-7;        // of |μ| − 1: rounding, as of pairs that never leave the circle
constexpr double kFirstArc = 0.1;         // of the longest

// A corrected point of the branch: the orbit's state and the parameter's share of the range; the arc's direction there.
struct ArcPoint {
    Eigen::VectorXd z, tangent;
    Eigen::MatrixXd derivative;  // of the section map
    SectionMap::Value value;
    PeriodicOrbit orbit;
};

class Continuation {
  public:
    Continuation(const Family& family, const ContinuationRequest& request, const PeriodicOrbit& like, int turns,
                 Eigen::VectorXd units, double size)
        : family_(family), request_(request), like_(like), turns_(turns), units_(std::move(units)), size_(size) {}

    double parameter(const Eigen::VectorXd& z) const {
        return request_.from + z[z.size() - 1] * (request_.to - request_.from);
    }
    double share(double parameter) const { return (parameter - request_.from) / (request_.to - request_.from); }
    SectionMap map(double share) const {
        const double p = request_.from + share * (request_.to - request_.from);
        return {for_orbits(family_(p)), like_.section, turns_, like_.start, units_, size_};
    }
    Eigen::MatrixXd derivative_at(const BranchPoint& point) const {
        const SectionMap here = map(share(point.parameter));
        return here.at(here.scaled(point.orbit.start), true).derivative;
    }
    BranchPoint branch_point(const ArcPoint& point) const { return {parameter(point.z), point.orbit}; }

    std::optional<ArcPoint> correct(Eigen::VectorXd z, const Eigen::VectorXd& tangent) const;
    // Steps from a point along its tangent; the point itself is not among the results.
    void follow(ArcPoint from, const Progress& progress, Branch& branch, std::string& end) const;

  private:
    void find_changes(const ArcPoint& a, const ArcPoint& b, Branch& branch) const;
    void locate(const ArcPoint& a, double step, OrbitChange change, const std::function<double(const ArcPoint&)>& test,
                Branch& branch) const;
    void end_at_impact(const ArcPoint& last, const std::optional<ArcPoint>& beyond, double step, Branch& branch,
                       std::string& end) const;

    const Family& family_;
    const ContinuationRequest& request_;
    const PeriodicOrbit& like_;
    int turns_;
    Eigen::VectorXd units_;
    double size_;
};

// Newton's method for P(y, p) = y on the plane through z across the tangent.                                   (S76)
std::optional<ArcPoint> Continuation::correct(Eigen::VectorXd z, const Eigen::VectorXd& tangent) const try {
    const Eigen::Index n = z.size() - 1;
    const Eigen::VectorXd predicted = z;
    Eigen::VectorXd by_parameter;
    double last = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kMostArcNewton; ++i) {
        const Eigen::VectorXd y = z.head(n);
        ArcPoint point;
        point.value = map(z[n]).at(y, true);
        if (i == 0) {  // it only steers
            const auto image = [&](double shift) { return map(z[n] + shift).at(y, false).image; };
            by_parameter = (image(kArcDifference) - image(-kArcDifference)) / (2 * kArcDifference);
        }
        Eigen::MatrixXd bordered(n + 1, n + 1);
        bordered << point.value.derivative - Eigen::MatrixXd::Identity(n, n), by_parameter, tangent.transpose();
        Eigen::VectorXd residual(n + 1);
        residual << point.value.image - y, tangent.dot(z - predicted);
        const double size = residual.norm();
        if (!std::isfinite(size)) return std::nullopt;
        const Eigen::PartialPivLU<Eigen::MatrixXd> lu(bordered);
        if (size < kArcConverged || (size < kArcAcceptable && size > 0.5 * last)) {
            point.z = z;
            point.tangent = lu.solve(Eigen::VectorXd::Unit(n + 1, n)).normalized();
            point.derivative = point.value.derivative;
            point.orbit = map(z[n]).orbit(y, point.value);
            return point;
        }
        if (size > 2 * last) return std::nullopt;
        last = size;
        z -= lu.solve(residual);
    }
    return std::nullopt;
} catch (const SolverError&) {
    return std::nullopt;
} catch (const StepFailure&) {
    return std::nullopt;
}

Eigen::MatrixXd plus_identity(const ArcPoint& p, double sign) {
    return p.derivative + sign * Eigen::MatrixXd::Identity(p.derivative.rows(), p.derivative.cols());
}
// Test functions: each vanishes where the orbit changes.                                                         (S77)
double fold_test(const ArcPoint& p) { return p.tangent[p.tangent.size() - 1]; }
double doubling_test(const ArcPoint& p) { return plus_identity(p, 1).determinant(); }
double branching_test(const ArcPoint& p) { return plus_identity(p, -1).determinant() * (fold_test(p) > 0 ? 1 : -1); }
// Of the complex pair nearest the unit circle; nothing without one. Where nothing is lost pairs stay on the circle.
double circle_test(const ArcPoint& p) {
    double nearest = std::numeric_limits<double>::quiet_NaN();
    for (const auto& m : p.orbit.multipliers)
        if (std::fabs(m.imag()) > kRealMultiplier && !(std::fabs(std::abs(m) - 1) >= std::fabs(nearest)))
            nearest = std::abs(m) - 1;
    return nearest;
}
bool crosses_circle(double before, double after) {
    return before * after < 0 && std::min(std::fabs(before), std::fabs(after)) > kOnCircle;
}

void Continuation::locate(const ArcPoint& a, double step, OrbitChange change,
                          const std::function<double(const ArcPoint&)>& test, Branch& branch) const {
    std::optional<ArcPoint> last;
    const auto value = [&](double s) {
        if (s == 0) return test(a);
        const auto point = correct(a.z + s * a.tangent, a.tangent);
        if (!point) return std::numeric_limits<double>::quiet_NaN();
        last = point;
        return test(*point);
    };
    const double low = value(0), high = value(step);
    if (!std::isfinite(low * high) || std::signbit(low) == std::signbit(high)) return;
    const double at = find_root(value, 0.0, step, low, high);
    const auto point = correct(a.z + at * a.tangent, a.tangent);
    if (!point) return;
    const double range = std::fabs(request_.to - request_.from);
    branch.special.push_back({change, branch_point(*point), kArcConverged * range * std::fabs(fold_test(a)) + 1e-15});
}

void Continuation::find_changes(const ArcPoint& a, const ArcPoint& b, Branch& branch) const {
    const double step = a.tangent.dot(b.z - a.z);
    const auto changes = [&](auto test) { return std::signbit(test(a)) != std::signbit(test(b)); };
    const bool folds = changes(fold_test);
    if (folds) locate(a, step, OrbitChange::fold, fold_test, branch);
    if (changes(doubling_test)) locate(a, step, OrbitChange::period_doubling, doubling_test, branch);
    if (!folds && changes(branching_test)) locate(a, step, OrbitChange::branching, branching_test, branch);
    if (crosses_circle(circle_test(a), circle_test(b)))
        locate(a, step, OrbitChange::neimark_sacker, circle_test, branch);
}

// The pattern of impacts changes within `step`, too short to halve.
void Continuation::end_at_impact(const ArcPoint& last, const std::optional<ArcPoint>& beyond, double step,
                                 Branch& branch, std::string& end) const {
    const OrbitChange change = last.orbit.always_touching() ? OrbitChange::release : OrbitChange::grazing;
    const double range = std::fabs(request_.to - request_.from);
    branch.special.push_back({change, branch_point(last), step * range});
    end = beyond ? fmt::format("{}: {} impacts become {}", name(change), last.orbit.impacts.size(),
                               beyond->orbit.impacts.size())
                 : fmt::format("{}: the orbit cannot be followed with its {} impacts", name(change),
                               last.orbit.impacts.size());
}

void Continuation::follow(ArcPoint from, const Progress& progress, Branch& branch, std::string& end) const {
    const Eigen::Index n = from.z.size() - 1;
    double step = kFirstArc * request_.step;
    for (int count = 0; count < request_.most_points; ++count) {
        if (progress && !progress(parameter(from.z))) throw Interrupted();
        auto next = correct(from.z + step * from.tangent, from.tangent);
        const bool same = next && next->orbit.impacts.size() == from.orbit.impacts.size() &&
                          next->orbit.start.phase.touching == from.orbit.start.phase.touching;
        if (!same || next->tangent.dot(from.tangent) < kLeastCosine) {
            const bool stuck = kArcShrink * step < kSmallestArc;
            constexpr double kEnd = 1e-5;  // of the range; what lies beyond it may be impossible
            const bool at_end = !next && (from.z[n] < kEnd || from.z[n] > 1 - kEnd);
            if (stuck && at_end) {
                end = "the range ends";
                return;
            }
            if (stuck) return end_at_impact(from, next, step, branch, end);
            step *= kArcShrink;
            continue;
        }
        find_changes(from, *next, branch);
        const double share = next->z[n];
        if (share < 0 || share > 1) {
            end = "the range ends";
            return;
        }
        branch.points.push_back(branch_point(*next));
        from = std::move(*next);
        step = std::min(kArcGrowth * step, request_.step);
    }
    end = "the number of points is spent";
}

// Where y is along the eigenvector of the multiplier −1, on the map of twice as many turns.                     (S77)
std::optional<ArcPoint> doubled(const Continuation& once, const Continuation& twice, const SpecialPoint& special,
                                double size) {
    const Eigen::MatrixXd derivative = once.derivative_at(special.at);
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(derivative);
    const Eigen::Index n = derivative.rows();
    Eigen::Index nearest = 0;
    for (Eigen::Index i = 1; i < n; ++i)
        if (std::abs(solver.eigenvalues()[i] + 1.0) < std::abs(solver.eigenvalues()[nearest] + 1.0)) nearest = i;
    Eigen::VectorXd z(n + 1), direction(n + 1);
    const double share = twice.share(special.at.parameter);
    z << twice.map(share).scaled(special.at.orbit.start), share;
    direction << solver.eigenvectors().col(nearest).real().normalized(), 0;
    for (double shift = size; shift > 1e-4 * size; shift *= 0.5) {
        auto point = twice.correct(z + shift * direction, direction);
        if (!point || point->orbit.impacts.size() != 2 * special.at.orbit.impacts.size()) continue;
        if (point->tangent.dot(direction) < 0) point->tangent *= -1;
        return point;
    }
    return std::nullopt;
}

}  // namespace

const char* name(OrbitChange change) {
    switch (change) {
        case OrbitChange::fold:
            return "fold";
        case OrbitChange::period_doubling:
            return "period-doubling";
        case OrbitChange::neimark_sacker:
            return "neimark-sacker";
        case OrbitChange::branching:
            return "branching";
        case OrbitChange::grazing:
            return "grazing";
        case OrbitChange::release:
            return "release";
    }
    return "";
}

std::vector<Branch> continue_orbit(const Family& family, const BranchPoint& start, const ContinuationRequest& request,
                                   const Progress& progress) {
    constexpr double kDoubledShift = 0.02;  // of the orbit's size: where the doubled branch is begun
    const Problem problem = for_orbits(family(start.parameter));
    const SectionScale scale = section_scale(problem, start.orbit);
    std::vector<Branch> branches(1);
    const auto run = [&](const Continuation& arc, ArcPoint at, bool both, Branch& branch) {
        branch.points.push_back(arc.branch_point(at));
        if (both) {
            ArcPoint back = at;
            back.tangent *= -1;
            arc.follow(back, progress, branch, branch.first_end);
            std::reverse(branch.points.begin(), branch.points.end());
            std::reverse(branch.special.begin(), branch.special.end());
        }
        arc.follow(std::move(at), progress, branch, branch.last_end);
    };
    {
        const Continuation arc(family, request, start.orbit, start.orbit.turns, scale.units, scale.size);
        const double share = arc.share(start.parameter);
        const Eigen::Index n = scale.units.size();
        Eigen::VectorXd z(n + 1);
        z << arc.map(share).scaled(start.orbit.start), share;
        const auto first = arc.correct(z, Eigen::VectorXd::Unit(n + 1, n));
        if (!first) return {};
        run(arc, *first, true, branches.front());
    }
    for (std::size_t i = 0; i < branches.size() && static_cast<int>(i) < request.doublings; ++i) {
        const std::vector<SpecialPoint> special = branches[i].special;
        for (const SpecialPoint& point : special) {
            if (point.change != OrbitChange::period_doubling) continue;
            const Continuation twice(family, request, point.at.orbit, 2 * point.at.orbit.turns, scale.units,
                                     scale.size);
            const Continuation once(family, request, point.at.orbit, point.at.orbit.turns, scale.units, scale.size);
            if (auto at = doubled(once, twice, point, kDoubledShift)) run(twice, *at, false, branches.emplace_back());
        }
    }
    return branches;
}

}  // namespace beamcam::sim
