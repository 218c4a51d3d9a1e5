// The Taylor series of the rigid beam's flight, θ̈ = α − k cos θ, which is exact to rounding over its `length`.
// MODEL.md (S83).
#pragma once

namespace beamcam::sim {

inline constexpr double kAngleRounding = 2e-16;  // [rad] rounding of an angle; limit of the last terms of its series

struct RodState {
    double theta = 0, rate = 0;  // [rad], [rad/s]
    bool operator==(const RodState&) const = default;
};

class FlightSeries {
  public:
    FlightSeries(double k, double alpha) : k_(k), alpha_(alpha) {}

    // Expands the motion from a state.
    void expand(const RodState& from);
    double length() const { return length_; }  // [s]
    double theta(double dt) const;
    double rate(double dt) const;
    RodState at(double dt) const { return {theta(dt), rate(dt)}; }

  private:
    static constexpr int kOrder = 18;

    double k_, alpha_;
    double a_[kOrder + 1];  // θ = Σ a_j dtʲ
    double length_ = 0;
};

}  // namespace beamcam::sim
