#include "sim/orbit/exponents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "sim/base/numerics.hpp"
#include "sim/orbit/flow_map.hpp"
#include "sim/run/run.hpp"

namespace beamcam::sim {
namespace {

constexpr double kSureErrors = 3;  // of an exponent that surely differs from zero, over its standard error
// Orthonormalization multiplies errors by the inverse share of a tangent that remains. It is repeated so often that the
// share is at least kLeastShare, but not more than 1/kShortest times an interval: a single impact may leave any share.
constexpr double kLeastShare = 1e-4, kShortest = 1.0 / 64;
constexpr double kHalvesApart = 4;  // standard errors between the halves of an average
// Blocks that do not match the period of a periodic motion may differ by this share of the whole.
constexpr double kBlockRounding = 1e-3;
constexpr double kGrazing = 0.01;  // of the root mean square approach speed: slower impacts are near grazing
// Tolerance of tangents over rtol: their errors enter an exponent once and are not amplified.
constexpr double kTangentErrors = 100;
constexpr std::size_t kHistory = 400;  // approximate number of points of the convergence history
// Chaos requires that the later half of a motion multiplies differences by more than e^kLateGrowth. Linear growth does
// not.                                                                                                          (S74)
constexpr double kLateGrowth = 3;

// The standard error of the mean of several blocks.
double standard_error(const Eigen::ArrayXd& blocks, double mean) {
    const auto n = static_cast<double>(blocks.size());
    return std::sqrt((blocks - mean).square().sum() / (n * (n - 1)));
}

// Gram–Schmidt orthonormalization, repeated once against rounding. Returns the remaining length of each column. A
// column annihilated by sustained contact has length zero and stays zero.
Eigen::VectorXd orthonormalize(Eigen::MatrixXd& v) {
    Eigen::VectorXd lengths = Eigen::VectorXd::Zero(v.cols());
    for (Eigen::Index i = 0; i < v.cols(); ++i) {
        const auto before = v.leftCols(i);
        const double rounding = kLongRounding * v.col(i).norm();
        for (int repeat = 0; repeat < 2; ++repeat) v.col(i) -= before * (before.transpose() * v.col(i)).eval();
        const double length = v.col(i).norm();
        if (length > rounding) lengths[i] = length;
        v.col(i) *= lengths[i] > 0 ? 1 / length : 0;
    }
    return lengths;
}

// Orthonormalizes the tangents and sums the logarithms of their growth.                                       (S74)
class Stretching {
  public:
    // `first`: the initial tangents.
    Stretching(const Eigen::MatrixXd& first, int blocks, double transient, double duration, double interval)
        : first_(first), sum_(Eigen::VectorXd::Zero(first.cols())), block_start_(sum_), transient_(transient) {
        const auto pieces = [&](double span) { return std::max(1.0, std::ceil(span / interval)); };
        per_block_ = static_cast<long>(pieces(duration / blocks));
        step_ = duration / static_cast<double>(per_block_ * blocks);
        settling_ = transient > 0 ? static_cast<long>(pieces(transient)) : 0;
        reach_ = kShortest * step_;
        block_ = Eigen::MatrixXd::Zero(first.cols(), blocks);
        thinning_ = std::max<long>(1, per_block_ * blocks / static_cast<long>(kHistory));
    }
    double first_pause() const { return std::min(instant(1), reach_); }

    double at(double t, Tangents& tangents) {
        Eigen::MatrixXd v = tangents.tangents(true);
        const Eigen::VectorXd length = v.colwise().norm();
        const Eigen::VectorXd left = orthonormalize(v);
        const bool lost = (left.array() > 0 && left.array() < kLeastShare * length.array()).any();
        reach_ = lost ? std::max(0.5 * reach_, kShortest * step_) : std::min(2 * reach_, step_);
        if (done_ >= settling_) sum_.array() += left.array().log();
        if (t >= instant(done_ + 1)) {
            advance();
            if (done_ == settling_) replace_annihilated(v, left, tangents);
        }
        tangents.set_canonical(v);
        return std::min(instant(done_ + 1), t + reach_);
    }

    // The last instant may equal the end up to rounding.
    void finish(double end, Tangents& tangents) {
        if (done_ == settling_ + per_block_ * block_.cols()) return;
        at(end, tangents);
        if (done_ < settling_ + per_block_ * block_.cols()) advance();
    }

    void results(Exponents& e) const {
        const double duration = e.duration, blocks = static_cast<double>(block_.cols());
        std::vector<Eigen::Index> order(static_cast<std::size_t>(sum_.size()));
        std::iota(order.begin(), order.end(), 0);
        std::ranges::stable_sort(order, [&](auto a, auto b) { return sum_[a] > sum_[b]; });
        e.time = time_;
        e.settled = halves_agree(order.front());
        for (const Eigen::Index i : order) {
            e.lambda.push_back(sum_[i] / duration);
            const Eigen::ArrayXd rates = block_.row(i).array() * (blocks / duration);
            e.error.push_back(std::isfinite(sum_[i]) ? standard_error(rates, rates.mean()) : 0);
            std::vector<double>& history = e.history.emplace_back();
            for (const Eigen::VectorXd& row : history_) history.push_back(row[i]);
        }
    }

  private:
    double instant(long k) const {
        return k <= settling_ ? transient_ * static_cast<double>(k) / static_cast<double>(settling_)
                              : transient_ + step_ * static_cast<double>(k - settling_);
    }
    // The halves of the average of this exponent agree.
    bool halves_agree(Eigen::Index i) const {
        const Eigen::Index half = block_.cols() / 2;
        if (half < 2 || !std::isfinite(sum_[i])) return true;
        const Eigen::ArrayXd first = block_.row(i).head(half), second = block_.row(i).tail(half);
        const double error = std::hypot(standard_error(first, first.mean()), standard_error(second, second.mean()));
        return std::fabs(first.mean() - second.mean()) <= kHalvesApart * error + kBlockRounding * std::fabs(sum_[i]);
    }
    void advance() {
        ++done_;
        const long k = done_ - settling_;
        if (k <= 0) return;
        if (k % thinning_ == 0 || k == per_block_ * block_.cols()) {
            time_.push_back(step_ * static_cast<double>(k));
            history_.push_back(sum_ / time_.back());
        }
        if (k % per_block_ != 0) return;
        block_.col(k / per_block_ - 1) = sum_ - block_start_;
        block_start_ = sum_;
    }

    // Replaces tangents that sustained contact annihilated during the transient.
    void replace_annihilated(Eigen::MatrixXd& v, const Eigen::VectorXd& left, Tangents& tangents) const {
        if ((left.array() > 0).all()) return;
        for (Eigen::Index i = 0; i < v.cols(); ++i)
            if (left[i] == 0) v.col(i) = first_.col(i);
        orthonormalize(v);
        tangents.set_canonical(v);
        tangents.keep_on_cam();
        v = tangents.tangents(true);
        orthonormalize(v);
    }

    Eigen::MatrixXd first_;
    Eigen::VectorXd sum_, block_start_;
    Eigen::MatrixXd block_;
    double transient_, step_;
    double reach_;  // of the next orthonormalization [s]
    long per_block_, settling_, thinning_, done_ = 0;
    std::vector<double> time_;
    std::vector<Eigen::VectorXd> history_;
};

// Orthonormal columns in arbitrary directions.
Eigen::MatrixXd first_tangents(Eigen::Index n, Eigen::Index count) {
    Eigen::MatrixXd v(n, count);
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < count; ++j)
            v(i, j) = std::cos(1.0 + 3.7 * double(i) + 2.3 * double(i * j)) + (i == j);
    orthonormalize(v);
    return v;
}

// With a prescribed hub neighbouring motions have the same hub angle and speed.
Eigen::MatrixXd all_tangents(const Problem& problem, int coordinates, int count) {
    const Eigen::Index n = coordinates;
    if (!is_prescribed(problem.hub.drive)) {
        const Eigen::Index most = 2 * n;
        return first_tangents(most, count == 0 ? most : std::min<Eigen::Index>(count, most));
    }
    const Eigen::Index most = 2 * (n - 1), columns = count == 0 ? most : std::min<Eigen::Index>(count, most);
    const Eigen::MatrixXd free = first_tangents(most, columns);
    Eigen::MatrixXd v = Eigen::MatrixXd::Zero(2 * n, columns);
    v.middleRows(1, n - 1) = free.topRows(n - 1);
    v.bottomRows(n - 1) = free.bottomRows(n - 1);
    return v;
}

void judge_impacts(const std::vector<TangentTouch>& touches, Exponents& e) {
    std::vector<double> approaches;
    for (const TangentTouch& touch : touches)
        if (touch.t > e.transient) approaches.push_back(touch.approach);
    if (approaches.empty()) return;
    e.impacts = static_cast<long>(approaches.size());
    e.slowest_impact = std::ranges::min(approaches);
    double squares = 0;
    for (const double approach : approaches) squares += approach * approach;
    const double typical = std::sqrt(squares / static_cast<double>(approaches.size()));
    for (const double approach : approaches)
        if (approach < kGrazing * typical) {
            ++e.near_grazing;
            e.doubt += std::log(typical / approach) / e.duration;
        }
    if (e.near_grazing > 0)
        e.warnings.push_back(fmt::format(
            "{} of {} impacts are near grazing (slower than {:g} of the typical approach speed): the linearized impact "
            "holds for small differences only, and the largest exponent may be too large by {:.3g} 1/s",
            e.near_grazing, e.impacts, kGrazing, e.doubt));
}

}  // namespace

bool Exponents::diverges() const { return lambda.front() > kSureErrors * error.front(); }

const char* Exponents::against_chaos() const {
    if (lambda.empty()) return "the hub's motion is prescribed and the beam rigid";
    if (impacts == 0) return "there were no impacts";
    if (!settled) return "the motion had not settled; a longer transient may help";
    if (!(lambda.front() > 0)) return "the largest exponent is not positive";
    if (!diverges()) return "the largest exponent does not exceed three times its error; a longer duration may help";
    if (!(lambda.front() * duration / 2 > kLateGrowth)) return "differences grow by less than e³ in the second half";
    return nullptr;
}

Chaos Exponents::chaos() const {
    if (against_chaos()) return Chaos::not_shown;
    return lambda.front() > kSureErrors * error.front() + doubt ? Chaos::shown : Chaos::doubtful;
}

Exponents lyapunov_exponents(const Problem& problem, const ExponentsRequest& request, const Progress& progress) {
    require_valid(problem);
    if (!(request.transient >= 0) || !(request.duration > 0) || request.blocks < 2 || request.count < 0)
        throw std::invalid_argument("exponents need transient >= 0, duration > 0, blocks >= 2 and count >= 0");
    const double end = request.transient + request.duration;
    Run run(problem, progress, {.end = end, .start = request.start ? &*request.start : nullptr});
    Tangents tangents(run.system(), end, kTangentErrors * problem.solver.rtol,
                      all_tangents(problem, run.system().coordinates(), request.count), progress);
    Stretching stretching(tangents.tangents(), request.blocks, request.transient, request.duration,
                          std::min(1.0, cam_period(problem)));
    tangents.pause_at(stretching.first_pause(), [&](double t) { return stretching.at(t, tangents); });
    run.add(tangents);
    run.integrate();
    stretching.finish(end, tangents);
    Exponents e;
    e.transient = request.transient;
    e.duration = request.duration;
    stretching.results(e);
    judge_impacts(tangents.touches(), e);
    if (!e.settled)
        e.warnings.push_back(
            "the two halves of the average differ by more than their errors: the motion had not settled; use a longer "
            "transient");
    if (!e.lambda.empty() && std::isinf(e.lambda.back()))
        e.warnings.push_back("in lasting contact neighbouring motions merge: the corresponding exponents are −∞");
    return e;
}

void confirm_chaos(const Problem& problem, const ExponentsRequest& request, Exponents& exponents,
                   const Progress& progress) {
    if (exponents.chaos() == Chaos::not_shown) return;
    ExponentsRequest rest = request;
    rest.count = 1;
    rest.transient = request.transient + request.duration;
    const Exponents later = lyapunov_exponents(problem, rest, progress);
    if (later.chaos() != Chaos::not_shown) return;
    exponents.settled = false;
    exponents.warnings.push_back(fmt::format(
        "in the {:g} s after that the largest exponent is {:.3g} ± {:.2g} 1/s: the sensitivity was that of a "
        "transient; use a longer one",
        later.duration, later.lambda.front(), later.error.front()));
}

}  // namespace beamcam::sim
