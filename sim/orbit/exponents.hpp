// Lyapunov exponents of a motion: how fast neighbouring motions part, on average over a long run. MODEL.md §16a.
//
// The tangent flow runs along the motion through every impact (tangent_integrator.hpp) and is orthonormalized at equal
// intervals (Benettin et al. 1980); the logarithms of its stretching, per time, are the exponents.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/dynamics/initial.hpp"
#include "sim/orbit/constants.hpp"
#include "sim/problem/problem.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::sim {

struct ExponentsRequest {
    int count = 1;                           // of the largest exponents; 0: the whole spectrum
    double transient = 0;                    // left out at the start [s], >= 0
    double duration = 100;                   // averaged over [s], > 0
    int blocks = 20;                         // for the error, >= 2
    std::optional<InitialState> start = {};  // at t = 0, instead of the problem's
};

// What the largest exponent says. Doubtful: it is positive beyond its error only by what near-grazing impacts add.
enum class Chaos { shown, doubtful, not_shown };

struct Exponents {
    std::vector<double> lambda;  // descending [1/s]; −∞ where the motion forgets at once (sustained contact)
    std::vector<double> error;   // standard error from the spread of the blocks [1/s]
    // Convergence: the exponents of the first part of the average, up to each of these times after the transient.
    std::vector<double> time;                  // [s]
    std::vector<std::vector<double>> history;  // [exponent][time] [1/s]
    double transient = 0, duration = 0;        // [s], as done
    long impacts = 0;                          // touches within the average
    // Impacts so slow that the linearized impact (S71) fails already for small differences: exponents are doubtful.
    long near_grazing = 0;
    double slowest_impact = 0;  // approach speed [m/s]; 0 without impacts
    // By how much the largest exponent may be too large because of them: as if each parted neighbours like an impact of
    // the typical speed only [1/s].
    double doubt = 0;
    // The largest exponent of the first half of the average and that of the second differ by less than four times their
    // errors: else the motion had not settled, and a transient may have looked chaotic.
    bool settled = true;
    std::vector<std::string> warnings;

    bool grows_late() const { return settled && !lambda.empty() && lambda.front() * duration / 2 > kLateGrowth; }
    // Shown: the largest exponent is positive beyond three times its error as well, and beyond the doubt: neighbouring
    // motions part exponentially.
    Chaos chaos() const {
        if (!grows_late() || !(lambda.front() > 3 * error.front())) return Chaos::not_shown;
        return lambda.front() > 3 * error.front() + doubt ? Chaos::shown : Chaos::doubtful;
    }
    bool chaotic() const { return chaos() == Chaos::shown; }
};

// Nothing where the tangent flow of this problem is known; else why not, with the remedy: models beyond first order.
std::optional<std::string> exponents_refusal(const Problem& problem);

// `progress` sees the time from the start of the transient. Throws SolverError, Interrupted; std::invalid_argument
// for what `exponents_refusal` refuses.
Exponents lyapunov_exponents(const Problem& problem, const ExponentsRequest& request, const Progress& progress = {});

// Chaos lasts. Where `exponents` of this request show it, the motion goes on for as long again, and if neighbours no
// longer part then, it had not settled: a sensitive transient. Progress and exceptions as above. (S89a)
void confirm_chaos(const Problem& problem, const ExponentsRequest& request, Exponents& exponents,
                   const Progress& progress = {});

}  // namespace beamcam::sim
