#include "sim/orbit/tangent_step.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/base/numerics.hpp"
#include "sim/integrate/nodal_step.hpp"

namespace beamcam::sim {
namespace {

constexpr double kTangentRounding = 1e-11;  // smallest tolerance of a step: that of the differences of Variation
// Least order of convergence of a step. Step lengths of neighbouring levels differ by √2.
constexpr int kTangentOrder = 8;

// The hub as an oscillator without stiffness.
StepTable::Row hub_row(double h) {
    const Collocation& gauss = Collocation::get();
    StepTable::Row row{};
    row.qq = row.vv = Lanes{} + 1.0;
    row.qv = h * gauss.c;
    for (std::size_t l = 0; l < kNodes; ++l) {
        row.q[l] = (h * h) * gauss.integrate_twice[l];
        row.v[l] = h * gauss.integrate[l];
    }
    row.end_q = (h * h) * (gauss.b * (1.0 - gauss.c));
    row.end_v = h * gauss.b;
    row.end_qq = row.end_vv = 1;
    row.end_qv = h;
    return row;
}

}  // namespace

TangentStep::TangentStep(System& system, Variation& variation, const Eigen::VectorXd& units, double rtol,
                         Progress progress)
    : variation_(variation),
      units_(units),
      rtol_(std::max(rtol, kTangentRounding)),
      progress_(std::move(progress)),
      n_(system.coordinates()),
      forced_(n_ + (system.has_bristle() ? 1 : 0)),
      flight_level_(kFirstFlightLevel),
      touch_level_(kFirstTouchLevel),
      y_(system.size) {
    const Model& model = system.model();
    const Eigen::VectorXd inertia = model.linearize().mass.diagonal();
    for (int i = 0; i + 1 < n_; ++i) {
        const double rate = model.damping() ? (*model.damping())(i, i) / inertia[i + 1] : 0;
        oscillators_.push_back({model.frequency(i), 0.5 * rate});
    }
}

// The table of the step length of this level, or of the rest of the interval if that is shorter. Rows: hub, modes.
const StepTable& TangentStep::table(int level, double rest) {
    const double h = step_length(level);
    const bool odd = rest <= kRestLevel * h && std::fabs(rest - h) > kLongRounding * h;
    StepTable& entry = odd ? tables_.length(rest) : tables_.level(level);
    if (entry.rows.size() == oscillators_.size()) entry.rows.insert(entry.rows.begin(), hub_row(entry.h));
    return entry;
}

// D_xF at the nodes, without the oscillators.
void TangentStep::differentiate(const Segment& motion, double t0, double h) {
    const Collocation& gauss = Collocation::get();
    for (int k = 0; k < kNodes; ++k) {
        const double t = t0 + h * gauss.c[k];
        motion.value(t, y_.data());
        variation_.set(t, y_.data(), phase_);
        derivative_[k] = variation_.field().leftCols(2 * n_ + kTangentMemories);
        for (int i = 1; i < n_; ++i) {
            const Oscillator& o = oscillators_[static_cast<std::size_t>(i - 1)];
            derivative_[k](i, i) += o.omega * o.omega;
            derivative_[k](i, n_ + i) += 2 * o.gamma;
        }
    }
}

// The equations of the nodal forcing: f_k − D_k Σ_l R_kl f_l = D_k v_k, v_k the unforced solution.
void TangentStep::couple(const StepTable& table) {
    const Collocation& gauss = Collocation::get();
    matrix_.setIdentity(forced_ * kNodes, forced_ * kNodes);
    for (int j = 0; j < forced_; ++j)
        for (int l = 0; l < kNodes; ++l) {
            Lanes q, v{};
            if (j < n_) {
                q = table.rows[static_cast<std::size_t>(j)].q[static_cast<std::size_t>(l)];
                v = table.rows[static_cast<std::size_t>(j)].v[static_cast<std::size_t>(l)];
            } else {
                q = table.h * gauss.integrate[static_cast<std::size_t>(l)];
            }
            const int by = j < n_ ? j : 2 * n_;
            double* column = matrix_.col(j * kNodes + l).data();
            for (int i = 0; i < forced_; ++i)
                for (int k = 0; k < kNodes; ++k) {
                    const double rate = j < n_ ? derivative_[k](i, n_ + j) * v[k] : 0;
                    column[i * kNodes + k] -= derivative_[k](i, by) * q[k] + rate;
                }
        }
    lu_.compute(matrix_);
}

// Largest error in units of the tolerance.
double TangentStep::solve(const StepTable& table, const Eigen::MatrixXd& before, Eigen::MatrixXd& after) {
    const Collocation& gauss = Collocation::get();
    const auto columns = before.cols();
    forcing_.resize(forced_ * kNodes, columns);
    unforced_.resize(2 * n_ + kTangentMemories, columns);
    for (int k = 0; k < kNodes; ++k) {
        for (int j = 0; j < n_; ++j) {
            const StepTable::Row& row = table.rows[static_cast<std::size_t>(j)];
            unforced_.row(j) = row.qq[k] * before.row(j) + row.qv[k] * before.row(n_ + j);
            unforced_.row(n_ + j) = row.vq[k] * before.row(j) + row.vv[k] * before.row(n_ + j);
        }
        unforced_.bottomRows(kTangentMemories) = before.bottomRows(kTangentMemories);
        for (int i = 0; i < forced_; ++i) forcing_.row(i * kNodes + k) = derivative_[k].row(i) * unforced_;
    }
    forcing_ = lu_.solve(forcing_).eval();
    after.resize(before.rows(), columns);
    after.bottomRows(kTangentMemories) = before.bottomRows(kTangentMemories);
    for (Eigen::Index c = 0; c < columns; ++c) {
        const auto nodal = [&](int i) {
            Lanes f;
            for (int k = 0; k < kNodes; ++k) f[k] = forcing_(i * kNodes + k, c);
            return f;
        };
        for (int i = 0; i < n_; ++i) {
            const StepTable::Row& row = table.rows[static_cast<std::size_t>(i)];
            const double q = before(i, c), v = before(n_ + i, c);
            const Lanes f = nodal(i);
            after(i, c) = row.end_qq * q + row.end_qv * v + sum(row.end_q * f);
            after(n_ + i, c) = row.end_vq * q + row.end_vv * v + sum(row.end_v * f);
        }
        if (forced_ > n_) after(2 * n_, c) += table.h * sum(gauss.b * nodal(n_));
    }
    return error(table.h, before, after);
}

double TangentStep::error(double h, const Eigen::MatrixXd& before, const Eigen::MatrixXd& after) const {
    double largest = 0;
    for (Eigen::Index c = 0; c < before.cols(); ++c) {
        double squares = 0;
        for (int i = 0; i < forced_; ++i) {
            Lanes f;
            for (int k = 0; k < kNodes; ++k) f[k] = forcing_(i * kNodes + k, c);
            const bool mode = i > 0 && i < n_;
            const double reach = mode ? std::min(h, 1 / oscillators_[static_cast<std::size_t>(i - 1)].omega) : h;
            const double e = units_[n_ + i] * interpolation_error(f) * reach;
            squares += e * e;
        }
        const double size =
            std::max(units_.cwiseProduct(before.col(c)).norm(), units_.cwiseProduct(after.col(c)).norm());
        if (size > 0) largest = std::max(largest, std::sqrt(squares) / (rtol_ * size));
        if (!std::isfinite(squares)) return kNoSolution;
    }
    return largest;
}

void TangentStep::advance(const Segment& motion, double t0, double t1, Eigen::MatrixXd& tangents) {
    if (tangents.cols() == 0) return;
    Eigen::MatrixXd at = units_.cwiseInverse().asDiagonal() * tangents, after;
    int& level = phase_.touching ? touch_level_ : flight_level_;
    for (double t = t0; t < t1;) {
        const StepTable& step = table(level, t1 - t);
        const bool last = t1 - t <= kRestLevel * step_length(level);
        differentiate(motion, t, step.h);
        couple(step);
        const double e = solve(step, at, after);
        if (++steps_ % kStepsPerReport == 0 && progress_ && !progress_(t)) throw Interrupted();
        if (e > 1 && level == kLowestLevel) throw StepFailure("the tangents cannot be integrated");
        if (e > 1) {
            level = std::max(kLowestLevel, lower_level(level, step.h, e, kTangentOrder, 4));
            continue;
        }
        if (tables_.on_ladder(step)) level = higher_level(level, e, kLongerFlight, kMuchLongerFlight);
        t = last ? t1 : t + step.h;
        at = after;
    }
    tangents = units_.asDiagonal() * at;
}

}  // namespace beamcam::sim
