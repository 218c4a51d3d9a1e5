// The outline of the cam as its support function. MODEL.md (S102).
//
// In the cam's own frame, whose origin is the axis C and which turns with ψ, h(α) is the distance from C to the tangent
// whose outward normal is n(α) = (cos α, sin α). The point of the outline with that normal is p = h n + h′ t with
// t = (−sin α, cos α), and ρ = h + h″ > 0 is the radius of curvature there. The eccentric disc has h = R + e cos α.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

// The outline where its outward normal has one angle.
struct CamPoint {
    double h = 0, slope = 0, radius = 0;  // h, h′ = dh/dα, ρ [m]
    Vec2 position(double alpha) const { return h * unit(alpha) + slope * perp(unit(alpha)); }  // p [m], cam's frame
    // The centre of curvature p − ρn is (h − ρ) n + h′ t = −h″ n + h′ t.
};

class CamShape {
  public:
    // The shape of the problem's cam, whose profile `validate` has accepted.
    explicit CamShape(const Problem& problem);

    bool is_disc() const { return pieces_.empty(); }
    CamPoint at(double alpha) const;          // any α [rad]; accurate to about 1e-15 of the size
    double radius_slope(double alpha) const;  // dρ/dα [m]; accurate to about 1e-12 of the size
    // Length of the outline from the normal 0 to the normal α in [0, 2π], counter-clockwise [m].
    double arc(double alpha) const;
    // The angles in [0, 2π) where ρ or its derivative jumps, increasing; but not the knots of a profile of points.
    std::span<const double> kinks() const { return kinks_; }
    // Intervals of a turn, over each of which the outline is smooth: their ends, from 0 to 2π, increasing.
    std::vector<double> intervals() const;

    double least_radius() const { return least_radius_; }      // of ρ [m]
    double largest_radius() const { return largest_radius_; }  // of ρ [m]
    double least_height() const { return least_height_; }      // of h [m], > 0: the base circle about C
    double inner_radius() const { return is_disc() ? disc_radius_ : least_height_; }  // of a disc within the cam [m]
    double largest_reach() const { return largest_reach_; }                           // of |p| [m]
    double largest_slope() const { return largest_slope_; }                           // of |h′| [m]; of the disc e
    double largest_arm() const { return largest_arm_; }  // of |p − ρn| [m]; of the disc e

  private:
    static constexpr int kDegree = 9;
    using Coefficients = std::array<double, kDegree + 1>;
    struct Piece {
        double from = 0, arc = 0;       // α and length of the outline at its start
        double middle = 0, scale = 0;   // z = (α − middle) scale, in [−1, 1]
        Coefficients h, slope, radius;  // of zᵏ
        CamPoint at(double alpha) const;
        double radius_slope(double alpha) const;
        double arc_at(double alpha) const;  // the outline's length up to there [m]
    };
    struct Fit;
    const Piece& piece(double alpha) const;  // α in [0, 2π)
    void find_kinks(const std::vector<double>& ends, double size);
    void find_extremes();

    double disc_radius_ = 0, eccentricity_ = 0;
    std::vector<Piece> pieces_;     // increasing, the first from 0
    std::vector<int> first_piece_;  // the piece at the start of each of as many equal intervals of the turn
    std::vector<double> kinks_;
    double least_radius_ = 0, largest_radius_ = 0, least_height_ = 0, largest_reach_ = 0, largest_slope_ = 0,
           largest_arm_ = 0;
};

// The shape of the problem's cam, or of the default one without a cam. A film, an orbit or a sweep asks for the same
// one thousands of times, and a profile takes about a millisecond: the last ones are kept.
std::shared_ptr<const CamShape> cam_shape(const Problem& problem);

}  // namespace beamcam::sim
