// The points of a sweep as its figures read them, and the colours and names of classes, starts and columns.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "output/data/sweep_data.hpp"
#include "render/plot/figure.hpp"
#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/caption.hpp"
#include "scenes/figures/motion_requests.hpp"
#include "scenes/scene/scene.hpp"
#include "sim/sweep/attractor.hpp"

namespace beamcam::scenes {

class SweptPoints {
  public:
    SweptPoints(const SweepResult& swept, Lang how);
    // The axes as diagrams draw them: in the scene's unit of angles and speeds, else with a prefix if it is linear.
    const std::vector<output::SweepAxis>& axes() const { return axes_; }
    const output::SweepAxis& axis(std::size_t i) const { return axes_.at(i); }
    double factor(std::size_t i) const { return factors_.at(i); }  // from the key's SI unit to that of the axis
    double value(std::uint64_t point) const { return factor(0) * data.place(point)[0]; }  // on the first axis
    std::uint64_t seeds() const { return starts_.size(); }
    SeedKind seed(std::uint64_t point) const { return starts_[point % starts_.size()]; }
    render::Scale scale(std::size_t i) const;
    // The index of a column of the samples; throws PictureError.
    std::size_t column(const std::string& name) const;
    bool of_impacts() const { return scene.sweep->sampling.kind == sim::SampleKind::impacts; }

    const Scene& scene;
    const output::SweepData& data;
    const Lang lang;

  private:
    std::vector<SeedKind> starts_;
    std::vector<output::SweepAxis> axes_;
    std::vector<double> factors_;
};

inline sim::AttractorClass kind_of(const output::StoredPoint& p) { return static_cast<sim::AttractorClass>(p.kind); }
render::Color color_of(sim::AttractorClass kind);
std::string class_label(sim::AttractorClass kind, Lang lang);

struct StartLook {
    SeedKind kind;
    const char* label;
    const char* lane;  // beside the strip of classes, whose highest lane is the first start
};
const StartLook& look_of(SeedKind kind);

// A column of samples along an axis, in the scene's unit of angles and speeds. Figures draw the speed v_n before an
// impact as the approach speed −v_n.
std::string column_label(const SweptPoints& points, std::size_t column);
double drawn(const SweptPoints& points, std::size_t column, double sample);
std::string label_of(const output::SweepAxis& axis);

// Edges of cells around the values, half-way between neighbours along the axis.
std::vector<double> edges_around(std::vector<double> values, render::Scale scale);
// The place of each value in ascending order, by its index.
std::vector<std::size_t> ranks(const std::vector<double>& values);

bool all_empty(const std::vector<render::figure::Cloud>& clouds);

// ---- the diagrams of one key and of two --------------------------------------------------------------

// The bifurcation diagram: samples over one parameter, the largest exponent where it is known, and a strip with the
// class of each motion. `how.value`: a column of the samples; empty: the default one. Throws PictureError for a column
// that they do not have.
render::figure::Figure bifurcation(const SweptPoints& points, const FigureOutput& how);

// Values of a map besides the columns of the samples; the first is the default.
inline constexpr const char* kMapValues[] = {"class", "exponent", "impacts_per_period"};

// A map over two keys: the class of each motion, or a number of it, as colours. `how.value`: one of these values or a
// column of the samples, whose mean is shown; empty: the class. Throws PictureError for another, or where no point has
// the number.
render::figure::Figure key_map(const SweptPoints& points, const FigureOutput& how);

}  // namespace beamcam::scenes
