#include "scenes/outputs/picture_sinks.hpp"

#include <algorithm>
#include <mutex>

#include "output/files/atomic_file.hpp"
#include "output/image/png.hpp"
#include "render/plot/user_text.hpp"
#include "scenes/scene/files.hpp"
#include "scenes/scene/version.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

class PngSink final : public PictureSink {
  public:
    PngSink(const PlannedPictures& p, const SinkFiles& to) : p_(p), to_(to), metadata_(png_metadata(to)) {
        if (p.kind != PlannedPictures::Kind::frames) return;
        // A scene may be many times as large as a picture: the first frame has it, the others name that.
        later_metadata_ = metadata_;
        later_metadata_.erase("beamcam-scene");
        later_metadata_["beamcam-scene-in"] =
            std::filesystem::path(numbered_file(p.file, p.times.first)).filename().string();
    }

    Input input(OrderedGate&) override {
        // An unchanged frame has the file of the one before.
        return [this, file = std::make_shared<std::string>(), encoded_with_scene = std::make_shared<bool>(false)](
                   long k, const render::Image& image, const render::DirtyTiles& changed) {
            const std::filesystem::path path = path_of(static_cast<std::size_t>(k));
            const output::FileTarget target = to_.files.target(path, p_.output);
            const auto start = Clock::now();
            const bool has_scene = p_.kind == PlannedPictures::Kind::still || p_.draw[static_cast<std::size_t>(k)] == 0;
            if (file->empty() || changed.any() || *encoded_with_scene != has_scene)
                *file = output::encode_png(image, {std::nullopt, has_scene ? metadata_ : later_metadata_});
            *encoded_with_scene = has_scene;
            output::write_file(
                target, *file,
                p_.kind == PlannedPictures::Kind::still ? output::Durability::synced : output::Durability::buffered);
            const std::lock_guard lock(mutex_);
            to_.context.times.write += seconds_since(start);
            if (p_.kind == PlannedPictures::Kind::frames) to_.files.count_written(path);
        };
    }
    void finish() override {
        if (p_.kind == PlannedPictures::Kind::still) return to_.files.wrote(to_.files.path_of(p_.file), "");
        to_.context.progress.end();
        const std::string last = numbered_file(p_.file, p_.number_of(p_.draw.size() - 1));
        to_.context.print("wrote {}{} ({})\n", path_of(0).string(), p_.draw.size() > 1 ? " … " + last : "",
                          counted(p_.draw.size(), "frame"));
    }

  private:
    std::filesystem::path path_of(std::size_t k) const {
        return to_.files.path_of(p_.kind == PlannedPictures::Kind::still ? p_.file
                                                                         : numbered_file(p_.file, p_.number_of(k)));
    }

    const PlannedPictures& p_;
    SinkFiles to_;
    const std::map<std::string, std::string> metadata_;
    std::map<std::string, std::string> later_metadata_;  // of the frames after the first
    std::mutex mutex_;                                   // guards the counts
};

class CallbackSink final : public PictureSink {
  public:
    CallbackSink(const PlannedPictures& p, const DrawCallbacks& callbacks) : p_(p), callbacks_(callbacks) {}
    Input input(OrderedGate&) override {
        return
            [this](long k, const render::Image& image, const render::DirtyTiles&) { callbacks_.picture(p_, k, image); };
    }

  private:
    const PlannedPictures& p_;
    const DrawCallbacks& callbacks_;
};

}  // namespace

std::map<std::string, std::string> png_metadata(const SinkFiles& to) {
    std::map<std::string, std::string> all = {{"Software", fmt::format("beamcam {}", kVersion)},
                                              {"beamcam-scene", metadata_json(to.scene)},
                                              {"beamcam-accuracy", to.accuracy}};
    if (!to.scene.title.empty()) all["Title"] = render::plain_text(to.scene.title);
    return all;
}

std::unique_ptr<PictureSink> make_png_sink(const PlannedPictures& p, const SinkFiles& files) {
    return std::make_unique<PngSink>(p, files);
}
std::unique_ptr<PictureSink> make_callback_sink(const PlannedPictures& p, const DrawCallbacks& callbacks) {
    return std::make_unique<CallbackSink>(p, callbacks);
}

void draw(const PlannedPictures& p, const render::Film& film, PictureSink& sink, RunContext& context) {
    const auto count = static_cast<long>(p.draw.size());
    context.progress.begin(p.kind == PlannedPictures::Kind::video ? "film" : "draw", static_cast<double>(count),
                           "frames");
    OrderedGate gate;
    std::mutex mutex;  // guards counts and times
    long put = 0;
    const auto make_worker = [&]() -> Worker {
        const auto own = std::make_shared<render::Film>(film.for_thread());
        return [&, own, input = sink.input(gate)](long k) {
            double spent = 0;
            const bool repeated = sink.repeat(k, *own, gate);
            if (!repeated) {
                const auto start = Clock::now();
                const render::Image& image = own->draw(p.draw[static_cast<std::size_t>(k)]);
                spent = seconds_since(start);
                input(k, image, own->changed());
            }
            const std::lock_guard lock(mutex);
            context.times.draw += spent;
            ++(repeated ? context.work.frames_repeated : context.work.frames_drawn);
            context.progress.reach(sink.done(++put));
        };
    };
    const int threads = sink.threads(thread_count(context.options.threads));
    context.times.threads = std::max(context.times.threads, fan_out(count, threads, make_worker, gate));
    stop_if_interrupted();
    sink.finish();
    context.progress.end();
    const render::DrawingCounts& counts = film.counts();
    context.work.font_sets += counts.font_sets;
    context.work.gl_contexts += counts.gl_contexts;
    context.work.bodies_drawn += counts.bodies_drawn;
}

}  // namespace beamcam::scenes
