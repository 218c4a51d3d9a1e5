#include "output/files/owner.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>

#include "output/files/atomic_file.hpp"
#include "output/files/descriptor.hpp"
#include "output/files/digest.hpp"

namespace beamcam::output {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDigits = 32;

// Empty if the environment names no folder.
fs::path state_folder() {
    const char *state = std::getenv("XDG_STATE_HOME"), *home = std::getenv("HOME");
    if (state && *state == '/') return fs::path(state) / "beamcam";
    if (home && *home == '/') return fs::path(home) / ".local/state/beamcam";
    return {};
}

// Empty if the file does not exist or is damaged.
std::string read_secret(const fs::path& file) {
    Descriptor opened(file, O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
    std::array<char, kDigits> digits{};
    if (!opened || opened.read(digits.data(), kDigits) != static_cast<std::ptrdiff_t>(kDigits)) return {};
    const std::string secret(digits.begin(), digits.end());
    return secret.find_first_not_of("0123456789abcdef") == std::string::npos ? secret : "";
}

// Two first runs at once get the same secret: the file appears whole, and only once.
void create_secret(const fs::path& file) {
    std::error_code failed;
    fs::create_directories(file.parent_path(), failed);
    const fs::path temporary = fmt::format("{}.{}", file.string(), random_digits());
    Descriptor created(open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
    std::string secret;
    while (secret.size() < kDigits) secret += random_digits();
    if (created && created.write(secret)) fs::create_hard_link(temporary, file, failed);
    unlink(temporary.c_str());
}

std::string secret_of_user() {
    const fs::path folder = state_folder();
    if (folder.empty()) return {};
    const fs::path file = folder / "owner";
    if (std::string secret = read_secret(file); !secret.empty()) return secret;
    create_secret(file);
    return read_secret(file);
}

}  // namespace

std::string owner_mark(const std::string& name, const std::string& sha256_of_file) {
    static const std::string secret = secret_of_user();
    return secret.empty() ? "" : sha256(fmt::format("{}\n{}\n{}", secret, sha256_of_file, name)).substr(0, kDigits);
}

}  // namespace beamcam::output
