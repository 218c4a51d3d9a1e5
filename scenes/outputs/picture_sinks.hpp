// Where the pictures of a film go: into a video, into PNG files, or to a command that compares them.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "output/film/video.hpp"
#include "render/film/film.hpp"
#include "scenes/motions/fan_out.hpp"
#include "scenes/outputs/draw_callbacks.hpp"
#include "scenes/outputs/film_track.hpp"
#include "scenes/outputs/output_files.hpp"

namespace beamcam::scenes {

class PictureSink {
  public:
    // What one drawing thread gives its pictures to. `k` counts from 0 those that are drawn (Pictures::draw);
    // `changed`: where the picture may differ from the one that this thread gave before.
    using Input = std::function<void(long k, const render::Image& image, const render::DirtyTiles& changed)>;

    virtual ~PictureSink() = default;
    // For one thread; pictures that need an order pass the gate.
    virtual Input input(Gate& gate) = 0;
    // Takes picture k without its being drawn, where it equals the one before.
    virtual bool repeat(long, const render::Film&, Gate&) { return false; }
    virtual Crew crew(int most) const { return {most, most}; }
    // How many of `put` pictures are done with.
    virtual double done(long put) const { return static_cast<double>(put); }
    // All pictures are there.
    virtual void finish() {}
};

// What sinks that write files share.
struct SinkFiles {
    const Scene& scene;
    OutputFiles& files;
    RunContext& context;
    std::string accuracy;  // accuracy_note of the pictures
    FilmTrack track = {};
};

std::map<std::string, std::string> png_metadata(const SinkFiles& files);
output::VideoOptions video_options(const Pictures& p);

std::unique_ptr<PictureSink> make_video_sink(const Pictures& p, render::Film& film, const SinkFiles& files);
std::unique_ptr<PictureSink> make_png_sink(const Pictures& p, const SinkFiles& files);
std::unique_ptr<PictureSink> make_callback_sink(const Pictures& p, const DrawCallbacks& capture);

// Draws what is asked for of a film, on several threads.
void draw(const Pictures& p, const render::Film& film, PictureSink& sink, RunContext& context);

}  // namespace beamcam::scenes
