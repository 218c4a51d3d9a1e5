// A directory of a test's own, gone afterwards; and small pictures and tables to write into it.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "output/files/errors.hpp"
#include "output/image/raster.hpp"
#include "render/draw/dirty_tiles.hpp"
#include "render/draw/image.hpp"

namespace beamcam::output {

class Scratch {
  public:
    Scratch() {
        std::string name = (std::filesystem::temp_directory_path() / "beamcam-test-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no scratch directory");
        directory_ = name;
    }
    ~Scratch() {
        std::error_code error;
        std::filesystem::permissions(directory_, std::filesystem::perms::owner_all, error);
        std::filesystem::remove_all(directory_, error);
    }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return directory_ / name; }
    const std::filesystem::path& path() const { return directory_; }

    // Names of everything in it, hidden files too, sorted.
    std::vector<std::string> names() const {
        std::vector<std::string> found;
        for (const auto& entry : std::filesystem::directory_iterator(directory_))
            found.push_back(entry.path().filename().string());
        std::sort(found.begin(), found.end());
        return found;
    }

  private:
    std::filesystem::path directory_;
};

// Of this process.
inline std::ptrdiff_t open_files() {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator());
}

inline render::Image flat_image(int width, int height, std::uint32_t pixel) {
    render::Image image(width, height);
    std::fill(image.pixels.begin(), image.pixels.end(), pixel);
    return image;
}

// Every pixel differs from its neighbours; transparent by as many shares unless `opaque`.
inline render::Image pattern(int width, int height, bool opaque) {
    render::Image image(width, height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const std::uint32_t alpha = opaque ? 255 : static_cast<std::uint32_t>(i * 37 % 256);
        const auto channel = [&](std::size_t step) { return static_cast<std::uint32_t>(i * step % (alpha + 1)); };
        image.pixels[i] = alpha << 24 | channel(13) << 16 | channel(7) << 8 | channel(3);
    }
    return image;
}

inline render::DirtyTiles all_tiles(const render::Image& image) {
    render::DirtyTiles all(image.width, image.height);
    all.add_all();
    return all;
}

// The decoded pixels of a file with this image, and their digest.
inline Raster raster_of(const render::Image& image) {
    Raster raster;
    to_raster(image, raster);
    return raster;
}
inline std::string rgba_bytes(const render::Image& image) {
    const Raster raster = raster_of(image);
    return {raster.rgba.begin(), raster.rgba.end()};
}
inline std::string digest(const render::Image& image) { return digest(raster_of(image)); }

// What a shell command prints; fails the test when it exits with an error.
inline std::string output_of(const std::string& command) {
    std::string text;
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) throw std::runtime_error("cannot run " + command);
    std::array<char, 4096> buffer;
    for (std::size_t got = 0; (got = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
        text.append(buffer.data(), got);
    const int status = pclose(pipe);
    EXPECT_EQ(status, 0) << command << "\n" << text;
    return text;
}

inline std::string in_shell(const std::filesystem::path& path) { return "'" + path.string() + "'"; }

// The message of the IoError that `body` ends with.
template <typename Body>
std::string io_error_of(Body body) {
    try {
        body();
    } catch (const IoError& error) {
        return error.what();
    }
    ADD_FAILURE() << "no IoError";
    return {};
}

// What ffprobe says of the file.
inline std::string probe(const std::filesystem::path& file, const std::string& what) {
    return output_of("/usr/bin/ffprobe -v error " + what + " -of default=nw=1 " + file.string());
}

// Runs `body` in a child process and gives its exit code; 256 plus the signal that ended it.
template <typename Body>
int exit_code_of(Body body) {
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("cannot fork");
    if (child == 0) {
        int code = 99;
        try {
            code = body();
        } catch (...) {
        }
        _exit(code);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 256 + WTERMSIG(status);
}

}  // namespace beamcam::output
