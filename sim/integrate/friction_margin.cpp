#include "sim/integrate/friction_margin.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/numerics.hpp"
#include "sim/integrate/step_polynomial.hpp"

namespace beamcam::sim {

constexpr int kPartsBetweenNodes = 4;  // in which a polynomial of degree seven has no more than one extremum

FrictionMargin::FrictionMargin(const NodalStep& step, const ContactStep& contact) : h_(step.segment.h) {
    const FrictionLaw& friction = step.system.friction();
    const FrictionStep& bristle = contact.friction();
    const ContactKinematics<Lanes>& nodes = contact.load.contact;
    const StepPolynomial acceleration = StepPolynomial::through(nodes.gap_rate).derivative(h_);
    const auto margin = [&](int k, double gap, double gap_rate, double slip, double z, double radius) {
        const ForceAndSlopes f = step.system.normal_law().at(radius).linearized(-gap, -gap_rate, contact.approach);
        const double growth = -f.by_depth * gap_rate - f.by_rate * acceleration(2 * (time(k) / h_) - 1);
        at_[static_cast<std::size_t>(k)] = friction.margin(bristle.state(), f.force, growth, slip, z);
    };
    margin(0, contact.start.gap, contact.start.gap_rate, contact.start.slip, bristle.start(), contact.start.radius);
    for (int k = 0; k < kNodes; ++k)
        margin(k + 1, nodes.gap[k], nodes.gap_rate[k], nodes.slip[k], bristle.deflection()[k], nodes.radius[k]);
    const double z = step.system.bristle(step.next.data());
    margin(kNodes + 1, contact.end.gap, contact.end.gap_rate, contact.end.slip, z, contact.end.radius);
    deep_ = 0;
    for (const double m : at_) deep_ = std::max(deep_, kNegligible * std::fabs(m));
}

double FrictionMargin::time(int k) const { return k == 0 ? 0 : k > kNodes ? h_ : h_ * Collocation::get().c[k - 1]; }

double FrictionMargin::end(bool smooth, bool ended) const {
    Lanes nodes;
    for (int k = 0; k < kNodes; ++k) nodes[k] = at_[static_cast<std::size_t>(k) + 1];
    const StepPolynomial between = StepPolynomial::through(nodes);
    const auto inside = [&](double t) { return between(2 * (t / h_) - 1); };
    bool lasts = at_[0] > deep_;
    for (int k = 1; k <= (ended ? kNodes : kNodes + 1); ++k) {
        const double t0 = time(k - 1), t1 = time(k);
        const double before = at_[static_cast<std::size_t>(k) - 1], now = at_[static_cast<std::size_t>(k)];
        const bool resolved = smooth && k > 1 && k <= kNodes;
        if (lasts && now < -deep_)
            return resolved ? find_root(inside, t0, t1, before, now) : t0 + (t1 - t0) * before / (before - now);
        for (int i = 1; resolved && lasts && i < kPartsBetweenNodes; ++i) {
            const double t = t0 + (t1 - t0) * i / kPartsBetweenNodes, dip = inside(t);
            if (dip < -deep_) return find_root(inside, t0, t, before, dip);
        }
        lasts = lasts || now > deep_;
    }
    return kNoSolution;
}

double FrictionMargin::to_zero() const {
    const double end = at_[kNodes + 1], last = at_[kNodes];
    return -end * (h_ - time(kNodes)) / (end - last);
}

}  // namespace beamcam::sim
