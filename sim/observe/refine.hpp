// Chooses instants of a plane curve so that straight pieces between them follow it: a piece is halved until the curve
// stays near it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/base/vec2.hpp"
#include "sim/observe/constants.hpp"

namespace beamcam::sim {

class CurveRefiner {
  public:
    // `drawn`: ends of the drawn abscissae. Finite ones are those of the range; pieces outside are not halved.
    explicit CurveRefiner(std::pair<double, double> drawn) : drawn_(drawn) {}

    // Between the instants a < b. `at(t)` is the curve; `keep(t)` receives the added instants, in order. `stray`: the
    // largest distance from a piece, as a share of the range so far.
    template <class At, class Keep>
    void refine(double a, double b, double stray, At&& at, Keep&& keep) {
        most_ = stray;
        halve(a, seen(at(a)), b, seen(at(b)), kMostCurveHalvings, at, keep);
    }

  private:
    template <class At, class Keep>
    void halve(double a, Vec2 from, double b, Vec2 to, int halvings, At& at, Keep& keep) {
        const double middle = 0.5 * (a + b);
        if (halvings == 0 || added_ >= kMostCurveRows || !(middle > a && middle < b)) return;
        const Vec2 aside = seen(at(a + kBesideMiddle * (b - a))), centre = seen(at(middle));
        if (std::max({from.x, centre.x, to.x}) < drawn_.first || std::min({from.x, centre.x, to.x}) > drawn_.second)
            return;
        // Where the curve has no value the distance is NaN and nothing is refined.
        if (!(std::max(stray(centre, from, to), stray(aside, from, to)) > most_)) return;
        halve(a, from, middle, centre, halvings - 1, at, keep);
        ++added_;
        keep(middle);
        halve(middle, centre, b, to, halvings - 1, at, keep);
    }

    Vec2 seen(Vec2 p) {
        low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
        high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
        return p;
    }

    // Distance of p from the piece, each direction by its range.
    double stray(Vec2 p, Vec2 from, Vec2 to) const {
        const auto end = [](double drawn, double seen) { return std::isfinite(drawn) ? drawn : seen; };
        const Vec2 range{end(drawn_.second, high_.x) - end(drawn_.first, low_.x), high_.y - low_.y};
        const auto scaled = [&](Vec2 v) {
            return Vec2{range.x > 0 ? v.x / range.x : 0, range.y > 0 ? v.y / range.y : 0};
        };
        const Vec2 along = scaled(to - from), off = scaled(p - from);
        const double length = dot(along, along),
                     share = length > 0 ? std::clamp(dot(off, along) / length, 0.0, 1.0) : 0;
        return norm(off - along * share);
    }

    static constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::pair<double, double> drawn_;
    Vec2 low_{kInfinity, kInfinity}, high_{-kInfinity, -kInfinity};
    double most_ = 0;
    long added_ = 0;
};

}  // namespace beamcam::sim
