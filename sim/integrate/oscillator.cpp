#include "sim/integrate/oscillator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/base/assert.hpp"

namespace beamcam::sim {
namespace {

// ζ from which the two decays are treated separately; below, they are too close to each other.
constexpr double kTwoDecays = 1.02;
constexpr double kNearlyCritical = 0.5;  // ζ from which on the recursion upwards loses more digits
constexpr double kSeriesRadians = 2;     // [rad], or decays, up to which responses come from their series
// In sustained contact, vibration that turns by more radians in a step is projected, unless its ζ is larger; growth by
// it begins at 14.                                                                                        (S52c)
constexpr double kAliasedRadians = 7, kMostDampingOfProjected = 0.1;

// The responses downwards from the series of the last two: g_j = Σ_k a_k τ^{j+2+k}/(j+2+k)!, a₀ = 1, a₁ = −2γ,
// a_k = −2γ a_{k−1} − ω² a_{k−2}; carried as a_k τᵏ, which stays small where a_k alone would overflow.
void descend(double w2, double damping, double tau, const double* power, double* r) {
    double term = power[kNodes], before = 0, a = 1, top = 0, next_to_top = 0;
    for (int k = 0; k < 24; ++k) {
        next_to_top += a * term;
        term /= kNodes + 1 + k;
        top += a * (tau * term);
        const double next = -(damping * tau) * a - (w2 * tau) * tau * before;
        before = a;
        a = next;
        if (std::fabs(a * term) + std::fabs(before * term) <= 1e-18 * std::fabs(next_to_top)) break;
    }
    r[kNodes] = next_to_top;
    r[kNodes + 1] = top;
    for (int j = kNodes - 2; j > 0; --j) r[1 + j] = power[j + 1] - damping * r[2 + j] - w2 * r[3 + j];
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
void follow_forcing(const Oscillator& o, const Derivatives& derive, Lanes& q, Lanes& v) {
    const std::array<double, kNodes> c = following(o);
    q = v = Lanes{};
    for (std::size_t j = 0; j < kNodes; ++j) {
        q += c[j] * derive[j];
        if (j + 1 < kNodes) v += c[j] * derive[j + 1];
    }
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
    if (reach < (!apart && o.gamma > kNearlyCritical * o.omega ? 2 * kSeriesRadians : kSeriesRadians))
        return descend(w2, damping, tau, power, r);
    if (apart) return respond_by_decays(decays_of(o), power, tau, r);
    const double inverse = 1 / w2;
    for (int j = -1; j + 1 < kNodes; ++j) r[3 + j] = (power[j + 1] - damping * r[2 + j] - r[1 + j]) * inverse;
}

Derivatives derivatives_at(std::size_t point, double h) {
    Derivatives out = Collocation::get().derive[point];
    double inverse = 1;
    for (Lanes& derivative : out) {
        derivative *= inverse;
        inverse /= h;
    }
    return out;
}

Propagation propagate(const Oscillator& o, const Derivatives& at_start, double tau) {
    double r[kResponse];
    respond(o, tau, r);
    Propagation p{r[0] + 2 * o.gamma * r[1], r[1], -(o.omega * o.omega) * r[1], r[0], {}, {}};
    for (std::size_t j = 0; j < kNodes; ++j) {
        p.forced_q += r[2 + j] * at_start[j];
        p.forced_v += r[1 + j] * at_start[j];
    }
    return p;
}

StepTable::Points StepTable::points() const {
    Points derive;
    for (std::size_t k = 0; k < derive.size(); ++k) derive[k] = derivatives_at(k, h);
    return derive;
}

void StepTable::build(const std::vector<Oscillator>& oscillators, double length) {
    BEAMCAM_ASSERT(length > 0 && std::isfinite(length));
    h = length;
    rows.resize(oscillators.size());
    const Points derive = points();
    for (std::size_t i = 0; i < oscillators.size(); ++i) build_row(oscillators[i], derive, rows[i]);
}

// From point to point, each by the expansion at its start.
void StepTable::build_row(const Oscillator& o, const Points& derive, Row& row) const {
    const Collocation& gauss = Collocation::get();
    if (o.omega * h > kAliasedRadians) follow_forcing(o, derive[0], row.steady, row.steady_rate);
    double qq = 1, qv = 0, vq = 0, vv = 1;
    Lanes q{}, v{};
    for (std::size_t k = 0; k <= kNodes; ++k) {
        const int lane = static_cast<int>(k);
        const double to = k < kNodes ? gauss.c[lane] : 1;
        const Propagation p = propagate(o, derive[k], (to - gauss.point[k]) * h);
        const Lanes q1 = p.qq * q + p.qv * v + p.forced_q;
        v = p.vq * q + p.vv * v + p.forced_v;
        q = q1;
        const double qq1 = p.qq * qq + p.qv * vq, qv1 = p.qq * qv + p.qv * vv;
        vq = p.vq * qq + p.vv * vq;
        vv = p.vq * qv + p.vv * vv;
        qq = qq1;
        qv = qv1;
        if (k == kNodes) break;
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
    const Points derive = points();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Oscillator& o = oscillators[i];
        if (o.omega * h > kAliasedRadians && hardly_damped(o)) project_row(o, derive, rows[i]);
    }
}

// The free vibration by ∫₀ʰ ℓ_k s = ∫₀ʰ ℓ_{7−k}(u) s(h − u) du, which are the weights of the end; forced motion follows
// the forcing but for a free vibration.
void StepTable::project_row(const Oscillator& o, const Points& derive, Row& row) const {
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
        follow_forcing(o, derive[static_cast<std::size_t>(k) + 1], q, v);
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

StepTables::StepTables(const std::vector<Oscillator>& oscillators)
    : oscillators_(oscillators), ladder_(kHighestLevel - kLowestLevel + 1) {}

StepTable& StepTables::level(int k) {
    StepTable& entry = ladder_[static_cast<std::size_t>(k - kLowestLevel)];
    if (entry.h == 0) entry.build(oscillators_, step_length(k));
    return entry;
}

StepTable& StepTables::length(double h) {
    other_.build(oscillators_, h);
    return other_;
}

}  // namespace beamcam::sim
