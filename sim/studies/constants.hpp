// Numerical constants of the assessment of accuracy, each with its reason.
#pragma once

namespace beamcam::sim {

inline constexpr int kInstants = 1000;           // at which motions are compared
inline constexpr double kReferenceRtol = 1e-13;  // the tightest tolerance
inline constexpr double kCheckRtol = 1e-12;      // of the run that estimates the error of the reference
inline constexpr double kReferenceRuns = 50;     // time limit of the reference and of contact variants, in longest runs
inline constexpr double kModesRuns = 5;          // the same of each number of shapes
inline constexpr double kModelRuns = 10;         // the same of each model
inline constexpr double kAllRuns = 20;           // after this time, in limits of one run, timings are not repeated
inline constexpr double kShortestPart = 1.0 / 16;  // of the motion: least part over which models are compared
inline constexpr int kModelShapes = 20;            // least number of shapes in the comparison of models
inline constexpr int kPaperShapes = 6;             // the same of `paper`, which loses its positive inertia with more
inline constexpr double kAsFar = 0.98;             // of the longest time within the target: as good

}  // namespace beamcam::sim
