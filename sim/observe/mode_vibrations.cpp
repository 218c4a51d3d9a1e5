#include "sim/observe/mode_vibrations.hpp"

#include <algorithm>

#include "sim/observe/constants.hpp"

namespace beamcam::sim {
namespace {

void pack_mode(const ModalBounds::Mode& mode, double elapsed, int lane, ModeVibrations& group) {
    group.amplitude[lane] = mode.amplitude;
    group.rate[lane] = mode.rate;
    group.acceleration[lane] = mode.acceleration;
    group.q_frequency[lane] = mode.q_frequency;
    group.rate_frequency[lane] = mode.rate_frequency;
    group.acceleration_frequency[lane] = mode.acceleration_frequency;
    for (int k = 0; k < ModalBounds::Mode::kSwings; ++k) {
        const ModalBounds::Mode::Swing& swing = mode.swings[k];
        const double left = swing.left(elapsed);
        ModeVibrations::Free& free = group.free[k];
        free.value[lane] = left * swing.value;
        free.rate[lane] = left * swing.rate;
        free.second[lane] = left * swing.second;
        free.frequency[lane] = swing.frequency;
        if (swing.value > 0) group.free_count = std::max(group.free_count, k + 1);
    }
}

}  // namespace

void set_vibrations(const ModalBounds& bounds, double elapsed, std::vector<ModeVibrations>& groups) {
    for (std::size_t i = 0; i < bounds.modes.size(); ++i) {
        const int lane = static_cast<int>(i % kNodes);
        if (lane == 0) groups[i / kNodes].free_count = 0;
        pack_mode(bounds.modes[i], elapsed, lane, groups[i / kNodes]);
    }
    for (ModeVibrations& group : groups) {
        for (int k = 0; k < group.free_count; ++k) {
            ModeVibrations::Free& free = group.free[k];
            const Lanes of_values = free.value / group.amplitude, of_rates = free.rate / group.rate;
            free.share = smaller(Lanes{} + 1.0, kProductSwing * of_values);
            free.share_with_rates = smaller(Lanes{} + 1.0, kProductSwing * larger(of_values, of_rates));
        }
    }
}

}  // namespace beamcam::sim
