#include "sim/sweep/sampler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/base/numerics.hpp"
#include "sim/observe/crossings.hpp"
#include "sim/observe/extrema.hpp"

namespace beamcam::sim {

constexpr double kSettledTolerances = 10;  // error of a settled motion, in units of rtol
constexpr int kCarriedRounds = 8;          // Newton iterations that move a carried state to the surface

Sampler::Sampler(const System& system, const Sampling& sampling)
    : sampling_(sampling),
      span_(sample_span(system.problem(), sampling)),
      evaluator_(system),
      system_(evaluator_.system()),
      step_(evaluator_),
      y_(static_cast<std::size_t>(system.size)),
      section_phase_(section_phase(system.problem(), sampling.level)),
      next_strobe_(span_.from),
      next_section_(span_.from) {
    motion_.accuracy = kSettledTolerances * system_.problem().solver.rtol;
    if (sampling.kind != SampleKind::peaks) return;
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    peaks_ = Peaks{};
    peaks_->extrema.fill({kInfinity, 0, -kInfinity, 0});
    peaks_->sample.fill(kNan);
}

void Sampler::resume(double t, const std::vector<double>& y, const Phase& phase) {
    system_.set_phase(phase);
    if (!phase.touching) left_ = true;
    motion_.end = {y, phase};
    hub_ = hub_at(t, y.data());
}

MotionSample Sampler::sample(double t, const double* y) {
    MotionSample out;
    out.fill(kNan);
    system_.set_state(t, y);
    out[kSampleTime] = t;
    out[kTheta] = system_.model().hub_angle();
    out[kThetaDot] = system_.model().hub_rate();
    out[kCamPhase] = turn_fraction(t / span_.period);
    if (system_.has_cam()) out[kCamAngle] = system_.cam().angle(t);
    return out;
}

void Sampler::evaluate(const SegmentInterval& s, double t) { s.segment->value(std::clamp(t, s.from, s.to), y_.data()); }

void Sampler::step(const SegmentInterval& s) {
    strobes(s);
    if (s.to >= span_.t_from()) {
        if (sampling_.kind == SampleKind::section) sections(s);
        const bool of_events = sampling_.kind == SampleKind::apexes || sampling_.kind == SampleKind::crossings;
        if (of_events && s.to > s.from) events(s);
        if (peaks_) raise_peaks(s);
    }
    evaluate(s, s.to);
    motion_.end.y = y_;
    const Hub before = std::exchange(hub_, hub_at(s.to, y_.data()));
    motion_.over_the_top = points_away(s, before, hub_);
}

Sampler::Hub Sampler::hub_at(double t, const double* y) {
    system_.set_state(t, y);
    return {system_.model().hub_angle(), system_.model().hub_rate()};
}

// The beam points away from the cam at an end of the interval, or at a turning point in it.                  (S80)
bool Sampler::points_away(const SegmentInterval& s, const Hub& before, const Hub& after) {
    const Problem& problem = system_.problem();
    if (!problem.cam || is_prescribed(problem.hub.drive)) return false;
    const auto away = [&](const Hub& hub) { return dot(unit(hub.angle), problem.cam->centre) < 0; };
    if (away(before) || away(after)) return true;
    if (!(before.rate * after.rate < 0)) return false;
    const auto hub = [&](double t) {
        evaluate(s, t);
        return hub_at(t, y_.data());
    };
    const auto rate = [&](double t) { return hub(t).rate; };
    return away(hub(find_root(rate, s.from, s.to, before.rate, after.rate)));
}

void Sampler::strobes(const SegmentInterval& s) {
    for (; next_strobe_ < span_.to; ++next_strobe_) {
        const double t = (static_cast<double>(next_strobe_) + kStrobePhase) * span_.period;
        if (s.ends_before(t)) return;
        evaluate(s, t);
        strobe(t, y_.data());
    }
}

void Sampler::strobe(double t, const double* y) {
    system_.set_state(t, y);
    motion_.strobes.push_back(
        {system_.model().hub_angle(), system_.model().hub_rate(), kept_impacts_, system_.phase().touching, left_});
    left_ = !system_.phase().touching;
}

void Sampler::sections(const SegmentInterval& s) {
    for (; next_section_ < span_.to; ++next_section_) {
        const double t = (static_cast<double>(next_section_) + section_phase_) * span_.period;
        if (s.ends_before(t)) return;
        evaluate(s, t);
        motion_.samples.push_back(sample(t, y_.data()));
    }
}

void Sampler::events(const SegmentInterval& s) {
    std::vector<double> times;
    if (sampling_.kind == SampleKind::apexes) {
        std::vector<Apex> apexes;
        find_apexes(step_, s, apexes);
        for (const Apex& apex : apexes) times.push_back(apex.t);
    } else {
        std::vector<LevelCrossing> crossings;
        find_crossings(step_, s, sampling_.channel, sampling_.level, crossings);
        for (const LevelCrossing& crossing : crossings)
            if (crossing.rises == sampling_.rising) times.push_back(crossing.t);
    }
    for (const double t : times) {
        if (!kept(t)) continue;
        evaluate(s, t);
        motion_.samples.push_back(sample(t, y_.data()));
    }
}

// Within the time that is kept.
void Sampler::raise_peaks(const SegmentInterval& s) {
    SegmentInterval part = s;
    part.from = std::max(s.from, span_.t_from());
    part.to = std::min(s.to, end());
    if (!(part.to > part.from)) return;
    Peaks& peaks = *peaks_;
    const double length = part.to - part.from, before = peaks.extrema[0].max;
    peaks.time += length;
    if (system_.phase().touching) peaks.touching += length;
    peaks.contact = system_.phase().touching ? peaks.contact + length : 0;
    peaks.longest = std::max(peaks.longest, peaks.contact);
    constexpr std::array kChannelsOfPeaks{Channel{ChannelKind::contact_force}, Channel{ChannelKind::stress_max},
                                          Channel{ChannelKind::gap}};
    raise_extrema(step_, part, kChannelsOfPeaks, peaks.extrema);
    if (!(peaks.extrema[0].max > std::max(before, 0.0))) return;
    evaluate(s, peaks.extrema[0].t_max);
    const double rebound = peaks.sample[kReboundPeak];
    peaks.sample = sample(peaks.extrema[0].t_max, y_.data());
    peaks.sample[kReboundPeak] = rebound;
}

void Sampler::finish_peaks() {
    Peaks& peaks = *peaks_;
    if (!(peaks.time > 0)) return;
    MotionSample& sample = peaks.sample;
    if (peaks.extrema[0].max > 0) sample[kForcePeak] = peaks.extrema[0].max;
    sample[kStressPeak] = peaks.extrema[1].max;
    sample[kGapPeak] = peaks.extrema[2].max;
    sample[kImpactCount] = static_cast<double>(kept_impacts_);
    sample[kDurationPeak] = peaks.longest;
    sample[kLiftShare] = 1 - peaks.touching / peaks.time;
    motion_.samples.push_back(sample);
}

SampledMotion Sampler::take() {
    if (peaks_) finish_peaks();
    return std::move(motion_);
}

// The end of summed-up chatter and a start in contact are touches without an approach: no impacts.
void Sampler::touch(double t, const std::vector<double>& y, const ContactState& contact) {
    impact_.reset();
    if (peaks_) peaks_->contact = 0;
    if (!(contact.gap_rate < 0) || t == 0) return;
    ++motion_.impacts;
    if (!kept(t)) return;
    ++kept_impacts_;
    if (sampling_.kind != SampleKind::impacts) return;
    impact_ = sample(t, y.data());
    (*impact_)[kContactX] = contact.x;
    (*impact_)[kNormalBefore] = contact.gap_rate;
    (*impact_)[kTangentialBefore] = contact.slip;
    motion_.samples.push_back(*impact_);
}

void Sampler::release(double t, const std::vector<double>&, const ContactState& contact) {
    left_ = true;
    if (peaks_ && kept(t)) {
        double& fastest = peaks_->sample[kReboundPeak];
        fastest = std::fmax(fastest, contact.gap_rate);  // of NaN and a number the number
    }
    if (!impact_) return;
    MotionSample& sample = motion_.samples.back();
    sample[kNormalAfter] = contact.gap_rate;
    sample[kTangentialAfter] = contact.slip;
    sample[kDuration] = t - sample[kSampleTime];
    impact_.reset();
}

SampledMotion sample_by_run(const Problem& problem, const Sampling& sampling, const InitialState* start,
                            const Progress& progress) {
    std::optional<Sampler> sampler;
    try {
        sampler.emplace(System(problem), sampling);
        Run run(problem, progress, {.start = start});
        run.add(*sampler);
        run.integrate();
    } catch (const SolverError& error) {
        SampledMotion motion = sampler->take();
        motion.failure = error.what();
        return motion;
    } catch (const StepFailure& failure) {  // the model itself
        SampledMotion motion;
        motion.failure = failure.what();
        return motion;
    }
    return sampler->take();
}

InitialState carried(const Problem& problem, const InitialState& end) {
    System system(problem);
    InitialState start = end;
    start.y.assign(static_cast<std::size_t>(system.size), 0.0);
    std::copy_n(end.y.begin(), std::min(end.y.size(), static_cast<std::size_t>(system.ledger_at)), start.y.begin());
    start.phase.gap_offset = 0;
    if (!problem.cam || is_prescribed(problem.hub.drive)) return start;
    const bool pressed_in = start.phase.touching && !start.phase.held;
    if (pressed_in) return start;
    system.set_phase({});
    double* y = start.y.data();
    const auto rate = static_cast<std::size_t>(system.coordinates());
    for (int round = 0; round < kCarriedRounds; ++round) {  // Newton's method for the angle
        const ContactState c = system.contact(0, y);
        if (!start.phase.held && c.gap >= 0) return start;
        const double lever = std::copysign(problem.hub.radius + c.x, cross(unit(y[0]), c.normal));
        y[0] -= c.gap / lever;
        if (start.phase.held) y[rate] -= c.gap_rate / lever;
    }
    return start;
}

}  // namespace beamcam::sim
