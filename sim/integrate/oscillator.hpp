// The exact response of q̈ + 2γq̇ + ω²q = f(t), however much damped, to a forcing that is a polynomial: at one instant,
// and tabulated at the nodes of a collocation step for a forcing given by its nodal values. MODEL.md §12.
#pragma once

#include <array>
#include <vector>

#include "sim/integrate/collocation.hpp"

namespace beamcam::sim {

// Step lengths come from the ladder 2^(k/2) s, so that few tables serve a run.
inline constexpr int kLowestLevel = -80, kHighestLevel = -4;
inline constexpr int kFirstFlightLevel = -18;  // 2 ms
inline constexpr int kFirstTouchLevel = -24;   // 0.24 ms
inline constexpr double kRestLevel = 1.01;     // steps: a rest of the interval that is no longer is one step
// A level is a factor √2 in length: below these errors, in units of the tolerance, the next step of flight is one level
// longer, or two.
inline constexpr double kLongerFlight = 0.5 / 16, kMuchLongerFlight = 1e-5;

struct Oscillator {
    double omega = 0;  // ω [rad/s], >= 0
    double gamma = 0;  // γ [1/s], >= 0
};

bool hardly_damped(const Oscillator& oscillator);  // ζ <= kMostDampingOfProjected
// c_j of the polynomial motion Σ c_j f⁽ʲ⁾ that follows a polynomial forcing without vibration [s^{2+j}].
std::array<double, kNodes> following(const Oscillator& oscillator);

// Well beyond critical damping q is the sum of two decays, ẋ = −rx ± f/(fast − slow), separated by
// x_slow = (q̇ + fast q)/(fast − slow), x_fast = −(q̇ + slow q)/(fast − slow).                              (S52a)
struct Decays {
    double slow = 0, fast = 0;  // [1/s]
    double apart() const { return fast - slow; }
};
bool decays(const Oscillator& oscillator);       // rather than vibrates
Decays decays_of(const Oscillator& oscillator);  // of one that does

// r[0] = ṡ, r[1] = s, r[2+j] = ∫₀^τ s(τ−u) uʲ/j! du for j = 0…7, where s is the response to a unit impulse (S52).
inline constexpr int kResponse = 2 + kNodes;
void respond(const Oscillator& oscillator, double tau, double* r);

// A polynomial forcing by its nodal values f: row j makes its j-th derivative at a point of a step of length h.
using Derivatives = std::array<Lanes, kNodes>;
Derivatives derivatives_at(std::size_t point, double h);

// The motion from a point of a step to an instant τ later: q ← qq q + qv v + sum(forced_q f), v ← vq q + vv v +
// sum(forced_v f).
struct Propagation {
    double qq, qv, vq, vv;
    Lanes forced_q, forced_v;
};
Propagation propagate(const Oscillator& oscillator, const Derivatives& at_start, double tau);

// The effect of a step of length h on the oscillators: rows for the eight nodes, and for the end.
struct StepTable {
    struct Row {  // of one oscillator: q ← qq q₀ + qv v₀ + Σ f_l q[l],  v ← vq q₀ + vv v₀ + Σ f_l v[l]
        Lanes qq, qv, vq, vv;
        std::array<Lanes, kNodes> q, v;
        Lanes end_q, end_v;  // over l
        double end_qq, end_qv, end_vq, end_vv;
        // Oscillators that turn by more than kAliasedRadians: q and v at the start, over l, of the polynomial motion
        // that follows the forcing without vibration.                                                        (S52c)
        Lanes steady, steady_rate;
    };
    double h = 0;
    std::vector<Row> rows;
    void build(const std::vector<Oscillator>& oscillators, double length);
    // The step of `table`; but where vibrations are not resolved by the nodes, q and v at the nodes are those of the
    // nearest polynomial of degree seven, by least squares.                                                  (S52c)
    void build_projected(const std::vector<Oscillator>& oscillators, const StepTable& table);

  private:
    using Points = std::array<Derivatives, kNodes + 1>;  // at the start of the step and at its nodes
    Points points() const;
    void build_row(const Oscillator& oscillator, const Points& derive, Row& row) const;
    void project_row(const Oscillator& oscillator, const Points& derive, Row& row) const;
};

double step_length(int level);  // [s] on the ladder of step lengths, two levels an octave
// The level of the next attempt after one of length h at this level, or shorter, whose error > 1 is that of a method of
// this order; `most` levels lower if the error is not finite. It may be below the lowest.
int lower_level(int level, double h, double error, int order, int most);
// The level after a step whose error is that of the tolerance or less: one higher for errors below `longer`, or two.
int higher_level(int level, double error, double longer, double much_longer);

// The step tables of the ladder, each built when it is first used, and one of any other length.
class StepTables {
  public:
    // The oscillators must outlive this.
    explicit StepTables(const std::vector<Oscillator>& oscillators);
    StepTable& level(int k);
    StepTable& length(double h);
    bool on_ladder(const StepTable& table) const { return &table != &other_; }

  private:
    const std::vector<Oscillator>& oscillators_;
    std::vector<StepTable> ladder_;
    StepTable other_;
};

}  // namespace beamcam::sim
