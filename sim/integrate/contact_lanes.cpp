#include "sim/integrate/contact_lanes.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/assert.hpp"
#include "sim/beam/modal_model.hpp"

namespace beamcam::sim {
namespace {

// The expansion of order p errs by (β|x − centre|)^(p+1)/(p+1)! of what the mode contributes: this share of rtol at
// most.
constexpr double kShareOfTolerance = 1e-2;
// Even for loose tolerances no farther than this, [–] of 1/β: a small part of a wave.
constexpr double kFarthest = 0.2;
// An expansion is kept while the contact stays within this part of its range.
constexpr double kKept = 1.0 / 3;

// β|x − centre| up to which the expansion is trusted.
double trusted(double rtol) {
    constexpr int kNext = ContactExpansion::kOrder + 1;
    return std::min(kFarthest, std::pow(kShareOfTolerance * rtol * std::tgamma(kNext + 1), 1.0 / kNext));
}

}  // namespace

ContactExpansion::ContactExpansion(std::shared_ptr<const ModalForm> form, System& system)
    : form_(std::move(form)),
      system_(system),
      n_(static_cast<std::size_t>(form_->n)),
      offset_(system.offset()),
      radius_(form_->radius),
      y_((kOrder + 1) * n_),
      turned_((kOrder + 1) * n_),
      shorten_(n_ * n_) {
    const Cam& cam = *system.problem().cam;
    disc_ = cam.radius;
    rim_ = cam.speed * cam.radius;
    range_ = 0.1 * form_->length;
    const double far = trusted(system.problem().solver.rtol);
    for (const double beta : form_->beta) range_ = std::min(range_, far / beta);
}

void ContactExpansion::centre(double x) {
    BEAMCAM_ASSERT(x >= 0 && x <= form_->length);
    if (x_ >= 0 && std::fabs(x - x_) < kKept * range_) return;
    x_ = x;
    if (n_ == 0) return;
    const auto& model = dynamic_cast<const ModalModel&>(system_.model());
    double* y = y_.data();
    model.shapes().evaluate(x, y, y + n_, y + 2 * n_, y + 3 * n_);
    for (std::size_t i = 0; i < n_; ++i) {
        const double b4 = std::pow(form_->beta[i], 4);
        for (std::size_t m = 4; m <= kOrder; ++m) y[m * n_ + i] = b4 * y[(m - 4) * n_ + i];
    }
    for (std::size_t i = 0; i < n_; ++i)
        for (std::size_t m = 0; m <= kOrder; ++m) turned_[i * (kOrder + 1) + m] = y[m * n_ + i];
    if (form_->shortening) model.shortening_matrix(x, shorten_.data());  // symmetric
}

void ContactExpansion::normal_rows(const ContactKinematics<Lanes>& touch, const Lanes* hq, Lanes* jn) const {
    const Lanes& x = touch.dx;
    Lanes c[kOrder + 1];
    c[0] = touch.ny;
    for (int m = 1; m <= kOrder; ++m) c[m] = c[m - 1] * x * (1.0 / m);
    if (form_->shortening)
        for (int j = 0; j < kOrder; ++j) c[1 + j] -= touch.nx * touch.moment[j];
    product(n_, kOrder + 1, turned_.data(), c, jn);
    if (!form_->shortening) return;
    for (std::size_t i = 0; i < n_; ++i) jn[i] -= touch.nx * (hq[i] + form_->h[i] * touch.shift);
}

}  // namespace beamcam::sim
