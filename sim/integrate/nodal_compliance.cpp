#include "sim/integrate/nodal_compliance.hpp"

namespace beamcam::sim {

NodalCompliance nodal_compliance(const StepTable& table, double mass, double hub, const std::vector<double>& a,
                                 const std::vector<double>& b) {
    const Collocation& gauss = Collocation::get();
    const double h = table.h;
    NodalCompliance out;
    for (std::size_t l = 0; l < kNodes; ++l) {
        out.value[l] = (hub * h * h) * gauss.integrate_twice[l];
        out.rate[l] = (hub * h) * gauss.integrate[l];
    }
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        const StepTable::Row& response = table.rows[i];
        const double c = a[i] * b[i] / mass;
        for (std::size_t l = 0; l < kNodes; ++l) {
            out.value[l] += c * response.q[l];
            out.rate[l] += c * response.v[l];
        }
    }
    return out;
}

}  // namespace beamcam::sim
