#include "sim/observe/impacts.hpp"

#include <algorithm>
#include <limits>

namespace beamcam::sim {
namespace {

std::optional<double> restitution(double v_n_before, double v_n_after) {
    if (!(v_n_before < 0)) return std::nullopt;
    return -v_n_after / v_n_before;
}

}  // namespace

void ImpactRecorder::touch(double t, const double* y, const ContactState& c) {
    const double* ledger = y + evaluator_.system().ledger_at;
    open_ = true;
    lost_at_touch_ = ledger[kNormalWork] + ledger[kFrictionWork];
    impulse_n_at_touch_ = ledger[kImpulseN];
    impulse_t_at_touch_ = ledger[kImpulseT];
    Impact impact;
    impact.t_start = t;
    impact.x = c.x;
    impact.cam_angle = evaluator_.system().cam().angle(t);
    impact.v_n_before = c.gap_rate;
    impact.v_t_before = c.slip;
    impact.penetration_peak = std::max(0.0, -c.gap);
    impact.at_touch = touch_state(t, y, c);
    impact.s = impact.at_touch->contact_s;
    if (evaluator_.system().problem().contact.model == ContactModel::compliant)
        impact.force_peak = c.force, impact.t_peak = t;
    Collision& collision = collision_of(t, c);
    ++collision.count;
    collision.t_end.reset();
    collision.v_n_after.reset();
    collision.restitution.reset();
    impact.collision = static_cast<int>(result_.collisions.size());
    result_.impacts.push_back(impact);
}

// The last collision, if the touch is close enough to it; else a new one.
Collision& ImpactRecorder::collision_of(double t, const ContactState& c) {
    std::vector<Collision>& all = result_.collisions;
    if (all.empty() || !(t - all.back().t_end.value_or(t) < collision_gap(evaluator_.system().problem()))) {
        Collision collision;
        collision.t_start = t;
        collision.x = c.x;
        collision.v_n_before = c.gap_rate;
        all.push_back(collision);
    }
    return all.back();
}

void ImpactRecorder::release(double t, const double* y, const ContactState& c) {
    Impact& impact = result_.impacts.back();
    impact.t_end = t;
    impact.duration = t - impact.t_start;
    impact.v_n_after = c.gap_rate;
    impact.v_t_after = c.slip;
    impact.at_release = touch_state(t, y, c);
    impact.restitution = restitution(impact.v_n_before, c.gap_rate);
    settle(y);
    open_ = false;
    Collision& collision = result_.collisions.back();
    collision.t_end = t;
    collision.v_n_after = c.gap_rate;
    collision.restitution = restitution(collision.v_n_before, c.gap_rate);
}

void ImpactRecorder::remember(double t, Initial& initial) const {
    if (result_.collisions.empty()) return;
    const Collision& collision = result_.collisions.back();
    if (!open_ && !(t - collision.t_end.value_or(t) < collision_gap(evaluator_.system().problem()))) return;
    if (!initial.contact) initial.contact = {.touching = false};
    initial.contact->first_approach = std::max(0.0, -collision.v_n_before);
    if (collision.t_end) initial.contact->last_release = *collision.t_end - t;
}

// Impulses and losses of the open impact up to the state y.
void ImpactRecorder::settle(const double* y) {
    Impact& impact = result_.impacts.back();
    Collision& collision = result_.collisions.back();
    const double* ledger = y + evaluator_.system().ledger_at;
    impact.impulse_n = ledger[kImpulseN] - impulse_n_at_touch_;
    impact.impulse_t = ledger[kImpulseT] - impulse_t_at_touch_;
    impact.energy_lost = ledger[kNormalWork] + ledger[kFrictionWork] - lost_at_touch_;
    if (impact.force_peak > collision.force_peak)
        collision.force_peak = impact.force_peak, collision.t_peak = impact.t_peak;
    collision.energy_lost += impact.energy_lost;
}

TouchState ImpactRecorder::touch_state(double t, const double* y, const ContactState& c) {
    evaluator_.set(t, y);
    TouchState out;
    out.theta = evaluator_.value({ChannelKind::theta});
    out.theta_dot = evaluator_.value({ChannelKind::theta_dot});
    out.contact_s = evaluator_.system().cam().place(t, c.normal);
    out.q.assign(y + 1, y + evaluator_.system().coordinates());
    return out;
}

void ImpactRecorder::finish(double t, const double* y) {
    if (!open_) return;
    evaluator_.set(t, y);
    settle(y);
    const double stored = evaluator_.energy_balance().contact;  // not lost
    result_.impacts.back().energy_lost -= stored;
    result_.collisions.back().energy_lost -= stored;
}

// θ where the time between collision i and the next one ends.
static double theta_after(const Result& result, std::size_t i) {
    if (i + 1 == result.collisions.size()) return result.end_theta;
    const double next = result.collisions[i + 1].t_start;
    const auto touch = std::ranges::find(result.impacts, next, &Impact::t_start);
    return touch != result.impacts.end() && touch->at_touch ? touch->at_touch->theta
                                                            : -std::numeric_limits<double>::infinity();
}

std::vector<Apex> rebounds(const Result& result) {
    const std::vector<Collision>& all = result.collisions;
    if (all.empty()) return result.apexes;
    std::vector<Apex> out;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double from = all[i].t_start, to = i + 1 < all.size() ? all[i + 1].t_start : result.end_time;
        std::optional<Apex> highest;
        for (const Apex& apex : result.apexes)
            if (apex.t > from && apex.t < to && (!highest || apex.theta > highest->theta)) highest = apex;
        if (highest && highest->theta >= theta_after(result, i)) out.push_back(*highest);
    }
    return out;
}

}  // namespace beamcam::sim
