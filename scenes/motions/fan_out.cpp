#include "scenes/motions/fan_out.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

#include "scenes/motions/progress.hpp"

namespace beamcam::scenes {

void OrderedGate::pass(long number, const std::function<void()>& action) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return closed_ || next_ == number; });
    if (closed_) throw Closed();
    action();
    ++next_;
    changed_.notify_all();
}

void OrderedGate::close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
}

int thread_count(int requested) {
    return requested > 0 ? requested : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

int fan_out(long count, int threads, const std::function<Worker()>& make_worker, OrderedGate& gate) {
    std::atomic<long> next{0};
    std::mutex mutex;  // guards the failure
    std::exception_ptr failure;
    const auto work = [&] {
        try {
            const Worker worker = make_worker();
            for (long k = next++; k < count; k = next++) {
                stop_if_interrupted();
                worker(k);
            }
        } catch (const OrderedGate::Closed&) {
            // the thread that closed it reports the reason
        } catch (...) {
            const std::lock_guard lock(mutex);
            if (!failure) failure = std::current_exception();
            next = count;
            gate.close();
        }
    };
    std::vector<std::thread> others;
    others.reserve(static_cast<std::size_t>(threads));
    try {
        for (long i = 1; i < std::min<long>(threads, count); ++i) others.emplace_back(work);
    } catch (const std::system_error&) {
        // fewer threads do the same work
    }
    work();
    for (std::thread& other : others) other.join();
    if (failure) std::rethrow_exception(failure);
    return static_cast<int>(others.size()) + 1;
}

void fan_out(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
    OrderedGate unused;
    const auto make_worker = [&] { return [&](long k) { work(static_cast<std::size_t>(k)); }; };
    fan_out(static_cast<long>(count), thread_count(threads), make_worker, unused);
}

}  // namespace beamcam::scenes
