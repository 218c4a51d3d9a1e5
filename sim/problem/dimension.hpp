// The dimension of a quantity. The angle is a base dimension here, so that Hz (cycles) is not confused with rad/s.
#pragma once

#include <string>

namespace beamcam::sim {

// Exponents of metre, kilogram, second and radian.
struct Dimension {
    double length = 0, mass = 0, time = 0, angle = 0;
};
bool same(const Dimension& a, const Dimension& b);

namespace dimension {
constexpr Dimension kNone{};
constexpr Dimension kLength{1, 0, 0, 0};
constexpr Dimension kArea{2, 0, 0, 0};
constexpr Dimension kSecondMoment{4, 0, 0, 0};
constexpr Dimension kTime{0, 0, 1, 0};
constexpr Dimension kFrequency{0, 0, -1, 0};
constexpr Dimension kAngle{0, 0, 0, 1};
constexpr Dimension kAngularSpeed{0, 0, -1, 1};
constexpr Dimension kSpeed{1, 0, -1, 0};
constexpr Dimension kAcceleration{1, 0, -2, 0};
constexpr Dimension kDensity{-3, 1, 0, 0};
constexpr Dimension kPressure{-1, 1, -2, 0};
constexpr Dimension kInertia{2, 1, 0, 0};
constexpr Dimension kTorque{2, 1, -2, 0};
constexpr Dimension kSpringStiffness{0, 1, -2, 0};    // N/m
constexpr Dimension kTorsionStiffness{2, 1, -2, -1};  // N m/rad
constexpr Dimension kTorsionDamping{2, 1, -1, -1};    // N m s/rad
// N/m^n, the stiffness of a contact with exponent n.
constexpr Dimension contact_stiffness(double n) { return {1 - n, 1, -2, 0}; }
}  // namespace dimension

// The SI unit of plain numbers of this dimension: "m", "rad/s", "N/m^1.5", "1".
std::string si_unit(const Dimension& dimension);

}  // namespace beamcam::sim
