// How each channel depends on the modes within one step: bounds of |∂c/∂q|, |∂c/∂q̇| and |∂c/∂q̈|, which turn the
// bounds of each mode (ModalBounds) into vibrations of the channel; and how fast the channel drifts. MODEL.md §12,
// (S59).
#pragma once

#include <optional>
#include <vector>

#include "sim/dynamics/system.hpp"
#include "sim/integrate/integrator.hpp"
#include "sim/observe/channels.hpp"
#include "sim/observe/mode_basis.hpp"
#include "sim/observe/variation.hpp"

namespace beamcam::sim {

class ModalChannels {
  public:
    ModalChannels(System& system, const ModeBasis& basis);  // which must outlive it

    // What bounds the part [from, to] of a step; they live while it is observed.
    struct Step {
        double from, to;
        double elapsed;  // since the start of the step [s]
        bool whole;      // all of it: the nodes of `modes` are those of the part
        const ModalBounds* modes;
        const MotionBounds* motion;
        const TouchSamples* touch;  // null in flight
    };
    void set(const Step& step);
    const TouchSamples* touch() const { return touch_; }
    double fading() const;  // the fastest, of vibration that a polynomial over the part does not resolve [1/s]

    struct Range {
        double low, high;
    };
    // The part of the tip's deflection or its rate in the state y that is linear in the modes.
    double tip(ChannelKind kind, const double* y) const;
    // The hub's angle or rate in that state.
    double hub(ChannelKind kind, const double* y) const;
    // The same at the nodes, or q; false where the part is not the whole step, or the channel is none of these.
    bool at_nodes(Channel channel, Lanes& values) const;
    // The values of a channel at the nodes that need no evaluation, if there are any.
    bool known_at_nodes(Channel channel, Lanes& values) const;
    // Of a channel within that part, from its values at the ends.
    Range range(Channel channel, double first, double last) const;
    // The same from its values at the nodes, too: closer but costlier; nothing where `at_nodes` is false.
    std::optional<Range> range_by_nodes(Channel channel, double first, double last) const;
    // Of q alone, by the bounds of its mode if it is one: cheap.
    Range mode_range(Channel channel) const;
    // Vibrations that a polynomial of degree 7 over that part does not resolve.
    void add_unresolved(Channel channel, Variation& out) const;

  private:
    // To one mode. `mixed`: contribution of products of modes; `shift`: frequency of the factor of q [rad/s].
    struct Sensitivity {
        double q = 0, rate = 0, acceleration = 0, mixed = 0, shift = 0;
    };
    using Mode = ModeBasis::Mode;
    void set_strays(std::size_t i);
    template <class Add>
    void each_unresolved(Channel channel, Add&& add) const;
    double drift(ChannelKind kind) const;
    double turning(std::size_t i) const;
    double foot(const Mode& m) const;
    Sensitivity in_contact(ChannelKind kind, const Mode& m) const;
    Sensitivity of_energy(ChannelKind kind, const Mode& m, const ModalBounds::Mode& b, double turning) const;
    double far_tip(const Mode& m) const;
    double far_kinetic(const Mode& m, const ModalBounds::Mode& b) const;
    double strays_between_nodes(Channel channel, const Variation& polynomial) const;
    template <class Visit>
    void each_mode(Channel channel, Visit&& visit) const;
    void sum_modes();
    void place_contact();
    void set_contact();
    Range contact_range(Channel channel) const;
    Range separation_range() const;
    double contact_value(ChannelKind kind, int sample) const;

    System& system_;
    const ModeBasis& basis_;
    struct Vibration {  // which the nodes do not resolve: of the mode, and its share of products with it
        double value, rate, second, frequency, share;
    };
    struct Strays {  // of q, q̇ and products of modes from a line within the step; the last for amplitude 1
        double q, rate, mixed;
        Vibration vibrations[ModalBounds::Mode::kSwings];
    };
    const std::vector<Mode>& modes_ = basis_.modes;
    std::vector<Strays> strays_;
    const double reach_ = basis_.reach, length_ = basis_.length, mass_ = basis_.mass, inertia_ = basis_.J;
    double gravity_ = 0, friction_ = 0, cam_radius_ = 0, cam_speed_ = 0, disc_speed_ = 0;

    // Of the step.
    const ModalBounds* bounds_ = nullptr;
    const MotionBounds* motion_ = nullptr;
    const TouchSamples* touch_ = nullptr;
    double from_ = 0, to_ = 0, elapsed_ = 0;
    bool whole_ = false;
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
