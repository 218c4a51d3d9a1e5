#include "sim/orbit/continuation.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "sim/base/counted.hpp"
#include "sim/base/linear_algebra.hpp"
#include "sim/base/numerics.hpp"
#include "sim/orbit/branch_arc.hpp"
#include "sim/orbit/contact_pattern.hpp"

namespace beamcam::sim {
namespace {

constexpr double kSmallestArc = 1e-9;  // of the range: smallest step, located end of a branch
// What is so close is one: the multiplier 1 at a fold; impact speeds half a period apart, relatively; of the range, a
// period doubling at which the branch of doubled period is bracketed.
constexpr double kClose = 1e-3;
constexpr double kFirstArc = 0.1;                     // of the longest step
constexpr double kArcShrink = 0.3, kArcGrowth = 1.4;  // step factors after failure and success
constexpr double kLeastCosine = 0.98;                 // between the tangents of neighbouring points
constexpr double kOnCircle = 1e-7;  // of |μ|² − 1: rounding, as of pairs that never leave the circle
constexpr double kAtTip = 1e-6;     // of the beam's length: a branch that ends with a foot this close ends at a corner
// The derivative of the section map errs by less than this share of itself; it is made of differences.
constexpr double kDerivativeError = 3e-9;
// Relative uncertainty of the parameter at which an interval of sustained contact vanishes: the impacts before it are
// too slow to be separated.
constexpr double kRestUncertainty = 3e-5;
// Largest multiplier: times the rounding of the section map it is the residual that is still acceptable.
constexpr double kMostUnstable = 1e6;
constexpr double kMovedSection = 0.01;  // [rad] smaller changes of the section are ignored
// The first step onto the doubled branch, as a share of the orbit's size over its turns, is halved so often until there
// is a point on it.
constexpr double kDoubledShift = 0.02;
constexpr int kDoubledHalvings = 13;

Eigen::MatrixXd plus_identity(const ArcPoint& p, double sign) {
    return p.derivative + sign * Eigen::MatrixXd::Identity(p.derivative.rows(), p.derivative.cols());
}
// Test functions; a zero is a bifurcation.                                                                       (S77)
double fold_test(const ArcPoint& p) { return p.tangent[p.tangent.size() - 1]; }
double doubling_test(const ArcPoint& p) { return plus_identity(p, 1).determinant(); }
double branching_test(const ArcPoint& p) { return plus_identity(p, -1).determinant() * (fold_test(p) > 0 ? 1 : -1); }

// The product of μ_iμ_j − 1 over all pairs, which is real and smooth, and the smallest of these factors.
struct CircleTest {
    double product = 1, nearest = std::numeric_limits<double>::infinity();
    bool complex = false;  // the smallest factor belongs to a complex conjugate pair
};
CircleTest circle_of(const ArcPoint& p) {
    const auto& m = p.orbit.multipliers;
    std::complex<double> product = 1;
    CircleTest test;
    for (std::size_t i = 0; i < m.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const std::complex<double> factor = m[i] * m[j] - 1.0;
            product *= factor;
            if (!(std::abs(factor) < test.nearest)) continue;
            test.nearest = std::abs(factor);
            test.complex = std::fabs(m[i].imag()) > kNegligible && std::abs(m[i] - std::conj(m[j])) < kOnCircle;
        }
    test.product = product.real();
    return test;
}
double circle_test(const ArcPoint& p) { return circle_of(p).product; }
// The pairs of a conservative system stay on the unit circle, which is no crossing.
bool crosses_circle(const ArcPoint& a, const ArcPoint& b) {
    const CircleTest before = circle_of(a), after = circle_of(b);
    return before.product * after.product < 0 && std::min(before.nearest, after.nearest) > kOnCircle;
}

// Otherwise the tangent turned for another reason.
bool has_unit_multiplier(const PeriodicOrbit& orbit) {
    return std::ranges::any_of(orbit.multipliers, [](auto mu) { return std::abs(mu - 1.0) < kClose; });
}
bool beyond_range(const Eigen::VectorXd& z) { return z[z.size() - 1] < 0 || z[z.size() - 1] > 1; }
// The point is an end of the range, and its tangent points outwards.
bool leaves_range(const ArcPoint& p) {
    const double share = p.z[p.z.size() - 1];
    return fold_test(p) < 0 ? share < kLongRounding : share > 1 - kLongRounding;
}

// The cubic polynomial through two points of a curve with their tangents, at the distance s from `a` along its tangent;
// the straight line if there is a corner between them.
Eigen::VectorXd cubic(const ArcPoint& a, const ArcPoint& b, double s) {
    const Eigen::VectorXd chord = b.z - a.z;
    const double length = a.tangent.dot(chord), u = s / length, cosine = a.tangent.dot(b.tangent);
    if (cosine < kLeastCosine) return a.z + u * chord;
    const Eigen::VectorXd slope = b.tangent / cosine;
    return a.z + s * a.tangent +
           u * u * ((3 - 2 * u) * (chord - length * a.tangent) + length * (u - 1) * (slope - a.tangent));
}

// The work of the motions of a branch in one direction. They report it by calls of `progress`; short ones do not.
struct Work {
    long most_steps, steps = 0;
    bool spent() const { return steps > most_steps; }
};

using Test = std::function<double(const ArcPoint&)>;
double value_at(const std::optional<ArcPoint>& point, const Test& test) {
    return point ? test(*point) : std::numeric_limits<double>::quiet_NaN();
}

// How much the error of the derivative changes the test.
double test_error(ArcPoint point, const Test& test) {
    const double value = test(point);
    point.derivative *= 1 + kDerivativeError;
    for (auto& mu : point.orbit.multipliers) mu *= 1 + kDerivativeError;
    return std::fabs(test(point) - value);
}

// The point at which the test changes its sign between two places with known values, if it does, and the uncertainty of
// its place.
struct TestedPlace {
    double place, value;
};
struct Crossing {
    ArcPoint point;
    double uncertainty;
};
template <class PointAt>
std::optional<Crossing> sign_change(const PointAt& point, const Test& test, const TestedPlace& a,
                                    const TestedPlace& b) {
    if (!std::isfinite(a.value * b.value) || std::signbit(a.value) == std::signbit(b.value)) return std::nullopt;
    const auto value = [&](double place) { return value_at(point(place), test); };
    auto found = point(find_root(value, a.place, b.place, a.value, b.value));
    if (!found) return std::nullopt;
    const double slope = (b.value - a.value) / (b.place - a.place);
    const double uncertainty = test_error(*found, test) / std::fabs(slope);
    return Crossing{std::move(*found), uncertainty};
}

constexpr const char* kRangeEnds = "the range ends";

class Continuation {
  public:
    // `start`: the share of the range at which passages are located.
    Continuation(BranchArc arc, const ContinuationRequest& request, double start, const Progress& progress,
                 const Work& work)
        : arc_(std::move(arc)), request_(request), start_(start), progress_(progress), work_(work) {}

    // Appends points from `from` on, without `from` itself.
    void follow(ArcPoint from, Branch& branch, std::string& end);

  private:
    struct Walk {
        ArcPoint at;
        std::optional<ArcPoint> before;  // the point before on a smooth piece with the same section
        double step;
        bool moved;  // the section, since the last point
    };
    struct Attempt {
        Eigen::VectorXd predicted;
        std::optional<ArcPoint> next;
        bool same = false, smooth = false;  // the pattern of contact; also the direction
    };
    enum class Then { advance, retry, stop };
    double first_step() const { return kFirstArc * request_.step; }
    std::string reason_to_stop(const ArcPoint& at) const;  // empty: the branch continues
    Attempt attempt(const Walk& walk) const;
    Then overcome(Walk& walk, const Attempt& tried, Branch& branch, std::string& end);
    void advance(Walk& walk, Attempt found, Branch& branch);
    std::optional<Crossing> root(const ArcPoint& a, const ArcPoint& b, const Test& test) const;
    std::optional<Crossing> doubling_of_half(const ArcPoint& near) const;
    void add(OrbitChange change, const Crossing& crossing, Branch& branch) const;
    void locate(const ArcPoint& a, const ArcPoint& b, OrbitChange change, const Test& test, Branch& branch) const;
    bool locate_turn(const ArcPoint& a, const ArcPoint& b, Branch& branch) const;
    bool find_changes(const ArcPoint& a, const ArcPoint& b, Branch& branch) const;
    std::optional<ArcPoint> recentre(const ArcPoint& at);
    bool end_at_range(const ArcPoint& last, const Eigen::VectorXd& beyond, Branch& branch) const;
    bool passes(const ArcPoint& last, const std::optional<ArcPoint>& beyond, double step, Branch& branch,
                std::string& end) const;

    BranchArc arc_;
    const ContinuationRequest& request_;
    double start_;
    const Progress& progress_;
    const Work& work_;
};

// The uncertainty is that of the share of the range.
std::optional<Crossing> Continuation::root(const ArcPoint& a, const ArcPoint& b, const Test& test) const {
    const auto point = [&](double s) { return arc_.correct(cubic(a, b, s), a.tangent); };
    auto crossing = sign_change(point, test, {0, test(a)}, {a.tangent.dot(b.z - a.z), test(b)});
    if (crossing) crossing->uncertainty *= std::fabs(fold_test(crossing->point));
    return crossing;
}

// The parameter errs by the residual of the point and by the error of the test.
void Continuation::add(OrbitChange change, const Crossing& crossing, Branch& branch) const {
    const double range = std::fabs(request_.to - request_.from);
    const BranchPoint at = arc_.branch_point(crossing.point);
    const double residual = kOrbitConverged * std::max(range, std::fabs(at.parameter));
    branch.special.push_back({change, at, residual + range * crossing.uncertainty});
}

void Continuation::locate(const ArcPoint& a, const ArcPoint& b, OrbitChange change, const Test& test,
                          Branch& branch) const {
    const auto crossing = root(a, b, test);
    if (!crossing) return;
    // A saddle with μ_iμ_j = 1 is no change.
    if (change == OrbitChange::neimark_sacker && !circle_of(crossing->point).complex) return;
    add(change, *crossing, branch);
}

// The period doubling of the orbit with half as many turns that is nearest to this point.
std::optional<Crossing> Continuation::doubling_of_half(const ArcPoint& near) const {
    const BranchArc half = arc_.of_turns(near.orbit.turns / 2);
    const Eigen::Index n = near.z.size() - 1;
    const auto point = [&](double share) {
        Eigen::VectorXd z = near.z;
        z[n] = share;
        return half.correct(z, Eigen::VectorXd::Unit(n + 1, n));
    };
    const double low = near.z[n] - kClose, high = near.z[n] + kClose;
    return sign_change(point, doubling_test, {low, value_at(point(low), doubling_test)},
                       {high, value_at(point(high), doubling_test)});
}

// Where the branch turns, it has a fold, or it is a branch of doubled period at its origin: there it meets itself, each
// orbit begun half of its period later. True if so, and the branch ends.                                       (S77)
bool Continuation::locate_turn(const ArcPoint& a, const ArcPoint& b, Branch& branch) const {
    const auto turn = root(a, b, fold_test);
    if (!turn) return false;
    const PeriodicOrbit& orbit = turn->point.orbit;
    const bool twice = !orbit.impacts.empty() && repeats(orbit, 2, kClose);
    const auto origin = twice ? doubling_of_half(turn->point) : std::nullopt;
    if (origin) {
        add(OrbitChange::period_doubling, *origin, branch);
        branch.points.push_back(arc_.branch_point(turn->point));
    } else if (has_unit_multiplier(orbit)) {
        add(OrbitChange::fold, *turn, branch);
    }
    return origin.has_value();
}

// True if the branch ends between the points.
bool Continuation::find_changes(const ArcPoint& a, const ArcPoint& b, Branch& branch) const {
    const auto changes = [&](auto test) { return std::signbit(test(a)) != std::signbit(test(b)); };
    const std::size_t count = a.orbit.impacts.size();
    if (count == b.orbit.impacts.size())
        for (std::size_t i = 0; i < count; ++i) {
            const Test overhang = [i, count](const ArcPoint& p) {
                return p.orbit.impacts.size() == count ? p.orbit.impacts[i].overhang
                                                       : std::numeric_limits<double>::quiet_NaN();
            };
            if (changes(overhang)) locate(a, b, OrbitChange::corner, overhang, branch);
        }
    const bool turns = changes(fold_test);
    if (turns && locate_turn(a, b, branch)) return true;
    if (changes(doubling_test)) locate(a, b, OrbitChange::period_doubling, doubling_test, branch);
    if (!turns && changes(branching_test)) locate(a, b, OrbitChange::branching, branching_test, branch);
    if (crosses_circle(a, b)) locate(a, b, OrbitChange::neimark_sacker, circle_test, branch);
    const Test beyond_start = [this](const ArcPoint& p) { return p.z[p.z.size() - 1] - start_; };
    if (changes(beyond_start))
        if (auto passage = root(a, b, beyond_start)) branch.at_start.push_back(std::move(passage->point.orbit));
    return false;
}

// Classifies the change within `step`, which is too short to be divided. True if the branch continues beyond it.
bool Continuation::passes(const ArcPoint& last, const std::optional<ArcPoint>& beyond, double step, Branch& branch,
                          std::string& end) const {
    const PeriodicOrbit& orbit = last.orbit;
    // Only the direction jumps: at a corner, or by rounding where impacts vanish.
    if (beyond && same_pattern(orbit, beyond->orbit)) {
        find_changes(last, *beyond, branch);
        return true;
    }
    const auto at_tip = [&](const OrbitImpact& impact) { return std::fabs(impact.overhang) < kAtTip * impact.x; };
    const bool released = orbit.always_touching() || orbit.chatters() || (beyond && beyond->orbit.chatters());
    const OrbitChange change = released                                     ? OrbitChange::release
                               : std::ranges::any_of(orbit.impacts, at_tip) ? OrbitChange::corner
                                                                            : OrbitChange::grazing;
    const double range = std::fabs(request_.to - request_.from);
    const bool rests = orbit.chatters() || (beyond && beyond->orbit.chatters());
    const double unsure = rests && !orbit.always_touching() ? kRestUncertainty * std::fabs(arc_.parameter(last.z)) : 0;
    branch.special.push_back({change, arc_.branch_point(last), std::max(step * range, unsure)});
    end = fmt::format("{}: {}", name(change), change_of_pattern(orbit, beyond ? &beyond->orbit : nullptr));
    return false;
}

// The same point with its section in the middle of its longest flight; nothing if the section is already there.
std::optional<ArcPoint> Continuation::recentre(const ArcPoint& at) {
    if (at.orbit.always_touching()) return std::nullopt;
    const BranchPoint point = arc_.branch_point(at);
    BranchArc moved = arc_.recentred(point);
    if (std::fabs(std::remainder(moved.section() - arc_.section(), 2 * std::numbers::pi)) < kMovedSection)
        return std::nullopt;
    const Eigen::Index n = at.z.size() - 1;
    auto same = moved.correct(moved.place(point.parameter), Eigen::VectorXd::Unit(n + 1, n));
    if (!same || !same_pattern(at.orbit, same->orbit)) return std::nullopt;
    if (fold_test(*same) * fold_test(at) < 0) same->tangent *= -1;
    arc_ = std::move(moved);
    return same;
}

// Puts the last point at the end of the range. False if there is none with the pattern of the point before.
bool Continuation::end_at_range(const ArcPoint& last, const Eigen::VectorXd& beyond, Branch& branch) const {
    const Eigen::Index n = last.z.size() - 1;
    const double end = beyond[n] > 1 ? 1 : 0, way = (end - last.z[n]) / (beyond[n] - last.z[n]);
    Eigen::VectorXd z = last.z + way * (beyond - last.z);
    z[n] = end;
    auto point = arc_.correct(z, Eigen::VectorXd::Unit(n + 1, n));
    if (!point || !same_pattern(last.orbit, point->orbit)) return false;
    if (fold_test(*point) * fold_test(last) < 0) point->tangent *= -1;
    if (find_changes(last, *point, branch)) return true;
    branch.points.push_back({end == 1 ? request_.to : request_.from, point->orbit});
    return true;
}

std::string Continuation::reason_to_stop(const ArcPoint& at) const {
    if (leaves_range(at)) return kRangeEnds;
    if (work_.spent()) return "its motions have used up their steps; a larger solver.max_steps allows more";
    const double largest = at.orbit.largest_multiplier();
    if (!(largest > kMostUnstable)) return {};
    return fmt::format("the orbit is so unstable that rounding hides it: its largest multiplier is {:.1e}", largest);
}

Continuation::Attempt Continuation::attempt(const Walk& walk) const {
    Attempt out;
    out.predicted = walk.before ? cubic(walk.at, *walk.before, walk.step) : walk.at.z + walk.step * walk.at.tangent;
    out.next = arc_.correct(out.predicted, walk.at.tangent);
    out.same = out.next && same_pattern(walk.at.orbit, out.next->orbit);
    out.smooth = out.same && out.next->tangent.dot(walk.at.tangent) >= kLeastCosine;
    return out;
}

// Without a smooth step: a shorter one, another section, a point beyond a corner, or the end of the branch.
Continuation::Then Continuation::overcome(Walk& walk, const Attempt& tried, Branch& branch, std::string& end) {
    // Beyond the range there may be no problem.
    if (!tried.next && beyond_range(tried.predicted) && end_at_range(walk.at, tried.predicted, branch))
        return Then::stop;
    if (kArcShrink * walk.step >= kSmallestArc) {
        walk.step *= kArcShrink;
        return Then::retry;
    }
    if (auto centred = tried.same || walk.moved ? std::nullopt : recentre(walk.at)) {
        walk = {std::move(*centred), std::nullopt, first_step(), true};
        return Then::retry;
    }
    if (!passes(walk.at, tried.next, walk.step, branch, end)) return Then::stop;
    walk.step = first_step();
    return Then::advance;
}

void Continuation::advance(Walk& walk, Attempt found, Branch& branch) {
    branch.points.push_back(arc_.branch_point(*found.next));
    walk.before = std::exchange(walk.at, std::move(*found.next));
    walk.moved = false;
    auto centred = near_section(walk.at.orbit) ? recentre(walk.at) : std::nullopt;
    if (centred) walk.at = std::move(*centred);
    if (!found.smooth || centred) walk.before.reset();
    walk.step = std::min(kArcGrowth * walk.step, request_.step);
}

void Continuation::follow(ArcPoint from, Branch& branch, std::string& end) {
    Walk walk{std::move(from), std::nullopt, first_step(), false};
    for (int count = 0; count < request_.most_points;) {
        if (progress_ && !progress_(arc_.parameter(walk.at.z))) throw Interrupted();
        end = reason_to_stop(walk.at);
        if (!end.empty()) return;
        end = kRangeEnds;
        Attempt tried = attempt(walk);
        if (!tried.smooth) {
            const Then then = overcome(walk, tried, branch, end);
            if (then == Then::stop) return;
            if (then == Then::retry) continue;
        } else if (beyond_range(tried.next->z)) {
            end_at_range(walk.at, tried.next->z, branch);
        } else if (find_changes(walk.at, *tried.next, branch)) {
            end = fmt::format("{}: there the orbit repeats itself after {}", name(OrbitChange::period_doubling),
                              counted(static_cast<std::size_t>(walk.at.orbit.turns / 2), "turn"));
            return;
        }
        if (beyond_range(tried.next->z)) return;
        advance(walk, std::move(tried), branch);
        ++count;
    }
    end = fmt::format("the largest number of points, {}, is reached", request_.most_points);
}

// A point on the period-doubled branch, along the eigenvector of the multiplier −1.                             (S77)
std::optional<ArcPoint> doubled(const BranchArc& once, const BranchArc& twice, const SpecialPoint& special) {
    const Eigen::MatrixXd derivative = once.derivative_at(special.at);
    const Eigen::VectorXd z = twice.place(special.at);
    Eigen::VectorXd direction(derivative.rows() + 1);
    direction << eigenvector_nearest(derivative, -1.0).real().normalized(), 0;
    const double first = kDoubledShift / special.at.orbit.turns;
    for (int halvings = 0; halvings <= kDoubledHalvings; ++halvings) {
        auto point = twice.correct(z + std::ldexp(first, -halvings) * direction, direction);
        if (!point || point->orbit.impacts.size() != 2 * special.at.orbit.impacts.size()) continue;
        if (point->tangent.dot(direction) < 0) point->tangent *= -1;
        return point;
    }
    return std::nullopt;
}

}  // namespace

std::vector<Branch> continue_orbit(const Family& family, const BranchPoint& start, const ContinuationRequest& request,
                                   const Progress& progress) {
    const Problem at_start = family(start.parameter);
    Work work{at_start.solver.max_steps};
    const Progress counting = [&](double parameter) {
        work.steps += kStepsPerReport;
        return !progress || progress(parameter);
    };
    const SectionScale scale =
        section_scale(for_orbits(at_start), start.orbit, [&](double) { return counting(start.parameter); });
    std::vector<Branch> branches(1);
    const auto run = [&](const BranchArc& arc, ArcPoint at, bool both, Branch& branch) {
        branch.points.push_back(arc.branch_point(at));
        const auto follow = [&](ArcPoint from, std::string& end) {
            work.steps = 0;
            Continuation(arc, request, arc.share(start.parameter), progress, work).follow(std::move(from), branch, end);
        };
        if (both) {
            branch.at_start.push_back(at.orbit);
            ArcPoint back = at;
            back.tangent *= -1;
            follow(std::move(back), branch.first_end);
            std::ranges::reverse(branch.points);
            std::ranges::reverse(branch.special);
        }
        follow(std::move(at), branch.last_end);
    };
    {
        const BranchArc arc(family, request, start.orbit, start.orbit.turns, scale, counting);
        const Eigen::Index n = scale.units.size();
        const auto first = arc.correct(arc.place(start), Eigen::VectorXd::Unit(n + 1, n));
        if (!first) return {};
        run(arc, *first, true, branches.front());
    }
    for (std::size_t i = 0; i < branches.size() && static_cast<int>(i) < request.doublings; ++i) {
        const std::vector<SpecialPoint> special = branches[i].special;
        for (const SpecialPoint& point : special) {
            const bool origin = point.at.orbit.turns != branches[i].points.front().orbit.turns;
            if (point.change != OrbitChange::period_doubling || origin) continue;
            const BranchArc once(family, request, point.at.orbit, point.at.orbit.turns, scale, counting);
            const BranchArc twice(family, request, point.at.orbit, 2 * point.at.orbit.turns, scale, counting);
            if (auto at = doubled(once, twice, point)) run(twice, *at, false, branches.emplace_back());
        }
    }
    return branches;
}

}  // namespace beamcam::sim
