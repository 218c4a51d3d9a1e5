// The templates of ContactExpansion for the model `exact`; included by contact_lanes.hpp only.
#pragma once

#include "sim/integrate/contact_lanes.hpp"

namespace beamcam::sim {

// r = (a, 0) + ∫₀ˣ(cos δ, sin δ) with the angle δ of the section against the hub                          (S18)
template <class T>
void ContactExpansion::integrate(const T* q, const T* v, Point<T>& at, T* rows) const {
    T sine[kMostNodes], cosine[kMostNodes], rate[kMostNodes];
    product(nodes_, n_, section_.data(), q, rate);
    for (std::size_t k = 0; k < nodes_; ++k) sine_and_cosine(rate[k], sine[k], cosine[k]);
    product(nodes_, n_, section_.data(), v, rate);
    at.x = T{} + radius_;
    at.y = at.rate_x = at.rate_y = T{};
    for (std::size_t k = 0; k < nodes_; ++k) {
        at.x += weights_[k] * cosine[k];
        at.y += weights_[k] * sine[k];
        at.rate_x -= weights_[k] * sine[k] * rate[k];
        at.rate_y += weights_[k] * cosine[k] * rate[k];
        sine[k] = -sine[k];
    }
    product(n_, nodes_, weighted_.data(), sine, rows);
    product(n_, nodes_, weighted_.data(), cosine, rows + n_);
}

// From the centre to the foot by Gauss's rule of four nodes, far beyond the order of the expansion.
template <class T>
void ContactExpansion::evaluate_exact(const T* q, const T* v, const Frame<T>& frame, double gap_offset, T* rows,
                                      ContactKinematics<T>& touch, int corrections) const {
    constexpr int kPoints = 4;
    constexpr double kHalf[] = {0.33998104358485626, 0.86113631159405258};
    constexpr double kWeight[] = {0.32607257743127307, 0.17392742256872693};
    T c[kOrder + 1], d[kOrder + 1];
    product(kOrder + 1, n_, y_.data(), q, c);
    product(kOrder + 1, n_, y_.data(), v, d);
    Point<T> at;
    integrate(q, v, at, rows);
    Disc<T> disc = given_disc(frame);
    T x = touch.dx, sine[kPoints], cosine[kPoints], place[kPoints], rx, ry, angle;
    for (int i = 0;; ++i) {
        rx = at.x;
        ry = at.y;
        for (int g = 0; g < kPoints; ++g) {
            place[g] = x * (0.5 + (g < 2 ? -0.5 : 0.5) * kHalf[g % 2]);
            taylor(c, place[g], kOrder + 1, angle);
            sine_and_cosine(angle, sine[g], cosine[g]);
            sine[g] = x * kWeight[g % 2] * sine[g];
            cosine[g] = x * kWeight[g % 2] * cosine[g];
            rx += cosine[g];
            ry += sine[g];
        }
        taylor(c, x, kOrder + 1, angle);
        sine_and_cosine(angle, at.tangent_y, at.tangent_x);
        if (frame.osculating) osculate(frame, at.tangent_x, at.tangent_y, rx, ry, disc);
        if (i == corrections) break;
        T curvature;
        taylor(c + 1, x, kOrder, curvature);
        const T ex = rx - disc.x, ey = ry - disc.y;
        const T residual = at.tangent_x * ex + at.tangent_y * ey;  // (S24)
        x -= residual / (1.0 + curvature * (at.tangent_x * ey - at.tangent_y * ex));
    }
    touch.dx = x;
    touch.v1 = touch.shift = T{};
    at.x = rx;
    at.y = ry;
    T speed;
    for (int g = 0; g < kPoints; ++g) {
        taylor(d, place[g], kOrder + 1, speed);
        at.rate_x -= sine[g] * speed;
        at.rate_y += cosine[g] * speed;
        for (std::size_t i = 0; i < n_; ++i) {
            const double* y = transposed_.data() + i * (kOrder + 1);
            T eta = T{} + y[kOrder];
            for (int m = kOrder - 1; m >= 0; --m) eta = y[m] + eta * place[g] * (1.0 / (m + 1));
            rows[i] -= sine[g] * eta;
            rows[n_ + i] += cosine[g] * eta;
        }
    }
    taylor(d, x, kOrder + 1, speed);
    at.tangent_rate_x = -speed * at.tangent_y;
    at.tangent_rate_y = speed * at.tangent_x;
    finish(at, disc, frame, gap_offset, touch);
}

}  // namespace beamcam::sim
