// Chooses instants of a motion so that straight pieces between them follow it: a piece is halved until the motion stays
// near it in its middle and beside it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "sim/base/vec2.hpp"

namespace beamcam::sim {

inline constexpr long kMostCurveRows = 400'000;  // 10 MB of three channels; more than a page resolves
inline constexpr double kBesideMiddle = 0.31;    // of a piece: no vibration has a node here and in the middle

// The distance of a plane curve from a piece, each direction by its range so far.
class PlaneCurve {
  public:
    using Point = Vec2;
    // `drawn`: ends of the drawn abscissae. Finite ones are those of the range; pieces outside are not halved. `stray`:
    // the largest distance from a piece, as a share of the range.
    PlaneCurve(std::pair<double, double> drawn, double stray) : drawn_(drawn), most_(stray) {}

    void see(Vec2 p) {
        low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
        high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
    }
    bool is_outside(Vec2 from, Vec2 centre, Vec2 to) const {
        return std::max({from.x, centre.x, to.x}) < drawn_.first || std::min({from.x, centre.x, to.x}) > drawn_.second;
    }
    // True if p, between the ends of a piece, is too far from it. False where the curve has no value.
    bool strays(Vec2 from, Vec2 to, Vec2 p, double /*share*/) const {
        const auto end = [](double drawn, double seen) { return std::isfinite(drawn) ? drawn : seen; };
        const Vec2 range{end(drawn_.second, high_.x) - end(drawn_.first, low_.x), high_.y - low_.y};
        const auto scaled = [&](Vec2 v) {
            return Vec2{range.x > 0 ? v.x / range.x : 0, range.y > 0 ? v.y / range.y : 0};
        };
        const Vec2 along = scaled(to - from), off = scaled(p - from);
        const double length = dot(along, along),
                     share = length > 0 ? std::clamp(dot(off, along) / length, 0.0, 1.0) : 0;
        return norm(off - along * share) > most_;
    }

  private:
    static constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::pair<double, double> drawn_;
    double most_;
    Vec2 low_{kInfinity, kInfinity}, high_{-kInfinity, -kInfinity};
};

// The values of several channels at an instant.
struct ChannelPoint {
    double t = 0;
    std::vector<double> values = {};
};

// The curves of several channels against time; a point strays from a piece if it does in one of them.
class ChannelCurves {
  public:
    using Point = ChannelPoint;
    // `drawn`: first and last time of the curves. `rounding`: of each channel, a difference that does not matter;
    // infinite: the channel is not followed.
    ChannelCurves(std::pair<double, double> drawn, std::vector<double> rounding, double stray)
        : curves_(rounding.size(), PlaneCurve(drawn, stray)), rounding_(std::move(rounding)) {}

    void see(const Point& p) {
        for (std::size_t c = 0; c < curves_.size(); ++c) curves_[c].see({p.t, p.values[c]});
    }
    bool is_outside(const Point&, const Point&, const Point&) const { return false; }
    bool strays(const Point& from, const Point& to, const Point& p, double share) const {
        for (std::size_t c = 0; c < curves_.size(); ++c) {
            const double a = from.values[c], b = to.values[c], value = p.values[c];
            if (std::fabs(value - std::lerp(a, b, share)) > rounding_[c] &&
                curves_[c].strays({from.t, a}, {to.t, b}, {p.t, value}, share))
                return true;
        }
        return false;
    }

  private:
    std::vector<PlaneCurve> curves_;
    std::vector<double> rounding_;
};

template <class Measure>
class PieceRefiner {
  public:
    using Point = typename Measure::Point;
    PieceRefiner(Measure measure, int halvings) : measure_(std::move(measure)), halvings_(halvings) {}

    const Measure& measure() const { return measure_; }
    bool is_full() const { return added_ >= kMostCurveRows; }

    // Between the instants a < b. `at(t)` is the motion; `keep(t, point)` receives the added instants, in order.
    template <class At, class Keep>
    void refine(double a, double b, At&& at, Keep&& keep) {
        halve(a, seen(at(a)), b, seen(at(b)), halvings_, at, keep);
    }

  private:
    template <class At, class Keep>
    void halve(double a, const Point& from, double b, const Point& to, int halvings, At& at, Keep& keep) {
        const double middle = 0.5 * (a + b);
        if (halvings == 0 || is_full() || !(middle > a && middle < b)) return;
        const Point aside = seen(at(a + kBesideMiddle * (b - a))), centre = seen(at(middle));
        if (measure_.is_outside(from, centre, to)) return;
        if (!measure_.strays(from, to, centre, 0.5) && !measure_.strays(from, to, aside, kBesideMiddle)) return;
        halve(a, from, middle, centre, halvings - 1, at, keep);
        ++added_;
        keep(middle, centre);
        halve(middle, centre, b, to, halvings - 1, at, keep);
    }

    Point seen(Point p) {
        measure_.see(p);
        return p;
    }

    Measure measure_;
    int halvings_;
    long added_ = 0;
};

}  // namespace beamcam::sim
