// An outline of tangent arcs. MODEL.md (S104).
#include <Eigen/Core>
#include <cmath>

#include "sim/base/linear_algebra.hpp"
#include "sim/cam/profile_spans.hpp"

namespace beamcam::sim {

// n of cᵢ − cᵢ₊₁ = (Rᵢ₊₁ − Rᵢ) n.
double joint_angle(const Arc& arc, const Arc& next) {
    const Vec2 towards = next.radius > arc.radius ? arc.centre - next.centre : next.centre - arc.centre;
    return std::atan2(towards.y, towards.x);
}

// Newton's method for |cᵢ₊₁ − cᵢ| = |Rᵢ₊₁ − Rᵢ|, each step the shortest one that solves the linear equations. The
// errors of a drawing's digits vanish to rounding in three steps.
std::vector<Arc> closed_arcs(const ArcsProfile& profile) {
    constexpr int kSteps = 3;
    std::vector<Arc> arcs = profile.arcs;
    const auto n = static_cast<Eigen::Index>(arcs.size());
    if (n < 3) return arcs;
    for (int step = 0; step < kSteps; ++step) {
        Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(n, 3 * n);
        Eigen::VectorXd errors(n);
        for (Eigen::Index i = 0; i < n; ++i) {
            const Eigen::Index k = (i + 1) % n;
            const Arc &arc = arcs[static_cast<std::size_t>(i)], &next = arcs[static_cast<std::size_t>(k)];
            const Vec2 apart = next.centre - arc.centre, along = (1 / norm(apart)) * apart;
            const double sign = next.radius > arc.radius ? 1 : -1;
            errors[i] = norm(apart) - sign * (next.radius - arc.radius);
            for (const auto& [of, factor] : {std::pair{i, -1.0}, std::pair{k, 1.0}}) {
                rows(i, 3 * of) += factor * along.x;
                rows(i, 3 * of + 1) += factor * along.y;
                rows(i, 3 * of + 2) -= factor * sign;
            }
        }
        const Eigen::VectorXd change = rows.transpose() * solve(rows * rows.transpose(), errors);
        if (!change.allFinite()) return arcs;
        for (Eigen::Index i = 0; i < n; ++i) {
            Arc& arc = arcs[static_cast<std::size_t>(i)];
            arc.centre = arc.centre - Vec2{change[3 * i], change[3 * i + 1]};
            arc.radius -= change[3 * i + 2];
        }
    }
    return arcs;
}

std::vector<ProfileSpan> spans_of(const ArcsProfile& profile) {
    const std::vector<Arc> arcs = closed_arcs(profile);
    std::vector<ProfileSpan> spans;
    double from = arcs.size() < 2 ? 0 : joint_angle(arcs.back(), arcs.front());
    for (std::size_t i = 0; i < arcs.size(); ++i) {
        const Arc arc = arcs[i];
        double to = from + kFullTurn;
        if (arcs.size() > 1) {
            to = joint_angle(arc, arcs[(i + 1) % arcs.size()]);
            to += kFullTurn * std::ceil((from - to) / kFullTurn);
        }
        spans.push_back({from, to, [arc](double alpha) {
                             const Vec2 n = unit(alpha);
                             return CamPoint{dot(arc.centre, n) + arc.radius, dot(arc.centre, perp(n)), arc.radius};
                         }});
        from = to;
    }
    return spans;
}

}  // namespace beamcam::sim
