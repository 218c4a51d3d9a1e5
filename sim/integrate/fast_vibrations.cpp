#include "sim/integrate/fast_vibrations.hpp"

#include <cmath>

#include "sim/integrate/constants.hpp"

namespace beamcam::sim {

FastVibrations::FastVibrations(const ModalForm& form, double h) : form_(&form) {
    if (!form.by_arrays()) return;
    const auto n = static_cast<std::size_t>(form.n);
    for (std::size_t i = 0; i < n && !any(); ++i)
        if (form.oscillators[i].omega * h > kFastRadians && hardly_damped(form.oscillators[i])) first_ = i;
}

double FastVibrations::stiffness(std::size_t i) const { return form_->coupling(i, i, spin, second); }

double FastVibrations::lag(std::size_t i) const {
    const Oscillator& o = form_->oscillators[i];
    return stiffness(i) / (2 * std::sqrt((o.omega - o.gamma) * (o.omega + o.gamma)));
}

}  // namespace beamcam::sim
