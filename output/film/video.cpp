#include "output/film/video.hpp"

#include <cmath>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "output/files/atomic_file.hpp"
#include "output/film/palette.hpp"
#include "output/film/pixel_layout.hpp"
#include "sim/base/clock.hpp"

namespace beamcam::output {

namespace {

constexpr double kLongestHold = 5;  // [s]

}  // namespace

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
    std::optional<PaletteTable> table;  // of a GIF
    std::unique_ptr<Encoder> encoder;   // used by the worker until `stop`, except to make frames

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

    Impl(const FileTarget& target, const VideoOptions& video_options) : file(target), options(video_options) {
        try {
            worker = std::thread([this] { work(); });
        } catch (const std::system_error&) {
            throw IoError("cannot write " + file.target().string() +
                          ": no thread can be started for the encoder; close some programs, or raise the limits of "
                          "processes and memory (ulimit -u, ulimit -v)");
        }
        try {
            open();
        } catch (...) {
            stop(true);
            throw;
        }
    }

    ~Impl() { stop(true); }

    void open() {
        if (options.variable_rate) longest_hold = std::lround(kLongestHold * options.fps.value());
        if (!options.palette.empty()) table.emplace(options.palette);
        try {
            encoder = video_library().open_encoder(options, file.temporary_path(), file.target());
        } catch (const CodecFailure& error) {  // for reasons that the limits do not contain
            throw UnsupportedOption(std::string("the encoder of ") + title(options.codec) + " rejects films of " +
                                    std::to_string(options.width) + "x" + std::to_string(options.height) +
                                    " pixels here (" + error.what() +
                                    "); choose a smaller size, or write frames (NAME-####.png)");
        }
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
            changed.wait(lock, [this] { return closing || !queue.empty(); });
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
        output::convert(image, encoder->layout(), table ? &*table : nullptr, *slot.frame, slot.stale);
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

VideoWriter::VideoWriter(const FileTarget& file, const VideoOptions& options)
    : impl_(std::make_unique<Impl>(file, options)) {}

VideoWriter::~VideoWriter() = default;

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

}  // namespace beamcam::output
