// Vibration that turns by many radians in a step of flight. The nodes sample it so rarely that its alias would be the
// largest error of the forcing. In the forcing these modes therefore have the deflection that follows their own forcing
// steadily, without the vibration w about it. What is left out of their forcing, κw, changes the frequency of w from ω
// to ω − κ/(2ω): after the step w is turned back by this lag. MODEL.md (S52b).
#pragma once

#include <cstddef>
#include <limits>

#include "sim/integrate/modal_form.hpp"

namespace beamcam::sim {

class FastVibrations {
  public:
    // No mode: in contact the force follows every vibration.
    FastVibrations() = default;
    // The fast modes of a step of length h. The form must outlive this object.
    FastVibrations(const ModalForm& form, double h);

    bool any() const { return first_ != kNone; }
    std::size_t first() const { return first_; }  // `kNone` if there is none
    bool contains(std::size_t mode) const { return mode >= first_ && hardly_damped(form_->oscillators[mode]); }
    double lag(std::size_t mode) const;        // of the vibration, in the mean of the step [rad/s]
    double stiffness(std::size_t mode) const;  // κ, in the mean of the step [1/s²]
    static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

    double spin = 0, second = 0;  // means of Θ̇² and Y in the step: f = Θ̇² (B/m) q + Y (G/m) q + …

  private:
    const ModalForm* form_ = nullptr;
    std::size_t first_ = kNone;
};

// Turns a vibration w with the rate dw and this damped frequency back by an angle.
template <class T, class U>
void turn_back(const T& sine, const T& cosine, const U& damped_omega, const U& gamma, T& w, T& dw) {
    const T u = (dw + gamma * w) / damped_omega, turned = cosine * w - sine * u;
    dw = damped_omega * (cosine * u + sine * w) - gamma * turned;
    w = turned;
}

}  // namespace beamcam::sim
