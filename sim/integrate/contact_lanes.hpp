// Contact geometry and force at the nodes of a collocation step: MODEL.md §7 and §8 in the beam's own frame, with the
// shapes expanded about one arc position near the contact, so that no node evaluates a shape. The same templates are
// used for one instant (T = double) and for eight (T = Lanes), for all models that the collocation integrates.
#pragma once

#include <memory>
#include <vector>

#include "sim/base/lanes.hpp"
#include "sim/base/numerics.hpp"
#include "sim/beam/modal_model.hpp"
#include "sim/dynamics/system.hpp"

namespace beamcam::sim {

inline constexpr int kFootCorrections = 3;  // of the foot by Newton's method, from a foot nearby

BEAMCAM_INLINE void root(double a, double& out) { out = std::sqrt(a); }
BEAMCAM_INLINE void root(const Lanes& a, Lanes& out) {
    for (int k = 0; k < kNodes; ++k) out[k] = std::sqrt(a[k]);
}

// The angle of a vector.
BEAMCAM_INLINE void direction(double x, double y, double& out) { out = std::atan2(y, x); }
BEAMCAM_INLINE void direction(const Lanes& x, const Lanes& y, Lanes& out) {
    for (int k = 0; k < kNodes; ++k) out[k] = std::atan2(y[k], x[k]);
}
// The outline of the cam where its normal has the angle α: h, h′ and ρ.
BEAMCAM_INLINE void outline(const CamShape& cam, double alpha, double& h, double& slope, double& radius) {
    const CamPoint at = cam.at(alpha);
    h = at.h;
    slope = at.slope;
    radius = at.radius;
}
BEAMCAM_INLINE void outline(const CamShape& cam, const Lanes& alpha, Lanes& h, Lanes& slope, Lanes& radius) {
    for (int k = 0; k < kNodes; ++k) {
        const CamPoint at = cam.at(alpha[k]);
        h[k] = at.h;
        slope[k] = at.slope;
        radius[k] = at.radius;
    }
}
// The sign of a number at one instant, or at the first of eight.
BEAMCAM_INLINE double sign_of(double a) { return a < 0 ? -1 : 1; }
BEAMCAM_INLINE double sign_of(const Lanes& a) { return a[0] < 0 ? -1 : 1; }

// The motion of the frame and the cam at one instant or eight.
template <class T>
struct Frame {
    T sin{}, cos{}, theta_dot{};  // of Θ; Θ̇
    T disc_x{}, disc_y{};         // B in fixed axes [m]
    T disc_vx{}, disc_vy{};       // Ḃ
    T radius{};                   // of the disc [m]
    T turned{};                   // Θ − ψ
    // The disc is that which osculates the cam at the foot, instead of the given one.
    bool osculating = false;
};

// The frame of the beam at the angle Θ, and the cam at time t.
inline Frame<double> frame_of(const TurningCam& cam, double t, double theta, double theta_dot) {
    Frame<double> frame{std::sin(theta), std::cos(theta), theta_dot};
    frame.osculating = !cam.is_disc();
    frame.turned = theta - cam.angle(t);
    if (frame.osculating) return frame;
    const OsculatingDisc disc = cam.disc(t, {});
    frame.disc_x = disc.centre.x;
    frame.disc_y = disc.centre.y;
    frame.disc_vx = disc.velocity.x;
    frame.disc_vy = disc.velocity.y;
    frame.radius = disc.radius;
    return frame;
}

constexpr int kExpansionOrder = 6;
constexpr std::size_t kMostNodes = 2 * kMaxModes + 24;  // of the integrals of `exact`

// The contact at one instant or eight; names as in ContactState.
template <class T>
struct ContactKinematics {
    T dx{};  // from the centre of the expansion to the foot; in: a first guess
    T gap, gap_rate, slip;
    T nx, ny;                   // normal in the beam's frame
    T radius;                   // ρ of the cam [m]
    T hub;                      // ∂(n·r)/∂Θ
    T hub_t;                    // ∂(t·r)/∂Θ with the moment of the face
    T cam_n, cam_t;             // n·Ḃ, t·Ḃ + ωR: power of the cam per force
    T moment[kExpansionOrder];  // ∫₀^dx v′ ξʲ/j! dξ
    T v1;                       // slope
    T shift;                    // a α
};

template <class T>
void product(std::size_t rows, std::size_t columns, const double* a, const T* x, T* y) {
    for (std::size_t r = 0; r < rows; ++r) {
        T total{};
        for (std::size_t c = 0; c < columns; ++c) total += a[r * columns + c] * x[c];
        y[r] = total;
    }
}

class ContactExpansion {
  public:
    static constexpr int kOrder = kExpansionOrder;

    explicit ContactExpansion(System& system);

    // Expands about x itself.
    void centre_at(double x);
    // Expands about the nearest point of a fixed grid: the result does not depend on earlier expansions.
    void centre_near(double x);
    double at() const { return x_; }
    // Largest distance from the centre at which the expansion is accurate [m].
    double range() const { return range_; }

    // Fills `touch` from q, q̇ (one entry a coordinate). `hq`, of `scratch` numbers, receives H q at the centre
    // (`exact`: ∂r/∂q), which `rows` needs. Newton's method corrects the foot `corrections` times, from touch.dx.
    std::size_t scratch() const { return exact() ? 2 * n_ : n_; }
    template <class T>
    void evaluate(const T* q, const T* v, const Frame<T>& frame, double gap_offset, T* hq, ContactKinematics<T>& touch,
                  int corrections) const;
    // ∂(n·r)/∂q_i, and ∂(t·r)/∂q_i with the moment of the face.
    template <class T>
    void rows(const ContactKinematics<T>& touch, const T* hq, std::size_t i, bool friction, T& jn, T& jt) const;
    // ∂(n·r)/∂q_i of all modes.
    void normal_rows(const ContactKinematics<Lanes>& touch, const Lanes* hq, Lanes* jn) const;

  private:
    // A point of the centre line in the beam's frame, and its rate and that of its tangent against the frame.
    template <class T>
    struct Point {
        T x, y, tangent_x, tangent_y, rate_x, rate_y, tangent_rate_x, tangent_rate_y;
    };
    // The disc of the cam in the beam's frame, and the velocity of its centre.
    template <class T>
    struct Disc {
        T x, y, vx, vy, radius;
    };
    bool exact() const { return !model_; }
    template <class T>
    Disc<T> given_disc(const Frame<T>& frame) const;
    template <class T>
    void osculate(const Frame<T>& frame, const T& tangent_x, const T& tangent_y, const T& x, const T& y,
                  Disc<T>& disc) const;
    template <class T>
    void finish(const Point<T>& at, const Disc<T>& disc, const Frame<T>& frame, double gap_offset,
                ContactKinematics<T>& touch) const;
    template <class T>
    void evaluate_exact(const T* q, const T* v, const Frame<T>& frame, double gap_offset, T* rows,
                        ContactKinematics<T>& touch, int corrections) const;
    // `exact`: r at the centre, its rate, and ∂r/∂q.
    template <class T>
    void integrate(const T* q, const T* v, Point<T>& at, T* rows) const;
    void centre_exact(double x);

    std::shared_ptr<const ModalModel> model_;  // of the shapes; null for `exact`
    std::size_t n_, nodes_ = 0;
    TurningCam cam_;
    double x_ = -1, range_ = 0, length_, offset_, radius_, trusted_ = 0;
    bool shortening_ = false;
    std::vector<double> h_;           // ∂α/∂q
    std::vector<double> y_;           // kOrder + 1 derivatives of each shape
    std::vector<double> transposed_;  // the same, transposed
    std::vector<double> shorten_;     // H(x), row-major
    // `exact`: shapes at Gauss nodes, and weights of ∫₀ˣ over these with the shapes, a row each, and without.
    Quadrature rule_;
    SpectralIntegral integral_;
    std::vector<double> section_, weighted_, weights_;
};

// ---- implementation of the templates ----

template <class T>
BEAMCAM_INLINE void taylor(const T* c, const T& dx, int count, T& out) {
    out = c[count - 1];
    for (int m = count - 2; m >= 0; --m) out = c[m] + out * dx * (1.0 / (m + 1));
}

// ∫₀^dx v′ ξʲ/j! dξ to the degree of the expansion in dx, from the derivatives c of v: with them ∫₀^dx v′φ′ =
// Σ φ⁽ʲ⁺¹⁾ moment_j, so that the rows are the exact derivatives of the expanded gap.
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
    if (exact()) return evaluate_exact(q, v, frame, gap_offset, hq, touch, corrections);
    // Deflection, its rate and their derivatives at the centre.
    T c[kOrder + 1], d[kOrder + 1];
    product(kOrder + 1, n_, y_.data(), q, c);
    product(kOrder + 1, n_, y_.data(), v, d);
    T turn{}, turn_rate{}, qhq{}, vhq{};
    if (shortening_) {
        product(n_, n_, shorten_.data(), q, hq);
        for (std::size_t i = 0; i < n_; ++i) {
            qhq += hq[i] * q[i];
            vhq += hq[i] * v[i];
            turn += h_[i] * q[i];
            turn_rate += h_[i] * v[i];
        }
    }
    const double a = radius_, length = shortening_ ? 1 : 0;
    touch.shift = a * turn;
    const T u0 = -0.5 * qhq - 0.5 * touch.shift * turn, du0 = -vhq - touch.shift * turn_rate;
    Disc<T> disc = given_disc(frame);
    T x = touch.dx, deflection, slope, bend, rx, ry, r1;
    T* moment = touch.moment;
    for (int i = 0;; ++i) {
        taylor(c, x, kOrder + 1, deflection);
        taylor(c + 1, x, kOrder, slope);
        taylor(c + 2, x, kOrder - 1, bend);
        T u{};
        if (shortening_) {
            slope_moments(c, x, moment);
            u = u0 - 0.5 * slope_product(moment, c);
        }
        r1 = 1 - (0.5 * length) * slope * slope;
        rx = a + x_ + x + u;
        ry = deflection;
        if (frame.osculating) osculate(frame, r1, slope, rx, ry, disc);
        if (i == corrections) break;
        const T ex = rx - disc.x, ey = ry - disc.y;
        // r′·(r − B) = 0                                                                                       (S24)
        const T residual = r1 * ex + slope * ey;
        x -= residual / (r1 * r1 + slope * slope + bend * (ey - length * slope * ex));
    }
    touch.dx = x;
    touch.v1 = slope;
    T speed, slope_speed, du{};
    taylor(d, x, kOrder + 1, speed);
    taylor(d + 1, x, kOrder, slope_speed);
    if (shortening_) du = du0 - slope_product(moment, d);
    const Point<T> at{rx, ry, r1, slope, du, speed, -length * slope * slope_speed, slope_speed};
    finish(at, disc, frame, gap_offset, touch);
}

template <class T>
BEAMCAM_INLINE ContactExpansion::Disc<T> ContactExpansion::given_disc(const Frame<T>& f) const {
    return {f.disc_x * f.cos + f.disc_y * f.sin, f.disc_y * f.cos - f.disc_x * f.sin,
            f.disc_vx * f.cos + f.disc_vy * f.sin, f.disc_vy * f.cos - f.disc_vx * f.sin, f.radius};
}

// The normal is that of the beam at (x, y), on the side away from the cam. The centre of curvature is
// (h − ρ) n + h′ t from the axis.
template <class T>
void ContactExpansion::osculate(const Frame<T>& frame, const T& tangent_x, const T& tangent_y, const T& x, const T& y,
                                Disc<T>& disc) const {
    const Vec2 c = cam_.axis();
    const T cx = c.x * frame.cos + c.y * frame.sin, cy = c.y * frame.cos - c.x * frame.sin;
    const double side = sign_of(tangent_x * (y - cy) - tangent_y * (x - cx));
    T length, angle, h, slope;
    root(tangent_x * tangent_x + tangent_y * tangent_y, length);
    const T nx = -side * tangent_y / length, ny = side * tangent_x / length;
    direction(nx, ny, angle);
    outline(cam_.shape(), angle + frame.turned, h, slope, disc.radius);
    const T along = h - disc.radius, ax = along * nx - slope * ny, ay = along * ny + slope * nx;
    disc.x = cx + ax;
    disc.y = cy + ay;
    disc.vx = cam_.speed() * ay;
    disc.vy = -cam_.speed() * ax;
}

template <class T>
BEAMCAM_INLINE void ContactExpansion::finish(const Point<T>& at, const Disc<T>& disc, const Frame<T>& frame,
                                             double gap_offset, ContactKinematics<T>& touch) const {
    const T ex = at.x - disc.x, ey = at.y - disc.y;
    T distance;
    root(ex * ex + ey * ey, distance);
    touch.nx = ex / distance;
    touch.ny = ey / distance;
    touch.radius = disc.radius;
    touch.gap = distance - (disc.radius + offset_ - gap_offset);  // (S25)
    const T vx = at.rate_x - at.y * frame.theta_dot, vy = at.rate_y + at.x * frame.theta_dot;
    touch.gap_rate = touch.nx * (vx - disc.vx) + touch.ny * (vy - disc.vy);  // (S26)
    // t = (n_y, −n_x)
    touch.cam_n = touch.nx * disc.vx + touch.ny * disc.vy;
    touch.cam_t = touch.ny * disc.vx - touch.nx * disc.vy + cam_.speed() * disc.radius;
    const T square = at.tangent_x * at.tangent_x + at.tangent_y * at.tangent_y;
    const T v1x = at.tangent_rate_x - at.tangent_y * frame.theta_dot,
            v1y = at.tangent_rate_y + at.tangent_x * frame.theta_dot;
    touch.slip = touch.ny * vx - touch.nx * vy - touch.cam_t +
                 offset_ * (at.tangent_x * v1y - at.tangent_y * v1x) / square;  // (S27)
    touch.hub = touch.ny * at.x - touch.nx * at.y;
    touch.hub_t = -touch.ny * at.y - touch.nx * at.x + offset_;
}

template <class T>
BEAMCAM_INLINE void ContactExpansion::rows(const ContactKinematics<T>& touch, const T* hq, std::size_t i, bool friction,
                                           T& jn, T& jt) const {
    const double* y = transposed_.data() + i * (kOrder + 1);
    const T& x = touch.dx;
    T phi = T{} + y[kOrder], axial{};
    for (int m = kOrder - 1; m >= 0; --m) phi = y[m] + phi * x * (1.0 / (m + 1));
    if (exact()) {
        jn = touch.nx * hq[i] + touch.ny * hq[n_ + i];
        if (friction) jt = touch.ny * hq[i] - touch.nx * hq[n_ + i] + offset_ * phi;
        return;
    }
    if (shortening_) {
        axial = -hq[i] - h_[i] * touch.shift;
        for (int j = 0; j < kOrder; ++j) axial = axial - y[1 + j] * touch.moment[j];
    }
    jn = touch.nx * axial + touch.ny * phi;
    if (!friction) return;
    T slope = T{} + y[kOrder];
    for (int m = kOrder - 2; m >= 0; --m) slope = y[1 + m] + slope * x * (1.0 / (m + 1));
    const double length = shortening_ ? 1 : 0;
    const T r1 = 1 - (0.5 * length) * touch.v1 * touch.v1, square = r1 * r1 + touch.v1 * touch.v1;
    jt = touch.ny * axial - touch.nx * phi + offset_ * slope * (r1 + length * touch.v1 * touch.v1) / square;
}

}  // namespace beamcam::sim

#include "sim/integrate/contact_lanes_exact.hpp"
