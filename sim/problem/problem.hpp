// The mechanical problem that one simulation solves: hub, beam, cam, contact law, drive, initial state, solver
// settings. SI units throughout; MODEL.md defines every symbol. A Problem knows no files, pictures or JSON.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "sim/base/named.hpp"
#include "sim/base/vec2.hpp"

namespace beamcam::sim {

inline constexpr double kEarthGravity = 9.81;      // [m/s²] in place of a gravity of zero
inline constexpr double kPointExponent = 1.5;      // of spheres
inline constexpr double kLineExponent = 10.0 / 9;  // of Palmgren's δ ~ F^0.9 (1959)
// The largest number in a scene, in SI units: products of a few such numbers do not overflow.
inline constexpr double kLargestNumber = 1e30;

// ---- hub and its drive -----------------------------------------------------------------------

struct FreeDrive {};
struct ConstantTorque {
    double value = 0;  // [N m], positive counter-clockwise
};
struct HarmonicTorque {    // amplitude · sin(2π·frequency·t + phase)
    double amplitude = 0;  // [N m]
    double frequency = 0;  // [Hz], >= 0
    double phase = 0;      // [rad]
};
struct TorqueTable {             // linear between the points, constant outside them
    std::vector<double> t;       // [s], strictly increasing, at least one
    std::vector<double> torque;  // [N m]
};
struct ConstantSpeed {
    double speed = 0;  // [rad/s], positive counter-clockwise
};
struct SpinUp {  // θ̇ = (Ω/T)(s − (T/2π) sin(2πs/T)), s = t − start, up to s = T, then Ω (Kane et al. 1987)
    double speed = 0;     // Ω [rad/s]
    double duration = 1;  // T [s], > 0
    double start = 0;     // [s]; negative: the spin-up began before t = 0
};
struct AngleTable {             // natural cubic spline, linear outside the points
    std::vector<double> t;      // [s], strictly increasing, at least two
    std::vector<double> theta;  // [rad]
    // Root mean square of the errors in `theta`, >= 0 [rad]: the spline is the smoothest one that stays within them
    // (S93). 0: it passes through the points. Absent: the errors are those of the table's steps.
    std::optional<double> smooth = 0;
};
using Drive = std::variant<FreeDrive, ConstantTorque, HarmonicTorque, TorqueTable, ConstantSpeed, SpinUp, AngleTable>;

// Whether the drive prescribes θ(t), so that only the beam is integrated.
bool is_prescribed(const Drive& drive);
// Free, or driven by a constant torque.
bool is_independent_of_time(const Drive& drive);

struct HubSpring {          // torque −k(θ − θ_f) − c θ̇ on the hub (S38a)
    double stiffness = 0;   // k [N m/rad], >= 0
    double free_angle = 0;  // θ_f [rad]
    double damping = 0;     // c [N m s/rad], >= 0
    double torque(double theta, double theta_dot) const {
        return -stiffness * (theta - free_angle) - damping * theta_dot;
    }
    double energy(double theta) const { return 0.5 * stiffness * (theta - free_angle) * (theta - free_angle); }
};
struct Hub {
    double radius = 0;   // a [m]; may be negative (root beyond the axis), a > −length
    double inertia = 0;  // I_h [kg m²], >= 0
    Drive drive;
    std::optional<HubSpring> spring = {};
};

// ---- beam ------------------------------------------------------------------------------------

enum class ModelKind { rigid, zeroth_order, first_order, paper, second_order, exact };
inline std::span<const Named<ModelKind>> names(ModelKind) {
    using enum ModelKind;
    static constexpr Named<ModelKind> all[] = {
        {rigid, "rigid"}, {zeroth_order, "zeroth-order"}, {first_order, "first-order"},
        {paper, "paper"}, {second_order, "second-order"}, {exact, "exact"}};
    return all;
}

enum class Basis { automatic, cantilever, hub_beam };
inline std::span<const Named<Basis>> names(Basis) {
    using enum Basis;
    static constexpr Named<Basis> all[] = {{automatic, "auto"}, {cantilever, "cantilever"}, {hub_beam, "hub-beam"}};
    return all;
}

// The shape of the cross-section. Heights and c_max lie in the plane of the motion, across the beam; widths are
// perpendicular to that plane, along the axis of the cam.
struct Rectangle {
    double width = 0.025;   // b [m], > 0
    double height = 0.001;  // h [m], > 0
};
struct Circle {
    double diameter = 0.01;  // [m], > 0
};
struct Tube {
    double diameter = 0.01;  // outside [m], > 0
    double wall = 0.001;     // thickness [m], > 0, at most half the diameter
};
struct CustomSection {
    double area = 1e-4;           // A [m²], > 0
    double second_moment = 1e-9;  // I [m⁴], > 0
    double c_max = 0.01;          // distance of the outermost fibre from the neutral axis [m], I <= A c_max²
};
using Section = std::variant<Rectangle, Circle, Tube, CustomSection>;

// The materials by name; the table of their values is in materials.cpp.
enum class Material { steel, aluminium, titanium, brass, pmma, pom, rubber };
std::span<const Named<Material>> names(Material);

struct Beam {
    double length = 1;                  // L [m], > 0
    std::optional<Section> section;     // replaces area and second_moment
    double area = 7.2968e-5;            // A [m²], > 0
    double second_moment = 8.2189e-9;   // I [m⁴], > 0
    std::optional<Material> material;   // replaces density, youngs_modulus and poisson_ratio
    double density = 2766.7;            // ρ [kg/m³], > 0
    double youngs_modulus = 6.8952e10;  // E [Pa], > 0
    double poisson_ratio = 0.3;         // ν [–], −1 < ν < 0.5; Hertz stiffness only
    std::optional<double> depth;  // h [m], > 0; drawn, and for the contact offset "half-depth"; absent: beam_depth
    ModelKind model = ModelKind::first_order;
    Basis basis = Basis::automatic;      // automatic: cantilever for prescribed drive and `paper`, else hub-beam
    int modes = 2;                       // N, 1…40; ignored by `rigid`
    std::vector<double> damping_ratio;   // ζ_i [–], >= 0; empty: none; one value for all modes, or one per mode
    std::optional<double> kelvin_voigt;  // η [s], >= 0; excludes damping_ratio

    double line_density() const;       // ρA [kg/m]
    double bending_stiffness() const;  // EI [N m²]
};

// ---- cam -------------------------------------------------------------------------------------

// A motion law of a straight rigid lever: s(u) from 0 to 1 over 0 <= u <= 1 (S100).
enum class MotionLaw { dwell, cycloidal, harmonic, polynomial_345, polynomial_4567, modified_sine, modified_trapezoid };
std::span<const Named<MotionLaw>> names(MotionLaw);
struct LawSegment {
    MotionLaw law = MotionLaw::dwell;
    double rise = 0;             // change of the lever's angle [rad]; 0 of a dwell
    std::optional<double> over;  // turn of the cam [rad], > 0; absent: the rest of the turn, of the last segment only
    bool operator==(const LawSegment&) const = default;
};
// The outline that moves a straight lever, whose face is the contact face, by a law of the cam's turn φ = −ψ.
struct LawProfile {
    double lowest = 0;                 // θ at φ = 0 [rad]
    std::vector<LawSegment> segments;  // rises that sum to 0
    bool operator==(const LawProfile&) const = default;
};
struct Arc {
    Vec2 centre;        // in the cam's frame [m]
    double radius = 0;  // [m], > 0
    bool operator==(const Arc&) const = default;
};
// Arcs about the cam, counter-clockwise, each tangent inside to the next; one arc is a disc.
struct ArcsProfile {
    std::vector<Arc> arcs;
    bool operator==(const ArcsProfile&) const = default;
};
// Points of a closed convex outline in the cam's frame, in order, at least 24; joined by a periodic spline of the
// support function.
struct PointsProfile {
    std::vector<double> x, y;  // [m]
    bool operator==(const PointsProfile&) const = default;
};
using Profile = std::variant<LawProfile, ArcsProfile, PointsProfile>;

struct Cam {
    Vec2 centre{0.25, 0};                  // C, the axis of rotation [m]
    double radius = 0.1;                   // R [m], > 0
    double eccentricity = 0.02;            // e [m], 0 <= e < R
    double phase = 0;                      // ψ₀ [rad], counter-clockwise angle of the cam's frame at t = 0
    double speed = 1;                      // ω [rad/s], positive clockwise: ψ = ψ₀ − ω t
    std::optional<Material> material;      // replaces youngs_modulus and poisson_ratio
    std::optional<double> youngs_modulus;  // [Pa]; Hertz stiffness only; absent: that of the beam
    double poisson_ratio = 0.3;            // [–]
    std::optional<Profile> profile = {};   // replaces radius and eccentricity; absent: the eccentric disc
};

// ---- contact ---------------------------------------------------------------------------------

enum class ContactModel { compliant, restitution };
inline std::span<const Named<ContactModel>> names(ContactModel) {
    using enum ContactModel;
    static constexpr Named<ContactModel> all[] = {{compliant, "compliant"}, {restitution, "restitution"}};
    return all;
}

// The names are beside the formulas, in dissipation.cpp.
enum class DampingLaw {
    none,
    hunt_crossley,
    lankarani_nikravesh,
    herbert_mcwhannell,
    lee_wang,
    gonthier,
    flores,
    hu_guo,
    zhang_sharf
};
std::span<const Named<DampingLaw>> names(DampingLaw);

enum class ImpactLaw { newton, poisson, stronge };
inline std::span<const Named<ImpactLaw>> names(ImpactLaw) {
    using enum ImpactLaw;
    static constexpr Named<ImpactLaw> all[] = {{newton, "newton"}, {poisson, "poisson"}, {stronge, "stronge"}};
    return all;
}

struct NoFriction {};
struct CoulombFriction {
    double coefficient = 0.2;  // μ [–], >= 0
    double slip_speed = 1e-3;  // v_s [m/s], > 0: regularization of compliant contact
};
// State of stick-slip friction: stick, or slip towards +t or −t.
enum class FrictionState { stick, slide_plus, slide_minus };
inline std::span<const Named<FrictionState>> names(FrictionState) {
    using enum FrictionState;
    static constexpr Named<FrictionState> all[] = {
        {stick, "stick"}, {slide_plus, "slide-plus"}, {slide_minus, "slide-minus"}};
    return all;
}
struct StickSlipFriction {
    double coefficient = 0.2;                  // μ, kinetic [–], >= 0
    std::optional<double> static_coefficient;  // μ_s >= μ; absent: μ
    std::optional<double> stiffness;           // bristle [N/m], > 0; absent: (S37)
};
using Friction = std::variant<NoFriction, CoulombFriction, StickSlipFriction>;

enum class ApproachFloorPolicy { value, first_touch };
inline std::span<const Named<ApproachFloorPolicy>> names(ApproachFloorPolicy) {
    using enum ApproachFloorPolicy;
    static constexpr Named<ApproachFloorPolicy> all[] = {{value, "value"}, {first_touch, "first-touch"}};
    return all;
}
struct ApproachFloor {
    ApproachFloorPolicy policy = ApproachFloorPolicy::value;
    double value = 1e-3;  // [m/s], > 0
};

struct Contact {
    ContactModel model = ContactModel::compliant;
    std::optional<double> stiffness = 1e8;  // K [N/m^n], > 0; absent: Hertz's (S29)
    double stiffness_factor = 1;            // of either, > 0; no key of scenes: studies vary it
    std::optional<double> exponent;         // n [–], 1…2; absent: contact_exponent
    DampingLaw damping = DampingLaw::lankarani_nikravesh;
    double restitution = 0.7;           // c_r [–], 0…1
    ImpactLaw law = ImpactLaw::newton;  // of ContactModel::restitution
    Friction friction;
    std::optional<double> offset =
        0.0;  // d [m], >= 0, from the centre line to the contact face; absent: half the depth
    ApproachFloor approach_floor;
    std::optional<double> collision_gap = 0.02;  // [s]: impacts closer than this form one collision; absent: "auto"
};

// ---- initial state, solver -------------------------------------------------------------------

enum class InitialShape { straight, static_equilibrium, resting };
inline std::span<const Named<InitialShape>> names(InitialShape) {
    using enum InitialShape;
    static constexpr Named<InitialShape> all[] = {
        {straight, "straight"}, {static_equilibrium, "static"}, {resting, "resting"}};
    return all;
}
// The contact at t = 0 of a motion that continues another one: the part of its state that is not in the coordinates.
struct InitialContact {
    bool touching = true;                           // false: in flight, within a collision
    double approach_speed = 1e-3;                   // δ̇₋ of this touch [m/s], > 0; compliant contact
    FrictionState friction = FrictionState::stick;  // of stick-slip friction
    double bristle = 0;                             // z [m]
    double gap_offset = 0;                          // added to the gap since the last event [m] (S25)
    // The approach floor `first-touch` needs the approach speed of the collision's first touch [m/s], and the instant
    // of its last release [s], <= 0.
    std::optional<double> first_approach = {}, last_release = {};
};
struct Initial {
    double angle = 0.78539816339744830962;  // θ(0) [rad], of the hub
    double angular_velocity = 0;            // of the hub, θ̇(0) [rad/s]
    InitialShape shape = InitialShape::straight;
    std::vector<double> q = {},
                        q_dot = {};  // coordinates and rates of the first shapes (only `straight`); others are 0
    std::optional<InitialContact> contact = {};  // only `straight`; absent: the motion begins in flight
};

enum class Method { automatic, rk8, cvode_adams, cvode_bdf };
inline std::span<const Named<Method>> names(Method) {
    using enum Method;
    static constexpr Named<Method> all[] = {
        {automatic, "auto"}, {rk8, "rk8"}, {cvode_adams, "cvode-adams"}, {cvode_bdf, "cvode-bdf"}};
    return all;
}
struct Solver {
    Method method = Method::automatic;
    double rtol = 1e-8;           // 1e-13…1e-2
    double atol = 1e-11;          // > 0
    int max_steps = 100'000'000;  // attempted steps of a run, 1…2e9
};

struct Problem {
    Hub hub;
    Beam beam;
    std::optional<Cam> cam = Cam{};
    Contact contact;
    double gravity = 9.81;  // g [m/s²], along −Y
    Initial initial;
    Solver solver;
};

// ---- derived values --------------------------------------------------------------------------

// The cross-section of the beam, from its section or its numbers (S94).
struct SectionProperties {
    double area = 0, second_moment = 0;  // A [m²], I [m⁴]
    double c_max = 0;                    // distance of the outermost fibre from the neutral axis [m]
};
SectionProperties section_properties(const Section& section);
SectionProperties section_properties(const Beam& beam);
struct MaterialProperties {
    double density = 0, youngs_modulus = 0, poisson_ratio = 0;  // ρ [kg/m³], E [Pa], ν [–]
};
MaterialProperties material_properties(Material material);
MaterialProperties material_properties(const Beam& beam);
// The same beam with the numbers of its material in place of the name.
Beam with_numbers_of_material(Beam beam);

Basis resolved_basis(const Problem& problem);  // never `automatic`
// Hertz's law is that of a line contact if the section is a rectangle, else of a sphere on a plane (S29).
bool is_line_contact(const Problem& problem);
double contact_exponent(const Problem& problem);   // n; by default 3/2, of Hertz's line contact 10/9
double contact_stiffness(const Problem& problem);  // K; Hertz's from the materials (S29) [N/m^n]
double beam_depth(const Beam& beam);               // h; by default that of the section, or √(12 I/A) [m]
double contact_offset(const Problem& problem);     // d [m]
double collision_gap(const Problem& problem);      // "auto": proportional to the time of a fall, √(L/g) [s]
double first_clamped_frequency(const Beam& beam);  // 3.516 √(EI/ρA)/L² [rad/s]
double cam_period(const Problem& problem);         // 2π/|ω|; 1 s if the cam is at rest or absent [s]
double turn_fraction(double turns);                // fractional part, in [0, 1)
// Fraction of a turn after t = 0 at which the cam's angle is ψ, in [0, 1).
double section_phase(const Problem& problem, double psi);

// B [m] (S23)
inline Vec2 disc_centre(const Cam& cam, double t) {
    return cam.centre + cam.eccentricity * unit(cam.phase - cam.speed * t);
}

// Maximum penetration of a mass that hits an undamped contact F = K δⁿ at this speed,
// [(n+1) m v²/(2K)]^{1/(n+1)} [m] (S37).
double impact_depth(double exponent, double stiffness, double mass, double speed);
// Dissipation factor D of F = Kδⁿ(1 + D δ̇/δ̇₋) for the pre-set restitution (S31).
double damping_factor(DampingLaw law, double restitution);
// The restitution of an impact by that law, which differs from the pre-set one but for zhang-sharf (S31).
double effective_restitution(DampingLaw law, double restitution);

// Changes model, basis and number of shapes. Added shapes take the last damping ratio; initial coordinates are kept as
// far as they mean the same.
void set_shapes(Problem& problem, ModelKind model, Basis basis, int modes);

// A finding of `validate` (dynamics/validate.hpp).
struct Issue {
    std::string path;     // scene key, "cam.eccentricity"
    std::string message;  // cause, value and remedy
    bool fatal = true;    // false: a warning
};

}  // namespace beamcam::sim
