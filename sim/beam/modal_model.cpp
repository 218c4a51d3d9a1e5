#include "sim/beam/modal_model.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/numerics.hpp"

namespace beamcam::sim {

ModalModel::ModalModel(const Problem& problem) : Model(problem), kind_(problem.beam.model) {
    auto tables = std::make_shared<Tables>();
    const Basis basis = resolved_basis(problem);
    tables->shapes = Shapes::of(problem);
    tables->m = modal_matrices(problem, tables->shapes, basis);
    ModalMatrices& m = tables->m;
    if (kind_ != ModelKind::zeroth_order && kind_ != ModelKind::rigid) tables->foreshortening.emplace(tables->shapes);
    tables->B = tables->foreshortening ? Eigen::MatrixXd(m.M - m.D) : m.M;
    coupled_ = basis == Basis::cantilever && modes_ > 0;
    for (int i = 0; i < modes_; ++i) hub_row_[1 + i] = m.slope[i];
    bq_ = gq_ = Eigen::VectorXd::Zero(modes_);
    tables_ = tables;
    keep(Eigen::VectorXd{});
    build_damping(problem);
}

void ModalModel::shortening_matrix(double x, double* h) const {
    ShapesAt here;
    here.evaluate(tables_->shapes, x);
    tables_->foreshortening->matrix(here, h);
}

void ModalModel::state_changed() {
    sin_ = std::sin(xi_[0]);
    cos_ = std::cos(xi_[0]);
    alpha_ = alpha_dot_ = 0;
    for (int i = 1; i < size_; ++i) {
        alpha_ += hub_row_[i] * xi_[i];
        alpha_dot_ += hub_row_[i] * rate_[i];
    }
    ++state_;
}

void ModalModel::keep(const Eigen::VectorXd& x) {
    std::vector<double> places(x.begin(), x.end());
    places.insert(places.end(), {0, length_});
    std::ranges::sort(places);
    kept_.assign(places.size(), {});
    for (std::size_t k = 0; k < places.size(); ++k) {
        kept_[k].evaluate(tables_->shapes, places[k]);
        if (!tables_->foreshortening) continue;
        kept_[k].h.resize(modes_, modes_);
        tables_->foreshortening->matrix(kept_[k], kept_[k].h.data());
    }
}

void ModalModel::shorten(const Local& here, const double* q, double* hq) const {
    if (here.h.size() == 0) return tables_->foreshortening->times(here, q, hq);
    Eigen::Map<Eigen::VectorXd>(hq, modes_).noalias() = here.h * Eigen::Map<const Eigen::VectorXd>(q, modes_);
}

const ModalModel::Local& ModalModel::at(double x) const {
    const auto kept = std::ranges::lower_bound(kept_, x, {}, &Local::x);
    Local& here = kept != kept_.end() && kept->x == x ? *kept : elsewhere_;
    if (here.x != x) {
        here.evaluate(tables_->shapes, x);
        here.state = -1;
    }
    if (tables_->foreshortening && here.state != state_ && x != 0) {  // no shortening at the root
        here.state = state_;
        shorten(here, xi_ + 1, here.shortening);
    }
    return here;
}

// first-order (S14), zeroth-order: D = G = 0, paper (S15):
//   [J + qᵀBq] Θ̈ + Uᵀq̈ = −2Θ̇ qᵀBq̇ − g[S cos Θ − Wᵀq sin Θ − ½ cos Θ qᵀGq]
//   U Θ̈ + m q̈ = −C_d q̇ − Kq + Θ̇²Bq + g sin Θ Gq − g cos Θ W
bool ModalModel::assemble(double* f) {
    const ModalMatrices& m = tables_->m;
    const Eigen::Map<const Eigen::VectorXd> q(xi_ + 1, modes_), dq(rate_ + 1, modes_);
    Eigen::Map<Eigen::VectorXd> fq(f + 1, modes_);
    const double Theta_dot = rate_[0];
    if (modes_ == 0) {
        inertia_ = m.J;
        f[0] = -gravity_ * m.S * cos_;
        return true;
    }
    bq_.noalias() = tables_->B * q;
    inertia_ = m.J + q.dot(bq_);
    double gravity_torque = m.S * cos_ - m.W.dot(q) * sin_;
    fq = -m.K.cwiseProduct(q) - gravity_ * cos_ * m.W;
    if (kind_ == ModelKind::first_order) {
        gq_.noalias() = m.G * q;
        gravity_torque -= 0.5 * cos_ * q.dot(gq_);
        fq += Theta_dot * Theta_dot * bq_ + gravity_ * sin_ * gq_;
    } else if (kind_ == ModelKind::paper) {
        // The stiffening weight a(l − x) + ½(l² − x²) with l = L cos θ, in the v-equation only.
        const double l = length_ * cos_;
        gq_.noalias() = m.M * q;
        gq_.noalias() -= (radius_ * l + 0.5 * l * l) * (m.P0 * q);
        gq_.noalias() += radius_ * (m.P1 * q);
        gq_.noalias() += 0.5 * (m.P2 * q);
        fq += Theta_dot * Theta_dot * gq_;
    } else {
        fq += Theta_dot * Theta_dot * bq_;
    }
    f[0] = -2 * Theta_dot * bq_.dot(dq) - gravity_ * gravity_torque;
    add_damping(f);
    const double schur = coupled_ ? inertia_ - m.U.squaredNorm() / mass_ : inertia_;
    return schur > kNegligible * m.J;
}

void ModalModel::solve(double* f) const {
    Eigen::Map<Eigen::VectorXd> fq(f + 1, modes_);
    if (coupled_) {
        const Eigen::VectorXd& U = tables_->m.U;
        const double hub = (f[0] - U.dot(fq) / mass_) / (inertia_ - U.squaredNorm() / mass_);
        fq = (fq - hub * U) / mass_;
        f[0] = hub;
    } else {
        f[0] /= inertia_;
        fq /= mass_;
    }
}

double ModalModel::solve_held(double* f, double hub) const {
    Eigen::Map<Eigen::VectorXd> fq(f + 1, modes_);
    double torque = inertia_ * hub - f[0];
    if (coupled_) fq -= hub * tables_->m.U;
    fq /= mass_;
    if (coupled_) torque += tables_->m.U.dot(fq);
    f[0] = hub;
    return torque;
}

void ModalModel::point(double x, BeamPoint& p) const {
    const Local& here = at(x);
    double v = 0, v1 = 0, v2 = 0, dv = 0, dv1 = 0, qHq = 0, rHq = 0;
    for (int i = 0; i < modes_; ++i) {
        const double q = xi_[1 + i], dq = rate_[1 + i];
        v += here.y[i] * q;
        v1 += here.y1[i] * q;
        v2 += here.y2[i] * q;
        dv += here.y[i] * dq;
        dv1 += here.y1[i] * dq;
    }
    double u = 0, du = 0, u1 = 0, u2 = 0, du1 = 0;
    if (tables_->foreshortening) {
        for (int i = 0; i < modes_; ++i) {
            qHq += xi_[1 + i] * here.shortening[i];
            rHq += rate_[1 + i] * here.shortening[i];
        }
        u = -0.5 * qHq - 0.5 * radius_ * alpha_ * alpha_;  // (S5), (S13)
        du = -rHq - radius_ * alpha_ * alpha_dot_;
        u1 = -0.5 * v1 * v1;
        u2 = -v1 * v2;
        du1 = -v1 * dv1;
    }
    const Vec2 along{cos_, sin_}, across{-sin_, cos_};
    const double Theta_dot = rate_[0];
    const double rx = radius_ + x + u, ry = v;
    p.r = rx * along + ry * across;
    p.r1 = (1 + u1) * along + v1 * across;
    p.r2 = u2 * along + v2 * across;
    p.v = (du - ry * Theta_dot) * along + (dv + rx * Theta_dot) * across;  // (S7)
    p.v1 = (du1 - v1 * Theta_dot) * along + (dv1 + (1 + u1) * Theta_dot) * across;
}

void ModalModel::jacobian(double x, double* jx, double* jy, double* jchi) const {
    const Local& here = at(x);
    const bool shortening = foreshortening();
    double v = 0, v1 = 0, u = 0;
    for (int i = 0; i < modes_; ++i) {
        v += here.y[i] * xi_[1 + i];
        v1 += here.y1[i] * xi_[1 + i];
        if (shortening) u -= 0.5 * here.shortening[i] * xi_[1 + i];
    }
    if (shortening) u -= 0.5 * radius_ * alpha_ * alpha_;
    const double rx = radius_ + x + u, t1 = shortening ? 1 - 0.5 * v1 * v1 : 1;
    const double speed2 = t1 * t1 + v1 * v1;
    jx[0] = -rx * sin_ - v * cos_;
    jy[0] = rx * cos_ - v * sin_;
    jchi[0] = 1;
    for (int i = 0; i < modes_; ++i) {
        const double ui = shortening ? -here.shortening[i] - radius_ * alpha_ * hub_row_[1 + i] : 0;
        const double ui1 = shortening ? -v1 * here.y1[i] : 0;
        jx[1 + i] = ui * cos_ - here.y[i] * sin_;
        jy[1 + i] = ui * sin_ + here.y[i] * cos_;
        jchi[1 + i] = (t1 * here.y1[i] - v1 * ui1) / speed2;
    }
}

// −Θ̇² r + 2Θ̇ k×(u̇, v̇) + (ü, 0) with ü = −q̇ᵀH(x)q̇ − aα̇², as in (S17).
Vec2 ModalModel::convective(double x) const {
    BeamPoint p;
    point(x, p);
    const Local& here = at(x);
    const double Theta_dot = rate_[0];
    const Vec2 along{cos_, sin_};
    const Vec2 relative = p.v - Theta_dot * perp(p.r);
    double bend = 0;
    if (tables_->foreshortening) {
        double h_rate[kMaxModes] = {};
        shorten(here, rate_ + 1, h_rate);
        for (int i = 0; i < modes_; ++i) bend -= rate_[1 + i] * h_rate[i];
        bend -= radius_ * alpha_dot_ * alpha_dot_;
    }
    return -Theta_dot * Theta_dot * p.r + 2 * Theta_dot * perp(relative) + bend * along;
}

double ModalModel::bending_moment(double x) const {
    double y2[kMaxModes];
    tables_->shapes.evaluate(x, nullptr, nullptr, y2);
    double v2 = 0;
    for (int i = 0; i < modes_; ++i) v2 += y2[i] * xi_[1 + i];
    return stiffness_ * v2;
}

Energies ModalModel::energies() const {
    const ModalMatrices& m = tables_->m;
    Energies e;
    const double Theta_dot = rate_[0];
    if (modes_ == 0) return {0.5 * m.J * Theta_dot * Theta_dot, gravity_ * m.S * sin_, 0};
    const Eigen::Map<const Eigen::VectorXd> q(xi_ + 1, modes_), dq(rate_ + 1, modes_);
    bq_.noalias() = tables_->B * q;
    e.kinetic =
        0.5 * (m.J + q.dot(bq_)) * Theta_dot * Theta_dot + Theta_dot * m.U.dot(dq) + 0.5 * mass_ * dq.squaredNorm();
    e.elastic = 0.5 * m.K.dot(q.cwiseAbs2());
    e.gravity = m.S * sin_ + m.W.dot(q) * cos_;
    if (kind_ == ModelKind::first_order) {
        gq_.noalias() = m.G * q;
        e.gravity -= 0.5 * sin_ * q.dot(gq_);
    }
    e.gravity *= gravity_;
    return e;
}

Linearization ModalModel::linearize() const {
    const ModalMatrices& m = tables_->m;
    Linearization linear(size_);
    linear.mass.diagonal().setConstant(mass_);
    linear.mass(0, 0) = m.J;
    linear.mass.col(0).tail(modes_) = m.U;
    linear.mass.row(0).tail(modes_) = m.U.transpose();
    linear.stiffness.diagonal().tail(modes_) = m.K;
    linear.centrifugal.bottomRightCorner(modes_, modes_) = -tables_->B;
    return linear;
}

double ModalModel::frequency(int i) const { return std::sqrt(tables_->m.K[i] / mass_); }

}  // namespace beamcam::sim
