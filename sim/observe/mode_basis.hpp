// The modes in which a motion is bounded, with what each contributes to hub, tip, energies and points of the beam: the
// coordinates themselves, or the natural modes of the straight beam where the coordinates are coupled or are no
// lengths.
#pragma once

#include <vector>

#include "sim/base/lanes.hpp"
#include "sim/dynamics/system.hpp"

namespace beamcam::sim {

struct ModeBasis {
    explicit ModeBasis(System& system);

    // `turn`, `tip`: what q adds to θ and to the tip's deflection; U of the term Θ̇Uq̇ of the energy, in groups its
    // magnitude. The rest are magnitudes: `h` of turn; W of the term gWq; `inertia`, `weight`: roots of the diagonals
    // of their quadratic terms; `shape`, `slope`: largest displacement and rotation along the beam; `wave`: wave number
    // [1/m]; `damping` = 2γ.
    template <class T>
    struct Contribution {
        T h{}, turn{}, tip{}, U{}, W{}, stiffness{}, inertia{}, weight{}, shape{}, slope{}, wave{}, omega{}, damping{};
        // Of q̈, what stiffness and damping cause; the forcing adds the rest.
        template <class X>
        X restored(const X& q, const X& rate) const {
            return -damping * rate - omega * omega * q;
        }
    };
    using Mode = Contribution<double>;
    std::vector<Mode> modes;
    using Group = Contribution<Lanes>;
    std::vector<Group> groups;  // the same, eight modes side by side; zero beyond the last
    // Angle and deflection of the tip by coordinates, and the coordinates by modes: row-major, empty where the modes
    // are the coordinates.
    std::vector<double> hub, tip, natural, to_natural;
    bool are_coordinates() const { return natural.empty(); }
    // By terms of third order in the deflection, which the modal models leave out.
    bool bends_far = false;
    double length = 0, reach = 0, mass = 0, J = 0, S = 0;

    std::size_t size() const { return modes.size(); }
    // What mode i contributes to coordinate q_{j+1}.
    double share(std::size_t j, std::size_t i) const {
        return are_coordinates() ? (i == j ? 1.0 : 0.0) : natural[(j + 1) * (size() + 1) + i + 1];
    }
    // Coordinates or rates, in place: z₀…z_n.
    void to_modes(double* x) const;

  private:
    void of_coordinates(System& system);
    void of_natural_modes(System& system);
    void pack_modes();
};

}  // namespace beamcam::sim
