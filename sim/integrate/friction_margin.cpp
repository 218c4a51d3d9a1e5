#include "sim/integrate/friction_margin.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/numerics.hpp"
#include "sim/integrate/constants.hpp"

namespace beamcam::sim {
namespace {

// Derivatives by s in [0, 1] of the polynomial with these nodal values: at the start, the nodes and the end.
std::array<double, kNodes + 2> slopes(const Lanes& nodal) {
    const Collocation& gauss = Collocation::get();
    Lanes inside{};
    double first = 0, last = 0;
    for (int l = 0; l < kNodes; ++l) {
        const auto row = static_cast<std::size_t>(l);
        inside += nodal[l] * gauss.slope[row];
        first += nodal[l] * gauss.derive[0][1][l];
        last -= nodal[l] * gauss.derive[0][1][kNodes - 1 - l];
    }
    std::array<double, kNodes + 2> out;
    out.front() = first;
    for (int k = 0; k < kNodes; ++k) out[static_cast<std::size_t>(k) + 1] = inside[k];
    out.back() = last;
    return out;
}

struct Polynomial {
    double c[kNodes];  // of (2s − 1)ʲ
    explicit Polynomial(const double* nodal) {
        for (std::size_t j = 0; j < kNodes; ++j) {
            c[j] = 0;
            for (int k = 0; k < kNodes; ++k) c[j] += Collocation::get().monomial[j][k] * nodal[k];
        }
    }
    double operator()(double s) const {
        double value = 0;
        for (int j = kNodes; j-- > 0;) value = value * (2 * s - 1) + c[j];
        return value;
    }
};

}  // namespace

FrictionMargin::FrictionMargin(const NodalStep& step, const ContactStep& contact) : h_(step.segment.h) {
    const FrictionLaw& friction = step.system.friction();
    const BristleStep& bristle = contact.bristle();
    const ContactKinematics<Lanes>& nodes = contact.load.contact;
    const std::array<double, kCount> acceleration = slopes(nodes.gap_rate);
    const auto margin = [&](std::size_t k, double gap, double gap_rate, double slip, double z) {
        const ForceAndSlopes f = step.system.normal_law().linearized(-gap, -gap_rate, contact.approach);
        const double growth = -f.by_depth * gap_rate - f.by_rate * acceleration[k] / h_;
        at_[k] = friction.margin(bristle.state(), f.force, growth, slip, z);
    };
    margin(0, contact.start.gap, contact.start.gap_rate, contact.start.slip, bristle.start());
    for (int k = 0; k < kNodes; ++k)
        margin(static_cast<std::size_t>(k) + 1, nodes.gap[k], nodes.gap_rate[k], nodes.slip[k],
               bristle.deflection()[k]);
    const double z = step.system.bristle(step.next.data());
    margin(kNodes + 1, contact.end.gap, contact.end.gap_rate, contact.end.slip, z);
    deep_ = 0;
    for (const double m : at_) deep_ = std::max(deep_, kMarginRounding * std::fabs(m));
}

double FrictionMargin::time(int k) const { return k == 0 ? 0 : k > kNodes ? h_ : h_ * Collocation::get().c[k - 1]; }

double FrictionMargin::end(bool smooth, bool ended) const {
    const Polynomial between(at_.data() + 1);
    const auto inside = [&](double t) { return between(t / h_); };
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
