// Numbered work on several threads, and a gate that lets its results through in order.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <stdexcept>

namespace beamcam::scenes {

// Threads pass one after the other, in the order of their numbers.
class Gate {
  public:
    struct Closed : std::runtime_error {
        Closed() : std::runtime_error("another thread failed") {}
    };

    // Waits until every number before has passed, then runs `action` alone. Throws Closed after `close`.
    void pass(long number, const std::function<void()>& action);
    void close();

  private:
    std::mutex mutex_;
    std::condition_variable changed_;
    long next_ = 0;
    bool closed_ = false;
};

// Threads to work with, of so many wanted; 0: one for each core.
int thread_count(int wanted);

// What one thread does with a number. Made in that thread, so that it may own what belongs to a thread.
using Worker = std::function<void(long)>;

// Calls workers for 0 … count−1, each once, on `threads` threads (the calling one for a single
// thread). The first exception closes the gate, ends the work and is thrown here.
void fan_out(long count, int threads, const std::function<Worker()>& make_worker, Gate& gate);

}  // namespace beamcam::scenes
