#include "sim/observe/variation.hpp"

#include <algorithm>
#include <cmath>

#include "sim/integrate/collocation.hpp"

namespace beamcam::sim {

void Variation::add(double amplitude, double frequency) {
    if (amplitude > 0) vibrations_.push_back({amplitude, frequency});
}

// |P_j| ≤ 1 and |P_j″| ≤ (j − 1)j(j + 1)(j + 2)/8 on [−1, 1].
void Variation::add_polynomial(const Lanes& nodes, double h) {
    for (int j = 2; j < kNodes; ++j) {
        const double bend = 0.5 * (j - 1) * j * (j + 1) * (j + 2);
        add(std::fabs(sum(Collocation::get().legendre[static_cast<std::size_t>(j)] * nodes)), std::sqrt(bend) / h);
    }
}

double Variation::strays(double length) const {
    double total = 0;
    for (const auto& [amplitude, frequency] : vibrations_) {
        const double radians = frequency * length;
        total += amplitude * std::min(2.0, radians * radians / 8);
    }
    return total;
}

double Variation::slope_strays(double length) const {
    double total = 0;
    for (const auto& [amplitude, frequency] : vibrations_)
        total += amplitude * frequency * std::min(2.0, frequency * length / 2);
    return total;
}

// Slow parts add at most the parabola ½cu(ℓ − u), c the sum of their second derivatives, u the distance from the higher
// end, from which the line falls by s u: (½cℓ − s)²/(2c) at its crest. Fast parts add 2a.
double Variation::rises(double length, double difference) const {
    double fast = 0, slow = 0, second = 0;
    for (const auto& [amplitude, frequency] : vibrations_) {
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
    for (const auto& [amplitude, frequency] : vibrations_) {
        const double radians = frequency * length;
        total += amplitude * std::min(2.0, radians * radians * radians / 124);
    }
    return total;
}

double Variation::unresolved(double length) const {
    double total = 0;
    for (const auto& [amplitude, frequency] : vibrations_)
        if (frequency * length > 1) total += 2 * amplitude;
    return total;
}

}  // namespace beamcam::sim
