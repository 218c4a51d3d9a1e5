#include "scenes/scene/time_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "render/base/error.hpp"

namespace beamcam::scenes {
namespace {

constexpr int kEasePieces = 32;  // of each ease: the integrand varies by at most e^(ln 1e4 / 16) in one of them

double smoothstep(double x) {
    x = std::clamp(x, 0.0, 1.0);
    return x * x * (3 - 2 * x);
}

}  // namespace

TimeMap::TimeMap(double from, double to, const Speed& speed, const std::vector<sim::Impact>& impacts)
    : from_(from), to_(to), base_(speed.factor) {
    if (speed.around) {
        const SlowMotion& slow = *speed.around;
        for (const sim::Impact& impact : impacts) {
            if (!slow.collisions.empty() &&
                std::ranges::find(slow.collisions, impact.collision) == slow.collisions.end())
                continue;
            const Span span{impact.t_start - slow.before,
                            impact.t_end.value_or(std::max(to, impact.t_start)) + slow.after, slow.factor, slow.ease,
                            slow.ease};
            if (span.to + slow.ease < from || span.from - slow.ease > to) continue;
            // Spans whose transitions would overlap are merged.
            if (!spans_.empty() && span.from - spans_.back().to < 2 * slow.ease)
                spans_.back().to = std::max(spans_.back().to, span.to);
            else
                spans_.push_back(span);
        }
    }
    for (const SpeedInterval& each : speed.intervals) {
        Span span{each.from.t, each.to.t, each.factor, speed.ease, speed.ease};
        if (!spans_.empty())
            spans_.back().after = span.before = std::min(speed.ease, (span.from - spans_.back().to) / 2);
        spans_.push_back(span);
    }
    std::vector<std::pair<double, bool>> cuts;  // beginnings of pieces, and whether their speed is constant
    cuts.emplace_back(from, true);
    for (const Span& s : spans_) {
        for (int side = 0; side < 2; ++side) {
            const double ease = side == 0 ? s.before : s.after, begin = side == 0 ? s.from - ease : s.to;
            for (int i = 0; i < kEasePieces; ++i) cuts.emplace_back(begin + ease * i / kEasePieces, ease == 0);
            cuts.emplace_back(begin + ease, true);
        }
    }
    double tau = 0;
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        const double t0 = std::clamp(cuts[i].first, from, to);
        const double t1 = i + 1 < cuts.size() ? std::clamp(cuts[i + 1].first, from, to) : to;
        if (!(t1 > t0)) continue;
        Piece piece{t0, t1, tau, cuts[i].second};
        tau += elapsed(piece, t1);
        pieces_.push_back(piece);
    }
    length_ = tau;
}

double TimeMap::speed_at(double t) const {
    double weight = 0, factor = base_;
    for (const Span& s : spans_) {
        double here = 0;
        if (t >= s.from && t <= s.to) here = 1;
        if (s.before > 0 && t < s.from) here = std::max(here, smoothstep(1 - (s.from - t) / s.before));
        if (s.after > 0 && t > s.to) here = std::max(here, smoothstep(1 - (t - s.to) / s.after));
        if (here > weight) weight = here, factor = s.factor;
    }
    if (weight == 0) return base_;
    if (weight == 1) return factor;
    return base_ * std::pow(factor / base_, weight);
}

// Gauss–Legendre quadrature with five points; within a piece the integrand is smooth.
double TimeMap::elapsed(const Piece& piece, double t) const {
    if (piece.flat) return (t - piece.t0) / speed_at((piece.t0 + piece.t1) / 2);
    static constexpr std::array<double, 5> kNodes{0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640,
                                                  -0.9061798459386640};
    static constexpr std::array<double, 5> kWeights{0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                                                    0.2369268850561891, 0.2369268850561891};
    const double middle = (piece.t0 + t) / 2, half = (t - piece.t0) / 2;
    double sum = 0;
    for (std::size_t i = 0; i < kNodes.size(); ++i) sum += kWeights[i] / speed_at(middle + half * kNodes[i]);
    return half * sum;
}

void TimeMap::freeze(double t, double seconds) {
    if (t < from_ || t > to_ || !(seconds > 0)) return;
    double tau = length_;
    for (const Piece& piece : pieces_)
        if (t >= piece.t0 && t < piece.t1) tau = piece.tau0 + elapsed(piece, t);
    freezes_.push_back({t, tau, seconds});
    std::ranges::stable_sort(freezes_, {}, &Freeze::t);
}

double TimeMap::duration() const {
    double all = length_;
    for (const Freeze& f : freezes_) all += f.seconds;
    return all;
}

double TimeMap::unfrozen(double film, bool& frozen) const {
    frozen = false;
    double spent = 0;
    for (const Freeze& f : freezes_) {
        if (film - spent <= f.tau) break;
        if (film - spent < f.tau + f.seconds) {
            frozen = true;
            return f.tau;
        }
        spent += f.seconds;
    }
    return film - spent;
}

double TimeMap::instant(double film) const {
    bool frozen = false;
    const double tau = unfrozen(film, frozen);
    if (frozen)  // all frames of a freeze show the same instant
        for (const Freeze& f : freezes_)
            if (f.tau == tau) return f.t;
    if (pieces_.empty() || tau <= 0) return from_;
    auto at = std::ranges::upper_bound(pieces_, tau, {}, &Piece::tau0);
    const Piece& piece = *(at - 1);
    const double target = tau - piece.tau0;
    double t = piece.t0 + target * speed_at(piece.flat ? (piece.t0 + piece.t1) / 2 : piece.t0);
    if (!piece.flat) {
        t = std::clamp(t, piece.t0, piece.t1);
        for (int i = 0; i < 20; ++i) {
            const double step = (target - elapsed(piece, t)) * speed_at(t);
            t = std::clamp(t + step, piece.t0, piece.t1);
            if (std::abs(step) <= 1e-15 * std::max(1.0, std::abs(t))) break;
        }
    }
    return std::min(t, to_);
}

double TimeMap::speed(double film) const {
    bool frozen = false;
    unfrozen(film, frozen);
    return frozen ? 0 : speed_at(instant(film));
}

double TimeMap::film_time(double t) const {
    double film = length_;
    if (t <= from_) film = 0;
    for (const Piece& piece : pieces_)
        if (t >= piece.t0 && t < piece.t1) film = piece.tau0 + elapsed(piece, t);
    for (const Freeze& f : freezes_)
        if (f.t < t) film += f.seconds;
    return film;
}

void record_event(const Instant& event, double scene_end, sim::Request& request) {
    request.apexes = request.apexes || event.kind == Instant::Kind::apex;
    if (event.kind != Instant::Kind::bend) return;
    request.bends = true;
    request.end_time = std::max(request.end_time, scene_end);
}

std::optional<double> find_instant(const Instant& instant, const sim::Result& motion) {
    const auto pick = [&](const auto& all, auto time) -> std::optional<double> {
        if (instant.number < 1 || std::cmp_greater(instant.number, all.size())) return std::nullopt;
        return std::invoke(time, all[static_cast<std::size_t>(instant.number - 1)]);
    };
    switch (instant.kind) {
        case Instant::Kind::time:
            break;
        case Instant::Kind::last:
            return motion.end_time;
        case Instant::Kind::impact:
            return pick(motion.impacts, &sim::Impact::t_start);
        case Instant::Kind::collision:
            return pick(motion.collisions, &sim::Collision::t_start);
        case Instant::Kind::peak:
            return pick(motion.collisions, &sim::Collision::t_peak);
        case Instant::Kind::bend:
            return pick(motion.collisions, &sim::Collision::t_bend);
        case Instant::Kind::release:
            return pick(motion.impacts, &sim::Impact::t_end);
        case Instant::Kind::liftoff:
            return pick(motion.collisions, &sim::Collision::t_end);
        case Instant::Kind::apex:
            return pick(sim::rebounds(motion), &sim::Apex::t);
    }
    return instant.t;
}

double instant_of(const Instant& instant, const sim::Result& motion) {
    if (const auto t = find_instant(instant, motion)) return *t;
    std::size_t count = 0;
    for (Instant each{.kind = instant.kind}; each.number < instant.number && find_instant(each, motion); ++each.number)
        ++count;
    if (std::cmp_less_equal(instant.number, motion.collisions.size())) {
        if (instant.kind == Instant::Kind::peak)
            throw render::PictureError(fmt::format(
                "{} does not occur: this collision is a pure impulse, without a finite force; take \"collision:{}\"",
                name_of(instant), instant.number));
        if (instant.kind == Instant::Kind::bend)
            throw render::PictureError(
                fmt::format("{} does not occur: the beam does not bend; choose another beam.model", name_of(instant)));
    }
    throw render::PictureError(
        fmt::format("{} does not occur: the motion has {} of them until {:g} s; a larger time.end, or \"to\" of a "
                    "film, may have more",
                    name_of(instant), count, motion.end_time));
}

}  // namespace beamcam::scenes
