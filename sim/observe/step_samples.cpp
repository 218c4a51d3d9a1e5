#include "sim/observe/step_samples.hpp"

#include <algorithm>
#include <cmath>

#include "sim/integrate/collocation.hpp"
#include "sim/integrate/step_errors.hpp"

namespace beamcam::sim {
namespace {

constexpr double kNegligibleEnergy = 1e-10;  // of the vibration: 10⁻⁵ of its rates
constexpr double kSamplesPerRadian = 1.3;    // of a vibration: eight in a period
constexpr double kMostSamples = 1e5;         // between two nodes of a step
// The larger of the last two Legendre coefficients of the nodal values, times this, is what a channel may do between
// the nodes: the phases of several vibrations make them as small as a quarter of the sum of their amplitudes.
constexpr double kStrayByDecay = 6;
// A step in which a vibration decays by more than the first, e⁻⁸ = 3·10⁻⁴, is sampled in parts; each is eight times as
// long as the one before.
constexpr double kFadedDecays = 8, kPartRatio = 0.125;

// The samples of a solved contact that are this channel; null for other channels.
const double* touch_channel(const TouchSamples& touch, ChannelKind kind) {
    if (kind == ChannelKind::contact_force) return touch.force;
    if (kind == ChannelKind::friction_force) return touch.friction;
    if (kind == ChannelKind::gap) return touch.gap;
    return kind == ChannelKind::contact_x ? touch.x : nullptr;
}

}  // namespace

StepSamples::StepSamples(ChannelEvaluator& evaluator)
    : evaluator_(evaluator), y_(static_cast<std::size_t>(evaluator.system().size)) {
    const Eigen::Index n = evaluator.system().coordinates() - 1;
    if (n == 0) return;
    const NaturalModes& natural = evaluator.natural_modes();
    to_modes_ = natural.inverse.bottomRightCorner(n, n);
    omega_ = natural.omega_squared.cwiseMax(0).cwiseSqrt();
    const Eigen::ArrayXd gamma = 0.5 * natural.damping, excess = gamma.square() - omega_.square();
    vibration_ = (excess < 0).select(omega_, 0);
    decay_ = gamma + excess.max(0).sqrt();
}

// Twice the kinetic energy of each mode per mass of the beam; or its whole energy at the start of a motion, which may
// rest far from equilibrium. Later the deflection follows the forcing without vibration.
Eigen::ArrayXd StepSamples::modal_energies(double t, bool whole) {
    step_.segment->value(t, y_.data());
    const Eigen::Index n = omega_.size();
    const Eigen::Map<const Eigen::VectorXd> q(y_.data() + 1, n), rate(y_.data() + n + 2, n);
    Eigen::ArrayXd energies = (to_modes_ * rate).array().square();
    if (whole) energies += (omega_ * (to_modes_ * q).array()).square();
    return energies;
}

// A vibration that fades early in the step is sampled in parts whose lengths grow from the start by a constant factor.
// In a step that was solved for the contact its force and gap are resolved.
void StepSamples::find_parts() {
    const TouchSamples* touch = step_.segment->touch();
    const bool solved =
        touch && std::ranges::all_of(channels_, [&](Channel c) { return touch_channel(*touch, c.kind) != nullptr; });
    const double length = step_.to - step_.from;
    double decay = 0;
    if (omega_.size() > 0 && decay_.maxCoeff() * length > kFadedDecays && !solved) {
        const Eigen::ArrayXd energies = modal_energies(step_.from, step_.from == 0);
        decay = (energies > kNegligibleEnergy * energies.sum()).select(decay_, 0).maxCoeff();
    }
    parts_.clear();
    double to = step_.to;
    for (double share = kPartRatio;; share *= kPartRatio) {
        double from = step_.from + share * length;
        const bool first = !(decay * (to - step_.from) > kFadedDecays) || !(from > step_.from && from < to);
        if (first) from = step_.from;
        Instants& part = parts_.emplace_back();
        part.front() = from;
        part.back() = to;
        for (int k = 0; k < kNodes; ++k)
            part[static_cast<std::size_t>(k) + 1] = from + Collocation::get().c[k] * (to - from);
        if (first) break;
        to = from;
    }
    std::ranges::reverse(parts_);
}

// The highest frequency whose share of the vibration's energy matters in the part [rad/s].
double StepSamples::fastest(const Instants& part) {
    if (omega_.size() == 0) return 0;
    Eigen::ArrayXd largest = Eigen::ArrayXd::Zero(omega_.size());
    for (const double t : part) largest = largest.max(modal_energies(t, false));
    return (largest > kNegligibleEnergy * largest.sum()).select(vibration_, 0).maxCoeff();
}

const TouchSamples* StepSamples::touch_at(const Instants& part) const {
    const TouchSamples* touch = step_.segment->touch();
    static_assert(TouchSamples::kCount == kCount);
    return touch && touch->t[0] == part.front() && touch->t[kCount - 1] == part.back() ? touch : nullptr;
}

std::span<const StepSamples::Series> StepSamples::sample(const SegmentInterval& s, std::span<const Channel> channels,
                                                         const NeedsMore& needs_more, const See& see) {
    step_ = s;
    channels_.assign(channels.begin(), channels.end());
    nodes_.resize(channels.size());
    series_.resize(std::max(series_.size(), channels.size()));  // they keep their memory
    for (Series& series : series_) {
        series.t.clear();
        series.value.clear();
    }
    find_parts();
    for (const Instants& part : parts_) sample_part(part, needs_more, see);
    return {series_.data(), channels.size()};
}

void StepSamples::sample_part(const Instants& part, const NeedsMore& needs_more, const See& see) {
    evaluate_nodes(part, needs_more, see);
    double frequency = -1;
    for (std::size_t k = 0; k < kCount; ++k) {
        for (std::size_t c = 0; c < channels_.size(); ++c) {
            if (k == 0 && !series_[c].t.empty()) continue;  // the end of the part before
            if (nodes_[c].only_ends && k > 0 && k + 1 < kCount) continue;
            series_[c].t.push_back(part[k]);
            series_[c].value.push_back(nodes_[c].value[k]);
        }
        if (k + 1 == kCount) return;
        sampled_.clear();
        for (std::size_t c = 0; c < channels_.size(); ++c) {
            const Nodes& of = nodes_[c];
            const auto [low, high] = std::minmax(of.value[k], of.value[k + 1]);
            const double least = is_gap_in_flight(c) ? std::max(low, of.stray) : low;  // it is not negative
            if (!of.only_ends && of.stray > 0 && needs_more(c, least, high, of.stray)) sampled_.push_back(c);
        }
        if (sampled_.empty()) continue;
        if (frequency < 0) frequency = std::max(fastest(part), evaluator_.system().cam_rate());
        const bool squared =
            std::ranges::any_of(sampled_, [&](std::size_t c) { return traits(channels_[c].kind).squared; });
        const double length = part[k + 1] - part[k], rate = squared ? 2 * frequency : frequency;
        const int pieces = static_cast<int>(std::min(kMostSamples, std::ceil(kSamplesPerRadian * rate * length)));
        for (int j = 1; j < pieces; ++j) {
            const double t = part[k] + length * j / pieces;
            place(t);
            for (const std::size_t c : sampled_) {
                series_[c].t.push_back(t);
                series_[c].value.push_back(evaluator_.value(channels_[c]));
            }
        }
    }
}

void StepSamples::evaluate_nodes(const Instants& part, const NeedsMore& needs_more, const See& see) {
    const TouchSamples* touch = touch_at(part);
    sampled_.clear();
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        Nodes& of = nodes_[c];
        const double* known = touch ? touch_channel(*touch, channels_[c].kind) : nullptr;
        if (known) std::copy_n(known, kCount, of.value.begin());
        of.only_ends = !known && ends_suffice(part, c, needs_more, see);
        if (!known && !of.only_ends) sampled_.push_back(c);
    }
    for (std::size_t k = 0; k < kCount && !sampled_.empty(); ++k) {
        place(part[k]);
        for (const std::size_t c : sampled_) nodes_[c].value[k] = evaluator_.value(channels_[c]);
    }
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        Nodes& of = nodes_[c];
        for (std::size_t k = 0; see && !of.only_ends && k < kCount; ++k) see(c, part[k], of.value[k]);
        Lanes inner;
        for (int k = 0; k < kNodes; ++k) inner[k] = of.value[static_cast<std::size_t>(k) + 1];
        of.stray = kStrayByDecay * legendre_decay(inner).last;
    }
}

bool StepSamples::is_gap_in_flight(std::size_t channel) const {
    return channels_[channel].kind == ChannelKind::gap && !evaluator_.system().phase().touching;
}

// In flight the gap, which is costly, is evaluated at the ends only where it cannot matter between them: it changes no
// faster than the beam and the disc move, and is not negative.
bool StepSamples::ends_suffice(const Instants& part, std::size_t channel, const NeedsMore& needs_more, const See& see) {
    const System& system = evaluator_.system();
    const auto bounds = step_.segment->bounds();
    if (!is_gap_in_flight(channel) || !bounds || !std::isfinite(bounds->theta_dot) || !system.has_cam()) return false;
    Nodes& of = nodes_[channel];
    for (const std::size_t k : {std::size_t{0}, kCount - 1}) {
        of.value[k] = value(channels_[channel], part[k]);
        if (see) see(channel, part[k], of.value[k]);
    }
    const Problem& problem = system.problem();
    const double reach = std::fabs(problem.hub.radius) + problem.beam.length;
    const double speed = bounds->theta_dot * reach + bounds->deflection_speed +
                         system.cam().shape().largest_slope() * std::fabs(system.cam().speed());
    const double stray = 0.5 * speed * (part.back() - part.front());
    const auto [low, high] = std::minmax(of.value.front(), of.value.back());
    return !needs_more(channel, std::max(low, stray), high, stray);
}

double StepSamples::value(Channel channel, double t) {
    place(t);
    return evaluator_.value(channel);
}

void StepSamples::place(double t) {
    step_.segment->value(t, y_.data());
    evaluator_.set(t, y_.data());
}

}  // namespace beamcam::sim
