#include "sim/observe/spectrum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace beamcam::sim {
namespace {

constexpr int kCount = 1024;
constexpr double kStep = 1e-3;

std::vector<double> sine(double amplitude, double frequency) {
    std::vector<double> out;
    for (int i = 0; i < kCount; ++i)
        out.push_back(5 + amplitude * std::sin(2 * std::numbers::pi * frequency * kStep * i));
    return out;
}

TEST(Spectrum, ASineHasItsAmplitudeAtItsFrequencyAndHalfBesideIt) {
    const double line = 1 / (kStep * kCount);
    const Spectrum s = amplitude_spectrum(sine(3, 100 * line), kStep);
    ASSERT_EQ(s.frequency.size(), kCount / 2 + 1u);
    EXPECT_NEAR(s.frequency[100], 100 * line, 1e-9);
    EXPECT_NEAR(s.amplitude[100], 3, 1e-12);
    EXPECT_NEAR(s.amplitude[99], 1.5, 1e-12);  // Hann's window
    EXPECT_NEAR(s.amplitude[101], 1.5, 1e-12);
    EXPECT_NEAR(s.amplitude[98], 0, 1e-12);
    EXPECT_NEAR(s.amplitude[0], 0, 1e-12);  // less the mean
    EXPECT_NEAR(s.resolution, 1.5 * line, 1e-12);
}

// Hann, between two lines: 0.849 of it.
TEST(Spectrum, BetweenLinesAnAmplitudeIsSmallerByOnePointFourDecibels) {
    const double line = 1 / (kStep * kCount);
    const Spectrum s = amplitude_spectrum(sine(1, 100.5 * line), kStep);
    EXPECT_NEAR(20 * std::log10(s.amplitude[100]), -1.42, 0.01);
}

TEST(Spectrum, SamplesWithoutAValueAreTheMean) {
    std::vector<double> samples = sine(0, 1);
    samples[7] = std::numeric_limits<double>::quiet_NaN();
    for (const double a : amplitude_spectrum(samples, kStep).amplitude) EXPECT_NEAR(a, 0, 1e-12);
}

}  // namespace
}  // namespace beamcam::sim
