// Amplitude spectrum of equally spaced samples, through Hann's window.
#pragma once

#include <vector>

namespace beamcam::sim {

struct Spectrum {
    std::vector<double> frequency;  // [Hz], from 0
    std::vector<double> amplitude;  // of a sine there, in the unit of the samples
    double resolution = 0;          // [Hz]: the window's equivalent noise bandwidth, 1.5 over the length of the record
};

// The samples are `step` [s] apart, at least two, and count less their mean; those without a value count as the mean.
// F. J. Harris, "On the use of windows for harmonic analysis with the discrete Fourier transform", Proc. IEEE 66
// (1978).
Spectrum amplitude_spectrum(const std::vector<double>& samples, double step);

}  // namespace beamcam::sim
