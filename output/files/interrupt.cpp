#include "output/files/interrupt.hpp"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>
#include <string>

namespace beamcam::output {

namespace {

constexpr std::size_t kLongestPath = 4096;  // PATH_MAX of Linux
enum SlotState : int { slot_free, slot_changing, slot_used };

struct Slot {
    std::atomic<int> state{slot_free};
    std::array<char, kLongestPath> path{};
};

// Signal handlers can access only globals; all accesses to these are atomic.
std::array<Slot, 64> slots;
std::atomic<int> signals_seen{0};
static_assert(std::atomic<int>::is_always_lock_free);

extern "C" void on_signal(int) {
    if (signals_seen.fetch_add(1) == 0) return;
    unlink_temporaries();
    _exit(130);
}

void handle(int signal_number, void (*handler)(int)) {
    struct sigaction now = {};
    sigaction(signal_number, nullptr, &now);
    if (now.sa_handler == SIG_IGN) return;
    struct sigaction action = {};
    action.sa_handler = handler;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    sigaction(signal_number, &action, nullptr);
}

}  // namespace

void unlink_temporaries() noexcept {
    for (Slot& slot : slots)
        if (slot.state.load() == slot_used) unlink(slot.path.data());
}

void install_handlers() {
    for (int signal_number : {SIGINT, SIGTERM, SIGHUP}) handle(signal_number, on_signal);
    for (int signal_number : {SIGPIPE, SIGXFSZ}) handle(signal_number, SIG_IGN);
}

bool interrupted() { return signals_seen.load(std::memory_order_relaxed) > 0; }

TemporaryName::TemporaryName(const std::filesystem::path& absolute) {
    const std::string name = absolute.string();
    if (name.size() >= kLongestPath) return;
    for (std::size_t i = 0; i < slots.size(); ++i) {
        int expected = slot_free;
        if (!slots[i].state.compare_exchange_strong(expected, slot_changing)) continue;
        std::memcpy(slots[i].path.data(), name.c_str(), name.size() + 1);
        slots[i].state.store(slot_used);
        slot_ = static_cast<int>(i);
        return;
    }
}

TemporaryName::~TemporaryName() {
    if (slot_ >= 0) slots[static_cast<std::size_t>(slot_)].state.store(slot_free);
}

}  // namespace beamcam::output
