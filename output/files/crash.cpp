#include "output/files/crash.hpp"

#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <initializer_list>
#include <string_view>

#include "output/files/interrupt.hpp"
#include "render/base/limits.hpp"

namespace beamcam::output {
namespace {

constexpr std::string_view kNoMemory =
    "beamcam: not enough memory: a library ended because an allocation failed; choose a smaller size, fewer threads "
    "(-j 1), or raise the limit (ulimit -v)\n";
constexpr std::string_view kNoThread = "beamcam: a library ended because no thread can be started; ";
int exit_code_of_crash = 0;
alignas(16) std::array<std::byte, 64 * 1024> handler_stack;

[[noreturn]] void end(std::initializer_list<std::string_view> message) {
    unlink_temporaries();
    for (const std::string_view part : message)
        [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, part.data(), part.size());
    _exit(exit_code_of_crash);
}

extern "C" void on_crash(int signal_number) {
    if (render::memory_is_short()) end({kNoMemory});
    if ((signal_number == SIGTRAP || signal_number == SIGABRT) && render::threads_are_short())
        end({kNoThread, render::kThreadRemedy, "\n"});
    raise(signal_number);  // with the default action: SA_RESETHAND
}

void handle(int signal_number) {
    struct sigaction action = {};
    action.sa_handler = on_crash;
    sigemptyset(&action.sa_mask);
    action.sa_flags = static_cast<int>(SA_ONSTACK | SA_NODEFER | SA_RESETHAND);
    sigaction(signal_number, &action, nullptr);
}

bool memory_is_limited() {
    rlimit space = {}, data = {};
    const bool known = getrlimit(RLIMIT_AS, &space) == 0 && getrlimit(RLIMIT_DATA, &data) == 0;
    return known && (space.rlim_cur != RLIM_INFINITY || data.rlim_cur != RLIM_INFINITY);
}

}  // namespace

void install_crash_handlers(int exit_code) {
    exit_code_of_crash = exit_code;
    render::watch_threads_of_glib();
    const stack_t stack = {handler_stack.data(), 0, handler_stack.size()};
    sigaltstack(&stack, nullptr);
    for (const int signal_number : {SIGTRAP, SIGABRT}) handle(signal_number);  // raised by libraries
    if (!memory_is_limited()) return;
    for (const int signal_number : {SIGSEGV, SIGBUS, SIGILL}) handle(signal_number);
}

}  // namespace beamcam::output
