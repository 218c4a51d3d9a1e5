#include <algorithm>

#include "output/files/atomic_file.hpp"
#include "output/film/palette.hpp"
#include "output/image/png.hpp"
#include "render/plot/user_text.hpp"
#include "scenes/outputs/picture_sinks.hpp"
#include "scenes/scene/version.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

// The palette of a GIF, from some of its frames.
std::vector<std::uint32_t> palette_of(render::Film& film) {
    constexpr int kSamples = 16;
    output::PaletteMaker maker;
    render::Image image;
    const int last = film.frames() - 1, samples = std::min(kSamples, film.frames());
    for (int i = 0; i < samples; ++i) {
        film.draw(samples == 1 ? 0 : i * last / (samples - 1), image);
        maker.add(image);
    }
    return maker.colors();
}

output::VideoOptions options_of(const PlannedPictures& p, render::Film& film, const SinkFiles& to) {
    output::VideoOptions options = video_options(p);
    if (options.codec == output::Codec::gif) options.palette = palette_of(film);
    options.metadata = film_metadata(metadata_json(to.scene), to.scene.title);
    options.metadata["beamcam-accuracy"] = to.accuracy;
    return options;
}

class VideoSink final : public PictureSink {
  public:
    VideoSink(const PlannedPictures& p, render::Film& film, const SinkFiles& to)
        : p_(p),
          to_(to),
          poster_metadata_(p.times.poster ? png_metadata(to) : std::map<std::string, std::string>()),
          video_(to.files.target(to.files.path_of(p.file), p.output), options_of(p, film, to)) {
        ++to.context.work.encoders;
    }

    Input input(OrderedGate& gate) override {
        return [this, &gate, converter = std::make_shared<output::VideoInput>(video_)](
                   long k, const render::Image& image, const render::DirtyTiles& changed) {
            if (is_poster(static_cast<std::size_t>(k)))
                output::write_png(to_.files.target(to_.files.path_of(p_.poster_file), p_.output), image,
                                  {std::nullopt, poster_metadata_});
            converter->convert(image, changed);
            gate.pass(k, [&] { converter->send(); });
        };
    }
    // A poster is always drawn.
    bool repeat(long k, const render::Film& film, OrderedGate& gate) override {
        const auto at = static_cast<std::size_t>(k);
        if (k == 0 || !film.repeats(p_.draw[at]) || is_poster(at)) return false;
        gate.pass(k, [&] { video_.repeat(); });
        return true;
    }
    // The encoder has its own threads; a few drawing threads keep it busy. Another one costs time: it has to draw every
    // change since its own last picture.
    int threads(int most) const override {
        if (p_.view.style == render::Style::solid) return most;
        return std::max(1, most / (p_.view.style == render::Style::flat ? 4 : 2));
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
        to_.files.wrote(to_.files.path_of(p_.file), counted(p_.draw.size(), "frame"));
        if (p_.times.poster) to_.files.wrote(to_.files.path_of(p_.poster_file), "poster");
    }

  private:
    bool is_poster(std::size_t k) const { return p_.times.poster && p_.draw[k] == *p_.times.poster; }

    const PlannedPictures& p_;
    SinkFiles to_;
    const std::map<std::string, std::string> poster_metadata_;
    output::VideoWriter video_;
};

}  // namespace

std::map<std::string, std::string> film_metadata(const std::string& scene, const std::string& title) {
    std::map<std::string, std::string> all = {{"comment", fmt::format("made by beamcam {}", kVersion)},
                                              {"beamcam-scene", scene},
                                              {"beamcam-version", std::string(kVersion)}};
    if (!title.empty()) all["title"] = render::plain_text(title);
    return all;
}

output::VideoOptions video_options(const PictureOutput& p) {
    output::VideoOptions video;
    video.width = p.size.width;
    video.height = p.size.height;
    video.fps = p.span.fps;
    static_cast<Encoding&>(video) = p.encoding;
    video.transparent = p.view.transparent;
    if (video.codec == output::Codec::gif) video.palette = {0xffffffff};
    return video;
}

std::unique_ptr<PictureSink> make_video_sink(const PlannedPictures& p, render::Film& film, const SinkFiles& files) {
    return std::make_unique<VideoSink>(p, film, files);
}

}  // namespace beamcam::scenes
