// Numerical constants of extrema and their bounds, curves, stored trajectories and warnings, each with its reason.
#pragma once

#include <cstddef>

namespace beamcam::sim {

// ---- the search of extrema ----
// Share of the best value below which a rise is not searched for. The error of the energy balance is rounding and
// truncation: its digits do not matter.
inline constexpr double kNegligibleRise = 1e-10, kNegligibleImbalance = 1e-3;
inline constexpr double kValueRounding = 1e-14;  // of the channel's largest magnitude: no less is searched for
// The most intervals that a search halves in one step: these, and these for each radian of the fastest vibration, but
// no more than the third; and all of a run: so many, and for each of its steps. Many times more than a valid motion
// needs. A vibration that neither grows nor decays over millions of periods has no end otherwise.
inline constexpr double kFewestHalvings = 20'000, kHalvingsPerRadian = 32, kMostHalvings = 50'000;
inline constexpr long kHalvingsOfRun = 3'000'000, kHalvingsPerStep = 1000;
inline constexpr double kRestTolerances = 10;               // times `atol`: a beam whose rates are smaller is at rest
inline constexpr long kEvaluationsPerPoll = 256;            // of a channel, between two chances to interrupt the search
inline constexpr std::size_t kMostKeptNumbers = 4'000'000;  // of kept steps: 32 MB
inline constexpr std::size_t kNumbersPerDrop = 150'000;     // of kept steps, until those that are beaten are dropped
// Kept steps of a channel beyond which its bounds exclude too few.
inline constexpr std::size_t kManyKept = 1024;
// Parabolas at a crest: each squares the distance from it, or halves the interval.
inline constexpr int kMostParabolas = 8;
inline constexpr double kParabolaMargin = 0.02;     // of the interval: new points keep this distance from its ends
inline constexpr double kParabolaConverged = 1e-9;  // of the interval: √ of rounding, where the crest is flat
// Of the amplitude: an error of the closed form of a mode, beyond which it is not used; between two crests it matters
// in second order. And how many times as large as at the nodes it is taken.
inline constexpr double kFormRounding = 1e-7, kFormMargin = 4;
inline constexpr double kSignRounding = 1e-14;  // of the sum of magnitudes: values below it have no sign

// ---- bounds within a step ----
inline constexpr double kFollowedRadians = 2;  // [rad] of a vibration: a polynomial of degree 7 follows it to 10⁻⁷
inline constexpr double kNegligibleVibration = 1e-9;  // of the largest rate of a mode
// A step in which a vibration decays by more than the first, e⁻⁸ = 3·10⁻⁴, is searched in parts; each is eight times as
// long as the one before.
inline constexpr double kFadedRadians = 8, kPartRatio = 0.125;
inline constexpr double kBentContactShift = 2;  // a bent beam moves the contact by at most this times a straight one
inline constexpr double kProductFrequency = 3;  // products of up to three modes vibrate no faster than this many times
inline constexpr double kProductSwing = 4;      // and swing by at most this many times the share of one mode
inline constexpr std::size_t kMissedTerms = 2;  // of the eight of a polynomial: twice the last are its error
inline constexpr double kWidestNodeGap = 0.2;   // of the step: no instant is farther from a node than half of this
// Beyond the outer nodes the line through two of them is extended by a quarter of their distance.
inline constexpr double kBeyondNodes = 1.25;
inline constexpr double kWholeStep = 1e-9;   // of the step: rounding of its ends
inline constexpr double kSlopeProbe = 1e-3;  // of the penetration: the slope of the law just beyond the deepest point

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
