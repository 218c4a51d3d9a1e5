// Films of a plan, and destinations of their pictures: a video, PNG files, or a command that compares them.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "output/film/video.hpp"
#include "render/film/film.hpp"
#include "scenes/motions/fan_out.hpp"
#include "scenes/outputs/output_files.hpp"

namespace beamcam::scenes {

class PictureSink {
  public:
    // Receives the pictures of one drawing thread. `k`: index into PlannedPictures::draw; `changed`: where the picture
    // can differ from the previous one of this thread.
    using Input = std::function<void(long k, const render::Image& image, const render::DirtyTiles& changed)>;

    virtual ~PictureSink() = default;
    // Creates the input of one thread; ordered output passes the gate.
    virtual Input input(OrderedGate& gate) = 0;
    // True: picture k equals the previous one and was repeated without drawing.
    virtual bool repeat(long, const render::Film&, OrderedGate&) { return false; }
    virtual int threads(int most) const { return most; }
    // Number of completed pictures, when `put` have been delivered.
    virtual double done(long put) const { return static_cast<double>(put); }
    // Called after the last picture.
    virtual void finish() {}
};

// Context of sinks that write files.
struct SinkFiles {
    const Scene& scene;
    OutputFiles& files;
    RunContext& context;
    std::string accuracy;  // accuracy_note of the pictures
};

std::map<std::string, std::string> png_metadata(const SinkFiles& files);
// The metadata of a film, with the keys of MP4; `scene` is JSON.
std::map<std::string, std::string> film_metadata(const std::string& scene, const std::string& title);
output::VideoOptions video_options(const PictureOutput& p);

std::unique_ptr<PictureSink> make_video_sink(const PlannedPictures& p, render::Film& film, const SinkFiles& files);
std::unique_ptr<PictureSink> make_png_sink(const PlannedPictures& p, const SinkFiles& files);
std::unique_ptr<PictureSink> make_callback_sink(const PlannedPictures& p, const DrawCallbacks& callbacks);

// ---- from the plan and its motions to the input of render/

// `results`: of the motions of this picture; poses and tables are moved out of them.
render::FilmSetup film_setup(const Plan& plan, const PlannedPictures& p, const Scene& scene,
                             std::span<sim::Result* const> results);

// "rtol 10⁻⁸ · energy closes to 2 × 10⁻⁹ · bends beyond first-order"
std::string accuracy_note(const sim::Problem& problem, const sim::Result& result);

// Draws the selected frames of a film on several threads.
void draw(const PlannedPictures& p, const render::Film& film, PictureSink& sink, RunContext& context);

}  // namespace beamcam::scenes
