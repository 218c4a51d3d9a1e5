// The ranges of channels within a part of a step, (S59): how far each strays from lines between known values.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/integrate/collocation.hpp"
#include "sim/observe/constants.hpp"
#include "sim/observe/modal_channels.hpp"

namespace beamcam::sim {

// Bound of |dc/dt| with the modes at rest.
double ModalChannels::drift(ChannelKind kind) const {
    const MotionBounds& motion = *bounds_.part.motion;
    const ModalBounds& modes = *bounds_.part.modes;
    const double theta_dot = motion.theta_dot, acceleration = motion.theta_ddot;
    switch (kind) {
        case ChannelKind::theta:
            return theta_dot;
        case ChannelKind::theta_dot:
            return acceleration;
        case ChannelKind::gap:
            return theta_dot * bounds_.lever() + bounds_.disc_speed;
        case ChannelKind::contact_x:
            return bounds_.foot_speed;
        case ChannelKind::contact_s:
            return sensitivity_.cam_radius() * (theta_dot + cam_speed_) +
                   bounds_.rim_share * (theta_dot * bounds_.lever() + bounds_.disc_speed);
        case ChannelKind::energy_kinetic:
            return basis_.J * theta_dot * acceleration;
        case ChannelKind::energy_potential:
            return sensitivity_.gravity() * basis_.S * theta_dot;
        case ChannelKind::work_cam:
            return modes.power_cam;
        case ChannelKind::work_drive:
            return modes.power_drive +
                   (system_.drive().prescribed() && !modes.resolved ? 2 * basis_.J * theta_dot * acceleration : 0);
        default:  // of the modes alone, monotone, or with a range of its own
            return 0;
    }
}

// Of gravity in the separation, at any place that the contact may have (S41). cos θ differs from that in the middle of
// the angles of the hub by the distance of their ends from it at most.
ModalChannels::Range ModalChannels::pull(ChannelKind kind) const {
    const MotionBounds& motion = *bounds_.part.motion;
    const double middle = std::cos(0.5 * (motion.angle_low + motion.angle_high)),
                 around = 0.5 * (motion.angle_high - motion.angle_low) + bounds_.alpha;
    const double sign = kind == ChannelKind::separation ? 1 : -1,
                 per_place = sign * 1.5 * system_.problem().gravity / basis_.length;
    const double low = std::max(-1.0, middle - around), high = std::min(1.0, middle + around);
    const double near = per_place * bounds_.nearest, far = per_place * bounds_.farthest;
    const auto [first, last] = std::minmax({near * low, near * high, far * low, far * high});
    return {first, last};
}

// Largest distance of the channel from the line between two of its values that are `length` apart in time.
double ModalChannels::line_strays(Channel channel, double length) const {
    if (is_mode(channel)) {
        const ModalBounds::Mode& mode = bounds_.part.modes->modes[static_cast<std::size_t>(channel.index) - 1];
        const double radians = mode.q_frequency * length;
        return mode.amplitude * std::min(2.0, radians * radians * 0.125);
    }
    Lanes total{};
    sensitivity_.each_group(channel, [&](const Sensitivity& s, const ModeVibrations& m) {
        const Lanes shift = s.shift.value_or(Lanes{});
        if (s.q) total += *s.q * m.amplitude * strays((m.q_frequency + shift) * length);
        if (s.rate) total += *s.rate * m.rate * strays((m.rate_frequency + shift) * length);
        const Lanes products = strays(larger(m.q_frequency, m.rate_frequency) * (kProductFrequency * length));
        for (const auto& mixed : {s.mixed, s.mixed_rate})
            if (mixed) total += *mixed * products;
    });
    return 0.5 * drift(channel.kind) * length + sum(total);
}

// Calls add(amplitude, frequency), in lanes, with every vibration that a polynomial of degree 7 over the part does not
// resolve; the others have amplitude 0.
template <class Add>
void ModalChannels::each_unresolved(Channel channel, Add&& add) const {
    if (traits(channel.kind).of_gap && channel.kind != ChannelKind::gap && !touch()) return;
    const double least = kFollowedRadians / bounds_.part.length();
    const auto add_above = [&](const Lanes& amplitude, const Lanes& frequency) {
        add(where_above(frequency, least, amplitude), frequency);
    };
    sensitivity_.each_group(channel, [&](const Sensitivity& s, const ModeVibrations& m) {
        if (s.q && s.shift) add_above(*s.q * m.amplitude, *s.shift);
        for (int k = 0; k < m.free_count; ++k) {
            const ModeVibrations::Free& v = m.free[k];
            const Lanes shifted = s.shift ? v.frequency + *s.shift : v.frequency;
            if (s.q && s.rate)
                add_above(*s.q * v.value + *s.rate * v.rate, shifted);
            else if (s.q)
                add_above(*s.q * v.value, shifted);
            else if (s.rate)
                add_above(*s.rate * v.rate, shifted);
            if (s.acceleration) add_above(*s.acceleration * v.second, v.frequency);
            if (s.mixed) add_above(*s.mixed * v.share, kProductFrequency * v.frequency);
            if (s.mixed_rate) add_above(*s.mixed_rate * v.share_with_rates, kProductFrequency * v.frequency);
        }
    });
}

void ModalChannels::add_unresolved(Channel channel, Variation& out) const {
    each_unresolved(channel, [&](const Lanes& amplitude, const Lanes& frequency) {
        for (int lane = 0; lane < kNodes; ++lane) out.add(amplitude[lane], frequency[lane]);
    });
}

bool ModalChannels::vary_by_modes(Channel channel, Variation& out) const {
    if (bounds_.part.modes->resolved) return false;
    if (channel.kind == ChannelKind::q) {
        for (std::size_t i = 0; i < modes_.size(); ++i) {
            const ModalBounds::Mode& mode = bounds_.part.modes->modes[i];
            out.add(std::fabs(basis_.share(static_cast<std::size_t>(channel.index) - 1, i)) * mode.amplitude,
                    mode.q_frequency);
        }
        return true;
    }
    if (traits(channel.kind).of_tip) {
        const bool deflection = channel.kind == ChannelKind::tip_deflection;
        for (std::size_t i = 0; i < modes_.size(); ++i) {
            const ModalBounds::Mode& mode = bounds_.part.modes->modes[i];
            out.add(std::fabs(modes_[i].tip) * (deflection ? mode.amplitude : mode.rate),
                    deflection ? mode.q_frequency : mode.rate_frequency);
        }
        return true;
    }
    if (!accelerated_by_modes()) return false;
    out.add_polynomial(bounds_.arm * forced().frame, bounds_.part.modes->h);
    for (std::size_t i = 0; i < modes_.size(); ++i) {
        const ModalBounds::Mode& mode = bounds_.part.modes->modes[i];
        out.add(bounds_.arm * modes_[i].h * mode.acceleration, mode.acceleration_frequency);
    }
    return true;
}

// Distance of the channel from the lines between neighbouring nodes: of their polynomial, and of unresolved vibration.
double ModalChannels::strays_between_nodes(Channel channel, const Variation& polynomial) const {
    const double length = kWidestNodeGap * bounds_.part.modes->h;
    Lanes stray{};
    each_unresolved(channel, [&](const Lanes& amplitude, const Lanes& frequency) {
        stray += amplitude * strays(frequency * length);
    });
    return polynomial.strays(length) + sum(stray);
}

ModalChannels::Range ModalChannels::range(Channel channel, double first, double last) const {
    const ChannelKind kind = channel.kind;
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (traits(kind).by_samples()) return {-kInfinity, kInfinity};
    if (traits(kind).separation) {
        const double most = bounds_.arm * bounds_.hub_acceleration;
        const Range pulled = pull(kind);
        return {pulled.low - most, pulled.high + most};
    }
    Range range{std::min(first, last), std::max(first, last)};
    const MotionBounds& motion = *bounds_.part.motion;
    if (kind == ChannelKind::theta && (motion.rate_low > 0 || motion.rate_high < 0)) return range;
    if (kind == ChannelKind::energy_residual) {
        const double error = bounds_.part.modes->balance_error;
        return {range.low - error, range.high + error};
    }
    if (touch() && traits(kind).of_gap) return contact_range(channel);
    if (traits(kind).of_gap && kind != ChannelKind::gap) return {0, 0};
    const double stray =
        line_strays(channel, bounds_.part.length()) + (traits(kind).of_tip ? estimate_error(channel) : 0);
    range = {range.low - stray, range.high + stray};
    if (kind == ChannelKind::q) {
        const Range mode = mode_range(channel);
        range = {std::max(range.low, mode.low), std::min(range.high, mode.high)};
    }
    if (kind == ChannelKind::energy_elastic) range.low = std::max(range.low, 0.0);
    if (kind == ChannelKind::gap && !bounds_.part.modes->resolved)  // no touch within (S56)
        range.low = std::max(range.low, std::min({first, last, 0.0}));
    return within(kind, range);
}

// The arc jumps at the mark on the disc.
ModalChannels::Range ModalChannels::within(ChannelKind kind, const Range& range) const {
    if (kind == ChannelKind::gap) return {std::max(range.low, bounds_.gap_low), std::min(range.high, bounds_.gap_high)};
    if (kind == ChannelKind::contact_x)
        return {std::max(range.low, bounds_.nearest), std::min(range.high, bounds_.farthest)};
    if (kind != ChannelKind::contact_s) return range;
    const double around = 2 * std::numbers::pi * sensitivity_.cam_radius();
    const bool jumps = range.low < 0 || range.high > around || range.high - range.low > 0.5 * around;
    return jumps ? Range{0, around} : range;
}

// Of the tip, terms of third order; of the kinetic energy, ½Θ̇²qᵀBq.
double ModalChannels::estimate_error(Channel channel) const {
    const double fastest = bounds_.part.motion->theta_dot;
    if (channel.kind == ChannelKind::energy_kinetic)
        return 0.5 * fastest * fastest * bounds_.inertia_root * bounds_.inertia_root;
    if (traits(channel.kind).separation) {
        const Range pulled = pull(channel.kind);
        return bounds_.arm * (accelerated_by_modes() ? forced().error : 0) + std::max(-pulled.low, pulled.high);
    }
    double error = 0;
    if (traits(channel.kind).of_tip)
        sensitivity_.each_group(channel, [&](const Sensitivity& s, const ModeVibrations&) {
            error += sum(s.mixed ? *s.mixed : *s.mixed_rate);
        });
    return error;
}

double ModalChannels::rounding(ChannelKind kind) const {
    const double place = std::numeric_limits<double>::epsilon() * basis_.length;
    switch (kind) {
        case ChannelKind::gap:
            return place;
        case ChannelKind::contact_force:
            return bounds_.force_per_depth * place;
        case ChannelKind::friction_force:
            return sensitivity_.friction() * bounds_.force_per_depth * place;
        case ChannelKind::energy_contact:
            return bounds_.force * place;
        case ChannelKind::separation:
        case ChannelKind::separation_paper:
            return kValueRounding * 1.5 * sensitivity_.gravity();
        default:
            return 0;
    }
}

std::optional<ModalChannels::Range> ModalChannels::range_by_nodes(Channel channel, double first, double last) const {
    if (traits(channel.kind).separation && (bounds_.part.modes->resolved || !system_.drive().prescribed())) {
        if (!turning_) turning_ = turning_range();
        const Range pulled = pull(channel.kind);
        return Range{turning_->low + pulled.low, turning_->high + pulled.high};
    }
    Lanes nodes;
    if (!at_nodes(channel, nodes)) return {};
    const double h = bounds_.part.modes->h;
    Variation variation;
    variation.add_polynomial(nodes, h);
    variation.add_missed(nodes, first, last, h);
    const double stray = estimate_error(channel) +
                         std::min(strays_between_nodes(channel, variation), line_strays(channel, kWidestNodeGap * h));
    Range range{std::min(first, last), std::max(first, last)};
    for (int k = 0; k < kNodes; ++k) range = {std::min(range.low, nodes[k]), std::max(range.high, nodes[k])};
    return Range{range.low - stray, range.high + stray};
}

// θ̈ = Θ̈ + h·q̈ times the arm. Lines through the nodes of the step; before the first node and after the
// last the line through the two nearest goes on: there vibrations leave it by at most 5/4 of what they do between
// nodes.
ModalChannels::Range ModalChannels::turning_range() const {
    const ModalBounds& modes = *bounds_.part.modes;
    const double length = kWidestNodeGap * modes.h, least = kFollowedRadians / modes.h;
    Lanes nodes{}, vibrations{}, unresolved{};
    for (std::size_t i = 0; i < modes_.size(); ++i)
        nodes += modes_[i].turn * (modes.force[i] + modes_[i].restored(modes.q[i], modes.rate[i]));
    for (std::size_t g = 0; g < bounds_.groups.size(); ++g) {
        const ModeVibrations& m = bounds_.groups[g];
        const Lanes& turn = basis_.groups[g].h;
        vibrations += turn * m.acceleration * strays(m.acceleration_frequency * length);
        for (int k = 0; k < m.free_count; ++k) {
            const ModeVibrations::Free& v = m.free[k];
            unresolved += where_above(v.frequency, least, turn * v.second) * strays(v.frequency * length);
        }
    }
    Variation variation;
    variation.add_polynomial(nodes, modes.h);
    const double between = std::min(variation.strays(length) + sum(unresolved), sum(vibrations)),
                 stray = kBeyondNodes * between + bounds_.part.motion->theta_ddot;
    Range range{0, 0};
    const auto add = [&](double value) { range = {std::min(range.low, value), std::max(range.high, value)}; };
    const Lanes& at = Collocation::get().c;
    const double first = bounds_.part.elapsed / modes.h, last = first + bounds_.part.length() / modes.h;
    const auto add_on_line = [&](double s) {
        int k = 0;
        while (k < kNodes - 2 && at[k + 1] < s) ++k;
        add(nodes[k] + (nodes[k + 1] - nodes[k]) * ((s - at[k]) / (at[k + 1] - at[k])));
    };
    add_on_line(first);
    add_on_line(last);
    for (int k = 0; k < kNodes; ++k)
        if (at[k] > first && at[k] < last) add(nodes[k]);
    return {-bounds_.arm * (stray - range.low), bounds_.arm * (range.high + stray)};
}

double ModalChannels::contact_value(ChannelKind kind, int k) const {
    if (kind == ChannelKind::gap) return touch()->gap[k];
    if (kind == ChannelKind::energy_contact) return system_.normal_law().stored_energy(-touch()->gap[k]);
    if (kind == ChannelKind::friction_force) return touch()->friction[k];
    return touch()->force[k];
}

// From the values at the nodes.
ModalChannels::Range ModalChannels::contact_range(Channel channel) const {
    Variation variation;
    Lanes nodes;
    for (int k = 0; k < kNodes; ++k) nodes[k] = contact_value(channel.kind, k + 1);
    variation.add_polynomial(nodes, bounds_.part.modes->h);
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Range range{kInfinity, -kInfinity};
    for (int k = 0; k < TouchSamples::kCount; ++k) {
        const double value = contact_value(channel.kind, k);
        range = {std::min(range.low, value), std::max(range.high, value)};
    }
    const double stray = strays_between_nodes(channel, variation);
    return {range.low - stray, range.high + stray};
}

}  // namespace beamcam::sim
