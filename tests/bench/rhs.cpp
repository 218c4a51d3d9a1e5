// Nanoseconds of one right-hand side, in flight and in contact, for every model at 2, 8 and 20 modes.
// Prints CSV: model,modes,phase,ns (median of repeated batches).
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "sim/dynamics/initial.hpp"
#include "sim/dynamics/system.hpp"

using namespace beamcam::sim;

namespace {

double median_nanoseconds(System& system, const std::vector<double>& y) {
    std::vector<double> dy(y.size()), batches;
    long calls = 16;
    for (int batch = 0; batch < 15; ++batch) {
        const auto start = std::chrono::steady_clock::now();
        for (long i = 0; i < calls; ++i) system.rhs(0.1, y.data(), dy.data());
        const double ns = std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
        batches.push_back(ns / static_cast<double>(calls));
        if (ns < 2e6) calls *= 4;  // batches of some milliseconds
    }
    std::nth_element(batches.begin() + 4, batches.begin() + 9, batches.end());
    return batches[9];
}

}  // namespace

int main() {
    fmt::print("model,modes,phase,ns\n");
    for (const ModelKind kind : {ModelKind::rigid, ModelKind::first_order, ModelKind::second_order, ModelKind::exact}) {
        for (const int modes : {2, 8, 20}) {
            if (kind == ModelKind::rigid && modes > 2) continue;
            Problem problem;
            problem.beam.model = kind;
            problem.beam.modes = modes;
            problem.initial.shape = InitialShape::resting;
            System system(problem);
            const InitialState state = initial_state(problem);
            for (const bool touching : {false, true}) {
                Phase phase = state.phase;
                phase.touching = touching;
                system.set_phase(phase);
                fmt::print("{},{},{},{:.0f}\n", name(kind), kind == ModelKind::rigid ? 0 : modes,
                           touching ? "contact" : "flight", median_nanoseconds(system, state.y));
            }
        }
    }
}
