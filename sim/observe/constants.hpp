// Numerical constants of extrema, curves, records and warnings, each with its reason.
#pragma once

#include <cstddef>

namespace beamcam::sim {

// ---- extrema and crossings ----
inline constexpr double kNegligibleRise = 1e-6;  // of the channel's range: a higher value is not searched for
inline constexpr double kRefinedRise = 1e-5;     // of that: a rise between samples, which moves the extremum's instant
inline constexpr double kNegligibleEnergy = 1e-10;  // of the vibration: 10⁻⁵ of its rates
inline constexpr double kSamplesPerRadian = 1.3;    // of a vibration: eight in a period
inline constexpr double kMostSamples = 1e5;         // between two nodes of a step
// The larger of the last two Legendre coefficients of the nodal values, times this, is what a channel may do between
// the nodes: the phases of several vibrations make them as small as a quarter of the sum of their amplitudes.
inline constexpr double kStrayByDecay = 6;
// A step in which a vibration decays by more than the first, e⁻⁸ = 3·10⁻⁴, is sampled in parts; each is eight times as
// long as the one before.
inline constexpr double kFadedDecays = 8, kPartRatio = 0.125;
inline constexpr double kSignRounding = 1e-14;  // of the largest sample: values below it have no sign

// ---- curves ----
inline constexpr int kMostCurveHalvings = 8;     // of the piece between two rows
inline constexpr long kMostCurveRows = 400'000;  // 10 MB of three channels; more than a page resolves
inline constexpr int kMostRowHalvings = 16;      // of the piece between two rows of an adaptive table
inline constexpr double kRowRounding = 1e-9;     // of a channel's natural size: differences that rows do not show
inline constexpr double kBesideMiddle = 0.31;    // of a piece: no vibration has a node here and in the middle

// ---- records ----
// Poses are taken within the first steps of a contact: after them a collision is over, and a lasting contact is slow.
inline constexpr int kContactPoseSteps = 4;
inline constexpr std::size_t kMostSharedInstants = 4096;  // of a step; poses of so many take 10 MB

// ---- chatter ----
// Model `restitution`: bounces slower than this share of the approach floor are summed in closed form where nothing
// else changes meanwhile (MODEL.md (S57)).
inline constexpr double kSummedShare = 0.1;
// Elsewhere a rebound slower than this share ends the chatter in sustained contact. A bouncing point then rests at
// most 2v/(g(1 − e)) too early (MODEL.md §9).
inline constexpr double kChatterShare = 1e-3;

// ---- warnings ----
inline constexpr double kMissedPeak = 0.95;       // of the largest force: rows that reach less miss it
inline constexpr double kLedgerTolerances = 10;   // times rtol: the accuracy of `auto`; a larger error is a warning
inline constexpr double kEnergyRounding = 1e-12;  // of the energy scale
inline constexpr double kReportedGap = 1e-10;     // of the length, left at an event: 1000 times rounding
inline constexpr double kForeshorteningSlope = 0.3;  // [rad] beyond which the modal models' u ≈ −½∫v′² misses 2 %

}  // namespace beamcam::sim
