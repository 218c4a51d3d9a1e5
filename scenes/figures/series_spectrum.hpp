// Amplitude spectra: of an interval of a motion and of measured data.
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
// States the resolution of the spectra of the data, and which data have none.
std::string measured_spectrum_text(const std::vector<Measured>& all, Lang lang);
// States window, resolution and number of samples.
std::string spectrum_text(const sim::Problem& problem, double from, double to, Lang lang);

}  // namespace beamcam::scenes
