#include "output/files/out_of_memory.hpp"

#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstring>

#include "output/files/interrupt.hpp"
#include "render/base/memory.hpp"

namespace beamcam::output {
namespace {

constexpr char kWords[] =
    "beamcam: not enough memory: a library ended because an allocation failed; choose a smaller size, fewer threads "
    "(-j 1), or raise the limit (ulimit -v)\n";
int exit_code_of_crash = 0;
alignas(16) std::array<std::byte, 64 * 1024> handler_stack;

extern "C" void on_crash(int signal_number) {
    if (render::memory_is_short()) {
        unlink_temporaries();
        [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kWords, sizeof kWords - 1);
        _exit(exit_code_of_crash);
    }
    raise(signal_number);  // handled as if there were no handler: SA_RESETHAND
}

}  // namespace

void install_memory_handlers(int exit_code) {
    rlimit space = {}, data = {};
    const bool known = getrlimit(RLIMIT_AS, &space) == 0 && getrlimit(RLIMIT_DATA, &data) == 0;
    if (!known || (space.rlim_cur == RLIM_INFINITY && data.rlim_cur == RLIM_INFINITY)) return;
    exit_code_of_crash = exit_code;
    const stack_t stack = {handler_stack.data(), 0, handler_stack.size()};
    sigaltstack(&stack, nullptr);
    for (const int signal_number : {SIGSEGV, SIGBUS, SIGTRAP, SIGABRT, SIGILL}) {
        struct sigaction wanted = {};
        wanted.sa_handler = on_crash;
        sigemptyset(&wanted.sa_mask);
        wanted.sa_flags = static_cast<int>(SA_ONSTACK | SA_NODEFER | SA_RESETHAND);
        sigaction(signal_number, &wanted, nullptr);
    }
}

}  // namespace beamcam::output
