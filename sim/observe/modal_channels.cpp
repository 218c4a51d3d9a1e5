#include "sim/observe/modal_channels.hpp"

#include <algorithm>
#include <cmath>

#include "sim/integrate/collocation.hpp"
#include "sim/observe/constants.hpp"

namespace beamcam::sim {

ModalChannels::ModalChannels(System& system, const ModeBasis& basis)
    : system_(system), basis_(basis), bounds_(system, basis), sensitivity_(system, basis, bounds_) {
    if (system.has_cam()) cam_speed_ = std::fabs(system.problem().cam->speed);
}

void ModalChannels::set(const PartBounds::Part& part) {
    bounds_.set(part);
    turning_.reset();
    forced_.reset();
}

double ModalChannels::fading() const {
    double fastest = 0;
    for (const ModalBounds::Mode& b : bounds_.part.modes->modes)
        for (const ModalBounds::Mode::Swing& swing : b.swings)
            if (swing.value > 0) fastest = std::max(fastest, swing.fading);
    return fastest;
}

double ModalChannels::fastest() const {
    double most = std::max(cam_speed_, bounds_.part.motion->theta_dot), rate = 0;
    for (const ModalBounds::Mode& mode : bounds_.part.modes->modes) rate = std::max(rate, mode.rate);
    for (const ModalBounds::Mode& mode : bounds_.part.modes->modes)
        for (const ModalBounds::Mode::Swing& swing : mode.swings)
            if (swing.rate > kNegligibleVibration * rate) most = std::max(most, swing.frequency);
    return most;
}

double ModalChannels::tip(ChannelKind kind, const double* y) const {
    const double* x = kind == ChannelKind::tip_rate ? y + 2 + modes_.size() : y + 1;
    double total = 0;
    for (std::size_t i = 0; i < modes_.size(); ++i) total += basis_.tip[i] * x[i];
    return total;
}

double ModalChannels::hub(ChannelKind kind, const double* y) const {
    const double* x = kind == ChannelKind::theta_dot ? y + 1 + modes_.size() : y;
    double total = x[0];
    for (std::size_t i = 0; i < modes_.size(); ++i) total += basis_.hub[1 + i] * x[1 + i];
    return total;
}

bool ModalChannels::accelerated_by_modes() const {
    return !bounds_.part.modes->resolved && !system_.drive().prescribed();
}

const ForcedAcceleration& ModalChannels::forced() const {
    if (forced_) return *forced_;
    const Collocation& gauss = Collocation::get();
    const ModalBounds& modes = *bounds_.part.modes;
    forced_.emplace();
    Lanes &frame = forced_->frame, &nodes = forced_->nodes;
    for (std::size_t l = 0; l < kNodes; ++l) frame += (modes.theta_dot[static_cast<int>(l)] / modes.h) * gauss.slope[l];
    nodes = frame;
    for (std::size_t i = 0; i < modes_.size(); ++i) nodes += modes_[i].turn * modes.force[i];
    forced_->polynomial = StepPolynomial::through(nodes);
    for (std::size_t j = kNodes - kMissedTerms; j < kNodes; ++j)
        forced_->error += 2 * std::fabs(sum(gauss.legendre[j] * nodes));
    return *forced_;
}

double ModalChannels::hub_acceleration(double t, const double* y) const {
    const std::size_t size = 1 + modes_.size();
    double z[kMaxSize], rate[kMaxSize];
    std::copy_n(y, size, z);
    std::copy_n(y + size, size, rate);
    basis_.to_modes(z);
    basis_.to_modes(rate);
    const PartBounds::Part& part = bounds_.part;
    double total = forced().polynomial(2 * (t - part.from + part.elapsed) / part.modes->h - 1);
    for (std::size_t i = 0; i < modes_.size(); ++i) total += modes_[i].turn * modes_[i].restored(z[1 + i], rate[1 + i]);
    return total;
}

ModalChannels::Range ModalChannels::mode_range(Channel channel) const {
    const std::vector<ModalBounds::Mode>& modes = bounds_.part.modes->modes;
    const std::size_t j = static_cast<std::size_t>(channel.index) - 1;
    if (basis_.are_coordinates()) return {modes[j].low, modes[j].high};
    Range range{0, 0};
    for (std::size_t i = 0; i < modes.size(); ++i) {
        const auto [low, high] = std::minmax({basis_.share(j, i) * modes[i].low, basis_.share(j, i) * modes[i].high});
        range = {range.low + low, range.high + high};
    }
    return range;
}

std::optional<UndampedMode> ModalChannels::undamped_mode(Channel channel) const {
    const PartBounds::Part& part = bounds_.part;
    const std::size_t j = static_cast<std::size_t>(channel.index) - 1;
    if (channel.kind != ChannelKind::q || part.modes->resolved || basis_.modes[j].damping != 0) return {};
    double other = 0;
    for (std::size_t i = 0; i < modes_.size(); ++i)
        other += std::fabs(basis_.share(j, i) - (i == j ? 1 : 0)) * part.modes->modes[i].amplitude;
    const UndampedMode mode(*part.modes, j, basis_.modes[j].omega, part.from - part.elapsed, other);
    return mode.has_crests() ? std::optional(mode) : std::nullopt;
}

std::optional<ModalChannels::Range> ModalChannels::crest_range(Channel channel, double first, double last) const {
    const std::optional<UndampedMode> mode = undamped_mode(channel);
    if (!mode) return {};
    Range range{std::min(first, last), std::max(first, last)};
    const PartBounds::Part& part = bounds_.part;
    mode->each_crest(1, part.from, part.to,
                     [&](double, double, double high) { range.high = std::max(range.high, high); });
    mode->each_crest(-1, part.from, part.to,
                     [&](double, double, double high) { range.low = std::min(range.low, -high); });
    return range;
}

bool ModalChannels::at_nodes(Channel channel, Lanes& values) const {
    if (!bounds_.part.whole) return false;
    const ModalBounds& modes = *bounds_.part.modes;
    const auto weigh = [&](const Lanes& start, std::span<const Lanes> x, auto&& weight) {
        values = start;
        for (std::size_t i = 0; i < modes_.size(); ++i) values += weight(i) * x[i];
        return true;
    };
    const auto turn = [&](std::size_t i) { return modes_[i].turn; };
    const auto tip = [&](std::size_t i) { return modes_[i].tip; };
    const std::size_t j = static_cast<std::size_t>(channel.index) - 1;
    switch (channel.kind) {
        case ChannelKind::q:
            if (!basis_.are_coordinates()) return weigh({}, modes.q, [&](auto i) { return basis_.share(j, i); });
            values = modes.q[j];
            return true;
        case ChannelKind::theta:  // of a prescribed hub not known there
            return (modes.resolved || !system_.drive().prescribed()) && weigh(modes.angle, modes.q, turn);
        case ChannelKind::theta_dot:
            return weigh(modes.theta_dot, modes.rate, turn);
        case ChannelKind::tip_deflection:
            return weigh({}, modes.q, tip);
        case ChannelKind::tip_rate:
            return weigh({}, modes.rate, tip);
        case ChannelKind::energy_kinetic:
            if (basis_.bends_far) return false;
            return weigh((0.5 * basis_.J) * modes.theta_dot * modes.theta_dot, modes.rate,
                         [&](auto i) { return modes_[i].U * modes.theta_dot + (0.5 * basis_.mass) * modes.rate[i]; });
        case ChannelKind::energy_elastic:
            if (basis_.bends_far) return false;
            return weigh({}, modes.q, [&](auto i) { return (0.5 * modes_[i].stiffness) * modes.q[i]; });
        case ChannelKind::separation:
        case ChannelKind::separation_paper:
            if (!accelerated_by_modes()) return false;
            values = bounds_.arm * forced().nodes;
            for (std::size_t i = 0; i < modes_.size(); ++i)
                values += (bounds_.arm * modes_[i].turn) * modes_[i].restored(modes.q[i], modes.rate[i]);
            return true;
        default:
            return false;
    }
}

}  // namespace beamcam::sim
