#include "sim/integrate/oscillator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/base/assert.hpp"

namespace beamcam::sim {
namespace {

constexpr double kSlowestOscillator = 1e-6;  // [rad/s] slower ones hardly have a period: no inverse of it
// ζ from which the two decays are treated separately; below, they are too close to each other.
constexpr double kTwoDecays = 1.02;
constexpr double kMostDampingInLanes = 0.5;  // the largest ζ of oscillators whose responses share lanes
constexpr double kSeriesRadians = 2;         // [rad], or decays, up to which responses come from their series
// In sustained contact, vibration that turns by more radians in a step is projected, unless its ζ is larger; growth by
// it begins at 14.                                                                                        (S52c)
constexpr double kAliasedRadians = 7, kMostDampingOfProjected = 0.1;

// Phases beyond lose digits in their reduction; there each response is computed by itself.
constexpr double kMostRadians = 1e5;
constexpr int kSeriesTerms = 18;  // of the last two responses, for ωτ < kSeriesRadians

// The responses downwards from the series of the last two: g_j = Σ_k a_k τ^{j+2+k}/(j+2+k)!, a₀ = 1, a₁ = −2γ,
// a_k = −2γ a_{k−1} − ω² a_{k−2}; carried as a_k τᵏ, which stays small where a_k alone would overflow.
void descend(double w2, double damping, double tau, const double* power, double* r) {
    for (const int j : {kNodes - 1, kNodes - 2}) {
        double term = power[j + 2], before = 0, a = 1, total = 0;
        for (int k = 0; k < 24; ++k) {
            total += a * term;
            const double next = -(damping * tau) * a - (w2 * tau) * tau * before;
            before = a;
            a = next;
            term /= j + 3 + k;
            if (std::fabs(a * term) + std::fabs(before * term) <= 1e-18 * std::fabs(total)) break;
        }
        r[2 + j] = total;
    }
    for (int j = kNodes - 2; j > 0; --j) r[1 + j] = power[j + 1] - damping * r[2 + j] - w2 * r[3 + j];
}

// The nearest integer, for |x| < 2⁵¹.
BEAMCAM_INLINE Lanes nearest(const Lanes& x) {
    constexpr double kInteger = 0x1.8p52;
    return (x + kInteger) - kInteger;
}

// sin z and cos z for 0 <= z <= kMostRadians, to about an ulp: π/2 in three parts, of which the first two have 33 bits
// so that their multiples are exact (as fdlibm has it), then Taylor's series on |r| <= π/4. Branches are products with
// 0 and 1, which are exact.
void sine_and_cosine_of_phase(const Lanes& z, Lanes& sine, Lanes& cosine) {
    constexpr double kFirst = 0x1.921fb544p+0, kSecond = 0x1.0b4611a6p-34, kRest = 0x1.3198a2e037073p-69;
    const Lanes k = nearest(z * 0.63661977236758134);
    Lanes s, c;
    sine_and_cosine_by_series(((z - k * kFirst) - k * kSecond) - k * kRest, s, c);
    // k mod 4 = 2 half + odd.
    const Lanes turns = k * 0.25, twice = 2 * (turns - nearest(turns - 0.375)), half = nearest(twice - 0.25),
                odd = 2 * (twice - half), even = 1 - odd;
    sine = (1 - 2 * half) * (odd * c + even * s);
    cosine = (1 - 2 * (half + odd - 2 * half * odd)) * (odd * s + even * c);
}

// The last two responses by their series, the others downwards from them.
void descend(const OscillatorLanes& group, const double* power, Lanes* out) {
    Lanes top{}, next_to_top{}, a = Lanes{} + 1.0, before{};
    for (int k = 0; k < kSeriesTerms; ++k) {
        top += a * power[kNodes + 1 + k];
        next_to_top += a * power[kNodes + k];
        const Lanes next = -(group.damping * a) - group.square * before;
        before = a;
        a = next;
    }
    out[kNodes - 1] = top;
    out[kNodes - 2] = next_to_top;
    for (int j = kNodes - 3; j >= 0; --j)
        out[j] = power[j + 2] - group.damping * out[j + 1] - group.square * out[j + 2];
}

// ∫₀^τ e^{−r(τ−u)} u^{k−1}/(k−1)! du = ψ_k(rτ) τᵏ/k!, k = 1…8: ψ₁(x) = (1 − e^{−x})/x, ψ_{k+1} = (k+1)(1 − ψ_k)/x,
// upwards where x is large and downwards, from the series of the last, where it is small.
void scaled_phi_functions(double x, double* psi) {
    if (x >= kSeriesRadians) {
        psi[0] = -std::expm1(-x) / x;
        for (int k = 1; k < kNodes; ++k) psi[k] = (k + 1) * (1 - psi[k - 1]) / x;
        return;
    }
    double total = 0, term = 1;
    for (int k = 1; k < 24; ++k) {
        total += term;
        term *= -x / (kNodes + k);
    }
    psi[kNodes - 1] = total;
    for (int k = kNodes - 1; k > 0; --k) psi[k - 1] = 1 - x * psi[k] / (k + 1);
}

// The responses as the difference of two decays.                                                          (S52a)
void respond_by_decays(const Decays& d, const double* power, double tau, double* r) {
    double slow[kNodes], fast[kNodes];
    scaled_phi_functions(d.slow * tau, slow);
    scaled_phi_functions(d.fast * tau, fast);
    for (int j = 0; j < kNodes; ++j) r[2 + j] = power[j + 1] * (slow[j] - fast[j]) / d.apart();
}

// q and v at a point of a step, over the nodal forcing, of the polynomial motion that follows it.               (S52c)
void follow_forcing(const Oscillator& o, const StepTable::Powers& inverse, std::size_t point, Lanes& q, Lanes& v) {
    const std::array<Lanes, kNodes>& derive = Collocation::get().derive[point];
    const std::array<double, kNodes> c = following(o);
    q = v = Lanes{};
    for (std::size_t j = 0; j < kNodes; ++j) {
        q += (c[j] * inverse[j]) * derive[j];
        if (j + 1 < kNodes) v += (c[j] * inverse[j + 1]) * derive[j + 1];
    }
}

// 1/hʲ
StepTable::Powers inverse_powers(double h) {
    StepTable::Powers inverse{1};
    for (std::size_t j = 1; j < kNodes; ++j) inverse[j] = inverse[j - 1] / h;
    return inverse;
}

}  // namespace

bool hardly_damped(const Oscillator& o) { return o.gamma <= kMostDampingOfProjected * o.omega; }

std::array<double, kNodes> following(const Oscillator& o) {
    const double w2 = o.omega * o.omega;
    std::array<double, kNodes> out;
    double c = 1 / w2, before = 0;
    for (double& each : out) {
        each = c;
        before = std::exchange(c, -(2 * o.gamma * c + before) / w2);
    }
    return out;
}

bool decays(const Oscillator& o) { return o.gamma > kTwoDecays * o.omega; }

Decays decays_of(const Oscillator& o) {
    const double fast = o.gamma + std::sqrt((o.gamma - o.omega) * (o.gamma + o.omega));
    return {o.omega * (o.omega / fast), fast};
}

// With g_j the responses (g₋₁ = s, g₋₂ = ṡ, ġ_j = g_{j−1}) the equation of motion itself is the recursion     (S52)
//   g_{j−1} + 2γ g_j + ω² g_{j+1} = τ^{j+1}/(j+1)!,
// stable upwards where ωτ is large and downwards, from the series of the last two, where it is small.
void respond(const Oscillator& o, double tau, double* r) {
    const double w2 = o.omega * o.omega, damping = 2 * o.gamma;
    const double turning = o.gamma == 0 ? o.omega : std::sqrt(std::fabs(w2 - o.gamma * o.gamma));
    const bool vibrates = o.gamma <= o.omega, apart = decays(o);
    double s, ds;
    if (!apart && turning * tau < 1e-4) {
        // Down to no stiffness at all: decay is as slow.
        const double z = turning * tau, decay = std::exp(-o.gamma * tau), z2 = vibrates ? z * z : -z * z;
        s = tau * (1 - z2 / 6) * decay;
        ds = (1 - 0.5 * z2) * decay - o.gamma * s;
    } else if (vibrates) {
        const double decay = o.gamma == 0 ? 1 : std::exp(-o.gamma * tau);
        s = decay * std::sin(turning * tau) / turning;
        ds = decay * std::cos(turning * tau) - o.gamma * s;
    } else {
        const Decays d = decays_of(o);
        const double slow = std::exp(-d.slow * tau);
        s = -slow * std::expm1(-d.apart() * tau) / d.apart();
        ds = (d.fast * std::exp(-d.fast * tau) - d.slow * slow) / d.apart();
    }
    r[0] = ds;
    r[1] = s;
    double power[kNodes + 3];  // τʲ/j!
    power[0] = 1;
    for (int j = 1; j < kNodes + 3; ++j) power[j] = power[j - 1] * (tau / j);
    const double reach = (apart ? decays_of(o).fast : o.omega) * tau;
    // Near critical damping the recursion upwards loses more.
    if (reach < (!apart && o.gamma > kMostDampingInLanes * o.omega ? 2 * kSeriesRadians : kSeriesRadians))
        return descend(w2, damping, tau, power, r);
    if (apart) return respond_by_decays(decays_of(o), power, tau, r);
    const double inverse = 1 / w2;
    for (int j = -1; j + 1 < kNodes; ++j) r[3 + j] = (power[j + 1] - damping * r[2 + j] - r[1 + j]) * inverse;
}

std::vector<OscillatorLanes> pack_oscillators(const std::vector<Oscillator>& oscillators) {
    std::vector<OscillatorLanes> groups((oscillators.size() + kNodes - 1) / kNodes);
    for (std::size_t i = 0; i < groups.size() * kNodes; ++i) {
        const Oscillator& o = oscillators[std::min(i, oscillators.size() - 1)];
        OscillatorLanes& group = groups[i / kNodes];
        const int lane = static_cast<int>(i % kNodes);
        const double w2 = o.omega * o.omega;
        group.omega[lane] = o.omega;
        group.square[lane] = w2;
        group.inverse_square[lane] = 1 / w2;
        group.gamma[lane] = o.gamma;
        group.damping[lane] = 2 * o.gamma;
        group.damped_omega[lane] = o.gamma == 0 ? o.omega : std::sqrt(std::fabs(w2 - o.gamma * o.gamma));
        group.inverse_damped[lane] = 1 / group.damped_omega[lane];
        group.slowest = lane == 0 ? o.omega : std::min(group.slowest, o.omega);
        group.fastest = std::max(group.fastest, o.omega);
        group.damped = group.damped || o.gamma > 0;
        group.alone = group.alone || o.gamma > kMostDampingInLanes * o.omega;
    }
    return groups;
}

void respond(const OscillatorLanes& group, double tau, Lanes* r) {
    if (group.alone || !(group.fastest * tau < kMostRadians && group.slowest > kSlowestOscillator)) {
        for (int k = 0; k < kNodes; ++k) {
            double one[kResponse];
            respond(Oscillator{group.omega[k], group.gamma[k]}, tau, one);
            for (int j = 0; j < kResponse; ++j) r[j][k] = one[j];
        }
        return;
    }
    Lanes sine, cosine;
    sine_and_cosine_of_phase(group.damped_omega * tau, sine, cosine);
    if (group.damped)
        for (int k = 0; k < kNodes; ++k) {
            const double decay = std::exp(-group.gamma[k] * tau);
            sine[k] *= decay;
            cosine[k] *= decay;
        }
    r[1] = sine * group.inverse_damped;
    r[0] = cosine - group.gamma * r[1];
    const bool any_slow = group.slowest * tau < kSeriesRadians, all_slow = group.fastest * tau < kSeriesRadians;
    const int powers = kNodes + (any_slow ? 2 + kSeriesTerms : 0);
    double power[kNodes + 2 + kSeriesTerms];  // τʲ/j!
    power[0] = 1;
    for (int j = 1; j < powers; ++j) power[j] = power[j - 1] * (tau / j);
    if (all_slow) return descend(group, power, r + 2);
    Lanes before = r[0], last = r[1];
    for (int j = 0; j < kNodes; ++j) {
        const Lanes next = (power[j] - group.damping * last - before) * group.inverse_square;
        before = last;
        last = r[2 + j] = next;
    }
    if (!any_slow) return;
    Lanes down[kNodes];
    descend(group, power, down);
    for (int k = 0; k < kNodes; ++k)
        if (group.omega[k] * tau < kSeriesRadians)
            for (int j = 0; j < kNodes; ++j) r[2 + j][k] = down[j][k];
}

void StepTable::build(const std::vector<Oscillator>& oscillators, const std::vector<OscillatorLanes>& groups,
                      double length) {
    BEAMCAM_ASSERT(length > 0 && std::isfinite(length));
    BEAMCAM_ASSERT(groups.size() == (oscillators.size() + kNodes - 1) / kNodes);
    const Collocation& gauss = Collocation::get();
    h = length;
    rows.resize(oscillators.size());
    const Powers inverse = inverse_powers(h);  // scaled derivatives: derive/hʲ times the responses
    responses_.resize(groups.size() * (kNodes + 1) * kResponse);
    for (std::size_t g = 0; g < groups.size(); ++g)
        for (std::size_t k = 0; k <= kNodes; ++k) {
            const double to = k < kNodes ? gauss.c[static_cast<int>(k)] : 1;
            respond(groups[g], (to - gauss.point[k]) * h, responses_.data() + (g * (kNodes + 1) + k) * kResponse);
        }
    for (std::size_t i = 0; i < oscillators.size(); ++i) build_row(i, oscillators[i], inverse);
}

void StepTable::build_row(std::size_t i, const Oscillator& o, const Powers& inverse) {
    const Collocation& gauss = Collocation::get();
    Row& row = rows[i];
    const double w2 = o.omega * o.omega, damping = 2 * o.gamma;
    if (o.omega * h > kAliasedRadians) follow_forcing(o, inverse, 0, row.steady, row.steady_rate);
    // From point to point, each by the expansion at its start.
    double qq = 1, qv = 0, vq = 0, vv = 1;
    Lanes q{}, v{};
    for (std::size_t k = 0; k <= kNodes; ++k) {
        const Lanes* all = responses_.data() + (i / kNodes * (kNodes + 1) + k) * kResponse;
        double r[kResponse];
        for (int j = 0; j < kResponse; ++j) r[j] = all[j][static_cast<int>(i % kNodes)];
        const double a = r[0] + damping * r[1], b = r[1], c = -w2 * r[1], d = r[0];
        Lanes q1 = a * q + b * v, v1 = c * q + d * v;
        for (std::size_t j = 0; j < kNodes; ++j) {
            q1 += (inverse[j] * r[2 + j]) * gauss.derive[k][j];
            v1 += (inverse[j] * r[1 + j]) * gauss.derive[k][j];
        }
        q = q1;
        v = v1;
        const double qq1 = a * qq + b * vq, qv1 = a * qv + b * vv;
        vq = c * qq + d * vq;
        vv = c * qv + d * vv;
        qq = qq1;
        qv = qv1;
        if (k == kNodes) break;
        const int lane = static_cast<int>(k);
        row.qq[lane] = qq;
        row.qv[lane] = qv;
        row.vq[lane] = vq;
        row.vv[lane] = vv;
        for (std::size_t l = 0; l < kNodes; ++l) {
            row.q[l][lane] = q[static_cast<int>(l)];
            row.v[l][lane] = v[static_cast<int>(l)];
        }
    }
    row.end_q = q;
    row.end_v = v;
    row.end_qq = qq;
    row.end_qv = qv;
    row.end_vq = vq;
    row.end_vv = vv;
}

void StepTable::build_projected(const std::vector<Oscillator>& oscillators, const StepTable& table) {
    h = table.h;
    rows = table.rows;
    const Powers inverse = inverse_powers(h);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Oscillator& o = oscillators[i];
        if (o.omega * h > kAliasedRadians && hardly_damped(o)) project_row(o, inverse, rows[i]);
    }
}

// The free vibration by ∫₀ʰ ℓ_k s = ∫₀ʰ ℓ_{7−k}(u) s(h − u) du, which are the weights of the end; forced motion follows
// the forcing but for a free vibration.
void StepTable::project_row(const Oscillator& o, const Powers& inverse, Row& row) const {
    const Collocation& gauss = Collocation::get();
    Lanes s, ds;
    for (int k = 0; k < kNodes; ++k) {
        s[k] = row.end_q[kNodes - 1 - k] / (h * gauss.b[k]);
        ds[k] = row.end_v[kNodes - 1 - k] / (h * gauss.b[k]);
    }
    row.qq = ds + 2 * o.gamma * s;
    row.qv = s;
    row.vq = -(o.omega * o.omega) * s;
    row.vv = ds;
    for (int k = 0; k < kNodes; ++k) {
        Lanes q, v;
        follow_forcing(o, inverse, static_cast<std::size_t>(k) + 1, q, v);
        for (std::size_t l = 0; l < kNodes; ++l) {
            const int node = static_cast<int>(l);
            row.q[l][k] = q[node] - row.qq[k] * row.steady[node] - row.qv[k] * row.steady_rate[node];
            row.v[l][k] = v[node] - row.vq[k] * row.steady[node] - row.vv[k] * row.steady_rate[node];
        }
    }
}

double step_length(int level) { return std::ldexp(level & 1 ? 1.4142135623730951 : 1.0, (level - (level & 1)) / 2); }

int lower_level(int level, double h, double error, int order, int most) {
    while (level > kLowestLevel && step_length(level) > h) --level;
    if (!std::isfinite(error)) return level - most;
    return level - std::clamp(static_cast<int>(std::ceil(std::log2(error) / (0.5 * order))), 1, 4);
}

int higher_level(int level, double error, double longer, double much_longer) {
    if (!(error < longer)) return level;
    return std::min(level + (error < much_longer ? 2 : 1), kHighestLevel);
}

StepTables::StepTables(const std::vector<Oscillator>& oscillators, const std::vector<OscillatorLanes>& groups)
    : oscillators_(oscillators), groups_(groups), ladder_(kHighestLevel - kLowestLevel + 1) {}

StepTable& StepTables::level(int k) {
    StepTable& entry = ladder_[static_cast<std::size_t>(k - kLowestLevel)];
    if (entry.h == 0) entry.build(oscillators_, groups_, step_length(k));
    return entry;
}

StepTable& StepTables::length(double h) {
    other_.build(oscillators_, groups_, h);
    return other_;
}

}  // namespace beamcam::sim
