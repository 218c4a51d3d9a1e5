// Numerical constants of a run, each with its reason: budgets, event location, transitions, the reproducible horizon.
#pragma once

namespace beamcam::sim {

// ---- budgets and progress ----
inline constexpr long kStepsPerReport = 16;         // steps between two calls of `progress`
inline constexpr long kEvaluationsPerReport = 256;  // the same within one step, for evaluations of the gap
inline constexpr double kLongStep = 1e3;            // [rad] of the fastest vibration: such a step reports on its own
// Stop early if the projected number of steps exceeds 100 × the budget. The projection takes the later half of the
// steps so far. A brief phase (a touch, a transient) may last fewer than kSurePace steps: before that the limit is
// larger by the square of what is missing. Chatter may take some thousands of steps before kFirstPace.
inline constexpr long kFirstPace = 20000;
inline constexpr double kSurePace = 30000, kHopeless = 100;
inline constexpr double kEndless = 1e60;  // of the length: no deflection of a beam, but far from overflow

// ---- event location ----
// Evaluations in one step that resolve components that are polynomials of degree twelve.
inline constexpr int kMaxPieces = 16;
inline constexpr double kMostPieces = 1e5;     // of one step: more would take longer than the integration
inline constexpr long kMostAdvances = 100000;  // of conservative advancement through one step, for the same reason
inline constexpr long kFirstAdvances = 2000;   // after so many the pace shows whether kMostAdvances will suffice
inline constexpr double kFootStiffness = 0.5;  // least r″·D + r′·r′ for which the gap's acceleration is bounded
inline constexpr double kRestSpeed = 1e-12;    // [m/s] slower is rounding
inline constexpr double kGapErrors = 10;       // step tolerances in the gap, to which several coordinates contribute
inline constexpr double kLowestBounce = 1e-13;     // of the beam's length: the gap is known to about 1e-15 of it
inline constexpr double kForceDifference = 1e-4;   // of the step: Ṅ by differences, where the force is smooth
inline constexpr double kGuardDifference = 1e-2;   // of the step: the rate of a guard known by its values alone
inline constexpr double kGuardRounding = 1e-9;     // of a guard's largest value: shallower dips are rounding
inline constexpr double kSameInstant = 1e-9;       // of the piece: earlier by less is the same event
inline constexpr double kVanishingForce = 1e-9;    // of the weight and the largest force: a smaller pull does not lift
inline constexpr double kPredictedShift = 1e-3;    // of the step, at most: a Newton step in time after it is retaken
inline constexpr double kInstantRounding = 1e-14;  // of the time: closer instants are one

// ---- transitions ----
// A grip and a slip may both fail within rounding, and a rebound may be lost in the error of a step. More than
// kMostFlips events at one instant are not resolved: the grip stays as it is for a step, the impact is plastic.
inline constexpr int kMostFlips = 10, kMostIdleEvents = 50;
inline constexpr double kFirstTouchStep = 0.05;  // of the time to the deepest point: every stage feels the force
inline constexpr double kBounces = 4;            // a first step in flight spans at most so many bounces
// Chatter is summed up (S57) once the rest of it is so brief, against the fastest vibration and turn, that the
// sum errs by (10⁻³)²/6 of the last rebound, and the pull on the beam stays the same all the while.
inline constexpr double kBriefChatter = 1e-3, kSteadyPull = 1e-2;

// ---- the reproducible horizon ----
inline constexpr double kReproducible = 1e-6;        // [rad], relative to the angle's size, 1 at least
inline constexpr double kComparedRate = 1000;        // [Hz] of comparison
inline constexpr double kBriefAgreement = 0.1;       // [s] of two different motions: a crossing
inline constexpr double kTighterTolerance = 1e-2;    // of the asked tolerance, for the comparison
inline constexpr double kTightestRtol = 1e-13;       // rounding multiplies by more below it
inline constexpr double kMostComparedSteps = 500e3;  // of an explicit method: some seconds
inline constexpr double kExplicitRadians = 2;        // that such a step spans of the fastest vibration
inline constexpr double kComparedTurns = 6;          // of the cam, that lasting contact is compared for
inline constexpr double kRepeatedTurns = 2;          // of these, that what follows repeats
inline constexpr double kSettlingTurns = 0.25;       // of a turn after the last touch, for the other method

}  // namespace beamcam::sim
