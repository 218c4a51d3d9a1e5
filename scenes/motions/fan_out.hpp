// Numbered tasks on several threads, and a gate that passes their results in order.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stdexcept>

namespace beamcam::scenes {

// Lets threads pass in the order of their numbers.
class OrderedGate {
  public:
    struct Closed : std::runtime_error {
        Closed() : std::runtime_error("another thread failed") {}
    };

    // Waits until all smaller numbers have passed, then runs `action` exclusively. Throws Closed after `close`.
    void pass(long number, const std::function<void()>& action);
    void close();

  private:
    std::mutex mutex_;
    std::condition_variable changed_;
    long next_ = 0;
    bool closed_ = false;
};

// Number of threads; 0 means one for each core.
int thread_count(int requested);

// Executes one task. Created in its thread, so that it can own data of the thread.
using Worker = std::function<void(long)>;

// Executes the tasks 0 … count−1 on at most this number of threads; the calling thread is the first one. The first
// exception, also that of an interruption, closes the gate, ends the work and is rethrown here. Returns the number of
// threads.
int fan_out(long count, int threads, const std::function<Worker()>& make_worker, OrderedGate& gate);
// All threads share one worker; 0 means one thread for each core.
void fan_out(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

}  // namespace beamcam::scenes
