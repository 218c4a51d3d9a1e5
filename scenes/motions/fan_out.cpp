#include "scenes/motions/fan_out.hpp"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "scenes/motions/progress.hpp"

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

int thread_count(int requested) {
    return requested > 0 ? requested : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

int fan_out(long count, const Crew& crew, const std::function<Worker()>& make_worker, Gate& gate) {
    std::atomic<long> next{0};
    std::mutex failure_mutex;
    std::exception_ptr failure;
    const int most = static_cast<int>(std::clamp<long>(crew.most, 1, std::max<long>(count, 1)));
    std::mutex others_mutex;
    std::vector<std::thread> others;  // to join
    std::atomic<int> working{1};
    std::function<void()> work;

    const auto start_another = [&] {
        const std::lock_guard lock(others_mutex);
        if (working >= most) return;
        try {
            others.emplace_back(work);
            ++working;
        } catch (const std::system_error&) {
            // fewer threads do the same work
        }
    };
    work = [&] {
        try {
            const Worker worker = make_worker();
            for (long k = next++; k < count; k = next++) {
                stop_if_interrupted();
                worker(k);
                if (crew.more && working < most && next < count && crew.more()) start_another();
            }
        } catch (const Gate::Closed&) {
            // the thread that closed it reports the reason
        } catch (...) {
            const std::lock_guard lock(failure_mutex);
            if (!failure) failure = std::current_exception();
            next = count;
            gate.close();
        }
    };

    for (int i = 1; i < std::min(crew.first, most); ++i) start_another();
    work();
    for (;;) {  // a running thread may start another one
        std::thread thread;
        {
            const std::lock_guard lock(others_mutex);
            if (others.empty()) break;
            thread = std::move(others.back());
            others.pop_back();
        }
        thread.join();
    }
    if (failure) std::rethrow_exception(failure);
    return working;
}

void fan_out(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
    Gate unused;
    const int all = thread_count(threads);
    const Worker worker = [&](long k) { work(static_cast<std::size_t>(k)); };
    fan_out(
        static_cast<long>(count), {all, all}, [&] { return worker; }, unused);
}

}  // namespace beamcam::scenes
