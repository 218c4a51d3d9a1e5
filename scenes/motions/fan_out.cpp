#include "scenes/motions/fan_out.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <system_error>
#include <thread>
#include <utility>
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

namespace {

// The threads of one fan_out.
class Threads {
  public:
    Threads(long count, const ThreadCounts& counts, const std::function<Worker()>& make_worker, OrderedGate& gate)
        : count_(count),
          most_(static_cast<int>(std::clamp<long>(counts.most, 1, std::max<long>(count, 1)))),
          counts_(counts),
          make_worker_(make_worker),
          gate_(gate) {}

    int run() {
        for (int i = 1; i < std::min(counts_.first, most_); ++i) start_another();
        work();
        join();
        if (failure_) std::rethrow_exception(failure_);
        return working_;
    }

  private:
    void start_another() {
        const std::lock_guard lock(mutex_);
        if (working_ >= most_) return;
        try {
            others_.emplace_back([this] { work(); });
            ++working_;
        } catch (const std::system_error&) {
            // fewer threads do the same work
        }
    }

    void work() {
        try {
            const Worker worker = make_worker_();
            for (long k = next_++; k < count_; k = next_++) {
                stop_if_interrupted();
                worker(k);
                if (counts_.more && working_ < most_ && next_ < count_ && counts_.more()) start_another();
            }
        } catch (const OrderedGate::Closed&) {
            // the thread that closed it reports the reason
        } catch (...) {
            const std::lock_guard lock(mutex_);
            if (!failure_) failure_ = std::current_exception();
            next_ = count_;
            gate_.close();
        }
    }

    void join() {
        for (;;) {  // a running thread may start another one
            std::thread thread;
            {
                const std::lock_guard lock(mutex_);
                if (others_.empty()) return;
                thread = std::move(others_.back());
                others_.pop_back();
            }
            thread.join();
        }
    }

    const long count_;
    const int most_;
    const ThreadCounts& counts_;
    const std::function<Worker()>& make_worker_;
    OrderedGate& gate_;
    std::atomic<long> next_{0};
    std::atomic<int> working_{1};
    std::mutex mutex_;  // of the next two
    std::vector<std::thread> others_;
    std::exception_ptr failure_;
};

}  // namespace

int fan_out(long count, const ThreadCounts& counts, const std::function<Worker()>& make_worker, OrderedGate& gate) {
    return Threads(count, counts, make_worker, gate).run();
}

void fan_out(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
    OrderedGate unused;
    const int all = thread_count(threads);
    const auto make_worker = [&] { return [&](long k) { work(static_cast<std::size_t>(k)); }; };
    fan_out(static_cast<long>(count), {all, all}, make_worker, unused);
}

}  // namespace beamcam::scenes
