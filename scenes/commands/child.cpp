#include "scenes/commands/child.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "output/files/descriptor.hpp"

namespace beamcam::scenes {
namespace {

constexpr char kReturned = '+', kThrown = '-';
constexpr std::size_t kLongestAnswer = 1 << 16;  // [bytes]: many times the list of all encoders

// The answer of the child: one of the two characters above, then the text.
std::string answer_of(const std::function<std::string()>& work) {
    try {
        return kReturned + work();
    } catch (const std::exception& error) {
        return std::string(1, kThrown) + error.what();
    }
}

}  // namespace

std::string in_child(const std::function<std::string()>& work) {
    int ends[2];
    if (pipe(ends) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
    output::Descriptor from(ends[0]), to(ends[1]);
    const pid_t child = fork();
    if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
    if (child == 0) {
        to.write(answer_of(work));
        _exit(0);
    }
    to.close();
    std::string answer(kLongestAnswer, '\0');
    answer.resize(static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, from.read(answer.data(), answer.size()))));
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFSIGNALED(status))
        throw std::runtime_error(fmt::format("the library ended with {}", strsignal(WTERMSIG(status))));
    if (answer.empty()) throw std::runtime_error(fmt::format("the library ended with exit {}", WEXITSTATUS(status)));
    if (answer.front() != kReturned) throw std::runtime_error(answer.substr(1));
    return answer.substr(1);
}

}  // namespace beamcam::scenes
