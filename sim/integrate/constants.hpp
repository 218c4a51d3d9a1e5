// Numerical constants of the exponential collocation and the other methods, each with its reason. MODEL.md §12.
#pragma once

namespace beamcam::sim {

// Step lengths come from the ladder 2^(k/2) s, so that few tables serve a run.
inline constexpr int kLowestLevel = -80, kHighestLevel = -4;
inline constexpr int kFirstFlightLevel = -18;  // 2 ms
inline constexpr int kFirstTouchLevel = -24;   // 0.24 ms
inline constexpr int kTouchLevels = 8;       // above the lowest, which a contact may use: then another method is better
inline constexpr double kRestLevel = 1.01;   // steps: a rest of the interval that is no longer is one step
inline constexpr double kLeastStep = 1e-14;  // of the time: rounding
// A step of flight errs by the power 8 of its length, one in contact by 12 where the force has just set in. A level is
// a factor √2 in length: below these errors the next step is one level longer, or two.
inline constexpr int kFlightOrder = 8, kTouchOrder = 12;
inline constexpr double kLongerFlight = 0.5 / 16, kMuchLongerFlight = 1e-5;
inline constexpr double kLongerTouch = 0.02, kMuchLongerTouch = 1e-4;
inline constexpr double kShortestFlight = 4e-16, kShortestTouch = 1e-13;  // of the time: rounding; of the force
inline constexpr double kShortestTouchEver = 1e-12;                       // [s] no contact is as stiff

// ---- errors ----
// Steps in contact are kept to a share of the tolerance: impacts multiply errors, and at order sixteen it costs little.
inline constexpr double kContactShare = 64;
// So are those of sustained contact, but to a larger one: undamped vibration of this size, which its own errors excite,
// would otherwise limit the steps.
inline constexpr double kHeldShare = 4;
inline constexpr double kShareOfIteration = 0.02;      // of the tolerance, for the rest of the iteration
inline constexpr double kLeastDecay = 1.0 / 30;        // of Legendre coefficients: the smoothest forcing assumed
inline constexpr double kLeastQuadratureDecay = 1e-5;  // the same for the quadrature, the fourth power of a decay

// ---- oscillators ----
inline constexpr double kSlowestOscillator = 1e-6;  // [rad/s] slower ones hardly have a period: no inverse of it
// ζ from which the two decays are treated separately; below, they are too close to each other.
inline constexpr double kTwoDecays = 1.02;
inline constexpr double kMostDampingInLanes = 0.5;  // the largest ζ of oscillators whose responses share lanes
inline constexpr double kSeriesRadians = 2;         // [rad], or decays, up to which responses come from their series
// The nodes do not resolve vibration that turns by more radians, or decays by more, in a step.
inline constexpr double kResolvedRadians = 3;
// In sustained contact, vibration that turns by more radians in a step is projected, unless its ζ is larger; growth by
// it begins at 14.                                                                                        (S52c)
inline constexpr double kAliasedRadians = 7, kMostDampingOfProjected = 0.1;
// Bounds within a step.
inline constexpr double kMissedTurning = 1e-6;    // of Θ̇, which its nodal polynomial may miss at any tolerance
inline constexpr double kFarthestFromNode = 0.1;  // of the step: no instant is farther from the nearest node

// ---- iterations ----
inline constexpr int kMostSweeps = 12;         // in flight: at a contraction of a half a step half as long is cheaper
inline constexpr int kMostNewton = 25;         // in contact, where the first sweeps find the nodes that touch
inline constexpr int kMostNewtonCoupled = 14;  // where sweeps cost more, and a contraction by less is strong coupling
// Changes that no longer fall are rounding once they are below this share of the largest; in contact the stiff force
// amplifies it tenfold. Otherwise the iteration diverges: by growth, which in contact the first sweeps may show.
inline constexpr double kFlightRounding = 1e-12, kContactRounding = 1e-11;
inline constexpr double kNegligibleChange = 1e-6;  // of the tolerance: the rounding of a motion that has hardly begun
inline constexpr double kDepthRounding = 4e-16;    // of the beam's length: two roundings of a gap
inline constexpr double kTravelRounding = 4e-16;   // of the way of the disc's centre: of the time and of the angle
// Largest of the last two Legendre coefficients, times the length of the step, of the rate of a polynomial that is zero
// at the start and up to 1 at the nodes: rounding of a gap's rate becomes such a constraint force.
inline constexpr double kRoughestRate = 136;
// [–] of the period of the fastest mode over 2π: where collocation of a constraint needs shorter steps, rounding rules.
inline constexpr double kShortestHeld = 1e-5;
// Where the damping of a contact decays by more than kFastDecay within a step, an error of a rate becomes a force that
// no polynomial follows: the iteration may leave only a share of kContactShare. So it is from kSteadyDecay on where the
// force varies by less than kSteadyForce: in a lasting contact it is the only error. Contractions vary from sweep to
// sweep; kSlowestContraction is the poorest after a good one.
inline constexpr double kFastDecay = 5, kSteadyDecay = 2, kSteadyForce = 1e-2, kSlowestContraction = 0.03;
inline constexpr double kStalled = 0.9, kContactGrowth = 2;
inline constexpr int kContactPatience = 5;
inline constexpr int kFootCorrections = 3;  // of the foot by Newton's method, from a foot nearby

// ---- the expansion of the contact ----
// Of order p it errs by (β|x − centre|)^(p+1)/(p+1)! of what the mode contributes: this share of rtol at most.
inline constexpr double kExpansionTolerance = 1e-2;
// Even for loose tolerances no farther than this, [–] of 1/β, a small part of a wave, and of the beam.
inline constexpr double kFarthestWave = 0.2, kLongestExpansion = 0.1;
inline constexpr double kKeptRange = 1.0 / 3;  // an expansion is kept while the contact stays so far within its range
inline constexpr int kMostCentres = 8;         // until the expansion contains the foot
inline constexpr double kSettledFoot = 3e-3;   // of the length: corrections by less have converged

// ---- events within a step ----
inline constexpr double kOnKink = 1e-6;          // of an interval: a passing so early means that it starts on the kink
inline constexpr int kMostEventHalvings = 16;    // then the ends decide: 10⁻⁵ of the interval
inline constexpr double kMarginRounding = 1e-9;  // of the largest margin of friction in a step
inline constexpr int kPartsBetweenNodes = 4;     // in which a polynomial of degree seven has no more than one extremum

// ---- the end of a step in contact ----
inline constexpr int kMostCuts = 8;            // of a step, to end it at an event
inline constexpr double kCarried = 1e-5;       // of a step, by which its end may be moved without solving again
inline constexpr double kCarriedKick = 0.1;    // of the tolerance, that the force in between may change
inline constexpr double kEndRounding = 1e-13;  // of a step: the end lies on the event
inline constexpr double kLeastLength = 1e-14, kLeastShift = 1e-16;  // [s] below the rounding of any time in a run
inline constexpr double kDeepest = 0.5;     // of the cam's radius: beyond, the contact leaves its geometry
inline constexpr double kResolvedTurn = 2;  // [rad] of a mode between two instants, which their cubic resolves (S58)

// ---- other methods ----
// Step-size factors of the published code of order 8: safety, and the least and most from one step to the next.
inline constexpr double kRk8Safety = 0.9, kRk8Shrink = 1.0 / 3.0, kRk8Growth = 6.0;
inline constexpr double kIgnoredWeight = 1e-30;  // in SUNDIALS, of components without error control
inline constexpr double kFarTime = 1e3;          // [s] a target beyond any step, in the direction of time

// ---- the fallback to another method ----
// Above these damping ratios, in flight and in contact, explicit steps are limited by stability; BDF is used. In flight
// the other method takes only some steps, which BDF begins at a low order. Its errors add up, so it gets a share of the
// tolerance.
inline constexpr double kStiffFlight = 20, kStiffContact = 1, kShareOfBdf = 0.03;
// [rad] of the fastest vibration in a step of modes that are not the coordinates: where their coupling asks for shorter
// ones, in flight by its error or in contact as nothing settles, Runge and Kutta's method is as good.
inline constexpr double kLeastTurns = 0.5;
inline constexpr long kFirstRetry = 32;  // steps of the other method before the next try, twice as many each time
// Friction that turns over within a small slip is stiff where the beam nearly sticks. A contact that has taken so many
// steps, shorter than this share of the way to its deepest point or of the fastest mode's 1/ω, is handed over to BDF.
inline constexpr long kMostCrawls = 2000;
inline constexpr double kCrawl = 1e-3;

}  // namespace beamcam::sim
