// A step of flight without its fast vibrations in the forcing. MODEL.md (S52b).
#include <algorithm>
#include <cmath>

#include "sim/integrate/nodal_step.hpp"

namespace beamcam::sim {

// Y of the forcing at the nodes.
Lanes NodalStep::second_factor() const {
    if (!form->paper) return form->gravity * sin;
    const Lanes l = form->length * cos;
    return -(segment.theta_dot * segment.theta_dot) * (form->radius * l + 0.5 * l * l);
}

// w and its rate at the start of the step.
NodalStep::Vibration NodalStep::vibration_at_start(std::size_t i, const StepTable::Row& row) const {
    const ExponentialSegment& s = segment;
    return {s.q0[i] - sum(row.steady * s.f[i]), s.v0[i] - sum(row.steady_rate * s.f[i])};
}

void NodalStep::propagate_without_fast(const StepTable& table) {
    ExponentialSegment& s = segment;
    const auto propagate = [&](std::size_t from, std::size_t count, const Lanes* base) {
        kernels_.propagate(count, table.rows.data() + from, s.f.data() + from, base, s.q.data() + from);
    };
    const std::size_t slow = std::min(n, s.left_out.first());
    propagate(0, slow, base_q_.data());
    for (std::size_t i = slow; i < n; ++i) {
        const StepTable::Row& row = table.rows[i];
        if (!s.left_out.contains(i)) {
            propagate(i, 1, &base_q_[i]);
            continue;
        }
        const Lanes base = row.qq * sum(row.steady * s.f[i]) + row.qv * sum(row.steady_rate * s.f[i]);
        propagate(i, 1, &base);
    }
}

// The squares of vibrations with the amplitude a add ½ Σ A_ii a² on average to the inertia and to the fall.
void NodalStep::weigh_fast(const StepTable& table) {
    const FastVibrations& fast = segment.left_out;
    fast_inertia_ = fast_fall_ = Lanes{};
    for (std::size_t i = fast.first(); i < n; ++i) {
        if (!fast.contains(i)) continue;
        const StepTable::Row& row = table.rows[i];
        const auto [w0, dw0] = vibration_at_start(i, row);
        const double omega = form->oscillators[i].omega;
        const Lanes w = row.qq * w0 + row.qv * dw0, u = (1 / omega) * (row.vq * w0 + row.vv * dw0);
        const Lanes square = 0.5 * (w * w + u * u);
        fast_inertia_ += square * form->spinning[i * (n + 1)];
        if (!form->second.empty()) fast_fall_ += square * form->second[i * (n + 1)];
    }
}

// At the nodes and at the end.
void NodalStep::turn_fast_back(const StepTable& table) {
    ExponentialSegment& s = segment;
    FastVibrations& fast = s.left_out;
    if (!fast.any()) return;
    const Collocation& gauss = Collocation::get();
    fast.spin = sum(gauss.b * (s.theta_dot * s.theta_dot));
    fast.second = sum(gauss.b * second_factor());
    for (std::size_t i = fast.first(); i < n; ++i) {
        if (!fast.contains(i)) continue;
        const auto& [omega, gamma] = form->oscillators[i];
        const double damped = std::sqrt((omega - gamma) * (omega + gamma)), angle = fast.lag(i) * table.h;
        const StepTable::Row& row = table.rows[i];
        const auto [w0, dw0] = vibration_at_start(i, row);
        fast_amplitude_[i] = std::hypot(w0, dw0 / omega);
        const auto turn = [&, gamma = gamma](const auto& by, const auto& w, const auto& dw, auto& q, auto& v) {
            auto sine = w, cosine = w, turned = w, rate = dw;
            sine_and_cosine(by, sine, cosine);
            turn_back(sine, cosine, damped, gamma, turned, rate);
            q += turned - w;
            v += rate - dw;
        };
        const Lanes w = row.qq * w0 + row.qv * dw0;
        fast_steady_[i] = s.q[i] - w;
        turn(angle * gauss.c, w, row.vq * w0 + row.vv * dw0, s.q[i], s.v[i]);
        turn(angle, row.end_qq * w0 + row.end_qv * dw0, row.end_vq * w0 + row.end_vv * dw0, next[1 + i],
             next[2 + n + i]);
    }
}

// The lag leaves a rest of the effect of κw on (q̇, ωq): the change of the amplitude by ¼κ/ω², of the frequency in
// second order, and of the lag within the step.
double NodalStep::fast_error(std::size_t i, double h) const {
    const double omega = form->oscillators[i].omega;
    const Lanes kappa = form->coupling(i, i, segment.theta_dot * segment.theta_dot, second_factor());
    const double most = largest(kappa), varies = largest(kappa - segment.left_out.stiffness(i));
    return fast_amplitude_[i] * (0.25 * most + 0.125 * h * (most * most / omega + varies * omega)) / omega;
}

}  // namespace beamcam::sim
