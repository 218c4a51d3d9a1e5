// The Taylor series of the rigid beam's flight, θ̈ = α − k cos θ, which is exact to rounding over its `length`, and of a
// tangent along it. MODEL.md (S83).
#pragma once

namespace beamcam::sim {

// A state and, optionally, a tangent.
struct RodState {
    double theta = 0, rate = 0;      // [rad], [rad/s]
    double d_theta = 0, d_rate = 0;  // of the tangent
    bool operator==(const RodState&) const = default;
};

class FlightSeries {
  public:
    FlightSeries(double k, double alpha) : k_(k), alpha_(alpha) {}

    // Expands the motion from a state; `tangent`: also that of the tangent.
    void expand(const RodState& from, bool tangent);
    double length() const { return length_; }  // [s]
    double theta(double dt) const { return value(a_, dt); }
    double rate(double dt) const { return slope(a_, dt); }
    RodState at(double dt) const;
    double acceleration(double theta) const;

  private:
    static constexpr int kOrder = 18;
    static double value(const double* a, double dt);  // Σ a_j dtʲ
    static double slope(const double* a, double dt);

    double k_, alpha_;
    double a_[kOrder + 1], d_[kOrder + 1];
    double length_ = 0;
    bool tangent_ = false;
};

}  // namespace beamcam::sim
