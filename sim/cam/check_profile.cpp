#include "sim/cam/check_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/base/counted.hpp"
#include "sim/base/numerics.hpp"
#include "sim/cam/profile_spans.hpp"

namespace beamcam::sim {
namespace {

constexpr double kShortestSegment = 1e-6;  // [rad] of a segment: the outline would turn in less than a step's rounding
constexpr double kSharp = 1e-6;            // of the outline's size: a radius of curvature that is an edge
constexpr double kTangent = 1e-6;          // of the outline's size: the digits of a drawing
constexpr std::size_t kFewestPoints = 24, kMostPoints = 100'000;
constexpr double kLongestGap =
    4;  // of the longest distance of neighbours: the first and the last point of an open curve
constexpr double kUncertain = 0.1;  // of a radius of curvature, which half of the points make that much different

double degrees(double angle) { return angle * 180 / std::numbers::pi; }

// ---- law ---------------------------------------------------------------------------------------

class LawCheck {
  public:
    LawCheck(const LawProfile& profile, Vec2 centre, double offset)
        : profile_(profile), centre_(centre), offset_(offset), side_(side_of(profile, centre)) {
        direction_ = std::atan2(centre.y, centre.x);
        direction_ += kFullTurn * std::round((profile.lowest - direction_) / kFullTurn);
    }

    std::vector<Issue> issues() {
        check_segments();
        if (out_.empty()) check_turn();
        if (out_.empty()) check_rises();
        if (out_.empty()) check_angles();
        if (out_.empty()) check_speed();
        if (out_.empty()) check_undercut();
        return std::move(out_);
    }

  private:
    void error(const std::string& key, std::string message) {
        out_.push_back({"cam.profile." + key, std::move(message)});
    }
    static std::string key_of(std::size_t i, const char* name = "") { return fmt::format("segments.{}{}", i, name); }

    void check_segments() {
        const std::vector<LawSegment>& all = profile_.segments;
        if (all.empty()) return error("segments", "is empty; write at least one segment");
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (all[i].law == MotionLaw::dwell && all[i].rise != 0)
                error(key_of(i, ".rise"),
                      fmt::format("a dwell has no rise, but this one has {:.6g} deg; remove it, or use "
                                  "another \"law\"",
                                  degrees(all[i].rise)));
            if (!all[i].over && i + 1 < all.size())
                error(key_of(i), "needs \"over\", for example \"90 deg\": only the last segment may fill the turn");
            if (all[i].over && *all[i].over < kShortestSegment)
                error(key_of(i, ".over"),
                      fmt::format("must be at least {:g} rad, is {:g} rad", kShortestSegment, *all[i].over));
        }
    }

    void check_turn() {
        double sum = 0;
        for (const LawSegment& each : profile_.segments) sum += each.over.value_or(0);
        const std::size_t last = profile_.segments.size() - 1;
        if (!profile_.segments[last].over) {
            if (!(kFullTurn - sum >= kShortestSegment))
                error(key_of(last),
                      fmt::format("nothing is left of the turn for it: the segments before it last {:.6g} "
                                  "deg of 360 deg; shorten one of them",
                                  degrees(sum)));
        } else if (!(std::fabs(sum - kFullTurn) <= kNegligible)) {
            error(
                key_of(last, ".over"),
                fmt::format("the segments last {:.10g} deg, not 360 deg; {}", degrees(sum),
                            sum < kFullTurn ? "add a segment, or leave out the last \"over\", which then fills the turn"
                                            : "shorten one of them"));
        }
    }

    void check_rises() {
        double sum = 0;
        std::size_t last = 0;
        for (std::size_t i = 0; i < profile_.segments.size(); ++i) {
            sum += profile_.segments[i].rise;
            if (profile_.segments[i].law != MotionLaw::dwell) last = i;
        }
        if (!(std::fabs(sum) <= kNegligible))
            error(key_of(last, ".rise"),
                  fmt::format("the rises sum to {:.10g} deg, so that the outline would not close; "
                              "write {:.10g} deg here, or change another rise",
                              degrees(sum), degrees(profile_.segments[last].rise - sum)));
    }

    // The lever stays on one side of its line to C, clear of it by the offset and within a right angle.
    void check_angles() {
        const double distance = norm(centre_);
        if (!(distance > offset_))
            return out_.push_back(
                {"cam.centre", fmt::format("is {:g} m from the pivot of the lever, whose face is {:g} m "
                                           "from it; move the cam away",
                                           distance, offset_)});
        const double near = std::asin(offset_ / distance), far = std::numbers::pi / 2;
        const auto [low, high] = range();
        if (side_ * (low - direction_) > near && side_ * (low - direction_) < far &&
            side_ * (high - direction_) > near && side_ * (high - direction_) < far)
            return;
        const double least = high > direction_ ? near : -far, most = high > direction_ ? far : -near;
        const std::string remedy = high - low < most - least
                                       ? fmt::format("write \"lowest\" between {:.6g} and {:.6g} deg",
                                                     degrees(direction_ + least + profile_.lowest - low),
                                                     degrees(direction_ + most + profile_.lowest - high))
                                       : "reduce the rises";
        error("lowest",
              fmt::format("the lever moves between {:.6g} and {:.6g} deg, but levers on a cam about [{:g}, {:g}] m "
                          "have angles between {:.6g} and {:.6g} deg, or between {:.6g} and {:.6g} deg on its other "
                          "side; {}",
                          degrees(low), degrees(high), centre_.x, centre_.y, degrees(direction_ + least),
                          degrees(direction_ + most), degrees(direction_ - most), degrees(direction_ - least), remedy));
    }

    // The least and the largest angle of the lever [rad].
    std::pair<double, double> range() const {
        double low = profile_.lowest, high = profile_.lowest, theta = profile_.lowest;
        for (const LawSegment& each : profile_.segments) {
            theta += each.rise;
            low = std::min(low, theta);
            high = std::max(high, theta);
        }
        return {low, high};
    }

    // Where `quantity` of the motion is least: {φ, value}. Not finite counts as least.
    template <class F>
    static Vec2 least(const LawProfile& profile, F&& quantity) {
        const ProgrammedMotion motion(profile);
        Vec2 best{0, std::numeric_limits<double>::infinity()};
        for (const ProgrammedMotion::Segment& segment : motion.segments()) {
            std::vector<double> ends{0};
            for (const double u : law_breaks(segment.law)) ends.push_back(u);
            ends.push_back(1);
            for (double& each : ends) each = segment.start + each * segment.over;
            const Vec2 here = largest_over(ends, [&](double phi) {
                const double value = quantity(ProgrammedMotion::at(segment, phi));
                return std::isfinite(value) ? -value : std::numeric_limits<double>::max();
            });
            if (-here.y < best.y) best = {here.x, -here.y};
        }
        return best;
    }

    void check_speed() {
        const Vec2 slowest = least(profile_, [](const LeverMotion& m) { return m.velocity; });
        if (slowest.y > -1) return;
        std::size_t i = 0;
        const ProgrammedMotion motion(profile_);
        while (i + 1 < motion.segments().size() && motion.segments()[i + 1].start <= slowest.x) ++i;
        error(key_of(i),
              fmt::format("at the turn {:.5g} deg the lever returns by {:.4g} rad per rad of the cam, but only a "
                          "return by less than 1 keeps it on a cam; use a longer \"over\" or a smaller rise",
                          degrees(slowest.x), -slowest.y));
    }

    double size() const { return norm(centre_); }
    Vec2 least_radius(const LawProfile& profile, Vec2 centre) const {
        return least(profile, [&](const LeverMotion& m) {
            return 1 + m.velocity > 0 ? touched_point(m, centre, offset_, side_).radius
                                      : -std::numeric_limits<double>::max();
        });
    }
    bool is_convex(const LawProfile& profile, Vec2 centre) const {
        return least_radius(profile, centre).y > kSharp * size();
    }

    // The least x in (from, to] with a convex outline; nothing if there is none.
    template <class IsConvex>
    static std::optional<double> first_convex(double from, double to, IsConvex&& convex_at) {
        constexpr int kScan = 32, kHalvings = 40;
        for (int i = 1; i <= kScan; ++i) {
            double high = from + (to - from) * i / kScan, low = from + (to - from) * (i - 1) / kScan;
            if (!convex_at(high)) continue;
            for (int k = 0; k < kHalvings; ++k) {
                const double middle = 0.5 * (low + high);
                (convex_at(middle) ? high : low) = middle;
            }
            return high;
        }
        return std::nullopt;
    }

    std::vector<std::string> remedies() const {
        std::vector<std::string> all;
        LawProfile changed = profile_;
        const auto [low, high] = range();
        const double room = std::numbers::pi / 2 - std::max(side_ * (low - direction_), side_ * (high - direction_));
        const auto lift = first_convex(0, room, [&](double x) {
            changed.lowest = profile_.lowest + side_ * x;
            return is_convex(changed, centre_);
        });
        if (lift)
            all.push_back(fmt::format("{} \"lowest\" to at {} {:.2f} deg", side_ > 0 ? "raise" : "lower",
                                      side_ > 0 ? "least" : "most",
                                      side_ * std::ceil(degrees(side_ * profile_.lowest + *lift) * 100) / 100));
        changed = profile_;
        const auto cut = first_convex(0, 1, [&](double x) {
            for (std::size_t i = 0; i < changed.segments.size(); ++i)
                changed.segments[i].rise = (1 - x) * profile_.segments[i].rise;
            return is_convex(changed, centre_);
        });
        if (cut && *cut < 0.999)
            all.push_back(fmt::format("multiply the rises by at most {:.3f}", std::floor((1 - *cut) * 1000) / 1000));
        // Without an offset the outline grows with the distance, and its shape stays.
        const auto factor = first_convex(0, 7, [&](double x) { return is_convex(profile_, std::exp(x) * centre_); });
        if (offset_ > 0 && factor)
            all.push_back(fmt::format("move the cam to at least {:.4g} m from the hub's axis",
                                      std::exp(*factor) * norm(centre_)));
        return all;
    }

    void check_undercut() {
        const Vec2 sharpest = least_radius(profile_, centre_);
        if (sharpest.y > kSharp * size()) return;
        const double theta = ProgrammedMotion(profile_).at(sharpest.x).theta;
        error(
            "lowest",
            fmt::format("the outline is undercut: at the turn {:.5g} deg, where the lever is at {:.4g} deg, its "
                        "radius of curvature is {:.4g} m; {}",
                        degrees(sharpest.x), degrees(theta), sharpest.y, fmt::join(with_default(remedies()), ", or ")));
    }
    static std::vector<std::string> with_default(std::vector<std::string> all) {
        if (all.empty()) all.emplace_back("use longer segments and smaller rises");
        return all;
    }

    const LawProfile& profile_;
    Vec2 centre_;
    double offset_, side_;
    double direction_;  // of the cam as seen from the pivot, within half a turn of the lever [rad]
    std::vector<Issue> out_;
};

// ---- arcs --------------------------------------------------------------------------------------

std::vector<Issue> check_arcs(const ArcsProfile& profile) {
    const std::vector<Arc>& arcs = profile.arcs;
    const std::size_t n = arcs.size();
    if (n == 0) return {{"cam.profile.arcs", "is empty; write at least one arc"}};
    double size = 0;
    for (const Arc& arc : arcs) size = std::max(size, norm(arc.centre) + arc.radius);
    if (n == 2)
        return {
            {"cam.profile.arcs",
             "two circles touch each other from inside in one point only; an outline has one arc or at least three"}};
    for (std::size_t i = 0; n > 1 && i < n; ++i) {
        const Arc &arc = arcs[i], &next = arcs[(i + 1) % n];
        const double apart = norm(next.centre - arc.centre), difference = std::fabs(next.radius - arc.radius);
        const std::string key = fmt::format("cam.profile.arcs.{}", (i + 1) % n);
        if (apart <= kTangent * size && difference <= kTangent * size)
            return {{key, "is a part of the same circle as the arc before it; remove one of them"}};
        if (!(std::fabs(apart - difference) <= kTangent * size))
            return {{key + ".radius",
                     fmt::format("the arc is not tangent to the one before it: their centres are {:.8g} m "
                                 "apart, but their radii differ by {:.8g} m; both must agree within {:.2g} m",
                                 apart, difference, kTangent * size)}};
    }
    const std::vector<ProfileSpan> spans = spans_of(profile);
    double turn = 0;
    for (const ProfileSpan& span : spans) turn += span.to - span.from;
    if (!(std::fabs(turn - kFullTurn) <= kTangent))
        return {{"cam.profile.arcs",
                 fmt::format(
                     "the arcs turn by {:.6g} deg from joint to joint, not by 360 deg; list them counter-clockwise, "
                     "each tangent to the next",
                     degrees(turn))}};
    return {};
}

// ---- points ------------------------------------------------------------------------------------

std::string point_name(std::size_t i, const Vec2& p) {
    return fmt::format("point {} at ({:.6g}, {:.6g}) m", i + 1, p.x, p.y);
}

// Half of the points have a quarter of the noise in the radius of curvature, and four times the error of a spline
// through exact points: where they disagree, one of these is large.
std::vector<Issue> warn_of_noise(const OrientedPoints& outline, const std::vector<ProfileSpan>& spans) {
    PointsProfile half;
    for (std::size_t i = 0; i < outline.points.size(); i += 2) {
        half.x.push_back(outline.points[i].x);
        half.y.push_back(outline.points[i].y);
    }
    const std::vector<ProfileSpan> coarse = spans_of(half);
    std::size_t worst = 0;
    double most = 0;
    const auto radius = [](const ProfileSpan& span) { return span.at(span.from).radius; };
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        const double change = std::fabs(radius(coarse[i]) / radius(spans[2 * i]) - 1);
        if (change > most) {
            most = change;
            worst = i;
        }
    }
    if (most <= kUncertain) return {};
    const Vec2 p = outline.points[2 * worst];
    return {{"cam.profile",
             fmt::format("the radius of curvature at ({:.6g}, {:.6g}) m is {:.4g} m, but {:.4g} m without every second "
                         "point: the points are too far apart or too noisy for forces and jump speeds; state more of "
                         "them or more digits, and smooth measured ones",
                         p.x, p.y, radius(spans[2 * worst]), radius(coarse[worst])),
             false}};
}

std::vector<Issue> check_points(const PointsProfile& profile, const std::string& hint) {
    if (profile.x.size() != profile.y.size())
        return {{"cam.profile", fmt::format("the points need as many second coordinates ({}) as first ones ({})",
                                            profile.y.size(), profile.x.size())}};
    const auto wrong = [&](const std::string& message) { return std::vector<Issue>{{"cam.profile", message + hint}}; };
    if (profile.x.size() > kMostPoints)
        return wrong(fmt::format("an outline has at most {} points, this one has {}: leave out most of them",
                                 kMostPoints, profile.x.size()));
    const OrientedPoints outline = oriented(profile);
    const std::vector<Vec2>& points = outline.points;
    const std::size_t n = points.size();
    if (n < kFewestPoints) return wrong(fmt::format("an outline needs at least {} points, has {}", kFewestPoints, n));
    // Numbers of the points in the order of the file.
    const bool reversed = !(points.front() == Vec2{profile.x.front(), profile.y.front()});
    const auto named = [&](std::size_t i) { return point_name(reversed ? n - 1 - i : i, points[i]); };
    const auto hollow = [&](std::size_t i) {
        return wrong(
            fmt::format("the outline is not convex at {}; remove hollows, or state the points with more digits or "
                        "farther apart",
                        named(i)));
    };
    double longest = 0, turn = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 &p = points[i], &next = points[(i + 1) % n];
        const double step = norm(next - p);
        if (!(step > 0)) return wrong(fmt::format("{} and the next one coincide; keep one of them", named(i)));
        if (i + 1 < n) longest = std::max(longest, step);
        turn += std::atan2(cross(p, next), dot(p, next));
    }
    const double closing = norm(points.front() - points.back());
    if (closing > kLongestGap * longest)
        return wrong(
            fmt::format("the outline is not closed: its last point is {:.4g} m from the first, other neighbours are "
                        "at most {:.4g} m apart; add the missing points",
                        closing, longest));
    if (!(std::fabs(turn - kFullTurn) < 1))
        return wrong(
            "the outline does not go once around the axis at (0, 0); state the points in the cam's frame, in order, "
            "and the unit of angles");
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 &before = points[(i + n - 1) % n], &p = points[i], &next = points[(i + 1) % n];
        if (!(cross(p - before, next - p) > 0)) return hollow(i);
    }
    for (std::size_t i = 0; i < n; ++i) {
        const double step = (i + 1 < n ? outline.normals[i + 1] : outline.normals[0] + kFullTurn) - outline.normals[i];
        if (!(step > 0)) return hollow(i);
    }
    double size = 0;
    for (const Vec2& p : points) size = std::max(size, norm(p));
    const std::vector<ProfileSpan> spans = spans_of(profile);
    std::size_t i = 0;
    for (const ProfileSpan& span : spans) {
        const Vec2 sharpest = largest_over({span.from, span.to}, [&](double alpha) {
            const double radius = span.at(alpha).radius;
            return std::isfinite(radius) ? -radius : std::numeric_limits<double>::max();
        });
        if (!(-sharpest.y > kSharp * size))
            return wrong(
                fmt::format("the smooth outline through the points has the radius of curvature {:.4g} m after {}; "
                            "state the points with more digits or farther apart, without corners",
                            -sharpest.y, named(i)));
        ++i;
    }
    return warn_of_noise(outline, spans);
}

std::vector<Issue> check_axis(const Problem& problem) {
    double least = std::numeric_limits<double>::infinity();
    for (const ProfileSpan& span : spans_of(problem))
        least = std::min(least, -largest_over({span.from, span.to}, [&](double alpha) { return -span.at(alpha).h; }).y);
    if (least > 0) return {};
    return {{"cam.profile",
             fmt::format("the axis of the cam, (0, 0) of its frame, lies outside the outline by {:.4g} m; move "
                         "the outline over it",
                         -least)}};
}

}  // namespace

std::vector<Issue> check_profile(const Problem& problem) {
    const Cam& cam = *problem.cam;
    std::vector<Issue> issues;
    if (const auto* law = std::get_if<LawProfile>(&*cam.profile))
        issues = LawCheck(*law, cam.centre, contact_offset(problem)).issues();
    if (const auto* arcs = std::get_if<ArcsProfile>(&*cam.profile)) issues = check_arcs(*arcs);
    if (const auto* points = std::get_if<PointsProfile>(&*cam.profile))
        issues = check_points(*points, hint_of_unit(problem));
    if (std::ranges::none_of(issues, &Issue::fatal)) std::ranges::move(check_axis(problem), std::back_inserter(issues));
    return issues;
}

std::string hint_of_unit(const Problem& problem) {
    const auto* points = std::get_if<PointsProfile>(problem.cam->profile ? &*problem.cam->profile : nullptr);
    if (!points || points->x.size() != points->y.size()) return "";
    double size = 0;
    for (std::size_t i = 0; i < points->x.size(); ++i) size = std::max(size, std::hypot(points->x[i], points->y[i]));
    if (size < norm(problem.cam->centre)) return "";
    return fmt::format(
        "; the points reach {:.4g} m from the axis: if their columns are in mm, add \"units\": "
        "{{\"COLUMN\": \"mm\", …}}",
        size);
}

}  // namespace beamcam::sim
