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

Form layout_form(std::optional<render::LayoutNode>& layout);

// Of words on pictures: a formula that cannot be read.
void judge_words(ObjectReader& r, const char* key, const std::string& text);
// Labels and titles of figures are markup.
void judge_markup(ObjectReader& r, const std::string& key, const std::string& text);
void judge_physics(ObjectReader& r, const sim::Problem& problem);
// The units in which the scene writes its angle and its speed are those of its pictures.
void take_written_units(ObjectReader& r, render::Units& units);
void judge_camera(ObjectReader& r, const View& view);  // `r`: of the camera
void judge_view(ObjectReader& r, const View& view);    // `r`: of the view
void judge_picture(ObjectReader& r, Picture& picture);
bool is_of_contact(sim::ChannelKind kind);  // without a cam it has no values
void judge_layout(ObjectReader& r, const Picture& picture);
void judge_speed(ObjectReader& r, const Speed& speed);  // `r`: of the speed
void judge_span(ObjectReader& r, const FrameSpan& span, const Picture& picture);
void take_usual_codec(ObjectReader& r, VideoOutput& video);
void judge_video(ObjectReader& r, VideoOutput& video);
void judge_figure(ObjectReader& r, FigureOutput& figure);
void judge_series_panel(ObjectReader& r, const SeriesPanel& panel);
void judge_table(ObjectReader& r, TrajectoryOutput& table);
void judge_shapes(ObjectReader& r, ShapesOutput& shapes);
void judge_sweep(ObjectReader& r, SweepOutput& sweep);
void name_after_scene(ObjectReader& r, std::string& file, const char* ending);
void judge_outputs(ObjectReader& r, Scene& scene);  // and remembers where each stands

// Why a span has no frames, or too many; empty when it is fine.
std::string problem_with_span(const FrameSpan& span, double end_time);

// Why a diagram cannot show this of the points of the scene's sweep; empty: it can.
std::string problem_with_value(std::string_view diagram, const std::string& value, const Scene& scene);

}  // namespace beamcam::scenes
