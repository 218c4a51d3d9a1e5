// Contact geometry and force at the nodes of a collocation step: MODEL.md §7 and §8 in the beam's own frame, with the
// shapes expanded about one arc position near the contact, so that no node evaluates a shape. The same formulas serve
// one instant (T = double) and eight (T = Lanes).
#pragma once

#include <memory>
#include <vector>

#include "sim/integrate/lane_kernels.hpp"
#include "sim/integrate/modal_form.hpp"

namespace beamcam::sim {

BEAMCAM_INLINE void root(double a, double& out) { out = std::sqrt(a); }
BEAMCAM_INLINE void root(const Lanes& a, Lanes& out) {
    for (int k = 0; k < kNodes; ++k) out[k] = std::sqrt(a[k]);
}

// The motion of the frame and the cam at one instant or eight.
template <class T>
struct Frame {
    T sin, cos, spin;    // Θ, Θ̇
    T disc_x, disc_y;    // B in fixed axes [m]
    T disc_vx, disc_vy;  // Ḃ
};

constexpr int kExpansionOrder = 6;

// The contact at one instant or eight; names as in ContactState.
template <class T>
struct ContactKinematics {
    T dx{};  // of the foot from the point of expansion; a first guess comes in
    T gap, gap_rate, slip;
    T nx, ny;                   // normal in the beam's frame
    T hub;                      // ∂(n·r)/∂Θ
    T hub_t;                    // ∂(t·r)/∂Θ with the moment of the face
    T cam_n, cam_t;             // n·Ḃ, t·Ḃ + ωR: power of the cam per force
    T moment[kExpansionOrder];  // ∫₀^dx v′ ξʲ/j! dξ
    T v1;                       // slope
    T shift;                    // a α
};

inline void product(std::size_t rows, std::size_t columns, const double* a, const Lanes* x, Lanes* y) {
    lane_kernels().multiply(rows, columns, a, x, y);
}
inline void product(std::size_t rows, std::size_t columns, const double* a, const double* x, double* y) {
    for (std::size_t r = 0; r < rows; ++r) {
        double total = 0;
        for (std::size_t c = 0; c < columns; ++c) total += a[r * columns + c] * x[c];
        y[r] = total;
    }
}

class ContactExpansion {
  public:
    static constexpr int kOrder = kExpansionOrder;

    ContactExpansion(std::shared_ptr<const ModalForm> form, System& system);

    // Expands about x unless the present expansion serves there too.
    void centre(double x);
    // The next expansion is made anew, as the first was.
    void forget() { x_ = -1; }
    double at() const { return x_; }
    // How far from its centre an expansion is trusted [m].
    double range() const { return range_; }

    // Fills `touch` from q, q̇ (one entry a mode); `hq` receives H q at the centre. `corrections` of the foot by
    // Newton's method, from touch.dx.
    template <class T>
    void evaluate(const T* q, const T* v, const Frame<T>& frame, double gap_offset, T* hq, ContactKinematics<T>& touch,
                  int corrections) const;
    // ∂(n·r)/∂q_i, and ∂(t·r)/∂q_i with the moment of the face.
    template <class T>
    void rows(const ContactKinematics<T>& touch, const T* hq, std::size_t i, bool friction, T& jn, T& jt) const;
    // ∂(n·r)/∂q_i of all modes.
    void normal_rows(const ContactKinematics<Lanes>& touch, const Lanes* hq, Lanes* jn) const;

  private:
    std::shared_ptr<const ModalForm> form_;
    System& system_;
    std::size_t n_;
    double x_ = -1, range_ = 0, offset_, radius_, disc_, rim_;
    std::vector<double> y_;        // kOrder + 1 derivatives of each shape
    std::vector<double> turned_;   // the same, transposed
    std::vector<double> shorten_;  // H(x), row-major
};

// ---- implementation of the templates ----

template <class T>
BEAMCAM_INLINE void taylor(const T* c, const T& dx, int count, T& out) {
    out = c[count - 1];
    for (int m = count - 2; m >= 0; --m) out = c[m] + out * dx * (1.0 / (m + 1));
}

// ∫₀^dx v′ ξʲ/j! dξ to degree kExpansionOrder in dx, from the derivatives c of v: with them ∫₀^dx v′φ′ = Σ φ⁽ʲ⁺¹⁾
// moment_j, so that the rows are the exact derivatives of the expanded gap.
template <class T>
BEAMCAM_INLINE void slope_moments(const T* c, const T& dx, T* moment) {
    T term[kExpansionOrder];  // v⁽ᵐ⁺¹⁾ dxᵐ/m!
    T power = T{} + 1.0;
    for (int m = 0; m < kExpansionOrder; ++m) {
        term[m] = c[1 + m] * power;
        power = power * dx * (1.0 / (m + 1));
    }
    power = dx;
    for (int j = 0; j < kExpansionOrder; ++j) {
        moment[j] = term[0] * (1.0 / (j + 1));
        for (int m = 1; m + j < kExpansionOrder; ++m) moment[j] = moment[j] + term[m] * (1.0 / (m + j + 1));
        moment[j] = moment[j] * power;
        power = power * dx * (1.0 / (j + 1));
    }
}
// ∫₀^dx v′φ′ from the moments of v and the derivatives of φ.
template <class T>
BEAMCAM_INLINE T slope_product(const T* moment, const T* derivatives) {
    T total = derivatives[1] * moment[0];
    for (int j = 1; j < kExpansionOrder; ++j) total = total + derivatives[1 + j] * moment[j];
    return total;
}

template <class T>
void ContactExpansion::evaluate(const T* q, const T* v, const Frame<T>& frame, double gap_offset, T* hq,
                                ContactKinematics<T>& touch, int corrections) const {
    // Deflection, its rate and their derivatives at the centre.
    T c[kOrder + 1], d[kOrder + 1];
    product(kOrder + 1, n_, y_.data(), q, c);
    product(kOrder + 1, n_, y_.data(), v, d);
    T turn{}, turn_rate{}, qhq{}, vhq{};
    if (form_->shortening) {
        product(n_, n_, shorten_.data(), q, hq);
        for (std::size_t i = 0; i < n_; ++i) {
            qhq += hq[i] * q[i];
            vhq += hq[i] * v[i];
            turn += form_->h[i] * q[i];
            turn_rate += form_->h[i] * v[i];
        }
    }
    const double a = radius_, length = form_->shortening ? 1 : 0;
    touch.shift = a * turn;
    const T u0 = -0.5 * qhq - 0.5 * touch.shift * turn, du0 = -vhq - touch.shift * turn_rate;
    const T bx = frame.disc_x * frame.cos + frame.disc_y * frame.sin,
            by = frame.disc_y * frame.cos - frame.disc_x * frame.sin;
    T x = touch.dx, deflection, slope, bend, rx, ry, r1;
    T* moment = touch.moment;
    for (int i = 0;; ++i) {
        taylor(c, x, kOrder + 1, deflection);
        taylor(c + 1, x, kOrder, slope);
        taylor(c + 2, x, kOrder - 1, bend);
        T u{};
        if (form_->shortening) {
            slope_moments(c, x, moment);
            u = u0 - 0.5 * slope_product(moment, c);
        }
        r1 = 1 - (0.5 * length) * slope * slope;
        rx = a + x_ + x + u;
        ry = deflection;
        const T ex = rx - bx, ey = ry - by;
        if (i == corrections) break;
        // r′·(r − B) = 0                                                                                       (S24)
        const T lean = r1 * ex + slope * ey;
        const T grow = r1 * r1 + slope * slope + bend * (ey - length * slope * ex);
        x -= lean / grow;
    }
    touch.dx = x;
    touch.v1 = slope;
    const T ex = rx - bx, ey = ry - by;
    T distance;
    root(ex * ex + ey * ey, distance);
    touch.nx = ex / distance;
    touch.ny = ey / distance;
    touch.gap = distance - (disc_ + offset_ - gap_offset);  // (S25)
    T speed, slope_speed, du{};
    taylor(d, x, kOrder + 1, speed);
    taylor(d + 1, x, kOrder, slope_speed);
    if (form_->shortening) du = du0 - slope_product(moment, d);
    const T bvx = frame.disc_vx * frame.cos + frame.disc_vy * frame.sin,
            bvy = frame.disc_vy * frame.cos - frame.disc_vx * frame.sin;
    const T vx = du - ry * frame.spin, vy = speed + rx * frame.spin;
    touch.gap_rate = touch.nx * (vx - bvx) + touch.ny * (vy - bvy);  // (S26)
    // t = (n_y, −n_x)
    touch.cam_n = touch.nx * bvx + touch.ny * bvy;
    touch.cam_t = touch.ny * bvx - touch.nx * bvy + rim_;
    const T square = r1 * r1 + slope * slope;
    const T v1x = -length * slope * slope_speed - slope * frame.spin, v1y = slope_speed + r1 * frame.spin;
    touch.slip = touch.ny * vx - touch.nx * vy - touch.cam_t + offset_ * (r1 * v1y - slope * v1x) / square;  // (S27)
    touch.hub = touch.ny * rx - touch.nx * ry;
    touch.hub_t = -touch.ny * ry - touch.nx * rx + offset_;
}

template <class T>
BEAMCAM_INLINE void ContactExpansion::rows(const ContactKinematics<T>& touch, const T* hq, std::size_t i, bool friction,
                                           T& jn, T& jt) const {
    const double* y = turned_.data() + i * (kOrder + 1);
    const T& x = touch.dx;
    T phi = T{} + y[kOrder], axial{};
    for (int m = kOrder - 1; m >= 0; --m) phi = y[m] + phi * x * (1.0 / (m + 1));
    if (form_->shortening) {
        axial = -hq[i] - form_->h[i] * touch.shift;
        for (int j = 0; j < kOrder; ++j) axial = axial - y[1 + j] * touch.moment[j];
    }
    jn = touch.nx * axial + touch.ny * phi;
    if (!friction) return;
    T slope = T{} + y[kOrder];
    for (int m = kOrder - 2; m >= 0; --m) slope = y[1 + m] + slope * x * (1.0 / (m + 1));
    const double length = form_->shortening ? 1 : 0;
    const T r1 = 1 - (0.5 * length) * touch.v1 * touch.v1, square = r1 * r1 + touch.v1 * touch.v1;
    jt = touch.ny * axial - touch.nx * phi + offset_ * slope * (r1 + length * touch.v1 * touch.v1) / square;
}

}  // namespace beamcam::sim
