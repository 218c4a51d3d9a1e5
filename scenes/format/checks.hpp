// What the keys of a scene ask of each other, beyond the range of each: judged by the reader after it has read them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenes/format/object_reader.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

// More than eight motions neither colours nor eyes tell apart.
inline constexpr std::size_t kMostCompared = 8;

ValueFormat layout_format(std::optional<render::LayoutNode>& layout);

// Of words on pictures: a formula that cannot be read.
void check_words(ObjectReader& r, const char* key, const std::string& text);
// Labels and titles of figures are markup.
void check_markup(ObjectReader& r, const std::string& key, const std::string& text);
void check_physics(ObjectReader& r, const sim::Problem& problem);
// The units in which the scene writes its angle and its speed are those of its pictures.
void take_written_units(ObjectReader& r, render::Units& units);
void check_camera(ObjectReader& r, const View& view);  // `r`: of the camera
void check_view(ObjectReader& r, const View& view);    // `r`: of the view
void check_picture(ObjectReader& r, Picture& picture);
void check_layout(ObjectReader& r, const Picture& picture);
void check_speed(ObjectReader& r, const Speed& speed);  // `r`: of the speed
void check_span(ObjectReader& r, const FrameSpan& span, const Picture& picture);
void take_usual_codec(ObjectReader& r, VideoOutput& video);
void check_video(ObjectReader& r, VideoOutput& video);
void check_figure(ObjectReader& r, FigureOutput& figure);
void check_series_panel(ObjectReader& r, const SeriesPanel& panel);
void check_table(ObjectReader& r, TrajectoryOutput& table);
void check_shapes(ObjectReader& r, ShapesOutput& shapes);
void check_sweep(ObjectReader& r, SweepOutput& sweep);
void name_after_scene(ObjectReader& r, std::string& file, const char* ending);
void check_outputs(ObjectReader& r, Scene& scene);  // and remembers where each stands

// Why a span has no frames, or too many; empty when it is fine.
std::string problem_with_span(const FrameSpan& span, double end_time);

// Why a diagram cannot show this of the points of the scene's sweep; empty: it can.
std::string problem_with_value(std::string_view diagram, const std::string& value, const Scene& scene);

}  // namespace beamcam::scenes
