// The curves of a series: where they are reproducible, the measured data among them, and spectra of both.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/plot/figure.hpp"
#include "scenes/figures/caption.hpp"
#include "scenes/figures/motion_requests.hpp"

namespace beamcam::scenes {

// ---- the intervals in which θ is not reproducible, where curves are drawn lighter -------------------------

// θ is not reproducible within it [s].
struct UnreliableInterval {
    double from, to;
    bool holds(double t) const { return t > from && t <= to; }
};
// The intervals before `end` of a motion whose horizon was requested.
std::vector<UnreliableInterval> unreliable_intervals(const sim::Result& result, double end);

// The part of a curve within the intervals, which is faded, and the part outside of them, if they have points;
// neighbouring pieces share a point. `times`: of its points.
std::vector<render::figure::Series> by_reliability(const render::figure::Series& whole,
                                                   const std::vector<double>& times,
                                                   const std::vector<UnreliableInterval>& intervals);

// ---- measured or foreign data ---------------------------------------------------------------------------

// Data with the table that holds the motion at their instants.
struct Measured {
    Measurement data;
    std::size_t table = 0;
};

// The scene's data of these channels within [from, to]; adds the table that they are compared with.
std::vector<Measured> measured(const Scene& scene, const std::vector<sim::Channel>& channels, double from, double to,
                               std::size_t motion, MotionRequests& requests);

// Points, or a line if they are many. `x`, `y`: of the rows of the data, as drawn.
render::figure::Series measured_series(const Measurement& data, std::vector<double> x, std::vector<double> y, int look);

// ---- amplitude spectra ----------------------------------------------------------------------------------

// Equally spaced, so close that the vibrations of all modes are far below half of their rate.
std::vector<double> spectrum_instants(const sim::Problem& problem, double from, double to);
// Frequency [Hz] and amplitude, until `highest`; without it, once and a half the highest mode at least.
sim::Table spectrum_table(const sim::Table& rows, std::optional<double> highest);
// The spectrum of measured values, at their own rate, until `highest`; nothing where their instants are few or not
// equally spaced.
std::optional<sim::Table> measured_spectrum(const Measurement& data, sim::Channel channel, double highest);
// Whether instants have the same distance, as spectra need.
bool equally_spaced(const std::vector<double>& times);

}  // namespace beamcam::scenes
