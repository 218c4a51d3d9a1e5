// Integrates tangents along a given motion. Within a phase they obey v̇ = D_xF v: oscillators with a forcing that is
// linear in v. The exponential collocation of MODEL.md §12 has linear nodal equations here, which are solved directly,
// however strong the coupling. MODEL.md (S70).
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

#include "sim/integrate/integrator.hpp"
#include "sim/integrate/oscillator.hpp"
#include "sim/orbit/variation.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::sim {

inline constexpr int kTangentMemories = 2;  // additional rows: z and δ̇₋

class TangentStep {
  public:
    // `variation` and `units` (of the rows of tangents) must outlive this object. Errors are kept below rtol of each
    // tangent.
    TangentStep(System& system, Variation& variation, const Eigen::VectorXd& units, double rtol, Progress progress);

    void begin(const Phase& phase) { phase_ = phase; }
    // From t0 to t1 inside the segment. Tangents are columns; their rows are in units. Throws StepFailure,
    // Interrupted.
    void advance(const Segment& motion, double t0, double t1, Eigen::MatrixXd& tangents);

  private:
    const StepTable& table(int level, double rest);
    void differentiate(const Segment& motion, double t0, double h);
    void couple(const StepTable& table);
    double solve(const StepTable& table, const Eigen::MatrixXd& before, Eigen::MatrixXd& after);
    double error(double h, const Eigen::MatrixXd& before, const Eigen::MatrixXd& after) const;

    Variation& variation_;
    const Eigen::VectorXd& units_;
    double rtol_;
    Progress progress_;
    long steps_ = 0;
    Phase phase_;
    int n_, forced_;                       // coordinates; components with a forcing, the bristle among them
    std::vector<Oscillator> oscillators_;  // of the modes
    StepTables tables_{oscillators_};
    int flight_level_, touch_level_;

    Eigen::VectorXd y_;
    // Derivative of the forcing at each node: a row for each forced component, columns as the rows of tangents.
    Eigen::MatrixXd derivative_[kNodes];
    Eigen::MatrixXd unforced_, matrix_, forcing_;
    Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
};

}  // namespace beamcam::sim
