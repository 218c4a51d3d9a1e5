#include "sim/integrate/inertia_forces.hpp"

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "sim/base/linear_algebra.hpp"
#include "sim/base/numerics.hpp"
#include "sim/beam/exact_model.hpp"
#include "sim/beam/modal_model.hpp"
#include "sim/beam/second_order_model.hpp"
#include "sim/integrate/lane_kernels.hpp"

namespace beamcam::sim {
namespace {

// A constant matrix times numbers in lanes.
class LaneMatrix {
  public:
    LaneMatrix() = default;
    explicit LaneMatrix(const Eigen::MatrixXd& m)
        : rows_(static_cast<std::size_t>(m.rows())), columns_(static_cast<std::size_t>(m.cols())) {
        for (Eigen::Index i = 0; i < m.rows(); ++i)
            for (Eigen::Index j = 0; j < m.cols(); ++j) numbers_.push_back(m(i, j));
    }
    void times(const Lanes* x, Lanes* y) const { lane_kernels().multiply(rows_, columns_, numbers_.data(), x, y); }

  private:
    std::size_t rows_ = 0, columns_ = 0;
    std::vector<double> numbers_;
};

Lanes dot(std::size_t n, const double* a, const Lanes* x) {
    Lanes total;
    lane_kernels().multiply(1, n, a, x, &total);
    return total;
}
Lanes dot(std::size_t n, const Lanes* a, const Lanes* x) {
    Lanes total{};
    for (std::size_t i = 0; i < n; ++i) total += a[i] * x[i];
    return total;
}

// The left side of (S14) and (S15) without stiffness and damping, in natural modes: Θ = z₀ + r·z, q = Φz. Their inertia
// is diagonal but for g = qᵀBq about the hub.
class ModalInertia final : public InertiaForces {
  public:
    ModalInertia(const ModalModel& model, const Problem& problem, const Eigen::MatrixXd& natural)
        : n_(static_cast<std::size_t>(model.size()) - 1),
          mass_(model.mass()),
          gravity_(problem.gravity),
          radius_(problem.hub.radius),
          length_(model.length()),
          paper_(model.kind() == ModelKind::paper),
          shortens_(model.kind() == ModelKind::first_order),
          bq_(n_),
          rq_(n_),
          gq_(n_) {
        const ModalMatrices& m = model.matrices();
        const Eigen::Index n = model.size() - 1;
        const Eigen::MatrixXd shapes = natural.bottomRightCorner(n, n);
        const auto in_modes = [&](const Eigen::MatrixXd& by) { return LaneMatrix(in_basis(by, shapes)); };
        J_ = m.J;
        S_ = m.S;
        turn_ = natural.topRightCorner(1, n).transpose();
        weight_ = shapes.transpose() * m.W;
        inertia_ = in_modes(model.inertia_matrix());
        if (paper_) spinning_ = in_modes(m.M + radius_ * m.P1 + 0.5 * m.P2);
        if (paper_ || shortens_) second_ = in_modes(paper_ ? m.P0 : m.G);
    }

    bool in_modes() const override { return true; }

    void evaluate(const NodalMotion& s, Lanes* out) override {
        const Lanes* z = s.position;
        const Lanes theta_dot = s.turn_rate + dot(n_, turn_.data(), s.rate), theta_dot2 = theta_dot * theta_dot,
                    theta_ddot = s.turn_acceleration + dot(n_, turn_.data(), s.acceleration);
        inertia_.times(z, bq_.data());
        Lanes second = gravity_ * s.sin, fall{};
        const Lanes* centrifugal = bq_.data();
        if (paper_) {
            const Lanes l = length_ * s.cos;
            second = -theta_dot2 * (radius_ * l + 0.5 * l * l);
            spinning_.times(z, rq_.data());
            centrifugal = rq_.data();
        }
        if (paper_ || shortens_) second_.times(z, gq_.data());
        if (shortens_) fall = dot(n_, gq_.data(), z);
        gain_ = dot(n_, bq_.data(), z);
        const Lanes pull = gravity_ * s.cos,
                    bent = gain_ * theta_ddot + 2.0 * theta_dot * dot(n_, bq_.data(), s.rate) +
                           gravity_ * (S_ * s.cos - dot(n_, weight_.data(), z) * s.sin - 0.5 * s.cos * fall);
        out[0] = J_ * s.turn_acceleration + bent;
        for (std::size_t i = 0; i < n_; ++i) {
            out[1 + i] = mass_ * s.acceleration[i] + turn_[i] * bent - theta_dot2 * centrifugal[i] - second * gq_[i] +
                         weight_[i] * pull;
        }
    }

    Lanes hub_inertia_gain() const override { return gain_; }

  private:
    std::size_t n_;
    double mass_, gravity_, radius_, length_, J_ = 0, S_ = 0;
    bool paper_, shortens_;
    Eigen::VectorXd turn_, weight_;  // r, ΦᵀW
    LaneMatrix inertia_, spinning_, second_;
    Lanes gain_{};
    std::vector<Lanes> bq_, rq_, gq_;
};

// Shared by both projected models: Gauss nodes, weights ρAw, the matrix P of ∫₀ˣ to the nodes, and PᵀW times ones.
class ProjectedInertia : public InertiaForces {
  protected:
    ProjectedInertia(const Problem& problem, int nodes)
        : n_(static_cast<std::size_t>(problem.beam.modes)),
          count_(static_cast<std::size_t>(nodes)),
          radius_(problem.hub.radius),
          hub_inertia_(problem.hub.inertia),
          gravity_(problem.gravity),
          rule_(gauss_legendre(nodes, problem.beam.length)),
          primitive_(SpectralIntegral(rule_, problem.beam.length).matrix(rule_)),
          weights_(problem.beam.line_density() * rule_.w),
          mass_beyond_(primitive_.transpose() * weights_),
          mass_(weights_.sum()),
          double_integral_(Eigen::MatrixXd(primitive_.transpose() * weights_.asDiagonal() * primitive_)) {}
    std::size_t n_, count_;  // shapes, nodes
    double radius_, hub_inertia_, gravity_;
    Quadrature rule_;
    Eigen::MatrixXd primitive_;
    Eigen::VectorXd weights_, mass_beyond_;  // ρAw, and the mass beyond a node
    double mass_;
    LaneMatrix double_integral_;  // C = PᵀWP
};

// (S17) with the integrals worked out: with s = v′, u = −½∫s² − ½aα², and B = r̈ + g in the frame, the force on q_i
// is ∫φ_i B_y − ∫φ_i′ s F − aαh_i F(0), F(x) the integral of B_x from x to the tip.
class SecondOrderInertia final : public ProjectedInertia {
  public:
    explicit SecondOrderInertia(const Problem& problem) : ProjectedInertia(problem, second_order_nodes(problem)) {
        const Shapes shapes = Shapes::of(problem);
        const Eigen::Index nodes = rule_.x.size(), n = problem.beam.modes;
        Eigen::MatrixXd phi(nodes, n), slope(nodes, n);
        Eigen::VectorXd y(n), y1(n);
        for (Eigen::Index k = 0; k < nodes; ++k) {
            shapes.evaluate(rule_.x[k], y.data(), y1.data(), nullptr);
            phi.row(k) = y.transpose();
            slope.row(k) = y1.transpose();
        }
        const Eigen::VectorXd arm = rule_.x.array() + radius_, weighted_arm = weights_.cwiseProduct(arm);
        const Eigen::MatrixXd weighted = weights_.asDiagonal() * phi, beyond = primitive_.transpose() * weighted;
        arm_beyond_ = primitive_.transpose() * weighted_arm;
        lever_ = weighted_arm.sum();
        inertia_ = weighted_arm.dot(arm);
        weight_ = weighted.colwise().sum();
        coupling_ = weighted.transpose() * arm;
        hub_row_ = Eigen::VectorXd::Zero(n);
        if (resolved_basis(problem) == Basis::hub_beam) shapes.evaluate(0, nullptr, hub_row_.data(), nullptr);
        slopes_ = LaneMatrix(slope);
        slopes_transposed_ = LaneMatrix(slope.transpose());
        beyond_ = LaneMatrix(beyond);
        beyond_transposed_ = LaneMatrix(beyond.transpose());
        products_ = LaneMatrix(phi.transpose() * weighted);
        for (auto* v : {&s_, &rate_, &square_, &mixed_, &bent_, &force_, &stretch_}) v->resize(count_);
        for (auto* v : {&by_square_, &by_mixed_, &by_bent_, &combined_, &mq_, &lateral_}) v->resize(n_);
    }

    void evaluate(const NodalMotion& m, Lanes* out) override {
        const Lanes *q = m.position, *dq = m.rate, *ddq = m.acceleration;
        const Lanes &theta_dot = m.turn_rate, &theta_ddot = m.turn_acceleration;
        const Lanes theta_dot2 = theta_dot * theta_dot;
        shorten(q, dq, ddq);
        // −½aα² and its rates.
        const Lanes alpha = dot(n_, hub_row_.data(), q), dalpha = dot(n_, hub_row_.data(), dq),
                    ddalpha = dot(n_, hub_row_.data(), ddq);
        const Lanes e = (-0.5 * radius_) * alpha * alpha, de = -radius_ * alpha * dalpha,
                    dde = -radius_ * (dalpha * dalpha + alpha * ddalpha);
        const Lanes along = dde - theta_dot2 * e + gravity_ * m.sin,
                    across = 2.0 * theta_dot * de + theta_ddot * e + gravity_ * m.cos;
        // F at the nodes, and F(0)
        for (std::size_t i = 0; i < n_; ++i) combined_[i] = -2.0 * theta_dot * dq[i] - theta_ddot * q[i];
        beyond_.times(combined_.data(), force_.data());
        const Sums sums = integrate_shortening();
        for (std::size_t k = 0; k < count_; ++k) force_[k] += theta_dot2 * stretch_[k];
        const Lanes whole = theta_dot2 * sums.mass_square - dot(count_, mass_beyond_.data(), bent_.data()) +
                            dot(n_, weight_.data(), combined_.data()) + mass_ * along - lever_ * theta_dot2;
        double_integral_.times(bent_.data(), stretch_.data());
        for (std::size_t k = 0; k < count_; ++k) {
            force_[k] += mass_beyond_[k] * along - arm_beyond_[k] * theta_dot2 - stretch_[k];
            force_[k] *= s_[k];
        }
        slopes_transposed_.times(force_.data(), lateral_.data());
        // ∫φ_i B_y, B_y = v̈ − Θ̇²v + 2Θ̇u̇ + Θ̈(a + x + u) + g cos Θ
        for (std::size_t i = 0; i < n_; ++i) combined_[i] = ddq[i] - theta_dot2 * q[i];
        products_.times(combined_.data(), mq_.data());
        const Lanes hub = hub_inertia_ * (theta_ddot + ddalpha);
        for (std::size_t i = 0; i < n_; ++i) {
            out[1 + i] = mq_[i] + coupling_[i] * theta_ddot + weight_[i] * across - 2.0 * theta_dot * by_mixed_[i] -
                         theta_ddot * by_square_[i] - lateral_[i] + hub_row_[i] * (hub - radius_ * alpha * whole);
        }
        // ∫(a + x + u)B_y − ∫vB_x
        const Lanes lateral_all = dot(n_, weight_.data(), combined_.data()) - 2.0 * theta_dot * sums.mass_mixed -
                                  theta_ddot * sums.mass_square + lever_ * theta_ddot + mass_ * across;
        Lanes moment = dot(n_, coupling_.data(), combined_.data()) - 2.0 * theta_dot * sums.arm_mixed -
                       theta_ddot * sums.arm_square + inertia_ * theta_ddot + lever_ * across + e * lateral_all;
        // −½∫s² ∫ₓB_y
        moment -= dot(n_, by_square_.data(), combined_.data()) - 2.0 * theta_dot * sums.stretched_rate -
                  theta_ddot * sums.stretched + theta_ddot * sums.arm_square + across * sums.mass_square;
        products_.times(q, mq_.data());
        for (std::size_t i = 0; i < n_; ++i) {
            moment -=
                q[i] * (theta_dot2 * by_square_[i] - by_bent_[i] + weight_[i] * along - coupling_[i] * theta_dot2) -
                mq_[i] * (2.0 * theta_dot * dq[i] + theta_ddot * q[i]);
        }
        out[0] = moment + hub;
    }

  private:
    // s = v′ at the nodes; s², sṡ, ṡ² + ss̈.
    void shorten(const Lanes* q, const Lanes* dq, const Lanes* ddq) {
        slopes_.times(q, s_.data());
        slopes_.times(dq, rate_.data());
        slopes_.times(ddq, bent_.data());
        for (std::size_t k = 0; k < count_; ++k) {
            square_[k] = s_[k] * s_[k];
            mixed_[k] = s_[k] * rate_[k];
            bent_[k] = rate_[k] * rate_[k] + s_[k] * bent_[k];
        }
    }

    // Integrals of ½s² and of its rate sṡ: with the mass and the static moment beyond each point, and with ½C s².
    struct Sums {
        Lanes mass_square, mass_mixed, arm_square, arm_mixed, stretched, stretched_rate;
    };
    // Halves the squares; stretch_ ← ½C s².
    Sums integrate_shortening() {
        for (std::size_t k = 0; k < count_; ++k) square_[k] *= 0.5;
        double_integral_.times(square_.data(), stretch_.data());
        beyond_transposed_.times(square_.data(), by_square_.data());
        beyond_transposed_.times(mixed_.data(), by_mixed_.data());
        beyond_transposed_.times(bent_.data(), by_bent_.data());
        const auto over = [&](const auto& weights, const std::vector<Lanes>& values) {
            return dot(count_, weights.data(), values.data());
        };
        return {over(mass_beyond_, square_), over(mass_beyond_, mixed_), over(arm_beyond_, square_),
                over(arm_beyond_, mixed_),   over(stretch_, square_),    over(stretch_, mixed_)};
    }

    double lever_, inertia_;
    Eigen::VectorXd arm_beyond_, weight_, coupling_, hub_row_;
    LaneMatrix slopes_, slopes_transposed_, beyond_, beyond_transposed_, products_;
    std::vector<Lanes> s_, rate_, square_, mixed_, bent_, force_, stretch_;
    std::vector<Lanes> by_square_, by_mixed_, by_bent_, combined_, mq_, lateral_;
};

// (S18), (S19) in the frame of the hub: the section's angle against it is δ = Σ q_j η_j, and the force on q_j is
// ∫η_j (cos δ F_y − sin δ F_x), F the integral of ρA(r̈ + g) from x to the tip.
class ExactInertia final : public ProjectedInertia {
  public:
    explicit ExactInertia(const Problem& problem) : ProjectedInertia(problem, exact_nodes(problem)) {
        const Eigen::Index nodes = rule_.x.size(), n = problem.beam.modes;
        Eigen::MatrixXd eta(nodes, n);
        Eigen::VectorXd row(n);
        for (Eigen::Index k = 0; k < nodes; ++k) {
            section_angle_shapes(rule_.x[k], problem.beam.length, problem.beam.modes, 0, row.data());
            eta.row(k) = row.transpose();
        }
        shapes_ = LaneMatrix(eta);
        shapes_transposed_ = LaneMatrix(eta.transpose());
        for (auto* v : {&sin_, &cos_, &rate_, &bend_, &x_, &y_}) v->resize(count_);
    }

    void evaluate(const NodalMotion& m, Lanes* out) override {
        const Lanes &theta_dot = m.turn_rate, &theta_ddot = m.turn_acceleration;
        shapes_.times(m.position, bend_.data());
        for (std::size_t k = 0; k < count_; ++k) sine_and_cosine(bend_[k], sin_[k], cos_[k]);
        shapes_.times(m.rate, rate_.data());
        shapes_.times(m.acceleration, bend_.data());
        for (std::size_t k = 0; k < count_; ++k) {
            const Lanes rate = rate_[k] + theta_dot, square = rate * rate, bend = bend_[k] + theta_ddot;
            rate_[k] = -bend * sin_[k] - square * cos_[k];
            bend_[k] = bend * cos_[k] - square * sin_[k];
        }
        double_integral_.times(rate_.data(), x_.data());
        double_integral_.times(bend_.data(), y_.data());
        const Lanes along = gravity_ * m.sin - radius_ * theta_dot * theta_dot,
                    across = gravity_ * m.cos + radius_ * theta_ddot;
        Lanes moment{}, whole = mass_ * across;
        for (std::size_t k = 0; k < count_; ++k) {
            const double beyond = mass_beyond_[k];
            whole += beyond * bend_[k];
            x_[k] = cos_[k] * (y_[k] + beyond * across) - sin_[k] * (x_[k] + beyond * along);
            moment += x_[k];
        }
        shapes_transposed_.times(x_.data(), out + 1);
        out[0] = moment + radius_ * whole + hub_inertia_ * theta_ddot;
    }

  private:
    LaneMatrix shapes_, shapes_transposed_;
    std::vector<Lanes> sin_, cos_, rate_, bend_, x_, y_;
};

}  // namespace

std::unique_ptr<InertiaForces> InertiaForces::of(const Model& model, const Problem& problem,
                                                 const Eigen::MatrixXd& natural) {
    switch (problem.beam.model) {
        case ModelKind::second_order:
            return std::make_unique<SecondOrderInertia>(problem);
        case ModelKind::exact:
            return std::make_unique<ExactInertia>(problem);
        case ModelKind::rigid:
        case ModelKind::zeroth_order:
        case ModelKind::first_order:
        case ModelKind::paper:
            break;
    }
    return std::make_unique<ModalInertia>(dynamic_cast<const ModalModel&>(model), problem, natural);
}

}  // namespace beamcam::sim
