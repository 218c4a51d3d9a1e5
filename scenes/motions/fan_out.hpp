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

// How many threads work: `first` from the beginning, and one more, up to `most`, whenever `more` says that it helps.
// Threads ask that after each number, several at once.
struct Crew {
    int first = 1, most = 1;
    std::function<bool()> more = {};
};

// Calls workers for 0 … count−1, each once; the calling thread is the first of the crew. The first exception closes the
// gate, ends the work and is thrown here. Returns how many threads worked.
int fan_out(long count, const Crew& crew, const std::function<Worker()>& make_worker, Gate& gate);
inline void fan_out(long count, int threads, const std::function<Worker()>& make_worker, Gate& gate) {
    fan_out(count, Crew{threads, threads}, make_worker, gate);
}

}  // namespace beamcam::scenes
