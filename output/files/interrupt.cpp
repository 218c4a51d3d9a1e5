#include "output/files/interrupt.hpp"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

#include "render/base/limits.hpp"

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

constexpr std::string_view kLibraryEnded =
    "beamcam: a library ended the program; perhaps there was not enough memory or no thread could be started: choose a "
    "smaller size, fewer threads (-j 1), or raise the limits (ulimit -v, ulimit -u)\n";
int exit_code_of_crash = 0;
std::atomic<pid_t> crashed_thread{0};
alignas(16) std::array<std::byte, 64 * 1024> handler_stack;

// Removes the temporary files of this process and ends it. Safe in signal handlers.
[[noreturn]] void end(int exit_code, std::string_view message = {}) {
    for (Slot& slot : slots)
        if (slot.state.load() == slot_used) unlink(slot.path.data());
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, message.data(), message.size());
    _exit(exit_code);
}

void handle(int signal_number, void (*handler)(int), unsigned flags) {
    struct sigaction action = {};
    action.sa_handler = handler;
    sigemptyset(&action.sa_mask);
    action.sa_flags = static_cast<int>(flags);
    sigaction(signal_number, &action, nullptr);
}

extern "C" void on_signal(int) {
    if (signals_seen.fetch_add(1) > 0) end(130);
}

// Several threads may crash at once: the first one ends the program, and the others wait.
extern "C" void on_crash(int) {
    pid_t first = 0;
    const pid_t self = gettid();
    if (crashed_thread.compare_exchange_strong(first, self)) end(exit_code_of_crash, kLibraryEnded);
    if (first == self) _exit(exit_code_of_crash);  // the handler crashed itself
    while (true) pause();
}

bool is_ignored(int signal_number) {
    struct sigaction now = {};
    sigaction(signal_number, nullptr, &now);
    return now.sa_handler == SIG_IGN;
}

}  // namespace

void install_handlers() {
    for (const int signal_number : {SIGINT, SIGTERM, SIGHUP})
        if (!is_ignored(signal_number)) handle(signal_number, on_signal, SA_RESTART);
    for (const int signal_number : {SIGPIPE, SIGXFSZ}) handle(signal_number, SIG_IGN, SA_RESTART);
}

void install_crash_handlers(int exit_code) {
    exit_code_of_crash = exit_code;
    const stack_t stack = {handler_stack.data(), 0, handler_stack.size()};
    sigaltstack(&stack, nullptr);
    handle(SIGTRAP, on_crash, SA_ONSTACK);  // raised by GLib
    if (!render::memory_limit()) return;
    for (const int signal_number : {SIGABRT, SIGSEGV, SIGBUS, SIGILL}) handle(signal_number, on_crash, SA_ONSTACK);
}

void end_silently(int exit_code) { end(exit_code); }

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
