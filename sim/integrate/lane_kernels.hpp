// The inner loops of the exponential collocation, compiled for several vector instruction sets and chosen when the
// program runs. Every version does the same operations in the same order on each lane (no fused multiply-add), so
// results have the same bits on every machine.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/integrate/oscillator.hpp"

namespace beamcam::sim {

struct LaneKernels {
    // y_r = Σ_c a[r·columns + c] x_c
    void (*multiply)(std::size_t rows, std::size_t columns, const double* a, const Lanes* x, Lanes* y);
    // q_i = base_i + Σ_l f_i[l] row_i.q[l], or the same with row_i.v for rates.
    void (*propagate)(std::size_t count, const StepTable::Row* rows, const Lanes* f, const Lanes* base, Lanes* out);
    void (*propagate_rates)(std::size_t count, const StepTable::Row* rows, const Lanes* f, const Lanes* base,
                            Lanes* out);
    // `respond` of a group (oscillator.hpp) below critical damping, for ωτ < kMostRadians; decay = exp(−γτ).
    void (*respond)(const OscillatorLanes& group, double tau, const Lanes& decay, Lanes* r);
    // out[j] = Σ_l factor[j][l] x[l], j and l from 0 to 7.
    void (*combine)(const Lanes* factors, const Lanes* x, Lanes* out);
    // q, q̇ of a group from its values (a, b) some time ago, its responses since and the derivatives of its forcing
    // then.
    void (*evolve)(const OscillatorLanes& group, const Lanes* r, const Lanes* derivatives, const Lanes& a,
                   const Lanes& b, Lanes& q, Lanes& v);
    const char* name;
};
inline constexpr double kMostRadians = 1e5;

// The fastest kernels that this machine can run; and all that it can run.
const LaneKernels& lane_kernels();
std::vector<LaneKernels> runnable_lane_kernels();

}  // namespace beamcam::sim
