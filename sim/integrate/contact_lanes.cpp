#include "sim/integrate/contact_lanes.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/assert.hpp"
#include "sim/beam/exact_model.hpp"

namespace beamcam::sim {
namespace {

// An expansion of order p errs by (β|x − centre|)^(p+1)/(p+1)! of what the mode contributes: this share of rtol at
// most.
constexpr double kExpansionTolerance = 1e-2;
// Even for loose tolerances it reaches no farther than this, [–] of 1/β, a small part of a wave, and of the beam.
constexpr double kFarthestWave = 0.2, kLongestExpansion = 0.1;
constexpr double kNearestCentre = 1.0 / 3;  // of the range: the farthest point from the nearest centre of the grid

// β|x − centre| up to which the expansion is accurate.
double trusted(double rtol) {
    constexpr int kNext = ContactExpansion::kOrder + 1;
    return std::min(kFarthestWave, std::pow(kExpansionTolerance * rtol * std::tgamma(kNext + 1), 1.0 / kNext));
}

// Null for `exact`.
std::shared_ptr<const ModalModel> modal_model_of(const Model& model) {
    const auto* modal = dynamic_cast<const ModalModel*>(&model);
    return modal ? std::make_shared<ModalModel>(*modal) : nullptr;
}

}  // namespace

ContactExpansion::ContactExpansion(System& system)
    : model_(modal_model_of(system.model())),
      n_(static_cast<std::size_t>(system.coordinates()) - 1),
      cam_(system.cam()),
      length_(system.model().length()),
      offset_(system.offset()),
      radius_(system.problem().hub.radius),
      trusted_(trusted(system.problem().solver.rtol)),
      shortening_(model_ && model_->foreshortening()),
      h_(system.model().hub_row() + 1, system.model().hub_row() + 1 + n_),
      y_((kOrder + 1) * n_),
      transposed_((kOrder + 1) * n_),
      shorten_(exact() ? 0 : n_ * n_) {
    range_ = kLongestExpansion * length_;
    if (!exact()) {
        for (std::size_t i = 0; i < n_; ++i)
            range_ = std::min(range_, trusted_ / model_->shapes().beta(static_cast<int>(i)));
        return;
    }
    rule_ = gauss_legendre(exact_nodes(system.problem()), length_);
    integral_ = SpectralIntegral(rule_, length_);
    nodes_ = static_cast<std::size_t>(rule_.x.size());
    section_.resize(nodes_ * n_);
    weighted_.resize(nodes_ * n_);
    weights_.resize(nodes_);
    for (std::size_t k = 0; k < nodes_; ++k)
        section_angle_shapes(rule_.x[static_cast<Eigen::Index>(k)], length_, static_cast<int>(n_), 0,
                             section_.data() + k * n_);
}

void ContactExpansion::centre_near(double x) {
    BEAMCAM_ASSERT(x >= 0 && x <= length_);
    double place = 0;
    if (exact()) {
        // A wave of `centre_exact` is as long in the angle φ, x = ½L(1 − cos φ), wherever it is.
        const double pitch = 2 * kNearestCentre * trusted_ / (static_cast<double>(n_) + 0.5);
        place = 0.5 * length_ * (1 - std::cos(pitch * std::round(std::acos(1 - 2 * x / length_) / pitch)));
    } else {
        const double pitch = 2 * kNearestCentre * range_;
        place = std::min(length_, pitch * std::round(x / pitch));
    }
    centre_at(place);
}

void ContactExpansion::centre_at(double x) {
    if (x == x_) return;
    x_ = x;
    if (n_ == 0) return;
    double* y = y_.data();
    if (exact()) {
        centre_exact(x);
    } else {
        model_->shapes().evaluate(x, y, y + n_, y + 2 * n_, y + 3 * n_);
        for (std::size_t i = 0; i < n_; ++i) {
            const double b4 = std::pow(model_->shapes().beta(static_cast<int>(i)), 4);
            for (std::size_t m = 4; m <= kOrder; ++m) y[m * n_ + i] = b4 * y[(m - 4) * n_ + i];
        }
        if (shortening_) model_->shortening_matrix(x, shorten_.data());  // symmetric
    }
    for (std::size_t i = 0; i < n_; ++i)
        for (std::size_t m = 0; m <= kOrder; ++m) transposed_[i * (kOrder + 1) + m] = y[m * n_ + i];
}

// A Legendre polynomial of degree N oscillates like a wave of β = 2(N + ½)/(L√(1 − z²)), z in [−1, 1].
void ContactExpansion::centre_exact(double x) {
    const double z = 2 * x / length_ - 1, order = static_cast<double>(n_) + 0.5;
    section_angle_shapes(x, length_, static_cast<int>(n_), kOrder, y_.data());
    const double beta = 2 * order / length_ * std::min(order, 1 / std::sqrt(std::max(0.0, (1 - z) * (1 + z)) + 1e-12));
    range_ = std::min(kLongestExpansion * length_, trusted_ / beta);
    integral_.weights(x, weights_.data());
    for (std::size_t i = 0; i < n_; ++i)
        for (std::size_t k = 0; k < nodes_; ++k) weighted_[i * nodes_ + k] = weights_[k] * section_[k * n_ + i];
}

void ContactExpansion::normal_rows(const ContactKinematics<Lanes>& touch, const Lanes* hq, Lanes* jn) const {
    if (exact()) {
        for (std::size_t i = 0; i < n_; ++i) jn[i] = touch.nx * hq[i] + touch.ny * hq[n_ + i];
        return;
    }
    const Lanes& x = touch.dx;
    Lanes c[kOrder + 1];
    c[0] = touch.ny;
    for (int m = 1; m <= kOrder; ++m) c[m] = c[m - 1] * x * (1.0 / m);
    if (shortening_)
        for (int j = 0; j < kOrder; ++j) c[1 + j] -= touch.nx * touch.moment[j];
    product(n_, kOrder + 1, transposed_.data(), c, jn);
    if (!shortening_) return;
    for (std::size_t i = 0; i < n_; ++i) jn[i] -= touch.nx * (hq[i] + h_[i] * touch.shift);
}

}  // namespace beamcam::sim
