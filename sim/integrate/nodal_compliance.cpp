#include "sim/integrate/nodal_compliance.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace beamcam::sim {

// By Gauss and Jordan's elimination with pivots by columns. With Eigen's LU a run with contact takes 13 to 17 % more
// instructions.
bool solve_dense(NodalMatrix a, std::span<Lanes> b) {
    for (int k = 0; k < kNodes; ++k) {
        Lanes& column = a[static_cast<std::size_t>(k)];
        int p = k;
        for (int i = k + 1; i < kNodes; ++i)
            if (std::fabs(column[i]) > std::fabs(column[p])) p = i;
        std::swap(column[k], column[p]);
        if (!(std::fabs(column[k]) > 0)) return false;
        const auto eliminate = [&](Lanes& x) {
            const double pivot = x[p] / column[k];
            x[p] = x[k];
            x -= column * pivot;
            x[k] = pivot;
        };
        std::for_each(a.begin() + k + 1, a.end(), eliminate);
        std::ranges::for_each(b, eliminate);
    }
    return true;
}

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
