#include "tests/bench/yardstick.hpp"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/beam/modal_model.hpp"

namespace beamcam::bench {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class Beam {
  public:
    explicit Beam(const sim::Problem& problem)
        : problem_(problem),
          shapes_(sim::Shapes::of(problem)),
          m_(sim::modal_matrices(problem, shapes_, sim::resolved_basis(problem))),
          n_(problem.beam.modes),
          mass_(problem.beam.line_density() * problem.beam.length),
          stiffness_(sim::contact_stiffness(problem)),
          damping_(sim::damping_factor(problem.contact.damping, problem.contact.restitution)),
          y_(n_),
          y1_(n_),
          y2_(n_),
          inertia_(n_ + 1, n_ + 1),
          force_(n_ + 1),
          B_(m_.M - m_.D) {}

    int size() const { return 2 * (n_ + 1); }
    int modes() const { return n_; }
    const VectorXd& slope() const { return m_.slope; }

    // Gap and its rate.
    void gap(double t, const double* y, double& gap, double& rate) {
        place(t, y);
        find_foot();
        const Eigen::Vector2d r = point(x_), velocity = speed(x_), d = r - disc_;
        normal_ = d.normalized();
        gap = d.norm() - problem_.cam->radius;
        rate = normal_.dot(velocity - disc_rate_);
    }

    void rhs(double t, const double* y, double* dy) {
        const double g = problem_.gravity;
        place(t, y);
        inertia_.setZero();
        inertia_(0, 0) = m_.J + q_.dot(B_ * q_);
        inertia_.block(1, 0, n_, 1) = m_.U;
        inertia_.block(0, 1, 1, n_) = m_.U.transpose();
        inertia_.bottomRightCorner(n_, n_).diagonal().setConstant(mass_);
        force_[0] =
            -2 * spin_ * q_.dot(B_ * dq_) - g * (m_.S * cos_ - m_.W.dot(q_) * sin_ - 0.5 * cos_ * q_.dot(m_.G * q_));
        force_.tail(n_) = -m_.K.cwiseProduct(q_) + spin_ * spin_ * (B_ * q_) + g * sin_ * (m_.G * q_) - g * cos_ * m_.W;
        if (touching) {
            double gap_now, rate;
            gap(t, y, gap_now, rate);
            if (gap_now < 0) {
                const double depth = -gap_now;
                const double f =
                    std::max(0.0, stiffness_ * depth * std::sqrt(depth) * (1 - damping_ * rate / approach));
                // ∂(n·r)/∂Θ and ∂(n·r)/∂q
                const Eigen::Vector2d r = point(x_), across(-sin_, cos_);
                force_[0] += f * (normal_.y() * r.x() - normal_.x() * r.y());
                force_.tail(n_) += f * normal_.dot(across) * y_;
            }
        }
        const VectorXd acceleration = inertia_.ldlt().solve(force_);
        std::copy_n(y + n_ + 1, n_ + 1, dy);
        std::copy_n(acceleration.data(), n_ + 1, dy + n_ + 1);
    }

    bool touching = false;
    double approach = 1;

  private:
    void place(double t, const double* y) {
        q_ = Eigen::Map<const VectorXd>(y + 1, n_);
        dq_ = Eigen::Map<const VectorXd>(y + n_ + 2, n_);
        spin_ = y[n_ + 1];
        sin_ = std::sin(y[0]);
        cos_ = std::cos(y[0]);
        const sim::Cam& cam = *problem_.cam;
        const double psi = cam.phase - cam.speed * t, e = cam.eccentricity;
        disc_ << cam.centre.x + e * std::cos(psi), cam.centre.y + e * std::sin(psi);
        disc_rate_ << e * cam.speed * std::sin(psi), -e * cam.speed * std::cos(psi);
    }

    Eigen::Vector2d point(double x) {
        shapes_.evaluate(x, y_.data(), nullptr, nullptr);
        const double along = problem_.hub.radius + x, v = y_.dot(q_);
        return {along * cos_ - v * sin_, along * sin_ + v * cos_};
    }
    Eigen::Vector2d speed(double x) {
        const double along = problem_.hub.radius + x, v = y_.dot(q_), dv = y_.dot(dq_);
        return {-dv * sin_ - spin_ * (along * sin_ + v * cos_), dv * cos_ + spin_ * (along * cos_ - v * sin_)};
    }

    // Newton's method on r′·(r − B) = 0 from the last foot.
    void find_foot() {
        for (int i = 0; i < 20; ++i) {
            const Eigen::Vector2d d = point(x_) - disc_;
            shapes_.evaluate(x_, nullptr, y1_.data(), y2_.data());
            const double v1 = y1_.dot(q_), v2 = y2_.dot(q_);
            const Eigen::Vector2d r1(cos_ - v1 * sin_, sin_ + v1 * cos_), r2(-v2 * sin_, v2 * cos_);
            const double dx = -r1.dot(d) / (r2.dot(d) + r1.squaredNorm());
            x_ = std::clamp(x_ + dx, 0.0, problem_.beam.length);
            if (std::fabs(dx) < 1e-14) break;
        }
    }

    const sim::Problem& problem_;
    sim::Shapes shapes_;
    sim::ModalMatrices m_;
    int n_;
    double mass_, stiffness_, damping_;
    VectorXd y_, y1_, y2_, q_, dq_;
    MatrixXd inertia_;
    VectorXd force_;
    MatrixXd B_;
    double spin_ = 0, sin_ = 0, cos_ = 1, x_ = 0.25;
    Eigen::Vector2d disc_, disc_rate_, normal_;
};

int cvode_rhs(double t, N_Vector y, N_Vector dy, void* beam) {
    static_cast<Beam*>(beam)->rhs(t, N_VGetArrayPointer(y), N_VGetArrayPointer(dy));
    return 0;
}
int cvode_root(double t, N_Vector y, double* out, void* beam) {
    double rate;
    static_cast<Beam*>(beam)->gap(t, N_VGetArrayPointer(y), out[0], rate);
    return 0;
}

void check(int flag) {
    if (flag < 0) throw std::runtime_error("CVODE failed");
}

}  // namespace

YardstickRun run_yardstick(const sim::Problem& problem, double rtol, double atol, const std::vector<double>& times,
                           long give_up) {
    Beam beam(problem);
    SUNContext context = nullptr;
#if SUNDIALS_VERSION_MAJOR >= 7
    SUNContext_Create(SUN_COMM_NULL, &context);
#else
    SUNContext_Create(nullptr, &context);
#endif
    N_Vector y = N_VNew_Serial(beam.size(), context);
    double* state = N_VGetArrayPointer(y);
    std::fill_n(state, beam.size(), 0.0);
    state[0] = problem.initial.angle;
    void* memory = CVodeCreate(CV_ADAMS, context);
    SUNNonlinearSolver solver = SUNNonlinSol_FixedPoint(y, 0, context);
    check(CVodeInit(memory, cvode_rhs, 0, y));
    check(CVodeSStolerances(memory, rtol, atol));
    check(CVodeSetNonlinearSolver(memory, solver));
    check(CVodeSetUserData(memory, &beam));
    check(CVodeSetMaxNumSteps(memory, 100000000));
    check(CVodeRootInit(memory, 1, cvode_root));

    YardstickRun out;
    const auto collect = [&] {
        long steps = 0, rhs = 0;
        CVodeGetNumSteps(memory, &steps);
        CVodeGetNumRhsEvals(memory, &rhs);
        out.steps += steps;
        out.rhs += rhs;
    };
    double t = 0;
    for (std::size_t i = 0; i < times.size();) {
        if (times[i] > t) {
            const int flag = CVode(memory, times[i], y, &t, CV_NORMAL);
            check(flag);
            if (flag == CV_ROOT_RETURN) {
                double gap, rate;
                beam.gap(t, state, gap, rate);
                beam.touching = rate < 0;
                if (beam.touching) {
                    beam.approach = std::max(-rate, problem.contact.approach_floor.value);
                    if (++out.impacts > give_up) break;
                }
                collect();
                check(CVodeReInit(memory, t, y));
                continue;
            }
        }
        out.theta.push_back(state[0] + beam.slope().dot(Eigen::Map<const VectorXd>(state + 1, beam.modes())));
        if (sim::resolved_basis(problem) == sim::Basis::cantilever) out.theta.back() = state[0];
        ++i;
    }
    collect();
    CVodeFree(&memory);
    SUNNonlinSolFree(solver);
    N_VDestroy(y);
    SUNContext_Free(&context);
    return out;
}

}  // namespace beamcam::bench
