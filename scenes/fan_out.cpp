#include "scenes/fan_out.hpp"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace beamcam::scenes {

void Gate::pass(long number, const std::function<void()>& action) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return closed_ || next_ == number; });
    if (closed_) throw Closed();
    action();
    ++next_;
    changed_.notify_all();
}

void Gate::close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
}

int thread_count(int wanted) {
    return wanted > 0 ? wanted : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

void fan_out(long count, int threads, const std::function<Worker()>& make_worker, Gate& gate) {
    std::atomic<long> next{0};
    std::mutex failure_mutex;
    std::exception_ptr failure;

    auto work = [&] {
        try {
            const Worker worker = make_worker();
            for (long k = next++; k < count; k = next++) worker(k);
        } catch (const Gate::Closed&) {
            // the thread that closed it tells why
        } catch (...) {
            const std::lock_guard lock(failure_mutex);
            if (!failure) failure = std::current_exception();
            next = count;
            gate.close();
        }
    };

    const long useful = std::clamp<long>(threads, 1, std::max<long>(count, 1));
    std::vector<std::thread> others;
    try {
        for (long i = 1; i < useful; ++i) others.emplace_back(work);
    } catch (const std::system_error&) {
        // fewer threads than asked for do the same work
    }
    work();
    for (std::thread& thread : others) thread.join();
    if (failure) std::rethrow_exception(failure);
}

}  // namespace beamcam::scenes
