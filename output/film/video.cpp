#include "output/film/video.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <exception>
#include <mutex>
#include <numeric>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "output/files/atomic_file.hpp"
#include "output/film/encoder_recipe.hpp"
#include "output/film/palette.hpp"
#include "output/film/pixel_layout.hpp"
#include "output/film/video_library.hpp"
#include "render/base/limits.hpp"
#include "sim/base/clock.hpp"

namespace beamcam::output {

namespace {

constexpr double kLongestHold = 5;  // [s]
constexpr std::array kPresets = {"ultrafast", "superfast", "veryfast", "faster",   "fast",
                                 "medium",    "slow",      "slower",   "veryslow", "placebo"};
std::string preset_names() {
    std::string text;
    for (const char* preset : kPresets) text += (text.empty() ? "" : ", ") + std::string(preset);
    return text;
}

// Upper limit for all encoders but SVT-AV1: `threads`, and some for look-ahead and filters.
constexpr int kThreadsOfEncoder = 16;

// SVT-AV1 waits forever if some of its threads cannot start. It started 90 threads on two cores; more cores, more
// threads.
int threads_of_svt_av1() { return std::min(64 + 32 * static_cast<int>(std::thread::hardware_concurrency()), 256); }

// Whether SVT-AV1 gets the memory that it needs. On two cores the process used an address space of 1.4 GB for 320x180
// pixels, 2.2 for 1280x720, 2.7 for 1920x1080, 5.0 for 3840x2160, with 8 MB for the stack of each thread. The process
// keeps this memory for the next encoder.
bool has_memory_for_svt_av1(int width, int height) {
    static std::atomic<std::size_t> taken = 0;
    constexpr std::size_t kThread = 10 << 20, kPixel = 350;  // [bytes]
    const std::size_t need = kThread * static_cast<std::size_t>(threads_of_svt_av1()) +
                             kPixel * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (need <= taken) return true;
    if (!render::has_memory(need)) return false;
    taken = need;
    return true;
}

}  // namespace

void silence_encoder_logs() { setenv("SVT_LOG", "1", 0); }

FrameRate frame_rate(double fps) {
    if (const std::string problem = rate_problem(Codec::h264, fps); !problem.empty()) throw UnsupportedOption(problem);
    // 23.976, 23.98, 29.97, 59.94 …: usual decimals differ from n·1000/1001 by less than 0.005; no integer rate does.
    for (int whole : {24, 30, 48, 60, 72, 90, 96, 100, 120, 144, 240})
        if (std::abs(fps - whole * 1000.0 / 1001) < 0.005) return {whole * 1000, 1001};
    FrameRate best{static_cast<int>(std::lround(fps)), 1};
    for (int base = 1; base <= 1000; ++base) {
        const FrameRate candidate{static_cast<int>(std::lround(fps * base)), base};
        if (std::abs(candidate.value() - fps) < std::abs(best.value() - fps) - 1e-12 * fps) best = candidate;
    }
    return best;
}

std::vector<std::string> problems(const VideoOptions& o, std::string_view ending) {
    std::vector<std::string> found;
    for (std::string problem : {format_problem(ending, o.codec, o.transparent),
                                size_problem(o.codec, o.width, o.height), rate_problem(o.codec, o.fps)})
        if (!problem.empty()) found.push_back(std::move(problem));
    const auto quality = quality_scale(o.codec);
    if (o.crf && !quality)
        found.push_back(std::string(title(o.codec)) + " has no crf, because its quality is fixed; remove it");
    else if (o.crf && (*o.crf < 0 || *o.crf > quality->worst))
        found.push_back("crf " + std::to_string(*o.crf) + " is not possible; use 0 (best) to " +
                        std::to_string(quality->worst) + ", " + std::to_string(quality->usual) + " looks lossless");
    if (o.codec == Codec::gif && (o.palette.empty() || o.palette.size() > 256))
        found.push_back("a GIF needs a palette of 1 to 256 colours");
    if (std::find(kPresets.begin(), kPresets.end(), o.preset) == kPresets.end())
        found.push_back("unknown preset \"" + o.preset + "\"; use one of " + preset_names());
    if (o.threads < 1 || o.threads > 4)
        found.push_back(
            std::to_string(o.threads) +
            " encoder threads are not possible; use 1 to 4, because with more the film depends on their number");
    return found;
}

// A converted picture: a frame of the module.
struct VideoInput::Slot {
    FramePlanes* frame = nullptr;
    int uses = 0;              // places in the queue, plus one if it is the latest picture
    render::DirtyTiles stale;  // tiles that differ from the picture that its input converted last
};

// Each input has a few slots, which it fills and queues in turn; `worker` encodes the queue in order. The number of
// slots limits how far drawing runs ahead.
struct VideoWriter::Impl {
    using Slot = VideoInput::Slot;
    static constexpr std::size_t kSlotsOfAnInput = 3, kLongestQueue = 12;

    AtomicFile file;
    VideoOptions options;
    PixelLayout layout = PixelLayout::yuv420;
    std::optional<PaletteTable> table;  // of a GIF
    std::unique_ptr<Encoder> encoder;   // used by the worker until `stop`, except to make frames
    std::unique_ptr<VideoInput> own;    // of `write`

    mutable std::mutex mutex;  // guards the members below
    std::condition_variable changed;
    std::deque<Slot> slots;
    Slot* latest = nullptr;  // queued last; kept for `repeat`
    struct Shown {
        Slot* slot;
        bool again;  // the previous picture once more
    };
    std::deque<Shown> queue;
    long waiting = 0;  // repetitions of the last encoded picture that are not encoded yet
    long longest_hold = 0;
    bool closing = false;    // no more pictures follow
    bool abandoned = false;  // and waiting pictures are dropped
    std::exception_ptr failure;
    VideoStatistics cost;
    std::thread worker;

    Impl(const Target& target, const VideoOptions& video_options) : file(target), options(video_options) {
        open();
        try {
            worker = std::thread([this] { work(); });
        } catch (const std::system_error&) {
            throw no_thread();
        }
    }

    ~Impl() { stop(true); }

    IoError no_thread() const {
        return IoError("cannot write " + file.target().string() + ": no thread can be started for the encoder; " +
                       render::kThreadRemedy);
    }

    void open() {
        const EncoderRecipe recipe = encoder_recipe(options, file.target().extension().string());
        layout = recipe.layout;
        if (options.variable_rate) {
            longest_hold = std::lround(kLongestHold * options.fps);
            options.metadata["beamcam-rate-mode"] = "variable";  // `concat` checks it
        }
        if (!options.palette.empty()) table.emplace(options.palette);
        const VideoLibrary& library = video_library();
        if (options.codec == Codec::av1 && library.has_encoder("libsvtav1")) {
            if (!has_memory_for_svt_av1(options.width, options.height)) throw std::bad_alloc();
            if (!render::can_start_threads(threads_of_svt_av1())) throw no_thread();
        }
        try {
            encoder = library.open_encoder(settings(recipe));
        } catch (const CodecFailure& error) {                       // for reasons unknown to format_problem
            if (render::memory_is_short()) throw std::bad_alloc();  // encoders do not report it
            if (!render::can_start_threads(kThreadsOfEncoder)) throw no_thread();
            throw UnsupportedOption(std::string("the encoder of ") + title(options.codec) + " rejects films of " +
                                    std::to_string(options.width) + "x" + std::to_string(options.height) +
                                    " pixels here (" + error.what() +
                                    "); choose a smaller size, or write frames (NAME-####.png)");
        }
    }

    EncoderSettings settings(const EncoderRecipe& recipe) const {
        const FrameRate fps = frame_rate(options.fps);
        EncoderSettings settings;
        settings.file = file.temporary_path();
        settings.named = file.target();
        settings.width = options.width;
        settings.height = options.height;
        settings.rate = fps.rate;
        settings.rate_base = fps.base;
        settings.threads = options.threads;
        settings.container = recipe.container;
        settings.encoders = recipe.encoders;
        settings.pixel_format = recipe.pixel_format;
        settings.encoder_options = recipe.encoder_options;
        settings.container_options = recipe.container_options;
        settings.missing = recipe.missing;
        if (layout == PixelLayout::indices) {
            auto& colors = settings.palette.emplace();
            colors.fill(0xff000000U);
            std::ranges::copy(options.palette, colors.begin());
        }
        settings.metadata.assign(options.metadata.begin(), options.metadata.end());
        settings.chapters = options.chapters;
        settings.subtitles = options.subtitles;
        settings.subtitle_language = options.subtitle_language;
        return settings;
    }

    // Slots for one more input.
    std::vector<Slot*> more_slots() {
        const std::lock_guard lock(mutex);
        std::vector<Slot*> more;
        for (std::size_t i = 0; i < kSlotsOfAnInput; ++i) {
            slots.push_back({&encoder->make_frame(), 0, render::DirtyTiles(options.width, options.height)});
            slots.back().stale.add_all();
            more.push_back(&slots.back());
        }
        return more;
    }

    void work() {
        std::unique_lock lock(mutex);
        for (;;) {
            const Clock::time_point idle = Clock::now();
            changed.wait(lock, [this] { return closing || !queue.empty(); });
            cost.idle_seconds += seconds_since(idle);
            if (abandoned || queue.empty()) return;
            const auto [slot, again] = queue.front();
            if (again && waiting + 1 < longest_hold) {
                ++waiting;
                ++cost.held;
            } else {
                encode(*slot, lock);
            }
            queue.pop_front();
            --slot->uses;
            changed.notify_all();
        }
    }

    // Encodes the picture after the waiting repetitions. An error ends `work`; the next `write` or `finish` throws it.
    void encode(Slot& slot, std::unique_lock<std::mutex>& lock) {
        const long held = std::exchange(waiting, 0);
        lock.unlock();
        const Clock::time_point start = Clock::now();
        std::exception_ptr error;
        try {
            if (held > 0) encoder->hold(held);
            encoder->encode(*slot.frame);
        } catch (...) {
            error = std::current_exception();
        }
        const double spent = seconds_since(start);
        lock.lock();
        cost.encode_seconds += spent;
        if (!error) {
            ++cost.frames;
            return;
        }
        closing = abandoned = true;
        failure = error;
    }

    // Encodes the waiting pictures and completes the file.
    void finish() {
        stop(false);
        std::unique_lock lock(mutex);
        // The last repetition is encoded, so that the film has the right duration.
        if (!failure && waiting > 0) {
            --waiting;
            --cost.held;
            encode(*latest, lock);
        }
        if (failure) std::rethrow_exception(failure);
        const Clock::time_point start = Clock::now();
        encoder->finish();
        cost.encode_seconds += seconds_since(start);
        file.commit();
    }

    // The last queued picture; null before the first.
    Slot* last() {
        const std::lock_guard lock(mutex);
        return latest;
    }

    // Waits until `ready` returns true; calls it under the lock. Throws the error of the encoder.
    template <typename Ready>
    void wait_until(std::unique_lock<std::mutex>& lock, Ready ready) {
        changed.wait(lock, [&] { return failure || ready(); });
        if (failure) std::rethrow_exception(failure);
    }

    // One of these slots that is neither in the queue nor the latest.
    Slot& unused(const std::vector<Slot*>& among) {
        std::unique_lock lock(mutex);
        Slot* found = nullptr;
        wait_until(lock, [&] {
            for (Slot* slot : among)
                if (slot->uses == 0) found = slot;
            return found != nullptr;
        });
        return *found;
    }

    void convert(const render::Image& image, Slot& slot) {
        if (image.width != options.width || image.height != options.height)
            throw std::logic_error("a picture of " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                                   " in a film of " + std::to_string(options.width) + "x" +
                                   std::to_string(options.height));
        const Clock::time_point start = Clock::now();
        output::convert(image, layout, table ? &*table : nullptr, *slot.frame, slot.stale);
        slot.stale.clear();
        const double spent = seconds_since(start);
        const std::lock_guard lock(mutex);
        cost.convert_seconds += spent;
    }

    void enqueue(Slot& slot, bool again = false) {
        std::unique_lock lock(mutex);
        wait_until(lock, [this] { return queue.size() < kLongestQueue; });
        queue.push_back({&slot, again});
        ++slot.uses;
        if (latest != &slot) {
            if (latest != nullptr) --latest->uses;
            latest = &slot;
            ++slot.uses;
        }
        changed.notify_all();
    }

    void stop(bool abandon) {
        {
            const std::lock_guard lock(mutex);
            closing = true;
            abandoned = abandoned || abandon;
        }
        changed.notify_all();
        if (worker.joinable()) worker.join();
    }
};

VideoWriter::VideoWriter(const Target& file, const VideoOptions& options) {
    if (const auto found = problems(options, file.path.extension().string()); !found.empty()) {
        std::string text;
        for (const std::string& problem : found) text += (text.empty() ? "" : "\n") + problem;
        throw UnsupportedOption(text);
    }
    impl_ = std::make_unique<Impl>(file, options);
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::write(const render::Image& image) {
    if (!impl_->own) impl_->own = std::make_unique<VideoInput>(*this);
    render::DirtyTiles all(impl_->options.width, impl_->options.height);
    all.add_all();
    impl_->own->convert(image, all);
    impl_->own->send();
}

void VideoWriter::repeat() {
    Impl::Slot* last = impl_->last();
    if (last == nullptr) throw std::logic_error("VideoWriter: nothing to repeat");
    impl_->enqueue(*last, true);
}

VideoInput::VideoInput(VideoWriter& film) : film_(*film.impl_), slots_(film_.more_slots()) {}

void VideoInput::convert(const render::Image& image, const render::DirtyTiles& changed) {
    for (Slot* slot : slots_) slot->stale.add(changed);
    Slot& slot = film_.unused(slots_);
    film_.convert(image, slot);
    filled_ = &slot;
}

void VideoInput::send() {
    if (filled_ == nullptr) throw std::logic_error("VideoInput: nothing to send");
    film_.enqueue(*std::exchange(filled_, nullptr));
}

void VideoWriter::finish() {
    if (impl_->last() == nullptr) throw std::logic_error("VideoWriter: a film needs at least one picture");
    impl_->finish();
}

VideoStatistics VideoWriter::statistics() const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->cost;
}

long concatenate(const std::vector<std::filesystem::path>& segments, const Target& file) {
    AtomicFile target(file);
    const std::int64_t frames = video_library().concatenate(segments, target.temporary_path(), file.path,
                                                            container_of(file.path.extension().string()));
    target.commit();
    return static_cast<long>(frames);
}

}  // namespace beamcam::output
