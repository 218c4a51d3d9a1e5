// Channels within the steps of a motion: estimates against true values, and samples of a contact against its law.
#include "sim/observe/step_channels.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "sim/run/run.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim {
namespace {

using namespace testing;

// Visits every step of a motion, with its channels.
template <class Visit>
class EachStep final : public MotionObserver {
  public:
    EachStep(const Problem& problem, Visit visit) : system_(problem), step_(system_), visit_(std::move(visit)) {}
    double end() const override { return 0; }
    void resume(double, const std::vector<double>&, const Phase& phase) override { step_.set_phase(phase); }
    void segment(const SegmentInterval& s) override {
        step_.begin(s);
        visit_(s, step_);
    }
    void touch(double, const std::vector<double>&, const ContactState&) override {}
    void release(double, const std::vector<double>&, const ContactState&) override {}
    bool done() const override { return false; }

  private:
    System system_;
    StepChannels step_;
    Visit visit_;
};

template <class Visit>
void visit_steps(const Problem& p, double end, Visit visit) {
    EachStep<Visit> observer(p, std::move(visit));
    Request request;
    request.end_time = end;
    RunOptions options;
    options.observer = &observer;
    const Progress silent;  // `run` refers to it
    Run run(p, {&request, 1}, silent, options);
    run.integrate();
}

Problem on_fast_cam(ContactModel contact, ModelKind model, int modes) {
    Problem p;
    p.beam.model = model;
    p.beam.modes = modes;
    p.cam->speed = 10;
    p.contact.model = contact;
    return p;
}

TEST(StepChannels, EstimatesKeepTheirError) {
    constexpr int kInstants = 50;
    constexpr double kSlack = 1 + 1e-9;
    for (const auto& [model, kind] : {std::pair{ContactModel::restitution, ModelKind::first_order},
                                      {ContactModel::compliant, ModelKind::first_order},
                                      {ContactModel::restitution, ModelKind::second_order},
                                      {ContactModel::compliant, ModelKind::exact}}) {
        SCOPED_TRACE(name(kind));
        const Problem p = on_fast_cam(model, kind, kind == ModelKind::exact ? 4 : 8);
        double largest = 0, error = 0;  // of the separation
        visit_steps(p, 0.4, [&](const SegmentInterval& s, StepChannels& step) {
            for (const auto* name : {"tip_deflection", "tip_rate", "separation", "separation_paper"}) {
                const Channel c = channel(name);
                const double most = kSlack * step.modes().estimate_error(c);
                for (int k = 0; k <= kInstants; ++k) {
                    const double t = s.from + (s.to - s.from) * k / kInstants;
                    const double value = step.value(s, c, t), estimate = step.estimate(s, c, t);
                    for (const double sign : {1.0, -1.0})
                        EXPECT_LE(sign * value, std::max(0.0, sign * estimate) + most) << name << " at " << t;
                    if (!traits(c.kind).separation) continue;
                    largest = std::max(largest, std::fabs(value));
                    error = std::max(error, most);
                }
                const StepChannels::Samples samples = step.estimates(s, c);
                for (std::size_t k = 0; k < samples.size(); ++k)
                    EXPECT_NEAR(samples[k], step.estimate(s, c, sample_time(s, k)),
                                1e-8 * (most + std::fabs(samples[k])));
                const Variation variation = step.variation_of_modes(s, c, samples);
                for (std::size_t k = 0; k + 1 < samples.size(); ++k) {
                    const double from = sample_time(s, k), length = sample_time(s, k + 1) - from;
                    const double stray = kSlack * variation.strays(length) + 1e-8 * (most + std::fabs(samples[k]));
                    for (const double share : {0.25, 0.5, 0.8})
                        EXPECT_NEAR(step.estimate(s, c, from + share * length),
                                    samples[k] + share * (samples[k + 1] - samples[k]), stray)
                            << name << " at " << from;
                }
            }
        });
        EXPECT_LT(error, 0.05 * largest);
    }
}

// Also where the beam bends as far as its model holds, or reaches behind the axis.
TEST(StepChannels, TheFootOfTheContactIsWithinItsBounds) {
    constexpr int kInstants = 30;
    constexpr double kEverywhere = 1e9, kRounding = 1e-12;
    for (const ModelKind kind : {ModelKind::first_order, ModelKind::second_order, ModelKind::exact})
        for (const double radius : {0.1, -0.05}) {
            SCOPED_TRACE(std::string(name(kind)) + " " + std::to_string(radius));
            Problem p;
            p.beam.model = kind;
            p.beam.modes = 4;
            p.hub.radius = radius;
            p.hub.inertia = 0.01;
            p.cam->speed = 10;
            p.initial.q = {kind == ModelKind::exact ? 0.2 : 0.03, kind == ModelKind::exact ? -0.05 : 0.01};
            visit_steps(p, 0.2, [&](const SegmentInterval& s, StepChannels& step) {
                const ModalChannels::Range bounds =
                    step.modes().within(ChannelKind::contact_x, {-kEverywhere, kEverywhere});
                for (int k = 0; k <= kInstants; ++k) {
                    const double t = s.from + (s.to - s.from) * k / kInstants,
                                 foot = step.value(s, {ChannelKind::contact_x}, t);
                    EXPECT_GE(foot, bounds.low - kRounding) << t;
                    EXPECT_LE(foot, bounds.high + kRounding) << t;
                }
            });
        }
}

// So the extrema of a channel without bounds of its own are found by samples.
TEST(StepChannels, APolynomialFollowsEveryChannelInShortParts) {
    constexpr double kRounding = 1e-9;
    for (const auto& [model, kind] : {std::pair{ContactModel::restitution, ModelKind::first_order},
                                      {ContactModel::compliant, ModelKind::first_order},
                                      {ContactModel::compliant, ModelKind::exact}}) {
        SCOPED_TRACE(name(kind));
        const Problem p = on_fast_cam(model, kind, kind == ModelKind::exact ? 3 : 6);
        std::map<std::string, double> largest;
        visit_steps(p, 0.32, [&](const SegmentInterval& s, StepChannels& step) {
            const std::vector<SegmentInterval> parts = step.followed_parts(s);
            EXPECT_EQ(parts.front().from, s.from);
            EXPECT_EQ(parts.back().to, s.to);
            for (std::size_t i = 0; i < parts.size(); i += std::max<std::size_t>(1, parts.size() / 4)) {
                const SegmentInterval& part = parts[i];
                step.begin(part);
                for (const auto* name : {"theta", "theta_dot", "tip_deflection", "tip_rate", "q1", "gap", "contact_x",
                                         "contact_force", "energy_kinetic", "energy_elastic", "separation"}) {
                    const Channel c = channel(name);
                    const StepChannels::Samples samples = step.sample(part, c);
                    for (const double value : samples) largest[name] = std::max(largest[name], std::fabs(value));
                    const Variation variation = step.variation(part, c, samples);
                    for (std::size_t k = 0; k + 1 < samples.size(); ++k) {
                        const double from = sample_time(part, k), length = sample_time(part, k + 1) - from;
                        const double stray = variation.strays(length) + kRounding * largest[name];
                        for (const double share : {0.25, 0.5, 0.8})
                            EXPECT_NEAR(step.value(part, c, from + share * length),
                                        samples[k] + share * (samples[k + 1] - samples[k]), stray)
                                << name << " at " << from << " of " << s.from << " to " << s.to;
                    }
                }
            }
            step.begin(s);
        });
    }
}

// Where the state of a bristle ends, the end of a step is moved without solving the step again.
TEST(StepChannels, SamplesOfAContactFollowItsLaw) {
    Problem p;
    p.beam.modes = 4;
    p.contact.friction = StickSlipFriction{0.3, {}, {}};
    int moved = 0;
    visit_steps(p, 0.45, [&](const SegmentInterval& s, StepChannels& step) {
        const TouchSamples* touch = s.segment->touch();
        if (!touch || s.to != s.segment->t1) return;
        if (touch->ending == TouchSamples::Ending::friction) ++moved;
        for (const int k : {0, TouchSamples::kCount - 1}) {
            const double t = touch->t[k], force = step.value(s, channel("contact_force"), t);
            EXPECT_NEAR(touch->force[k], force, 1e-9 * (1 + force)) << t;
            EXPECT_NEAR(touch->friction[k], step.value(s, channel("friction_force"), t), 1e-9 * (1 + force)) << t;
        }
    });
    EXPECT_GT(moved, 3);
}

}  // namespace
}  // namespace beamcam::sim
