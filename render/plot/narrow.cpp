#include "render/plot/narrow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "render/plot/reduce.hpp"

namespace beamcam::render {
namespace {

constexpr double kWindow = 1.0 / 3;  // of the period of dashes: two to three widths of the line
constexpr double kLonger = 3;        // length of a curve in the window, in periods and in distances of its ends
constexpr Vec2 kInterruption{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};

}  // namespace

DashedCurve without_dashes_in_spikes(const std::vector<Vec2>& points, double period) {
    if (points.size() < 3 || !increasing(points)) return {points, {}};
    std::vector<double> length{0}, x;  // along the curve up to each point; gaps have no length
    for (std::size_t i = 0; i < points.size(); ++i) {
        const bool joined = i > 0 && !broken(points[i]) && !broken(points[i - 1]);
        if (i > 0) length.push_back(length.back() + (joined ? norm(points[i] - points[i - 1]) : 0));
        x.push_back(!broken(points[i]) ? points[i].x : (x.empty() ? -1e300 : x.back()));
    }
    DashedCurve out;
    const std::vector<Vec2>* open = nullptr;  // holds the last piece
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        if (broken(points[i]) || broken(points[i + 1])) {
            open = nullptr;
            continue;
        }
        const double middle = (x[i] + x[i + 1]) / 2;
        const auto first = std::ranges::lower_bound(x, middle - kWindow * period / 2) - x.begin(),
                   last = std::ranges::upper_bound(x, middle + kWindow * period / 2) - x.begin() - 1;
        const std::size_t from = std::min(static_cast<std::size_t>(first), i),
                          to = std::max(static_cast<std::size_t>(last), i + 1);
        const double apart = !broken(points[from]) && !broken(points[to]) ? norm(points[to] - points[from]) : 0;
        const bool narrow = length[to] - length[from] > kLonger * std::max(period, apart);
        std::vector<Vec2>& piece = narrow ? out.solid : out.dashed;
        if (open != &piece) {
            if (!piece.empty()) piece.push_back(kInterruption);
            piece.push_back(points[i]);
        }
        piece.push_back(points[i + 1]);
        open = &piece;
    }
    return out;
}

void stroke_curve(Painter& on, const std::vector<Vec2>& points, Pen pen) {
    if (pen.dash.empty()) return on.curve(points, pen);
    const DashedCurve pieces = without_dashes_in_spikes(points, std::accumulate(pen.dash.begin(), pen.dash.end(), 0.0));
    on.curve(pieces.dashed, pen);
    if (pieces.solid.empty()) return;
    pen.dash.clear();
    on.curve(pieces.solid, pen);
}

}  // namespace beamcam::render
