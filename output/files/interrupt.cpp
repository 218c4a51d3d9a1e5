#include "output/files/interrupt.hpp"

#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <initializer_list>
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

constexpr std::string_view kNoMemory =
    "beamcam: a library ended; perhaps there was not enough memory: choose a smaller size, fewer threads (-j 1), or "
    "raise "
    "the limit (ulimit -v)\n";
constexpr std::string_view kNoThread = "beamcam: a library ended because no thread can be started; ";
int exit_code_of_crash = 0;
std::atomic<pid_t> crashed_thread{0};
alignas(16) std::array<std::byte, 64 * 1024> handler_stack;

// Removes the temporary files of this process and ends it. Safe in signal handlers.
[[noreturn]] void end(int exit_code, std::initializer_list<std::string_view> message = {}) {
    for (Slot& slot : slots)
        if (slot.state.load() == slot_used) unlink(slot.path.data());
    for (const std::string_view part : message)
        [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, part.data(), part.size());
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
extern "C" void on_crash(int signal_number) {
    pid_t first = 0;
    const pid_t self = gettid();
    if (crashed_thread.compare_exchange_strong(first, self)) {
        if (render::memory_was_short()) end(exit_code_of_crash, {kNoMemory});
        if ((signal_number == SIGTRAP || signal_number == SIGABRT) && render::threads_are_short())
            end(exit_code_of_crash, {kNoThread, render::kThreadRemedy, "\n"});
    } else if (first != self) {
        while (true) pause();
    }
    handle(signal_number, SIG_DFL, 0);
    raise(signal_number);
}

bool is_ignored(int signal_number) {
    struct sigaction now = {};
    sigaction(signal_number, nullptr, &now);
    return now.sa_handler == SIG_IGN;
}

bool memory_is_limited() {
    rlimit space = {}, data = {};
    const bool known = getrlimit(RLIMIT_AS, &space) == 0 && getrlimit(RLIMIT_DATA, &data) == 0;
    return known && (space.rlim_cur != RLIM_INFINITY || data.rlim_cur != RLIM_INFINITY);
}

}  // namespace

void install_handlers() {
    for (const int signal_number : {SIGINT, SIGTERM, SIGHUP})
        if (!is_ignored(signal_number)) handle(signal_number, on_signal, SA_RESTART);
    for (const int signal_number : {SIGPIPE, SIGXFSZ}) handle(signal_number, SIG_IGN, SA_RESTART);
}

void install_crash_handlers(int exit_code) {
    exit_code_of_crash = exit_code;
    render::watch_threads_of_glib();
    const stack_t stack = {handler_stack.data(), 0, handler_stack.size()};
    sigaltstack(&stack, nullptr);
    constexpr unsigned kFlags = SA_ONSTACK | SA_NODEFER;
    for (const int signal_number : {SIGTRAP, SIGABRT}) handle(signal_number, on_crash, kFlags);  // raised by libraries
    if (!memory_is_limited()) return;
    for (const int signal_number : {SIGSEGV, SIGBUS, SIGILL}) handle(signal_number, on_crash, kFlags);
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
