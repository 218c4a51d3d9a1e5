#include "output/video.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <numeric>
#include <optional>
#include <thread>
#include <utility>

#include "output/atomic_file.hpp"
#include "output/video_library.hpp"
#include "output/video_module.hpp"
#include "output/yuv.hpp"

namespace beamcam::output {

namespace {

// ---- options -----------------------------------------------------------------------------------

constexpr std::array kPresets = {"ultrafast", "superfast", "veryfast", "faster",   "fast",
                                 "medium",    "slow",      "slower",   "veryslow", "placebo"};
constexpr int kSmallestSide = 16, kLargestSide = 16384;  // x264's

std::string plain(double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
}

std::optional<std::string> size_problem(int width, int height) {
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    if (std::min(width, height) < kSmallestSide || std::max(width, height) > kLargestSide)
        return "a film of " + size + " pixels is not possible; both sides must be " + std::to_string(kSmallestSide) +
               " to " + std::to_string(kLargestSide);
    if (width % 2 != 0 || height % 2 != 0)
        return "a film of " + size +
               " pixels is not possible, because H.264 stores colour for pairs of rows and columns; use " +
               std::to_string(width + width % 2) + "x" + std::to_string(height + height % 2);
    return {};
}

std::optional<std::string> rate_problem(double fps) {
    if (fps >= 0.1 && fps <= 1000) return {};
    return plain(fps) + " frames per second is not possible; use 0.1 to 1000";
}

std::string presets_in_words() {
    std::string text;
    for (const char* preset : kPresets) text += (text.empty() ? "" : ", ") + std::string(preset);
    return text;
}

// ---- module ------------------------------------------------------------------------------------

const BeamcamVideoModule& load_module() {
    using Door = const BeamcamVideoModule* (*)();
    const BeamcamVideoModule* module = reinterpret_cast<Door>(video_library_symbol("beamcam_video_module"))();
    if (module->version != kBeamcamVideoModuleVersion)
        throw MissingCodec("the module beamcam_video.so belongs to another version of beamcam; install beamcam again");
    return *module;
}

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

}  // namespace

FrameRate frame_rate(double fps) {
    if (const auto problem = rate_problem(fps)) throw UnsupportedOption(*problem);
    // 23.976, 23.98, 29.97, 59.94 …: the decimals people write differ from n·1000/1001 by less than 0.005,
    // and no whole rate lies that near to one of them.
    for (int whole : {24, 30, 48, 60, 72, 90, 96, 100, 120, 144, 240})
        if (std::abs(fps - whole * 1000.0 / 1001) < 0.005) return {whole * 1000, 1001};
    FrameRate best{static_cast<int>(std::lround(fps)), 1};
    for (int base = 1; base <= 1000; ++base) {
        const FrameRate candidate{static_cast<int>(std::lround(fps * base)), base};
        if (std::abs(candidate.value() - fps) < std::abs(best.value() - fps) - 1e-12 * fps) best = candidate;
    }
    return best;
}

std::vector<std::string> problems(const VideoOptions& o) {
    std::vector<std::string> found;
    if (auto problem = size_problem(o.width, o.height)) found.push_back(*problem);
    if (auto problem = rate_problem(o.fps)) found.push_back(*problem);
    if (o.codec != "h264") found.push_back("the codec \"" + o.codec + "\" is not known; use \"h264\"");
    if (o.crf < 0 || o.crf > 51)
        found.push_back("crf " + std::to_string(o.crf) + " is not possible; use 0 (best) to 51, 18 looks lossless");
    if (std::find(kPresets.begin(), kPresets.end(), o.preset) == kPresets.end())
        found.push_back("the preset \"" + o.preset + "\" is not known; use one of " + presets_in_words());
    if (o.threads < 1 || o.threads > 4)
        found.push_back(std::to_string(o.threads) +
                        " encoder threads are not possible; use 1 to 4, beyond that the film depends on the number");
    return found;
}

// Pictures pass through a few frames that belong to the module. `write` fills one that is not in use and queues it;
// `worker` encodes the queue in order. The number of frames bounds how far drawing runs ahead.
struct VideoWriter::Impl {
    struct Slot {
        BeamcamVideoFrame* frame = nullptr;
        int uses = 0;  // places in the queue, and one for being the latest picture
    };

    AtomicFile file;
    VideoOptions options;
    const BeamcamVideoModule& module;
    BeamcamVideoSession* session = nullptr;
    Slot* latest = nullptr;  // filled by the last `write`; kept for `repeat`

    mutable std::mutex mutex;  // guards what follows
    std::condition_variable changed;
    std::array<Slot, 5> slots;
    std::deque<Slot*> queue;
    bool closing = false;    // nothing more will come
    bool abandoned = false;  // and what waits is dropped
    std::exception_ptr failure;
    VideoStatistics cost;
    std::thread worker;

    Impl(const std::filesystem::path& target, const VideoOptions& wanted)
        : file(target), options(wanted), module(load_module()) {
        open();
        worker = std::thread([this] { work(); });
    }

    ~Impl() {
        stop(true);
        if (session != nullptr) module.close(session);
    }

    void open() {
        std::vector<const char*> metadata;
        for (const auto& [key, value] : options.metadata) metadata.insert(metadata.end(), {key.c_str(), value.c_str()});
        metadata.push_back(nullptr);
        const FrameRate fps = frame_rate(options.fps);
        const std::string path = file.temporary_path().string();
        const BeamcamVideoSettings settings = {path.c_str(),   options.width, options.height,         fps.rate,
                                               fps.base,       options.crf,   options.preset.c_str(), options.threads,
                                               metadata.data()};
        BeamcamVideoError error = {};
        check(module.open(&settings, &session, &error), error);
        for (Slot& slot : slots) {
            slot.frame = module.make_frame(session);
            if (slot.frame != nullptr) continue;
            module.close(session);
            throw std::bad_alloc();
        }
    }

    // Throws what a status of the module means to the user.
    void check(BeamcamVideoStatus status, const BeamcamVideoError& error) const {
        switch (status) {
            case beamcam_video_ok:
                return;
            case beamcam_video_missing_codec:
                throw MissingCodec(error.text);
            case beamcam_video_write_failed:
                throw write_error(file.target(), error.error_number);
            case beamcam_video_failed:
                break;
        }
        throw std::runtime_error("the film " + file.target().string() + " failed: " + error.text);
    }

    void work() {
        std::unique_lock lock(mutex);
        for (;;) {
            changed.wait(lock, [this] { return closing || !queue.empty(); });
            if (abandoned || queue.empty()) return;
            Slot* slot = queue.front();
            lock.unlock();
            const Clock::time_point start = Clock::now();
            BeamcamVideoError error = {};
            const BeamcamVideoStatus status = module.encode(session, slot->frame, &error);
            const double spent = seconds_since(start);
            lock.lock();
            queue.pop_front();
            --slot->uses;
            cost.encode_seconds += spent;
            if (status == beamcam_video_ok)
                ++cost.frames;
            else
                give_up(status, error);
            changed.notify_all();
        }
    }

    // Leaves the reason where the next `write` or `finish` finds it, and ends `work`.
    void give_up(BeamcamVideoStatus status, const BeamcamVideoError& error) {
        closing = abandoned = true;
        try {
            check(status, error);
        } catch (...) {
            failure = std::current_exception();
        }
    }

    Slot* unused_slot() {
        const auto slot = std::find_if(slots.begin(), slots.end(), [](const Slot& s) { return s.uses == 0; });
        return slot == slots.end() ? nullptr : &*slot;
    }

    // Waits until `ready`, which runs under the lock. Throws what the encoder met.
    template <typename Ready>
    void wait_until(std::unique_lock<std::mutex>& lock, Ready ready) {
        const Clock::time_point start = Clock::now();
        changed.wait(lock, [&] { return failure || ready(); });
        cost.wait_seconds += seconds_since(start);
        if (failure) std::rethrow_exception(failure);
    }

    void fill(const render::Image& image) {
        {
            std::unique_lock lock(mutex);
            if (latest != nullptr) --std::exchange(latest, nullptr)->uses;
            wait_until(lock, [this] { return unused_slot() != nullptr; });
            latest = unused_slot();
            ++latest->uses;
        }
        const Clock::time_point start = Clock::now();
        YuvPlanes planes;
        for (std::size_t i = 0; i < 3; ++i) {
            planes.plane[i] = latest->frame->plane[i];
            planes.stride[i] = latest->frame->stride[i];
        }
        convert_to_yuv420(image, planes);
        const double spent = seconds_since(start);
        const std::lock_guard lock(mutex);
        cost.convert_seconds += spent;
    }

    void enqueue_latest() {
        std::unique_lock lock(mutex);
        wait_until(lock, [this] { return queue.size() < slots.size(); });
        queue.push_back(latest);
        ++latest->uses;
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

VideoWriter::VideoWriter(const std::filesystem::path& file, const VideoOptions& options) {
    if (const auto found = problems(options); !found.empty()) {
        std::string text;
        for (const std::string& problem : found) text += (text.empty() ? "" : "\n") + problem;
        throw UnsupportedOption(text);
    }
    impl_ = std::make_unique<Impl>(file, options);
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::write(const render::Image& image) {
    if (image.width != impl_->options.width || image.height != impl_->options.height)
        throw std::logic_error("VideoWriter: a picture of " + std::to_string(image.width) + "x" +
                               std::to_string(image.height) + " in a film of " + std::to_string(impl_->options.width) +
                               "x" + std::to_string(impl_->options.height));
    impl_->fill(image);
    impl_->enqueue_latest();
}

void VideoWriter::repeat() {
    if (impl_->latest == nullptr) throw std::logic_error("VideoWriter: nothing to repeat");
    impl_->enqueue_latest();
}

void VideoWriter::finish() {
    if (impl_->latest == nullptr) throw std::logic_error("VideoWriter: a film needs at least one picture");
    impl_->stop(false);
    if (impl_->failure) std::rethrow_exception(impl_->failure);
    const Clock::time_point start = Clock::now();
    BeamcamVideoError error = {};
    impl_->check(impl_->module.finish(impl_->session, &error), error);
    impl_->cost.encode_seconds += seconds_since(start);
    impl_->file.commit();
}

VideoStatistics VideoWriter::statistics() const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->cost;
}

}  // namespace beamcam::output
