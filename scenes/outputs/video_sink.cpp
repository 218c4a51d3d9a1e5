#include <algorithm>
#include <utility>

#include "output/film/palette.hpp"
#include "output/image/png.hpp"
#include "scenes/outputs/demand.hpp"
#include "scenes/outputs/picture_sinks.hpp"
#include "scenes/scene/version.hpp"

namespace beamcam::scenes {
namespace {

// What a film's players show, in the keys that MP4 knows.
std::map<std::string, std::string> film_metadata(const Pictures& p, const SinkFiles& to) {
    std::map<std::string, std::string> all = {{"comment", fmt::format("made by beamcam {}", kVersion)},
                                              {"beamcam-scene", to_json(to.scene)},
                                              {"beamcam-version", std::string(kVersion)},
                                              {"beamcam-accuracy", to.accuracy}};
    if (!p.part.empty()) all["beamcam-frames"] = p.part;
    if (!to.scene.title.empty()) all["title"] = to.scene.title;
    return all;
}

// A GIF's colours are those of a few of its frames.
std::vector<std::uint32_t> palette_of(render::Film& film) {
    constexpr int kSamples = 9;
    output::PaletteMaker maker;
    render::Image image;
    const int last = film.frames() - 1, samples = std::min(kSamples, film.frames());
    for (int i = 0; i < samples; ++i) {
        film.draw(samples == 1 ? 0 : i * last / (samples - 1), image);
        maker.add(image);
    }
    return maker.colors();
}

output::VideoOptions options_of(const Pictures& p, render::Film& film, const SinkFiles& to) {
    output::VideoOptions options = video_options(p);
    if (options.codec == output::Codec::gif) options.palette = palette_of(film);
    options.metadata = film_metadata(p, to);
    return options;
}

class VideoSink final : public PictureSink {
  public:
    VideoSink(const Pictures& p, render::Film& film, const SinkFiles& to)
        : p_(p),
          to_(to),
          poster_metadata_(p.makes_poster() ? png_metadata(to) : std::map<std::string, std::string>()),
          video_(to.files.target(to.files.path_of(p.file), p.output), options_of(p, film, to)) {
        ++to.context.work.encoders;
    }

    std::unique_ptr<Input> input(Gate& gate) override { return std::make_unique<ToVideo>(*this, gate); }
    // An encoder has its own threads; few have to draw to keep it busy.
    Crew crew(int most) const override {
        if (p_.picture.view.style == render::Style::solid) return {most, most};
        const int share = p_.picture.view.style == render::Style::flat ? 4 : 2;
        return {std::max(1, most / share), most, [demand = std::make_shared<Demand>(video_)] { return (*demand)(); }};
    }
    double done(long) const override {
        const output::VideoStatistics now = video_.statistics();
        return static_cast<double>(now.frames + now.held);
    }
    void finish() override {
        video_.finish();
        to_.context.progress.reach(static_cast<double>(p_.draw.size()));
        const output::VideoStatistics spent = video_.statistics();
        to_.context.times.convert += spent.convert_seconds;
        to_.context.times.encode += spent.encode_seconds;
        to_.context.work.frames_encoded += spent.frames;
        to_.files.wrote(to_.files.path_of(p_.file), fmt::format("{} frames", p_.draw.size()));
        if (p_.makes_poster()) to_.files.wrote(to_.files.path_of(p_.poster_file), "poster");
    }

  private:
    class ToVideo final : public Input {
      public:
        ToVideo(VideoSink& sink, Gate& gate) : sink_(sink), gate_(gate), converter_(sink.video_) {}
        bool repeat(long k, const render::Film& film) override {
            if (!sink_.repeats(static_cast<std::size_t>(k), film)) return false;
            gate_.pass(k, [&] { sink_.video_.repeat(); });
            return true;
        }
        void put(long k, const render::Image& image, const render::Tiles& changed) override {
            if (sink_.is_poster(static_cast<std::size_t>(k))) sink_.write_poster(image);
            converter_.convert(image, changed);
            gate_.pass(k, [&] { converter_.send(); });
        }

      private:
        VideoSink& sink_;
        Gate& gate_;
        output::VideoInput converter_;
    };

    bool is_poster(std::size_t k) const { return p_.makes_poster() && p_.draw[k] == *p_.poster; }
    // Equal to the picture that is written just before it, and not wanted beside the film.
    bool repeats(std::size_t k, const render::Film& film) const {
        return k > 0 && p_.draw[k] == p_.draw[k - 1] + 1 && film.repeats(p_.draw[k]) && !is_poster(k);
    }
    void write_poster(const render::Image& image) const {
        output::write_png(to_.files.target(to_.files.path_of(p_.poster_file), p_.output), image,
                          {std::nullopt, poster_metadata_});
    }

    const Pictures& p_;
    SinkFiles to_;
    const std::map<std::string, std::string> poster_metadata_;
    output::VideoWriter video_;
};

}  // namespace

output::VideoOptions video_options(const Pictures& p) {
    output::VideoOptions video;
    video.width = p.picture.size.width;
    video.height = p.picture.size.height;
    video.fps = p.span.fps.value();
    video.codec = p.encoding.codec;
    video.transparent = p.picture.view.transparent;
    video.crf = p.encoding.crf;
    video.preset = p.encoding.preset;
    video.variable_rate = p.encoding.variable_rate && p.part.empty();
    if (video.codec == output::Codec::gif) video.palette = {0xffffffff};
    return video;
}

std::unique_ptr<PictureSink> make_video_sink(const Pictures& p, render::Film& film, const SinkFiles& files) {
    return std::make_unique<VideoSink>(p, film, files);
}

}  // namespace beamcam::scenes
