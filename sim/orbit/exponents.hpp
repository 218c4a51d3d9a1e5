// Lyapunov exponents of a motion: average exponential rates at which neighbouring motions diverge. MODEL.md (S74).
//
// Tangents are integrated along the motion through every impact (tangents.hpp) and orthonormalized at equal
// intervals (Benettin et al. 1980). The mean logarithmic growth of their lengths gives the exponents.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/dynamics/initial.hpp"
#include "sim/problem/problem.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::sim {

struct ExponentsRequest {
    int count = 1;                           // number of largest exponents; 0: the whole spectrum
    double transient = 0;                    // before the average [s], >= 0
    double duration = 100;                   // of the average [s], > 0
    int blocks = 20;                         // of the average, for the standard error; >= 2
    std::optional<InitialState> start = {};  // at t = 0; absent: that of the problem
};

// Doubtful: near-grazing impacts alone may make the largest exponent positive.
enum class Chaos { shown, doubtful, not_shown };

struct Exponents {
    std::vector<double> lambda;  // in descending order [1/s]; −∞ where sustained contact annihilates a tangent
    std::vector<double> error;   // standard error, from the spread of the blocks [1/s]
    // Convergence: the exponents averaged from the transient up to each of these times after it.
    std::vector<double> time;                  // [s]
    std::vector<std::vector<double>> history;  // [exponent][time] [1/s]
    double transient = 0, duration = 0;        // [s]
    long impacts = 0;                          // touches during the average
    // Impacts so slow that the linearization (S71) holds only for very small differences.
    long near_grazing = 0;
    double slowest_impact = 0;  // approach speed [m/s]; 0 without impacts
    // Amount by which they may make the largest exponent too large (S74) [1/s].
    double doubt = 0;
    // The largest exponents of the two halves of the average agree within four standard errors; otherwise the motion
    // had not settled, and a transient may appear chaotic.
    bool settled = true;
    std::vector<std::string> warnings;

    // Neighbouring motions surely diverge: the largest exponent exceeds three times its error.
    bool diverges() const;
    // The first reason why no chaos is shown; null if there is none. Without impacts a positive exponent is that of an
    // unstable equilibrium or of a growing vibration.
    const char* against_chaos() const;
    // Shown: the largest exponent exceeds three times its error plus the doubt.
    Chaos chaos() const;
    bool chaotic() const { return chaos() == Chaos::shown; }
};

// `progress` receives the time from the start of the transient. Throws SolverError, Interrupted; std::invalid_argument
// for an invalid problem.
Exponents lyapunov_exponents(const Problem& problem, const ExponentsRequest& request, const Progress& progress = {});

// If `exponents` of this request show chaos, continues the motion for as long again. If neighbouring motions no longer
// diverge there, the motion had not settled but was a sensitive transient. Progress and exceptions as above. (S74)
void confirm_chaos(const Problem& problem, const ExponentsRequest& request, Exponents& exponents,
                   const Progress& progress = {});

}  // namespace beamcam::sim
