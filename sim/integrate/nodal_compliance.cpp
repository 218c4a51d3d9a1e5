#include "sim/integrate/nodal_compliance.hpp"

#include <Eigen/LU>

namespace beamcam::sim {

bool solve_dense(const NodalMatrix& a, std::span<Lanes> b) {
    using Square = Eigen::Matrix<double, kNodes, kNodes>;
    Eigen::Map<Eigen::Matrix<double, kNodes, Eigen::Dynamic>> x(&b[0][0], kNodes, static_cast<Eigen::Index>(b.size()));
    x = Eigen::PartialPivLU<Square>(Eigen::Map<const Square>(reinterpret_cast<const double*>(a.data())))
            .solve(x)
            .eval();
    return x.allFinite();
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
