// The dissipation laws of compliant contact, one table row each: the name, and the factor D of F = K δⁿ (1 + D δ̇/δ̇₋)
// as a function of the pre-set restitution c. MODEL.md (S31).
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "sim/base/assert.hpp"
#include "sim/base/numerics.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim {
namespace {

// For D below this the restitution equation is evaluated by its series: the closed form would cancel.
constexpr double kSeriesFactor = 0.02;
constexpr double kPoleMargin = 1e-15;  // of 1/c or 1/D, where the logarithm of that equation diverges

// {D(1+e) − ln[(1+D)/(1−eD)]}/D², whose zero relates the factor D and the effective restitution e    (S31)
double restitution_residual(double d, double e) {
    if (d > kSeriesFactor) return (d * (1 + e) - std::log1p(d) + std::log1p(-e * d)) / (d * d);
    // Σ_{k≥2} Dᵏ⁻²[(−1)ᵏ − eᵏ]/k; ten terms reach rounding.
    double sum = 0.5 * (1 - e) * (1 + e), power = 1, ek = e * e;
    for (int k = 3; k <= 11; ++k) {
        power *= d;
        ek *= e;
        sum += power * ((k % 2 ? -1.0 : 1.0) - ek) / k;
    }
    return sum;
}

// The law whose effective restitution equals c. The residual is (1 − c²)/2 > 0 at D = 0 and −∞ at D = 1/c.
double zhang_sharf_factor(double c) {
    if (c >= 1) return 0;
    const auto f = [c](double d) { return restitution_residual(d, c); };
    const double top = (1 - kPoleMargin) / c;
    return f(top) < 0 ? find_root(f, 0.0, top) : top;
}

struct LawRow {
    Named<DampingLaw> law;
    double (*factor)(double c);
};
constexpr LawRow kLaws[] = {
    {{DampingLaw::none, "none"}, [](double) { return 0.0; }},
    {{DampingLaw::hunt_crossley, "hunt-crossley"}, [](double c) { return 1.5 * (1 - c); }},
    {{DampingLaw::lankarani_nikravesh, "lankarani-nikravesh"}, [](double c) { return 0.75 * (1 - c * c); }},
    {{DampingLaw::herbert_mcwhannell, "herbert-mcwhannell"},
     [](double c) { return 6 * (1 - c) / ((2 * c - 1) * (2 * c - 1) + 3); }},
    {{DampingLaw::lee_wang, "lee-wang"}, [](double c) { return 0.75 * (1 - c); }},
    {{DampingLaw::gonthier, "gonthier"}, [](double c) { return (1 - c * c) / c; }},
    {{DampingLaw::flores, "flores"}, [](double c) { return 8 * (1 - c) / (5 * c); }},
    {{DampingLaw::hu_guo, "hu-guo"}, [](double c) { return 1.5 * (1 - c) / c; }},
    {{DampingLaw::zhang_sharf, "zhang-sharf"}, zhang_sharf_factor},
};

}  // namespace

std::span<const Named<DampingLaw>> names(DampingLaw) {
    static constexpr auto kNames = [] {
        std::array<Named<DampingLaw>, std::size(kLaws)> all{};
        std::ranges::transform(kLaws, all.begin(), &LawRow::law);
        return all;
    }();
    return kNames;
}

double damping_factor(DampingLaw law, double c) {
    BEAMCAM_ASSERT(c >= 0 && c <= 1);
    return std::ranges::find(kLaws, law, [](const LawRow& row) { return row.law.value; })->factor(c);
}

// The residual is >= 0 at e = 0, and negative at e = 1 or, for D >= 1, at the pole e = 1/D.
double effective_restitution(DampingLaw law, double c) {
    const double d = damping_factor(law, c);
    if (d == 0) return 1;
    if (!std::isfinite(d)) return 0;
    const auto f = [d](double e) { return restitution_residual(d, e); };
    const double top = d < 1 ? 1 : (1 - kPoleMargin) / d;
    return f(top) < 0 ? find_root(f, 0.0, top) : top;
}

}  // namespace beamcam::sim
