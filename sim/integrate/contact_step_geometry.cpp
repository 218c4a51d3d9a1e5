// The geometry of the contact in a step: at its start, its nodes and its end.
#include <algorithm>
#include <cmath>

#include "sim/integrate/contact_step.hpp"

namespace beamcam::sim {

void ContactStep::evaluate(double t, const double* state, ContactKinematics<double>& touch) {
    const Frame<double> frame = frame_of(step_.system.cam(), t, state[0], state[1 + step_.n]);
    expansion_.evaluate(state + 1, state + 2 + step_.n, frame, gap_offset_, hq_end_.data(), touch, kFootCorrections);
}

void ContactStep::begin() {
    held_start_ = held_end_;
    const ExponentialSegment& s = step_.segment;
    const double before = expansion_.at();
    evaluate(s.t0, s.end.data(), start);
    expansion_.centre_near(before + start.dx);
    if (expansion_.at() != before) {
        start.dx += before - expansion_.at();
        evaluate(s.t0, s.end.data(), start);
    }
    place_at_start();
    double along_n[kMaxSize] = {start.hub}, along_t[kMaxSize] = {start.hub_t};
    for (std::size_t i = 0; i < step_.n; ++i)
        expansion_.rows(start, hq_end_.data(), i, load.rough, along_n[1 + i], along_t[1 + i]);
    const auto to_modes = [&](const double* coordinates, std::vector<double>& rows) {
        if (form_.by_arrays())
            std::copy_n(coordinates + 1, step_.n, rows.begin());
        else
            product(step_.n, step_.n + 1, form_.mode_rows.data(), coordinates, rows.data());
    };
    to_modes(along_n, row);
    if (load.rough) to_modes(along_t, row_t_);
}

void ContactStep::place_at_start() {
    load.contact = {};
    load.contact.dx = Lanes{} + start.dx;
}

// The contact at the nodes and its rows, of the modes.
void ContactStep::place_contact(int corrections) {
    frame_.sin = step_.sin;
    frame_.cos = step_.cos;
    frame_.theta_dot = step_.frame_rate();
    if (frame_.osculating) frame_.turned = step_.frame_angle() - cam_angle_;
    ContactKinematics<Lanes>& contact = load.contact;
    expansion_.evaluate(step_.deflection(), step_.deflection_rate(), frame_, gap_offset_, hq_.data(), contact,
                        corrections);
    expansion_.normal_rows(contact, hq_.data(), load.jn.data());
    if (load.rough)
        for (std::size_t i = 0; i < step_.n; ++i) expansion_.rows(contact, hq_.data(), i, true, load.jn[i], load.jt[i]);
    if (form_.by_arrays()) return;
    const auto to_modes = [&](const Lanes& hub, std::vector<Lanes>& rows) {
        coordinate_rows_[0] = hub;
        std::ranges::copy(rows, coordinate_rows_.begin() + 1);
        product(step_.n, step_.n + 1, form_.mode_rows.data(), coordinate_rows_.data(), rows.data());
    };
    to_modes(contact.hub, load.jn);
    if (load.rough) to_modes(contact.hub_t, load.jt);
}

// Subtracts the contribution of the present state from the gap and its rates (sign −1), or adds it (+1): around the
// last change of the state, this moves the contact with it. The ledger takes the work of the force at these rates.
void ContactStep::move(double sign) {
    const ExponentialSegment& s = step_.segment;
    Lanes gap{}, rate{}, slip{};
    if (sign > 0) {
        const Lanes turn = step_.theta - contact_theta_, faster = s.theta_dot - contact_theta_dot_;
        gap = load.contact.hub * turn;
        rate = load.contact.hub * faster;
        slip = load.contact.hub_t * faster;
    }
    for (std::size_t i = 0; i < step_.n; ++i) {
        gap += sign * load.jn[i] * s.q[i];
        rate += sign * load.jn[i] * s.v[i];
        if (load.rough) slip += sign * load.jt[i] * s.v[i];
    }
    load.contact.gap += gap;
    load.contact.gap_rate += rate;
    load.contact.slip += slip;
}

}  // namespace beamcam::sim
