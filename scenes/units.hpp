// Quantities that scenes write as text: "12 mm", "300 rpm", "2.7 g/cm^3", "1e8 N/m^1.5".
//
// A unit is a product of named units with exponents. Its dimension is checked against the one that
// the key has; angles count as a dimension of their own, so that Hz (cycles) is never taken for rad/s.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace beamcam::scenes {

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
constexpr Dimension kSpringStiffness{0, 1, -2, 0};  // N/m
constexpr Dimension kSpringDamping{0, 1, -1, 0};    // N s/m
// N/m^n, the stiffness of a contact with exponent n.
constexpr Dimension contact_stiffness(double n) { return {1 - n, 1, -2, 0}; }
}  // namespace dimension

// The SI unit in which plain numbers of that dimension are read: "m", "rad/s", "N/m^1.5", "1".
std::string si_unit(const Dimension& dimension);

struct Quantity {
    double value = 0;  // in SI
    Dimension dimension;
};

// Either a quantity or the reason why the text is none, in words with a remedy.
struct QuantityText {
    std::optional<Quantity> quantity;
    std::string problem;
};
QuantityText parse_quantity(std::string_view text);

}  // namespace beamcam::scenes
