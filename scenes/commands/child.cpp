#include "scenes/commands/child.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

namespace beamcam::scenes {
namespace {

constexpr char kReturned = '+', kThrown = '-';

// The answer of the child: one of the two characters above, then the text.
std::string answer_of(const std::function<std::string()>& work) {
    try {
        return kReturned + work();
    } catch (const std::exception& error) {
        return std::string(1, kThrown) + error.what();
    }
}

void write_all(int descriptor, const std::string& text) {
    for (std::size_t at = 0; at < text.size();) {
        const ssize_t written = ::write(descriptor, text.data() + at, text.size() - at);
        if (written < 0 && errno != EINTR) return;
        at += static_cast<std::size_t>(std::max<ssize_t>(written, 0));
    }
}

std::string read_all(int descriptor) {
    std::string text;
    std::array<char, 4096> block;
    for (;;) {
        const ssize_t got = ::read(descriptor, block.data(), block.size());
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return text;
        text.append(block.data(), static_cast<std::size_t>(got));
    }
}

}  // namespace

std::string in_child(const std::function<std::string()>& work) {
    int ends[2];
    if (pipe(ends) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
    const pid_t child = fork();
    if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
    if (child == 0) {
        close(ends[0]);
        write_all(ends[1], answer_of(work));
        _exit(0);
    }
    close(ends[1]);
    const std::string answer = read_all(ends[0]);
    close(ends[0]);
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
