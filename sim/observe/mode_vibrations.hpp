// Bounds of the modes within a part of a step, eight side by side, and how far they stray from a straight line there.
// MODEL.md §12, (S59).
#pragma once

#include <vector>

#include "sim/integrate/integrator.hpp"

namespace beamcam::sim {

// Lanes beyond the last mode are zero.
struct ModeVibrations {
    Lanes amplitude{}, rate{}, acceleration{};                        // of |q|, |q̇|, |q̈|
    Lanes q_frequency{}, rate_frequency{}, acceleration_frequency{};  // as in ModalBounds
    struct Free {                                                     // a vibration that the nodes do not resolve
        Lanes value{}, rate{}, second{}, frequency{};
        Lanes share{}, share_with_rates{};  // of the amplitudes of products of modes, and of those with rates
    };
    Free free[ModalBounds::Mode::kSwings];
    int free_count = 0;
};

// Of the part of a step that begins `elapsed` after its start.
void set_vibrations(const ModalBounds& bounds, double elapsed, std::vector<ModeVibrations>& groups);

// Largest distance of a vibration of amplitude 1 from a straight line while it turns by these radians.
BEAMCAM_INLINE Lanes strays(const Lanes& radians) { return smaller(Lanes{} + 2.0, radians * radians * 0.125); }

// `value` where x exceeds the least, else 0.
BEAMCAM_INLINE Lanes where_above(const Lanes& x, double least, Lanes value) {
    for (int i = 0; i < Lanes::kParts; ++i) value.part[i] = x.part[i] > least ? value.part[i] : Lanes::Part{};
    return value;
}

}  // namespace beamcam::sim
