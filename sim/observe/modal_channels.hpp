// Bounds of the channels within one step, or a part of it, and their values at its nodes. MODEL.md §12, (S59).
#pragma once

#include <optional>
#include <vector>

#include "sim/dynamics/system.hpp"
#include "sim/integrate/integrator.hpp"
#include "sim/integrate/step_polynomial.hpp"
#include "sim/observe/channel_sensitivity.hpp"
#include "sim/observe/channels.hpp"
#include "sim/observe/mode_basis.hpp"
#include "sim/observe/part_bounds.hpp"
#include "sim/observe/undamped_mode.hpp"
#include "sim/observe/variation.hpp"

namespace beamcam::sim {

// θ̈ in a step of the collocation without what stiffness and damping cause: a polynomial.
struct ForcedAcceleration {
    Lanes frame{};  // values of Θ̈ at the nodes [rad/s²]
    Lanes nodes{};  // values [rad/s²]
    StepPolynomial polynomial;
    double error = 0;  // estimate, by its last terms
};

class ModalChannels {
  public:
    ModalChannels(System& system, const ModeBasis& basis);  // which must outlive it
    ModalChannels(const ModalChannels&) = delete;
    ModalChannels& operator=(const ModalChannels&) = delete;

    void set(const PartBounds::Part& part);
    const TouchSamples* touch() const { return bounds_.part.touch; }
    double fading() const;  // the fastest, of vibration that a polynomial over the part does not resolve [1/s]
    // The highest frequency of vibration, and of the rotation of hub and cam, within the part [rad/s].
    double fastest() const;

    struct Range {
        double low, high;
    };
    // The part of the tip's deflection or its rate in the state y that is linear in the modes.
    double tip(ChannelKind kind, const double* y) const;
    // The hub's angle or rate in that state.
    double hub(ChannelKind kind, const double* y) const;
    // In steps of the collocation θ̈ in the state y follows from its modes, but for the error of the polynomial through
    // their nodal forcing. A prescribed hub follows its drive.
    bool accelerated_by_modes() const;
    double hub_acceleration(double t, const double* y) const;
    // The same at the nodes, or q, or the elastic energy, or the kinetic but for the change of inertia by bending;
    // false where the part is not the whole step, or the channel is none of these. Of the separation θ̈ times the
    // longest arm.
    bool at_nodes(Channel channel, Lanes& values) const;
    // Of a channel within that part, from its values at the ends.
    Range range(Channel channel, double first, double last) const;
    // The same from its values at the nodes, too: closer but costlier; nothing where `at_nodes` is false.
    std::optional<Range> range_by_nodes(Channel channel, double first, double last) const;
    bool is_mode(Channel channel) const { return channel.kind == ChannelKind::q && basis_.are_coordinates(); }
    // Of q alone, by the bounds of its modes: cheap.
    Range mode_range(Channel channel) const;
    // The possible part of that range; of the arc on the disc the whole disc if the mark may be in it.
    Range within(ChannelKind kind, const Range& range) const;
    // How far the channel may be from its estimate. That of the tip is its linear part; of the separation, θ̈ times the
    // longest arm; of the kinetic energy, that without the change of inertia by bending.
    double estimate_error(Channel channel) const;
    double longest_arm() const { return bounds_.arm; }  // of the contact, from the root
    // What rounding of the beam's place and of terms that cancel changes it by.
    double rounding(ChannelKind kind) const;
    // Bounds of q by the crests of the mode that it is, from its values at the ends; nothing without crests.
    std::optional<Range> crest_range(Channel channel, double first, double last) const;
    // The mode that q is, or almost is, if it is undamped and has crests.
    std::optional<UndampedMode> undamped_mode(Channel channel) const;
    // The variation of q, or of an estimate, by all its modes and, of the separation, the frame; false where its nodes
    // bound it better.
    bool vary_by_modes(Channel channel, Variation& out) const;
    // Vibrations that a polynomial of degree 7 over that part does not resolve.
    void add_unresolved(Channel channel, Variation& out) const;

  private:
    const ForcedAcceleration& forced() const;
    double drift(ChannelKind kind) const;
    double line_strays(Channel channel, double length) const;
    Range pull(ChannelKind kind) const;
    double strays_between_nodes(Channel channel, const Variation& polynomial) const;
    template <class Add>
    void each_unresolved(Channel channel, Add&& add) const;
    Range contact_range(Channel channel) const;
    Range turning_range() const;
    double contact_value(ChannelKind kind, int sample) const;

    System& system_;
    const ModeBasis& basis_;
    const std::vector<ModeBasis::Mode>& modes_ = basis_.modes;
    PartBounds bounds_;
    ChannelSensitivity sensitivity_;
    mutable std::optional<Range> turning_;  // `turning_range`, which both separations share
    mutable std::optional<ForcedAcceleration> forced_;
    double cam_speed_ = 0;
};

}  // namespace beamcam::sim
