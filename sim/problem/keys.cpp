#include "sim/problem/keys.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::sim {

namespace dim = dimension;

// ---- hub and its drive -----------------------------------------------------------------------

static void visit(Visitor&, FreeDrive&) {}

static void visit(Visitor& v, ConstantTorque& d) {
    v.number(required("value", "\"0.5 N m\""), d.value, dim::kTorque, kAny, "Torque, positive counter-clockwise.");
}

static void visit(Visitor& v, HarmonicTorque& d) {
    v.number(required("amplitude", "0.5"), d.amplitude, dim::kTorque, kAny, "Amplitude of the torque.");
    v.number(required("frequency", "\"2 Hz\""), d.frequency, dim::kFrequency, kNotNegative, "Frequency.");
    v.number("phase", d.phase, dim::kAngle, kAny, "Phase at t = 0.");
}

static void visit(Visitor& v, TorqueTable& d) {
    v.numbers(required("t", "[0, 1]"), d.t, dim::kTime, kAny, {1}, "Times, strictly increasing.");
    v.numbers(required("torque", "[0, 0.5]"), d.torque, dim::kTorque, kAny, {1}, "Torque at each time.");
}

static void visit(Visitor& v, ConstantSpeed& d) {
    v.number(required("speed", "\"30 rpm\""), d.speed, dim::kAngularSpeed, kAny,
             "Angular speed, positive counter-clockwise.");
}

static void visit(Visitor& v, SpinUp& d) {
    v.number(required("speed", "4"), d.speed, dim::kAngularSpeed, kAny, "Final angular speed Ω.");
    v.number(required("duration", "15"), d.duration, dim::kTime, kPositive, "Duration T of the spin-up.");
    v.number("start", d.start, dim::kTime, kAny,
             "Time at which the spin-up begins; negative where it began before this motion.");
}

static void visit(Visitor& v, AngleTable& d) {
    v.numbers(required("t", "[0, 1, 2]"), d.t, dim::kTime, kAny, {2}, "Times, strictly increasing.");
    v.numbers(required("theta", "[0, 0.5, 0]"), d.theta, dim::kAngle, kAny, {2}, "Hub angle at each time.");
    v.number("smooth", d.smooth, dim::kAngle, kNotNegative,
             "Root mean square of the errors in \"theta\": the spline is the smoothest one within them. \"auto\": the "
             "table's values are multiples of a step, as an encoder's, with errors of step/√12. 0: the spline passes "
             "through all points.",
             "auto");
}

static void visit(Visitor& v, Drive& drive) {
    v.alternatives(
        {alternative<FreeDrive>(drive, {{"type", "free"}}, "The hub turns freely."),
         alternative<ConstantTorque>(drive, {{"type", "torque"}}, "A constant torque."),
         alternative<HarmonicTorque>(drive, {{"type", "torque"}},
                                     "A harmonic torque: amplitude · sin(2π · frequency · t + phase)."),
         alternative<TorqueTable>(drive, {{"type", "torque"}},
                                  "A table of torques: linear between the points, constant outside."),
         alternative<ConstantSpeed>(drive, {{"type", "prescribed"}, {"law", "constant"}}, "Constant angular speed."),
         alternative<SpinUp>(drive, {{"type", "prescribed"}, {"law", "spin-up"}},
                             "Smooth spin-up: the speed is (Ω/T)(t − (T/2π) sin(2πt/T)) up to T, then Ω."),
         alternative<AngleTable>(
             drive, {{"type", "prescribed"}, {"law", "table"}},
             "A table of hub angles: a natural cubic spline, continued at constant speed outside.")});
}

static void visit(Visitor& v, HubSpring& s) {
    v.number("stiffness", s.stiffness, dim::kTorsionStiffness, kNotNegative, "Stiffness k.");
    v.number("free_angle", s.free_angle, dim::kAngle, kAny, "Hub angle θ_f at which the spring has no torque.");
    v.number("damping", s.damping, dim::kTorsionDamping, kNotNegative, "Viscous damping c, parallel to the spring.");
}

static void visit(Visitor& v, Hub& hub) {
    v.number("radius", hub.radius, dim::kLength, kAny,
             "Distance from the fixed axis O to the root of the beam; negative: the root lies beyond the axis.");
    v.number("inertia", hub.inertia, dim::kInertia, kNotNegative, "Moment of inertia about O.");
    v.object("drive", hub.drive, "Drive of the hub.");
    v.object(written_if(hub.spring.has_value(), "spring"), hub.spring,
             "Spring and damper between the hub and the ground, torque −k(θ − θ_f) − c θ̇; null: none.");
}

// ---- beam ------------------------------------------------------------------------------------

constexpr Range kPoissonRatio{-1, 0.5, true, true, nullptr};

static void visit(Visitor& v, Rectangle& s) {
    v.number(required("width", "\"25 mm\""), s.width, dim::kLength, kPositive,
             "Width b, perpendicular to the plane of the motion: the length of the line contact with the cam.");
    v.number(required("height", "\"0.8 mm\""), s.height, dim::kLength, kPositive,
             "Height h, in the plane of the motion: the beam bends across it, I = b h³/12.");
}

static void visit(Visitor& v, Circle& s) {
    v.number(required("diameter", "\"5 mm\""), s.diameter, dim::kLength, kPositive, "Diameter.");
}

static void visit(Visitor& v, Tube& s) {
    v.number(required("diameter", "\"10 mm\""), s.diameter, dim::kLength, kPositive, "Outer diameter.");
    v.number(required("wall", "\"1 mm\""), s.wall, dim::kLength, kPositive,
             "Thickness of the wall, at most half the diameter.");
}

static void visit(Visitor& v, CustomSection& s) {
    v.number(required("area", "\"50 mm^2\""), s.area, dim::kArea, kPositive, "Area A.");
    v.number(required("second_moment", "\"400 mm^4\""), s.second_moment, dim::kSecondMoment, kPositive,
             "Second moment of area I about the axis perpendicular to the plane of the motion.");
    v.number(required("c_max", "\"5 mm\""), s.c_max, dim::kLength, kPositive,
             "Distance of the outermost fibre from the neutral axis, in the plane of the motion.");
}

static void visit(Visitor& v, Section& section) {
    v.alternatives({alternative<Rectangle>(section, {{"type", "rectangle"}}, "A solid rectangle."),
                    alternative<Circle>(section, {{"type", "circle"}}, "A solid rod."),
                    alternative<Tube>(section, {{"type", "tube"}}, "A round tube."),
                    alternative<CustomSection>(section, {{"type", "custom"}}, "Any section, by its numbers.")});
}

// A section or a material replaces the numbers that follow from it; writers leave those out.
static void visit(Visitor& v, Beam& beam) {
    v.number("length", beam.length, dim::kLength, kPositive, "Length L.");
    v.object(written_if(beam.section.has_value(), "section"), beam.section,
             "Cross-section, in place of \"area\" and \"second_moment\".");
    v.number(written_if(!beam.section, "area"), beam.area, dim::kArea, kPositive, "Cross-section area A.");
    v.number(written_if(!beam.section, "second_moment"), beam.second_moment, dim::kSecondMoment, kPositive,
             "Second moment of area I.");
    v.choice("material", beam.material,
             "Material, in place of \"density\", \"youngs_modulus\" and \"poisson_ratio\"; typical values, listed with "
             "their sources in sim/MODEL.md (S95).");
    v.number(written_if(!beam.material, "density"), beam.density, dim::kDensity, kPositive, "Density ρ.");
    v.number(written_if(!beam.material, "youngs_modulus"), beam.youngs_modulus, dim::kPressure, kPositive,
             "Young's modulus E.");
    v.number(written_if(!beam.material, "poisson_ratio"), beam.poisson_ratio, dim::kNone, kPoissonRatio,
             "Poisson's ratio ν; used by the Hertz stiffness only.");
    for (const char* number : {"area", "second_moment"}) v.exclusive("section", number);
    for (const char* number : {"density", "youngs_modulus", "poisson_ratio"}) v.exclusive("material", number);
    v.number(
        derived("depth"), beam.depth, dim::kLength, kPositive,
        "Depth h of the cross-section; drawn, and used by the contact offset \"half-depth\" and, without a section, by "
        "the bending stress. By default that of the section: its height, its diameter or 2 c_max; without a section "
        "√(12 I/A), that of a rectangle; for the default area and second moment 36.8 mm.");
    v.choice("model", beam.model, "Beam model, from rigid to the exact elastica.");
    v.choice(
        "basis", beam.basis,
        "Shape functions; auto: cantilever for a prescribed drive and for the model paper, else hub-beam. Cantilever "
        "shapes on a free hub serve comparisons: rk8 integrates them, in steps shorter than the period of the last.");
    v.integer("modes", beam.modes, 1, 40, "Number N of shape functions.");
    v.numbers("damping_ratio", beam.damping_ratio, dim::kNone, kNotNegative, {.min = 1, .or_one_number = true},
              "Modal damping ratio ζ: one number for all modes, or one for each mode; by default none. Excludes "
              "kelvin_voigt.");
    v.number("kelvin_voigt", beam.kelvin_voigt, dim::kTime, kNotNegative,
             "Kelvin–Voigt relaxation time η; by default none. Excludes damping_ratio.");
}

// ---- cam -------------------------------------------------------------------------------------

constexpr std::size_t kMostParts = 200;  // segments or arcs of a turn

static void visit(Visitor& v, LawSegment& segment) {
    v.choice(required("law", "\"cycloidal\""), segment.law,
             "Law of the motion from rest to rest; dwell: the lever is at rest.");
    v.number(written_if(segment.law != MotionLaw::dwell, "rise"), segment.rise, dim::kAngle, kAny,
             "Change of the lever's angle over the segment, negative where the lever returns.");
    v.number("over", segment.over, dim::kAngle, kPositive,
             "Turn of the cam over the segment; by default, of the last segment only, the rest of the turn.");
}

static void visit(Visitor& v, LawProfile& profile) {
    v.number(required("lowest", "\"14 deg\""), profile.lowest, dim::kAngle, kAny,
             "Angle θ of the lever at the turn 0, where the cam's frame has the angle ψ = 0.");
    v.list(required("segments", "[{\"law\": \"cycloidal\", \"rise\": \"8 deg\", \"over\": \"180 deg\"}, …]"),
           objects(profile.segments, 1, kMostParts, "segments"),
           "Motions that follow one another as the cam turns clockwise; their rises sum to 0.");
}

static void visit(Visitor& v, Arc& arc) {
    v.numbers("centre", arc.centre, dim::kLength, "Centre [x, y] in the cam's frame, whose origin is the axis.");
    v.number(required("radius", "\"30 mm\""), arc.radius, dim::kLength, kPositive, "Radius.");
}

static void visit(Visitor& v, ArcsProfile& profile) {
    v.list(required("arcs", "[{\"centre\": [0.02, 0], \"radius\": 0.1}]"), objects(profile.arcs, 1, kMostParts, "arcs"),
           "Arcs in counter-clockwise order, each tangent to the next from inside or from outside; one arc is a disc.");
}

static void visit(Visitor& v, PointsProfile& profile) {
    v.file_of_columns();
    v.numbers(required("x", "\"@cam.csv:x\""), profile.x, dim::kLength, kAny, {24},
              "Coordinates x of the points in the cam's frame, in order, at least 24.");
    v.numbers(required("y", "\"@cam.csv:y\""), profile.y, dim::kLength, kAny, {24}, "Coordinates y of the points.");
}

// Points in polar coordinates, which are read into Cartesian ones.
static void visit_polar(Visitor& v, Profile& profile) {
    std::vector<double> angle, radius;
    v.file_of_columns();
    v.numbers(required("angle", "\"@cam.csv:angle\""), angle, dim::kAngle, kAny, {24},
              "Angles of the points in the cam's frame, in order, at least 24.");
    v.numbers(required("radius", "\"@cam.csv:radius\""), radius, dim::kLength, kAny, {24},
              "Distances of the points from the axis.");
    PointsProfile points{radius, angle};
    for (std::size_t i = 0; i < std::min(angle.size(), radius.size()); ++i) {
        points.x[i] = radius[i] * std::cos(angle[i]);
        points.y[i] = radius[i] * std::sin(angle[i]);
    }
    profile = std::move(points);
}

static void visit(Visitor& v, Profile& profile) {
    v.alternatives({alternative<LawProfile>(profile, {{"type", "law"}},
                                            "The outline by which a straight lever moves as the segments say."),
                    alternative<ArcsProfile>(profile, {{"type", "arcs"}}, "Tangent arcs."),
                    alternative<PointsProfile>(profile, {{"type", "points"}},
                                               "A closed convex outline through points, joined by a smooth curve."),
                    {{{"type", "points"}}, "The same by angle and radius.", false, [&profile](Visitor& inside) {
                         visit_polar(inside, profile);
                     }}});
}

// A profile replaces the numbers of the disc; writers leave those out.
static void visit(Visitor& v, Cam& cam) {
    v.numbers("centre", cam.centre, dim::kLength, "C = [x, y], the fixed axis of rotation.");
    v.object(written_if(cam.profile.has_value(), "profile"), cam.profile,
             "Outline of the cam, in place of \"radius\" and \"eccentricity\"; null: the eccentric disc.");
    v.number(written_if(!cam.profile, "radius"), cam.radius, dim::kLength, kPositive, "Radius R of the disc.");
    constexpr Range kEccentricity{0, Range::kInfinity, false, false, nullptr, "; turn the phase by 180 deg instead"};
    v.number(written_if(!cam.profile, "eccentricity"), cam.eccentricity, dim::kLength, kEccentricity,
             "Distance e of the disc's centre from C, less than R.");
    for (const char* number : {"radius", "eccentricity"}) v.exclusive("profile", number);
    v.number("phase", cam.phase, dim::kAngle, kAny,
             "Counter-clockwise angle of the cam about C at t = 0: of the disc's centre, or of the profile's frame.");
    v.number("speed", cam.speed, dim::kAngularSpeed, kAny, "Angular speed ω, positive clockwise.");
    v.choice("material", cam.material,
             "Material, for the Hertz stiffness, in place of \"youngs_modulus\" and \"poisson_ratio\".");
    v.number(written_if(!cam.material, "poisson_ratio"), cam.poisson_ratio, dim::kNone, kPoissonRatio,
             "Poisson's ratio; used by the Hertz stiffness only.");
    v.number(written_if(!cam.material, "youngs_modulus"), cam.youngs_modulus, dim::kPressure, kPositive,
             "Young's modulus, for the Hertz stiffness; by default that of the beam.");
    for (const char* number : {"poisson_ratio", "youngs_modulus"}) v.exclusive("material", number);
}

// ---- contact ---------------------------------------------------------------------------------

static void visit(Visitor&, NoFriction&) {}

static void visit(Visitor& v, CoulombFriction& f) {
    v.number("coefficient", f.coefficient, dim::kNone, kNotNegative, "Coefficient of friction μ.");
    v.number("slip_speed", f.slip_speed, dim::kSpeed, kPositive,
             "Slip speed v_s over which friction builds up in compliant contact.");
}

static void visit(Visitor& v, StickSlipFriction& f) {
    v.number("coefficient", f.coefficient, dim::kNone, kNotNegative, "Kinetic coefficient of friction μ.");
    v.number("static_coefficient", f.static_coefficient, dim::kNone, kNotNegative,
             "Static coefficient of friction μ_s, at least μ; by default μ.");
    v.number("stiffness", f.stiffness, dim::kSpringStiffness, kPositive,
             "Stiffness of the bristle; by default derived from the contact stiffness.");
}

static void visit(Visitor& v, Friction& friction) {
    v.alternatives(
        {alternative<NoFriction>(friction, {{"type", "none"}}, "No friction."),
         alternative<CoulombFriction>(friction, {{"type", "coulomb"}}, "Coulomb friction, regularized near zero slip."),
         alternative<StickSlipFriction>(friction, {{"type", "stick-slip"}},
                                        "Stick-slip friction by a bristle model.")});
}

static void visit(Visitor& v, ApproachFloor& floor) {
    v.choice("policy", floor.policy,
             "value: the key \"value\"; first-touch: the approach speed of the first touch of the collision.");
    v.number("value", floor.value, dim::kSpeed, kPositive, "Smallest approach speed.");
}

static void visit(Visitor& v, Contact& contact) {
    v.choice("model", contact.model,
             "compliant: a contact force as a function of the penetration; restitution: impulses.");
    v.number(
        "stiffness", contact.stiffness, of_contact_stiffness(contact.exponent), kPositive,
        "Contact stiffness K in F = K δⁿ. \"hertz\": computed from the materials, for a rectangular section as the "
        "line contact of the disc with a flat face of that width, else as that of a sphere of the cam's radius with "
        "a plane.",
        "hertz");
    v.number(derived("exponent"), contact.exponent, dim::kNone, between(1, 2),
             "Exponent n in F = K δⁿ; by default 1.5, for Hertz's line contact 10/9.");
    v.choice("damping", contact.damping, "Dissipation law of the model compliant.");
    v.number("restitution", contact.restitution, dim::kNone, between(0, 1),
             "Coefficient of restitution, parameter of the dissipation law or the impact law.");
    v.choice("law", contact.law, "Impact law of the model restitution.");
    v.object("friction", contact.friction, "Friction between beam and cam.");
    v.number("offset", contact.offset, dim::kLength, kNotNegative,
             "Distance d of the touching face from the centre line; \"half-depth\": half the beam's depth.",
             "half-depth");
    v.object("approach_floor", contact.approach_floor,
             "Lower bound of the approach speed, by which dissipation laws divide.");
    v.number(
        "collision_gap", contact.collision_gap, dim::kTime, kNotNegative,
        "Impacts closer in time than this form one collision. auto: 20 ms for a beam of 1 m, else in proportion to "
        "√(L/g), the time scale of a fall.",
        "auto");
}

// ---- initial state, solver -------------------------------------------------------------------

static void visit(Visitor& v, InitialContact& contact) {
    v.boolean("touching", contact.touching,
              "The beam touches the cam; false: it flies, between two touches of a collision.");
    v.number("approach_speed", contact.approach_speed, dim::kSpeed, kPositive,
             "Approach speed of the present touch, by which the dissipation law divides; of compliant contact.");
    v.choice("friction", contact.friction,
             "State of stick-slip friction: stick, or slip along or against the tangent.");
    v.number("bristle", contact.bristle, dim::kLength, kAny, "Deflection of the bristle of stick-slip friction.");
    v.number("gap_offset", contact.gap_offset, dim::kLength, kAny,
             "Added to the gap, which was zero at the last touch or release but for rounding errors.");
    v.number("first_approach", contact.first_approach, dim::kSpeed, kNotNegative,
             "Approach speed of the collision's first touch; of the approach floor \"first-touch\".");
    v.number("last_release", contact.last_release, dim::kTime,
             {-Range::kInfinity, 0, false, false, "is after the start"},
             "Time of the collision's last release, not positive; of the approach floor \"first-touch\".");
}

static void visit_initial(Visitor& v, Initial& initial, ModelKind model) {
    const bool angles = model == ModelKind::exact;
    v.number("angle", initial.angle, dim::kAngle, kAny,
             "Hub angle θ(0), counter-clockwise from the horizontal; a drive with a table of angles replaces it.");
    v.number("angular_velocity", initial.angular_velocity, dim::kAngularSpeed, kAny,
             "Angular velocity of the hub; the beam rotates rigidly with it. A prescribed drive replaces it.");
    v.choice("shape", initial.shape,
             "straight: undeformed; static: equilibrium with a fixed hub; resting: equilibrium on the cam.");
    v.numbers(
        written_if(!initial.q.empty(), "q"), initial.q, angles ? dim::kAngle : dim::kLength, kAny, {0, 40},
        "Coordinates of the first shape functions (channels q1, q2 …) in place of a straight beam; in rad for "
        "the model "
        "\"exact\". With \"angle\", \"angular_velocity\", \"q_dot\" and, in contact, \"contact\" this is the complete "
        "state; `beamcam simulate --state-at` writes it.");
    v.numbers(written_if(!initial.q_dot.empty(), "q_dot"), initial.q_dot, angles ? dim::kAngularSpeed : dim::kSpeed,
              kAny, {0, 40}, "Time derivatives of q (channels q1_dot, q2_dot …).");
    v.object(written_if(initial.contact.has_value(), "contact"), initial.contact,
             "The contact in which the motion continues another one; null: it begins in flight.");
}

static void visit(Visitor& v, Solver& solver) {
    v.choice("method", solver.method, "Integration method; auto selects one that suits the problem.");
    v.number("rtol", solver.rtol, dim::kNone, between(1e-13, 1e-2), "Relative tolerance.");
    // A tolerance below 1e-40 would have the effect of 0.
    v.number("atol", solver.atol, dim::kNone, between(1e-40, 1e10), "Absolute tolerance.");
    v.integer("max_steps", solver.max_steps, 1, 2'000'000'000,
              "Largest number of attempted steps; beyond it the run stops with an error (exit code 4), and a branch of "
              "orbits ends.");
}

void visit(Visitor& v, Problem& problem) {
    v.object("hub", problem.hub, "The hub, which turns about the fixed axis O.");
    v.object("beam", problem.beam, "The uniform beam, clamped radially to the hub.");
    v.object("cam", problem.cam, "The cam, an eccentric rotating disc; null: no cam.");
    v.object("contact", problem.contact, "Contact between beam and cam.");
    v.number("gravity", problem.gravity, dim::kAcceleration, kAny, "Acceleration of gravity, downwards.");
    v.object(
        "initial", [&](Visitor& inside) { visit_initial(inside, problem.initial, problem.beam.model); },
        "State at t = 0.", nullptr);
    v.object("solver", problem.solver, "Numerical integration.");
}

}  // namespace beamcam::sim
