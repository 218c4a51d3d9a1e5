// A stretch of the rigid beam's flight, θ̈ = α − k cos θ, as its Taylor series: exact to rounding over `length`, known
// everywhere inside. Also the motion of a small difference beside it. MODEL.md §18, (S83).
#pragma once

namespace beamcam::sim {

// A state and, if it is followed, a small difference of it.
struct Swing {
    double theta = 0, rate = 0;      // [rad], [rad/s]
    double d_theta = 0, d_rate = 0;  // of the difference
    bool operator==(const Swing&) const = default;
};

class SwingSeries {
  public:
    SwingSeries(double k, double alpha) : k_(k), alpha_(alpha) {}

    // From the state on; `difference`: it is followed, too.
    void expand(const Swing& from, bool difference);
    double length() const { return length_; }  // [s] for which the series holds
    double theta(double dt) const;
    double rate(double dt) const;
    Swing at(double dt) const;
    double acceleration(double theta) const;

  private:
    static constexpr int kOrder = 18;

    double k_, alpha_;
    double a_[kOrder + 1], d_[kOrder + 1];
    double length_ = 0;
    bool difference_ = false;
};

}  // namespace beamcam::sim
