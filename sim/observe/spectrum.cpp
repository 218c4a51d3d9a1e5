#include "sim/observe/spectrum.hpp"

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace beamcam::sim {

Spectrum amplitude_spectrum(const std::vector<double>& samples, double step) {
    const std::size_t count = samples.size();
    double sum = 0;
    std::size_t defined = 0;
    for (const double v : samples)
        if (std::isfinite(v)) sum += v, ++defined;
    const double mean = defined > 0 ? sum / static_cast<double>(defined) : 0;
    std::vector<double> windowed(count);
    double weights = 0, squares = 0;
    for (std::size_t i = 0; i < count; ++i) {
        // Periodic: its spectrum is three lines.
        const double w =
            0.5 - 0.5 * std::cos(2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count));
        weights += w, squares += w * w;
        windowed[i] = std::isfinite(samples[i]) ? w * (samples[i] - mean) : 0;
    }
    Eigen::FFT<double> transform;
    std::vector<std::complex<double>> lines;
    transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    transform.fwd(lines, windowed);
    Spectrum out;
    const double length = step * static_cast<double>(count);
    out.resolution = squares * static_cast<double>(count) / (weights * weights) / length;
    for (std::size_t k = 0; k < lines.size(); ++k) {
        out.frequency.push_back(static_cast<double>(k) / length);
        out.amplitude.push_back(2 * std::abs(lines[k]) / weights);
    }
    return out;
}

}  // namespace beamcam::sim
