// Samples of a sweep against the recorders of the same run.
#include "sim/sweep/sampler.hpp"

#include <numbers>

#include "sim/sweep/sweep_point.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

constexpr double kTurns = 3;

Problem turning_cam(ModelKind model, ContactModel contact) {
    Problem p;
    p.beam.model = model;
    p.cam->speed = 12;
    p.cam->eccentricity = 0.005;
    p.contact.model = contact;
    p.contact.restitution = 0.5;
    return p;
}

Sampling sampling(SampleKind kind) {
    Sampling s;
    s.kind = kind;
    s.transient.turns = 0;
    s.keep.turns = kTurns;
    return s;
}

Result recorded(const Problem& p) { return run(p, kTurns * cam_period(p)); }

TEST(Sampler, TakesTheImpactsOfTheRecorder) {
    for (const ContactModel contact : {ContactModel::compliant, ContactModel::restitution})
        for (const ModelKind model : {ModelKind::rigid, ModelKind::first_order}) {
            const Problem p = turning_cam(model, contact);
            const SampledMotion motion = sample_by_run(p, sampling(SampleKind::impacts), nullptr, {});
            std::vector<Impact> impacts = recorded(p).impacts;
            std::erase_if(impacts, [](const Impact& i) { return !(i.v_n_before < 0); });
            ASSERT_EQ(motion.samples.size(), impacts.size());
            ASSERT_GT(impacts.size(), 3u);
            for (std::size_t i = 0; i < impacts.size(); ++i) {
                const MotionSample& sample = motion.samples[i];
                EXPECT_EQ(sample[kSampleTime], impacts[i].t_start);
                EXPECT_EQ(sample[kContactX], impacts[i].x);
                EXPECT_EQ(sample[kCamAngle], impacts[i].cam_angle);
                EXPECT_EQ(sample[kNormalBefore], impacts[i].v_n_before);
                EXPECT_EQ(sample[kTangentialBefore], impacts[i].v_t_before);
                if (!impacts[i].t_end) continue;
                EXPECT_EQ(sample[kNormalAfter], *impacts[i].v_n_after);
                EXPECT_EQ(sample[kDuration], *impacts[i].duration);
            }
        }
}

TEST(Sampler, TakesThePeaksOfTheRecorder) {
    const Problem p = turning_cam(ModelKind::first_order, ContactModel::compliant);
    const SampledMotion motion = sample_by_run(p, sampling(SampleKind::peaks), nullptr, {});
    ASSERT_EQ(motion.samples.size(), 1u);
    const MotionSample& sample = motion.samples[0];
    const double end = kTurns * cam_period(p);
    const std::vector<Impact> impacts = recorded(p).impacts;
    double rebound = 0, longest = 0, touching = 0;
    for (const Impact& i : impacts) {
        const double duration = i.t_end.value_or(end) - i.t_start;
        if (i.v_n_after) rebound = std::max(rebound, *i.v_n_after);
        longest = std::max(longest, duration);
        touching += duration;
    }
    const Extremum force = extremum(p, "contact_force", end);
    EXPECT_NEAR(sample[kForcePeak], force.max, 1e-5 * force.max);
    EXPECT_NEAR(sample[kSampleTime], force.t_max, 1e-7);
    const double stress = extremum(p, "stress_max", end).max, gap = extremum(p, "gap", end).max;
    EXPECT_NEAR(sample[kStressPeak], stress, 1e-5 * stress);
    EXPECT_NEAR(sample[kGapPeak], gap, 1e-5 * gap);
    EXPECT_EQ(sample[kReboundPeak], rebound);
    EXPECT_EQ(sample[kImpactCount], static_cast<double>(impacts.size()));
    EXPECT_NEAR(sample[kDurationPeak], longest, 1e-12);
    EXPECT_NEAR(sample[kLiftShare], 1 - touching / end, 1e-9);
}

// Only the kept time counts: the first impact is the hardest.
TEST(Sampler, TakesThePeaksAfterTheTransient) {
    const Problem p = turning_cam(ModelKind::first_order, ContactModel::compliant);
    Sampling late = sampling(SampleKind::peaks);
    late.transient.turns = 1;
    late.keep.turns = 2;
    const SampledMotion motion = sample_by_run(p, late, nullptr, {});
    ASSERT_EQ(motion.samples.size(), 1u);
    double force = 0;
    for (const Impact& i : recorded(p).impacts)
        if (i.t_start > cam_period(p)) force = std::max(force, *i.force_peak);
    EXPECT_NEAR(motion.samples[0][kForcePeak], force, 1e-5 * force);
    EXPECT_LT(force, extremum(p, "contact_force", cam_period(p)).max);
}

TEST(Sampler, TakesTheApexesOfTheRecorder) {
    const Problem p = turning_cam(ModelKind::first_order, ContactModel::compliant);
    const SampledMotion motion = sample_by_run(p, sampling(SampleKind::apexes), nullptr, {});
    const std::vector<Apex> apexes = recorded(p).apexes;
    ASSERT_EQ(motion.samples.size(), apexes.size());
    ASSERT_GT(apexes.size(), 3u);
    for (std::size_t i = 0; i < apexes.size(); ++i) {
        EXPECT_EQ(motion.samples[i][kSampleTime], apexes[i].t);
        EXPECT_NEAR(motion.samples[i][kThetaDot], 0, 1e-9);
    }
}

TEST(Sampler, TakesCrossingsOfAnyChannelInTheirDirection) {
    const Problem p = turning_cam(ModelKind::first_order, ContactModel::compliant);
    Sampling s = sampling(SampleKind::crossings);
    s.channel = channel("tip_deflection");
    s.level = 2e-5;
    const SampledMotion up = sample_by_run(p, s, nullptr, {});
    s.rising = false;
    const SampledMotion down = sample_by_run(p, s, nullptr, {});
    ASSERT_GT(up.samples.size(), 10u);
    EXPECT_NEAR(static_cast<double>(up.samples.size()), static_cast<double>(down.samples.size()), 1);
    std::vector<double> times;
    for (const MotionSample& sample : up.samples) times.push_back(sample[kSampleTime]);
    for (const double value : series(p, "tip_deflection", times)) EXPECT_NEAR(value, 2e-5, 1e-11);
}

TEST(Sampler, TakesOneSectionATurnAtTheCamAngle) {
    const Problem p = turning_cam(ModelKind::first_order, ContactModel::compliant);
    Sampling s = sampling(SampleKind::section);
    s.level = 1;
    const SampledMotion motion = sample_by_run(p, s, nullptr, {});
    ASSERT_EQ(motion.samples.size(), 3u);
    for (const MotionSample& sample : motion.samples) {
        EXPECT_NEAR(std::cos(sample[kCamAngle] - 1), 1, 1e-12);
        EXPECT_EQ(sample[kTheta], series(p, "theta", {sample[kSampleTime]})[0]);
    }
    EXPECT_EQ(motion.strobes.size(), 3u);
}

TEST(Sampler, KeepsNothingOfTheTransient) {
    const Problem p = turning_cam(ModelKind::rigid, ContactModel::restitution);
    Sampling all = sampling(SampleKind::impacts), late = all;
    late.transient.turns = 2;
    late.keep.turns = 1;
    const SampledMotion whole = sample_by_run(p, all, nullptr, {}), rest = sample_by_run(p, late, nullptr, {});
    std::size_t i = whole.samples.size() - rest.samples.size();
    for (const MotionSample& sample : rest.samples) EXPECT_EQ(sample[kSampleTime], whole.samples[i++][kSampleTime]);
    EXPECT_EQ(whole.impacts, rest.impacts);
    EXPECT_EQ(whole.end.y, rest.end.y);
}

TEST(Sampler, RoundsATimeUpToWholeTurns) {
    Problem p = turning_cam(ModelKind::rigid, ContactModel::restitution);
    Sampling s;
    s.transient.time = 10.1 * cam_period(p);
    s.keep.time = 3 * cam_period(p);
    const SampleSpan span = sample_span(p, s);
    EXPECT_EQ(span.from, 11);
    EXPECT_EQ(span.to, 14);
    p.cam->speed = 0;
    EXPECT_EQ(sample_span(p, s).period, 1);
}

// A motion that continues another one equals the longer motion.
TEST(Sampler, GoesOnFromTheEndOfAnother) {
    for (const ModelKind model : {ModelKind::rigid, ModelKind::first_order}) {
        const Problem p = turning_cam(model, ContactModel::compliant);
        Sampling both = sampling(SampleKind::section), half = both;
        both.keep.turns = 2;
        half.keep.turns = 1;
        const SampledMotion whole = sample_by_run(p, both, nullptr, {}), first = sample_by_run(p, half, nullptr, {});
        const InitialState start = carried(p, first.end);
        const SampledMotion second = sample_by_run(p, half, &start, {});
        ASSERT_EQ(whole.samples.size(), 2u);
        EXPECT_NEAR(second.samples.at(0)[kTheta], whole.samples[1][kTheta], 1e-6);
    }
}

TEST(Sampler, PutsACarriedBeamOnACamThatHasGrown) {
    Problem p = turning_cam(ModelKind::rigid, ContactModel::restitution);
    Sampling s = sampling(SampleKind::section);
    p.cam->speed = 2;
    const SampledMotion rest = sample_by_run(p, s, nullptr, {});
    ASSERT_TRUE(rest.end.phase.held);
    p.cam->radius = 0.11;
    const InitialState start = carried(p, rest.end);
    System system(p);
    const ContactState c = system.contact(0, start.y.data());
    EXPECT_NEAR(c.gap, 0, 1e-14);
    EXPECT_NEAR(c.gap_rate, 0, 1e-14);
}

TEST(Sampler, EndsWhereTheBeamPointsAwayFromTheCam) {
    Problem p = turning_cam(ModelKind::rigid, ContactModel::compliant);
    p.initial.angular_velocity = 8;
    const SampledMotion motion = sample_by_run(p, sampling(SampleKind::impacts), nullptr, {});
    EXPECT_TRUE(motion.over_the_top);
    EXPECT_EQ(classify(p, motion).kind, AttractorClass::over_the_top);
}

TEST(MotionFrom, IsTheRestOfALongerMotion) {
    std::size_t impacts = 0;
    for (const ContactModel contact : {ContactModel::compliant, ContactModel::restitution})
        for (const ModelKind model : {ModelKind::rigid, ModelKind::first_order}) {
            const Problem p = turning_cam(model, contact);
            const SweepPoint point = sweep_point(p, sampling(SampleKind::impacts), nullptr, {});
            const double end = kTurns * cam_period(p);
            Sampling two = sampling(SampleKind::impacts);
            two.transient.turns = 0;
            two.keep.turns = 2;
            const std::vector<MotionSample> rest = sweep_point(p, two, &point.motion.end, {}).motion.samples;
            std::vector<Impact> whole = run(p, end + 2 * cam_period(p)).impacts;
            // The end of summed-up chatter has no approach, and no sample.
            std::erase_if(whole, [&](const Impact& i) { return i.t_start <= end || !(i.v_n_before < 0); });
            impacts += whole.size();
            ASSERT_EQ(rest.size(), whole.size());
            for (std::size_t i = 0; i < whole.size(); ++i) {
                EXPECT_NEAR(rest[i][kSampleTime], whole[i].t_start - end, 1e-6);  // steps differ: grown tolerance
                EXPECT_NEAR(rest[i][kNormalBefore], whole[i].v_n_before, 1e-5);
                EXPECT_NEAR(std::remainder(rest[i][kCamAngle] - whole[i].cam_angle, 2 * std::numbers::pi), 0, 1e-5);
            }
        }
    EXPECT_GT(impacts, 8u);
}

}  // namespace
}  // namespace beamcam::sim::testing
