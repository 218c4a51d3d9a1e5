#include "sim/observe/variation.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/assert.hpp"
#include "sim/integrate/collocation.hpp"

namespace beamcam::sim {

void Variation::add(double amplitude, double frequency) {
    if (!(amplitude > 0)) return;
    BEAMCAM_ASSERT(count_ < kMost);
    vibrations_[count_++] = {amplitude, frequency};
}

namespace {

// Constants of the Legendre polynomials on [0, 1], computed once: |P_j| ≤ 1 and |P_j″| ≤ (j − 1)j(j + 1)(j + 2)/2.
struct Polynomials {
    Lanes coefficients[kNodes];  // [l][j]: what a value at node l contributes to the coefficient of P_j
    double frequency[kNodes];
    Lanes at_start;  // ℓ_l at 0, which is ℓ_{7−l} at 1
    Polynomials() {
        const Collocation& gauss = Collocation::get();
        at_start = gauss.derive[0][0];
        for (int j = 0; j < kNodes; ++j) {
            for (int l = 0; l < kNodes; ++l) coefficients[l][j] = gauss.legendre[static_cast<std::size_t>(j)][l];
            frequency[j] = j < 2 ? 0 : std::sqrt(0.5 * (j - 1) * j * (j + 1) * (j + 2));
        }
    }
};

const Polynomials& polynomials() {
    static const Polynomials constants;
    return constants;
}

}  // namespace

void Variation::add_polynomial(const Lanes& nodes, double h) {
    const Polynomials& constants = polynomials();
    Lanes amplitudes{};
    for (int l = 0; l < kNodes; ++l) amplitudes += nodes[l] * constants.coefficients[l];
    for (int j = 2; j < kNodes; ++j) add(std::fabs(amplitudes[j]), constants.frequency[j] / h);
}

void Variation::add_missed(const Lanes& nodes, double first, double last, double h) {
    const Lanes& at_start = polynomials().at_start;
    double start = 0, end = 0;
    for (int k = 0; k < kNodes; ++k) {
        start += at_start[k] * nodes[k];
        end += at_start[k] * nodes[kNodes - 1 - k];
    }
    add(2 * std::max(std::fabs(start - first), std::fabs(end - last)), kNodes * (kNodes + 1) / h);
}

double Variation::strays(double length) const {
    double total = 0;
    for (const auto& [amplitude, frequency] : vibrations()) {
        const double radians = frequency * length;
        total += amplitude * std::min(2.0, radians * radians / 8);
    }
    return total;
}

double Variation::slope_strays(double length) const {
    double total = 0;
    for (const auto& [amplitude, frequency] : vibrations())
        total += amplitude * frequency * std::min(2.0, frequency * length / 2);
    return total;
}

// Slow parts add at most the parabola ½cu(ℓ − u), c the sum of their second derivatives, u the distance from the higher
// end, from which the line falls by s u: (½cℓ − s)²/(2c) at its crest. Fast parts add 2a.
double Variation::rises(double length, double difference) const {
    double fast = 0, slow = 0, second = 0;
    for (const auto& [amplitude, frequency] : vibrations()) {
        const double radians = frequency * length;
        if (radians < 4) {
            slow += amplitude * radians * radians / 8;
            second += amplitude * frequency * frequency;
        } else {
            fast += 2 * amplitude;
        }
    }
    const double over = 0.5 * second * length - std::fabs(difference) / length;
    return fast + (over > 0 ? std::min(slow, over * over / (2 * second)) : 0);
}

// |f‴| (ℓ/2)³/(9√3)
double Variation::parabola_error(double length) const {
    double total = 0;
    for (const auto& [amplitude, frequency] : vibrations()) {
        const double radians = frequency * length;
        total += amplitude * std::min(2.0, radians * radians * radians / 124);
    }
    return total;
}

double Variation::unresolved(double length) const {
    double total = 0;
    for (const auto& [amplitude, frequency] : vibrations())
        if (frequency * length > 1) total += 2 * amplitude;
    return total;
}

}  // namespace beamcam::sim
