// How each channel depends on the modes within one step: bounds of |∂c/∂q|, |∂c/∂q̇| and |∂c/∂q̈|, which turn the
// bounds of each mode (ModalBounds) into vibrations of the channel; and how fast the channel drifts. For the modal
// models. MODEL.md §12, (S59).
#pragma once

#include <optional>
#include <vector>

#include "sim/dynamics/system.hpp"
#include "sim/integrate/integrator.hpp"
#include "sim/observe/channels.hpp"
#include "sim/observe/variation.hpp"

namespace beamcam::sim {

class ModalChannels {
  public:
    explicit ModalChannels(System& system);  // which must outlive it

    // The part [from, to] of a step of that system in its present phase. False when the step bounds no modes.
    bool set(const Segment& segment, double from, double to);

    struct Range {
        double low, high;
    };
    // The part of the tip's deflection or its rate in the state y that is linear in the modes.
    double tip(ChannelKind kind, const double* y) const;
    // The hub's angle or rate in that state.
    double hub(ChannelKind kind, const double* y) const;
    // The same at the nodes, or q; false where the part is not the whole step, or the channel is none of these.
    bool at_nodes(Channel channel, Lanes& values) const;
    // Of a channel within that part, from its values at the ends.
    Range range(Channel channel, double first, double last) const;
    // The same from its values at the nodes, too: closer but costlier; nothing where `at_nodes` is false.
    std::optional<Range> range_by_nodes(Channel channel, double first, double last) const;
    // Of q alone, by the bounds of its mode: cheap.
    Range mode_range(Channel channel) const {
        const ModalBounds::Mode& mode = bounds_->modes[static_cast<std::size_t>(channel.index) - 1];
        return {mode.low, mode.high};
    }
    // Vibrations that a polynomial of degree 7 over that part does not resolve.
    void add_unresolved(Channel channel, Variation& out) const;

  private:
    // To one mode. `mixed`: contribution of products of modes; `shift`: frequency of the factor of q [rad/s].
    struct Sensitivity {
        double q = 0, rate = 0, acceleration = 0, mixed = 0, shift = 0;
    };
    struct Mode {  // weights that do not change
        double h, turn, tip, U, W, stiffness, inertia, weight, shape, slope, wave, omega, damping;
    };
    double swing(std::size_t i) const;
    double swinging_share(std::size_t i) const;
    template <class Add>
    void each_unresolved(Channel channel, Add&& add) const;
    double drift(ChannelKind kind) const;
    double turning(std::size_t i) const;
    double foot(const Mode& m) const;
    Sensitivity in_contact(ChannelKind kind, const Mode& m) const;
    Sensitivity of_energy(ChannelKind kind, const Mode& m, const ModalBounds::Mode& b, double turning) const;
    double strays_between_nodes(Channel channel, const Variation& polynomial) const;
    template <class Visit>
    void each_mode(Channel channel, Visit&& visit) const;
    void place_contact();
    void set_contact();
    Range contact_range(Channel channel) const;
    Range separation_range() const;
    double contact_value(ChannelKind kind, int sample) const;

    System& system_;
    struct Strays {  // of q, q̇ and products of modes from a line within the step; the last for amplitude 1
        double q, rate, mixed;
        double swing, share;  // of the vibrating mode, and of products with it
    };
    std::vector<Mode> modes_;
    std::vector<Strays> strays_;
    double reach_ = 0, length_ = 0, mass_ = 0, inertia_ = 0, lever_ = 0, gravity_ = 0;
    double friction_ = 0, cam_radius_ = 0, cam_speed_ = 0, disc_speed_ = 0;

    // Of the step.
    const ModalBounds* bounds_ = nullptr;
    const MotionBounds* motion_ = nullptr;
    const TouchSamples* touch_ = nullptr;
    double from_ = 0, to_ = 0;
    bool whole_ = false;                                   // all of the collocation step, whose hub moves freely
    double deflection_ = 0, inclination_ = 0, alpha_ = 0;  // bounds of |v|, |v′|, |α|
    double inertia_root_ = 0, weight_root_ = 0;            // of √|qᵀBq|, √|qᵀGq|
    double hub_acceleration_ = 0;                          // of |θ̈|
    double arm_ = 0;                                       // of the contact's distance from the root
    double away_ = 0;                                      // of the distance from the disc's centre to the beam
    double foot_speed_ = 0, slide_ = 0;        // of the contact along a straight beam, and along the bent one
    mutable std::optional<Range> separation_;  // both channels have the same
    double torque_ = 0, force_ = 0, force_per_depth_ = 0, force_per_rate_ = 0;
};

}  // namespace beamcam::sim
