// The yardstick of the benchmarks: the beam and cam as a competent engineer programs them in an afternoon. Hub-beam or
// cantilever modes, the mass matrix assembled and factorized (Eigen's LDLT) in every right-hand side, CVODE's Adams
// method with default settings, root finding on the gap, a restart at each touch and release. Frictionless compliant
// contact, free hub; the contact geometry leaves out the foreshortening of the beam (a part in 1e6), as such programs
// do, so that its θ is compared with its own reference. It shares the constant integrals with sim/, nothing else.
#pragma once

#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::bench {

struct YardstickRun {
    std::vector<double> theta;  // at the instants [rad]
    long steps = 0, rhs = 0, impacts = 0;
};

// θ at `times` (ascending). `give_up` bounds the number of impacts of a run that diverges.
YardstickRun run_yardstick(const sim::Problem& problem, double rtol, double atol, const std::vector<double>& times,
                           long give_up = 2000);

}  // namespace beamcam::bench
