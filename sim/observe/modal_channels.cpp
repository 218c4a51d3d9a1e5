#include "sim/observe/modal_channels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/beam/modal_model.hpp"
#include "sim/observe/constants.hpp"

namespace beamcam::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Largest distance of a vibration of amplitude 1 from a straight line while it turns by these radians.
double strays(double radians) { return std::min(2.0, radians * radians / 8); }

bool depends_on_gap(ChannelKind kind) {
    return kind == ChannelKind::contact_force || kind == ChannelKind::friction_force || kind == ChannelKind::gap ||
           kind == ChannelKind::energy_contact;
}

}  // namespace

ModalChannels::ModalChannels(System& system, const ModeBasis& basis) : system_(system), basis_(basis) {
    gravity_ = std::fabs(system.problem().gravity);
    strays_.resize(modes_.size());
    if (!system.has_cam()) return;
    const Cam& cam = *system.problem().cam;
    cam_radius_ = cam.radius;
    cam_speed_ = std::fabs(cam.speed);
    disc_speed_ = cam.eccentricity * cam_speed_;
    friction_ = std::max(system.friction().kinetic, system.friction().limit);
}

void ModalChannels::set(const Step& step) {
    bounds_ = step.modes;
    motion_ = step.motion;
    touch_ = step.touch;
    separation_.reset();
    from_ = step.from;
    to_ = step.to;
    elapsed_ = step.elapsed;
    whole_ = step.whole;
    sum_modes();
    const DriveLaw& drive = system_.drive();
    torque_ = drive.has_torque() ? std::max(std::fabs(drive.torque(from_)), std::fabs(drive.torque(to_))) : 0;
    if (!system_.has_cam()) return;
    const double speed = motion_->theta_dot * reach_ + disc_speed_;
    place_contact();
    foot_speed_ = kBentContactShift * (speed + motion_->theta_dot * away_);
    slide_ = foot_speed_ + kBentContactShift * (motion_->slope_speed * away_ + motion_->deflection_speed);
    if (touch_) set_contact();
}

double ModalChannels::fading() const {
    double fastest = 0;
    for (const ModalBounds::Mode& b : bounds_->modes)
        for (const ModalBounds::Mode::Swing& swing : b.swings)
            if (swing.value > 0) fastest = std::max(fastest, swing.fading);
    return fastest;
}

void ModalChannels::sum_modes() {
    deflection_ = inclination_ = alpha_ = inertia_root_ = weight_root_ = 0;
    hub_acceleration_ = motion_->theta_ddot;
    for (std::size_t i = 0; i < modes_.size(); ++i) {
        const ModalBounds::Mode& b = bounds_->modes[i];
        deflection_ += modes_[i].shape * b.amplitude;
        inclination_ += modes_[i].slope * b.amplitude;
        alpha_ += modes_[i].h * b.amplitude;
        inertia_root_ += modes_[i].inertia * b.amplitude;
        weight_root_ += modes_[i].weight * b.amplitude;
        hub_acceleration_ += modes_[i].h * b.acceleration;
        set_strays(i);
    }
}

void ModalChannels::set_strays(std::size_t i) {
    const ModalBounds::Mode& b = bounds_->modes[i];
    const double h = to_ - from_;
    Strays& s = strays_[i];
    s.q = b.amplitude * strays(b.q_frequency * h);
    s.rate = b.rate * strays(b.rate_frequency * h);
    s.mixed = strays(kProductFrequency * std::max(b.q_frequency, b.rate_frequency) * h);
    for (int k = 0; k < ModalBounds::Mode::kSwings; ++k) {
        const ModalBounds::Mode::Swing& swing = b.swings[k];
        const double left = swing.left(elapsed_), x = left * swing.value, speed = left * swing.rate;
        const bool swings = kProductSwing * x < b.amplitude && kProductSwing * speed < b.rate;
        const double share = swings ? kProductSwing * std::max(x / b.amplitude, speed / b.rate) : 1;
        s.vibrations[k] = {x, speed, left * swing.second, swing.frequency, share};
    }
}

// Distance of the disc's centre from the beam, and of the contact from the root: for a straight beam, plus bending.
void ModalChannels::place_contact() {
    const double angle = 0.5 * (motion_->angle_low + motion_->angle_high),
                 turn = 0.5 * (motion_->angle_high - motion_->angle_low), h = to_ - from_;
    const Vec2 disc = system_.cam(from_).disc, along = unit(angle);
    const double root = system_.problem().hub.radius, foot = dot(disc, along),
                 on_beam = std::clamp(foot, root, root + length_), moved = disc_speed_ * h;
    away_ = norm(disc - on_beam * along) + turn * reach_ + moved + deflection_;
    const double bent = kBentContactShift * (inclination_ * away_ + deflection_ * inclination_);
    arm_ = std::min(length_, std::max(0.0, foot - root) + turn * norm(disc) + moved + bent) + deflection_;
}

// The law is convex in the penetration and linear in its rate: its slopes just beyond the deepest and fastest point are
// the largest.
void ModalChannels::set_contact() {
    double depth = 0, rate = 0;
    for (int k = 0; k < TouchSamples::kCount; ++k) {
        depth = std::max(depth, std::fabs(touch_->gap[k]));
        rate = std::max(rate, std::fabs(touch_->gap_rate[k]));
    }
    for (std::size_t i = 0; i < modes_.size(); ++i) {
        for (const Vibration& v : strays_[i].vibrations) {
            if (!(v.frequency * (to_ - from_) > kFollowedRadians)) continue;
            depth += modes_[i].shape * v.value;
            rate += modes_[i].shape * v.rate + modes_[i].slope * slide_ * v.value;
        }
    }
    const double more = kSlopeProbe * depth;
    const auto force = [&](double d, double v) { return system_.normal_law().force(d, v, system_.phase().approach); };
    force_ = force(depth, rate);
    force_per_depth_ = more > 0 ? (force(depth + more, rate) - force_) / more : 0;
    force_per_rate_ = rate > 0 ? (force_ - force(depth, 0)) / rate : 0;
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

ModalChannels::Range ModalChannels::mode_range(Channel channel) const {
    if (!basis_.are_coordinates()) return {-kInfinity, kInfinity};
    const ModalBounds::Mode& mode = bounds_->modes[static_cast<std::size_t>(channel.index) - 1];
    return {mode.low, mode.high};
}

bool ModalChannels::at_nodes(Channel channel, Lanes& values) const {
    if (!whole_) return false;
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
            if (!basis_.are_coordinates()) return weigh({}, bounds_->q, [&](auto i) { return basis_.share(j, i); });
            values = bounds_->q[j];
            return true;
        case ChannelKind::theta:
            return weigh(bounds_->angle, bounds_->q, turn);
        case ChannelKind::theta_dot:
            return weigh(bounds_->theta_dot, bounds_->rate, turn);
        case ChannelKind::tip_deflection:
            return weigh({}, bounds_->q, tip);
        case ChannelKind::tip_rate:
            return weigh({}, bounds_->rate, tip);
        default:
            return false;
    }
}

bool ModalChannels::known_at_nodes(Channel channel, Lanes& values) const {
    if (channel.kind == ChannelKind::q || channel.kind == ChannelKind::theta || channel.kind == ChannelKind::theta_dot)
        return at_nodes(channel, values);
    if (!touch_ || touch_->t[0] != from_ || touch_->t[TouchSamples::kCount - 1] != to_) return false;
    const double* all = channel.kind == ChannelKind::gap             ? touch_->gap
                        : channel.kind == ChannelKind::contact_force ? touch_->force
                        : channel.kind == ChannelKind::contact_x     ? touch_->x
                                                                     : nullptr;
    if (!all) return false;
    for (int k = 0; k < kNodes; ++k) values[k] = all[k + 1];
    return true;
}

// Of the inertia: a mode vibrates about the shape of the others.
double ModalChannels::turning(std::size_t i) const {
    return motion_->theta_dot * modes_[i].inertia * inertia_root_ * bounds_->modes[i].amplitude;
}

// Of the place of contact: a slope rotates the normal, which passes the disc's centre at the distance `away_`.
double ModalChannels::foot(const Mode& m) const {
    return kBentContactShift * (m.slope * away_ + m.shape * inclination_);
}

BEAMCAM_INLINE ModalChannels::Sensitivity ModalChannels::in_contact(ChannelKind kind, const Mode& m) const {
    Sensitivity s{.shift = m.wave * slide_};
    if (kind == ChannelKind::gap) s.q = m.shape;
    if (kind == ChannelKind::contact_x) s.q = foot(m);
    if (kind == ChannelKind::contact_s) s.q = cam_radius_ * m.slope + m.shape;
    if (kind == ChannelKind::energy_contact) s.q = force_ * m.shape;
    if (kind == ChannelKind::contact_force || kind == ChannelKind::friction_force) {
        const double share = kind == ChannelKind::contact_force ? 1 : friction_;
        s.q = share * (force_per_depth_ * m.shape + force_per_rate_ * m.slope * slide_);
        s.rate = share * force_per_rate_ * m.shape;
    }
    return s;
}

BEAMCAM_INLINE ModalChannels::Sensitivity ModalChannels::of_energy(ChannelKind kind, const Mode& m,
                                                                   const ModalBounds::Mode& b, double turning) const {
    const double theta_dot = motion_->theta_dot;
    if (kind == ChannelKind::energy_kinetic)
        return {.rate = theta_dot * m.U,
                .mixed = 0.25 * mass_ * b.rate * b.rate + theta_dot * turning + far_kinetic(m, b)};
    if (kind == ChannelKind::energy_potential)
        return {.q = gravity_ * m.W,
                .mixed = gravity_ * (m.weight * weight_root_ + mass_ * far_tip(m)) * b.amplitude,
                .shift = 2 * theta_dot};
    if (kind == ChannelKind::energy_elastic) return {.mixed = 0.25 * m.stiffness * b.amplitude * b.amplitude};
    if (bounds_->resolved) return {};                                // work_drive is a polynomial
    if (!system_.drive().prescribed()) return {.q = torque_ * m.h};  // (S55)
    return {.q = m.U * motion_->theta_ddot, .rate = 2 * theta_dot * m.U, .mixed = 2 * theta_dot * turning};
}

// Where tangents turn by δ, sin δ is δ but for ½δ²δ_i of each mode; against the hub they turn by twice the inclination
// at most. The deflection of the tip changes by that over the length.
double ModalChannels::far_tip(const Mode& m) const {
    return basis_.bends_far ? 2 * length_ * inclination_ * inclination_ * m.slope : 0;
}

// The same of velocities across the beam; and those along it, L|v′v̇′|, squared and times those by the rotation.
double ModalChannels::far_kinetic(const Mode& m, const ModalBounds::Mode& b) const {
    if (!basis_.bends_far) return 0;
    const double speed = motion_->theta_dot * reach_ + motion_->deflection_speed,
                 along = length_ * inclination_ * motion_->slope_speed;
    return mass_ * length_ * inclination_ * m.slope * b.rate *
           (2 * speed * inclination_ + 0.5 * along + motion_->theta_dot * deflection_);
}

// Calls `visit` with |∂c/∂q_i|, |∂c/∂q̇_i|, |∂c/∂q̈_i| of every mode i: a separate loop for each channel.
template <class Visit>
void ModalChannels::each_mode(Channel channel, Visit&& visit) const {
    const auto each = [&](auto&& sensitivity) {
        for (std::size_t i = 0; i < modes_.size(); ++i) visit(sensitivity(modes_[i], bounds_->modes[i], i), i);
    };
    // −(L + Δu) sin α + Δv cos α: what is not linear is of third order.
    const double third =
        length_ * alpha_ * alpha_ / 6 + 0.5 * length_ * inclination_ * inclination_ + 0.5 * deflection_ * alpha_;
    const double pull = 1.5 * gravity_ / length_;
    using Bounds = ModalBounds::Mode;
    switch (channel.kind) {
        case ChannelKind::q: {
            const std::size_t j = static_cast<std::size_t>(channel.index) - 1;
            if (basis_.are_coordinates()) return visit(Sensitivity{.q = 1}, j);
            return each([&](const Mode&, const Bounds&, std::size_t i) {
                return Sensitivity{.q = std::fabs(basis_.share(j, i))};
            });
        }
        case ChannelKind::theta:
            return each([&](const Mode& m, const Bounds&, std::size_t) { return Sensitivity{.q = m.h}; });
        case ChannelKind::theta_dot:  // Θ̇ = p/(J + qᵀBq)
            return each([&](const Mode& m, const Bounds&, std::size_t i) {
                return Sensitivity{.rate = m.h, .mixed = 2 * turning(i) / inertia_};
            });
        case ChannelKind::tip_deflection:
            return each([&](const Mode& m, const Bounds& b, std::size_t) {
                return Sensitivity{.q = std::fabs(m.tip), .mixed = (3 * third * m.h + far_tip(m)) * b.amplitude};
            });
        case ChannelKind::tip_rate:
            return each([&](const Mode& m, const Bounds& b, std::size_t) {
                return Sensitivity{.rate = std::fabs(m.tip), .mixed = (9 * third * m.h + far_tip(m)) * b.rate};
            });
        case ChannelKind::separation:
        case ChannelKind::separation_paper:  // (S41)
            return each([&](const Mode& m, const Bounds& b, std::size_t) {
                return Sensitivity{.acceleration = m.h * arm_,
                                   .mixed = ((hub_acceleration_ + pull) * foot(m) + pull * arm_ * m.h) * b.amplitude};
            });
        case ChannelKind::gap:
        case ChannelKind::contact_x:
        case ChannelKind::contact_s:
        case ChannelKind::contact_force:
        case ChannelKind::friction_force:
        case ChannelKind::energy_contact:
            return each([&](const Mode& m, const Bounds&, std::size_t) { return in_contact(channel.kind, m); });
        case ChannelKind::energy_kinetic:
        case ChannelKind::energy_potential:
        case ChannelKind::energy_elastic:
        case ChannelKind::work_drive:
            return each([&](const Mode& m, const Bounds& b, std::size_t i) {
                return of_energy(channel.kind, m, b, turning(i));
            });
        default:
            return;
    }
}

// Bound of |dc/dt| with the modes at rest; zero where the channel is monotone.
double ModalChannels::drift(ChannelKind kind) const {
    const double theta_dot = motion_->theta_dot, acceleration = motion_->theta_ddot;
    switch (kind) {
        case ChannelKind::theta:
            return theta_dot;
        case ChannelKind::theta_dot:
            return acceleration;
        case ChannelKind::gap:
            return theta_dot * reach_ + disc_speed_;
        case ChannelKind::contact_x:
            return foot_speed_;
        case ChannelKind::contact_s:
            return cam_radius_ * (theta_dot + cam_speed_) + theta_dot * reach_ + disc_speed_;
        case ChannelKind::energy_kinetic:
            return inertia_ * theta_dot * acceleration;
        case ChannelKind::energy_potential:
            return gravity_ * basis_.S * theta_dot;
        case ChannelKind::work_cam:
            return bounds_->power_cam;
        case ChannelKind::work_drive:
            return bounds_->power_drive +
                   (system_.drive().prescribed() && !bounds_->resolved ? 2 * inertia_ * theta_dot * acceleration : 0);
        default:
            return 0;
    }
}

// Calls add(amplitude, frequency) with every vibration that a polynomial of degree 7 over the part does not resolve.
template <class Add>
void ModalChannels::each_unresolved(Channel channel, Add&& add) const {
    if (depends_on_gap(channel.kind) && channel.kind != ChannelKind::gap && !touch_) return;
    const double least = kFollowedRadians / (to_ - from_);
    each_mode(channel, [&](const Sensitivity& s, std::size_t i) {
        const ModalBounds::Mode& b = bounds_->modes[i];
        if (s.shift > least) add(s.q * b.amplitude, s.shift);
        for (const Vibration& v : strays_[i].vibrations) {
            if (v.frequency + s.shift > least) add(s.q * v.value + s.rate * v.rate, v.frequency + s.shift);
            if (v.frequency > least && s.acceleration != 0) add(s.acceleration * v.second, v.frequency);
            if (kProductFrequency * v.frequency > least && s.mixed != 0)
                add(s.mixed * v.share, kProductFrequency * v.frequency);
        }
    });
}

void ModalChannels::add_unresolved(Channel channel, Variation& out) const {
    each_unresolved(channel, [&](double amplitude, double frequency) { out.add(amplitude, frequency); });
}

// Distance of the channel from the lines between neighbouring nodes: of their polynomial, and of unresolved vibration.
double ModalChannels::strays_between_nodes(Channel channel, const Variation& polynomial) const {
    const double length = kWidestNodeGap * bounds_->h;
    double stray = polynomial.strays(length);
    each_unresolved(channel,
                    [&](double amplitude, double frequency) { stray += amplitude * strays(frequency * length); });
    return stray;
}

ModalChannels::Range ModalChannels::range(Channel channel, double first, double last) const {
    const double h = to_ - from_;
    if (channel.kind == ChannelKind::separation || channel.kind == ChannelKind::separation_paper) {
        const double most = arm_ * (hub_acceleration_ + 1.5 * gravity_ / length_);
        return {-most, most};
    }
    if (channel.kind == ChannelKind::energy_residual)
        return {std::min(first, last) - bounds_->balance_error, std::max(first, last) + bounds_->balance_error};
    if (touch_ && depends_on_gap(channel.kind)) return contact_range(channel);
    if (depends_on_gap(channel.kind) && channel.kind != ChannelKind::gap) return {0, 0};
    double stray = 0.5 * drift(channel.kind) * h;
    const bool tip = channel.kind == ChannelKind::tip_deflection || channel.kind == ChannelKind::tip_rate;
    each_mode(channel, [&](const Sensitivity& s, std::size_t i) {
        const ModalBounds::Mode& b = bounds_->modes[i];
        const Strays& of = strays_[i];
        if (s.shift == 0)
            stray += s.q * of.q + s.rate * of.rate + s.mixed * of.mixed;
        else
            stray += s.q * b.amplitude * strays((b.q_frequency + s.shift) * h) +
                     s.rate * b.rate * strays((b.rate_frequency + s.shift) * h) + s.mixed * of.mixed;
        if (tip) stray += s.mixed;  // not in `tip`
    });
    Range range{std::min(first, last) - stray, std::max(first, last) + stray};
    if (channel.kind == ChannelKind::q && basis_.are_coordinates()) {
        const Range mode = mode_range(channel);
        range = {std::max(range.low, mode.low), std::min(range.high, mode.high)};
    }
    if (channel.kind == ChannelKind::energy_elastic) range.low = std::max(range.low, 0.0);
    // The arc jumps at the mark on the disc.
    const double around = 2 * std::numbers::pi * cam_radius_;
    if (channel.kind == ChannelKind::contact_s &&
        (range.low < 0 || range.high > around || range.high - range.low > 0.5 * around))
        return {0, around};
    return range;
}

std::optional<ModalChannels::Range> ModalChannels::range_by_nodes(Channel channel, double first, double last) const {
    const bool separation = channel.kind == ChannelKind::separation || channel.kind == ChannelKind::separation_paper;
    if (separation && whole_) {
        if (!separation_) separation_ = separation_range();
        return separation_;
    }
    Lanes nodes;
    if (!at_nodes(channel, nodes)) return {};
    Variation variation;
    variation.add_polynomial(nodes, bounds_->h);
    variation.add_missed(nodes, first, last, bounds_->h);
    double stray = strays_between_nodes(channel, variation);
    const bool tip = channel.kind == ChannelKind::tip_deflection || channel.kind == ChannelKind::tip_rate;
    if (tip) each_mode(channel, [&](const Sensitivity& s, std::size_t) { stray += s.mixed; });
    Range range{std::min(first, last), std::max(first, last)};
    for (int k = 0; k < kNodes; ++k) range = {std::min(range.low, nodes[k]), std::max(range.high, nodes[k])};
    return Range{range.low - stray, range.high + stray};
}

// θ̈ = Θ̈ + h·q̈ times the arm, and gravity. Before the first node and after the last the line through the two
// nearest goes on: there vibrations leave it by at most 5/4 of what they do between two nodes.
ModalChannels::Range ModalChannels::separation_range() const {
    Lanes nodes{};
    Variation variation;
    for (std::size_t i = 0; i < modes_.size(); ++i) {
        const Mode& m = modes_[i];
        nodes += m.turn * (bounds_->force[i] - m.damping * bounds_->rate[i] - m.omega * m.omega * bounds_->q[i]);
        for (const Vibration& v : strays_[i].vibrations)
            if (v.frequency * (to_ - from_) > kFollowedRadians) variation.add(m.h * v.second, v.frequency);
    }
    variation.add_polynomial(nodes, bounds_->h);
    const double stray = kBeyondNodes * variation.strays(kWidestNodeGap * bounds_->h) + motion_->theta_ddot;
    const auto beyond = [&](int last, int before) {
        return nodes[last] + (kBeyondNodes - 1) * (nodes[last] - nodes[before]);
    };
    Range range{0, 0};
    const auto add = [&](double value) { range = {std::min(range.low, value), std::max(range.high, value)}; };
    for (int k = 0; k < kNodes; ++k) add(nodes[k]);
    add(beyond(0, 1));
    add(beyond(kNodes - 1, kNodes - 2));
    const double pull = 1.5 * gravity_ / length_;
    return {-arm_ * (stray - range.low + pull), arm_ * (range.high + stray + pull)};
}

double ModalChannels::contact_value(ChannelKind kind, int k) const {
    if (kind == ChannelKind::gap) return touch_->gap[k];
    if (kind == ChannelKind::energy_contact) return system_.normal_law().stored_energy(-touch_->gap[k]);
    return touch_->force[k];
}

// From the values at the nodes.
ModalChannels::Range ModalChannels::contact_range(Channel channel) const {
    Variation variation;
    Lanes nodes;
    for (int k = 0; k < kNodes; ++k) nodes[k] = contact_value(channel.kind, k + 1);
    variation.add_polynomial(nodes, bounds_->h);
    Range range{kInfinity, -kInfinity};
    for (int k = 0; k < TouchSamples::kCount; ++k) {
        const double value = contact_value(channel.kind, k);
        range = {std::min(range.low, value), std::max(range.high, value)};
    }
    const double stray = strays_between_nodes(channel, variation);
    if (channel.kind == ChannelKind::friction_force) {
        const double most = friction_ * (range.high + stray);
        return {-most, most};
    }
    return {range.low - stray, range.high + stray};
}

}  // namespace beamcam::sim
