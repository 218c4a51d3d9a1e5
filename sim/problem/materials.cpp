// Cross-sections and materials of the beam by name. MODEL.md (S94), (S95).
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {
namespace {

using std::numbers::pi;

struct MaterialRow {
    Named<Material> named;
    MaterialProperties values;
};
// Rounded typical values; the sources of each are in the table of (S95).
constexpr MaterialRow kMaterials[] = {
    {{Material::steel, "steel"}, {7850, 210e9, 0.3}},         // EN 1991-1-1, EN 1993-1-1
    {{Material::aluminium, "aluminium"}, {2700, 70e9, 0.3}},  // EN 1999-1-1
    {{Material::titanium, "titanium"}, {4500, 110e9, 0.33}},  // Gere: titanium alloys
    {{Material::brass, "brass"}, {8500, 101e9, 0.35}},        // Gere: density; Dowling: 70 Cu–30 Zn
    {{Material::pmma, "pmma"}, {1190, 3.3e9, 0.35}},          // data sheets of extruded sheets; Dowling: ν
    {{Material::pom, "pom"}, {1410, 3.0e9, 0.35}},            // homopolymer: Margolis; Delrin Design Guide: ν
    {{Material::rubber, "rubber"}, {1100, 2e6, 0.49}},        // Gere: the middle of the ranges
};

}  // namespace

std::span<const Named<Material>> names(Material) {
    static constexpr auto all = [] {
        std::array<Named<Material>, std::size(kMaterials)> out{};
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = kMaterials[i].named;
        return out;
    }();
    return all;
}

MaterialProperties material_properties(Material material) {
    for (const MaterialRow& row : kMaterials)
        if (row.named.value == material) return row.values;
    return {};
}

MaterialProperties material_properties(const Beam& beam) {
    if (beam.material) return material_properties(*beam.material);
    return {beam.density, beam.youngs_modulus, beam.poisson_ratio};
}

Beam with_numbers_of_material(Beam beam) {
    const MaterialProperties material = material_properties(beam);
    beam.material.reset();
    beam.density = material.density;
    beam.youngs_modulus = material.youngs_modulus;
    beam.poisson_ratio = material.poisson_ratio;
    return beam;
}

// (S94)
SectionProperties section_properties(const Section& section) {
    if (const auto* s = std::get_if<Rectangle>(&section))
        return {s->width * s->height, s->width * std::pow(s->height, 3) / 12, 0.5 * s->height};
    if (const auto* s = std::get_if<Circle>(&section))
        return {pi / 4 * s->diameter * s->diameter, pi / 64 * std::pow(s->diameter, 4), 0.5 * s->diameter};
    if (const auto* s = std::get_if<Tube>(&section)) {
        const double mean = s->diameter - s->wall;  // of the diameters; no difference of powers is formed
        const double area = pi * mean * s->wall;
        return {area, 0.125 * area * (mean * mean + s->wall * s->wall), 0.5 * s->diameter};
    }
    const auto& s = std::get<CustomSection>(section);
    return {s.area, s.second_moment, s.c_max};
}

SectionProperties section_properties(const Beam& beam) {
    if (beam.section) return section_properties(*beam.section);
    return {beam.area, beam.second_moment, 0.5 * beam_depth(beam)};
}

double Beam::line_density() const { return material_properties(*this).density * section_properties(*this).area; }
double Beam::bending_stiffness() const {
    return material_properties(*this).youngs_modulus * section_properties(*this).second_moment;
}

}  // namespace beamcam::sim
