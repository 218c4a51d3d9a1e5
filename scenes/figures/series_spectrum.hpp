// A series against the frequency: amplitudes of a stretch of a motion.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenes/figures/measured.hpp"

namespace beamcam::scenes {

// Equally spaced, so close that the vibrations of all modes are far below half of their rate.
std::vector<double> spectrum_instants(const sim::Problem& problem, double from, double to);
// Frequency [Hz] and amplitude, until `highest`; without it, once and a half the highest mode at least.
sim::Table spectrum_table(const sim::Table& rows, std::optional<double> highest);
// Of measured values, at their own rate, until `highest`; nothing where their instants are few or not equally spaced.
std::optional<sim::Table> measured_spectrum(const Measurement& data, sim::Channel channel, double highest);
// How fine the spectra of the data are, and which data have none.
std::string measured_spectrum_words(const std::vector<Measured>& all, Lang lang);
// Its window, its resolution and the rate of its samples.
std::string spectrum_words(const sim::Problem& problem, double from, double to, Lang lang);

}  // namespace beamcam::scenes
