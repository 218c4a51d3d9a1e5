// An open file or directory of the operating system. The functions continue after signals and partial transfers; where
// they fail, errno states the cause.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <string_view>
#include <utility>

namespace beamcam::output {

// The bytes of an array, vector or span of numbers.
template <class Numbers>
std::string_view bytes_of(const Numbers& values) {
    return {reinterpret_cast<const char*>(std::data(values)), std::size(values) * sizeof *std::data(values)};
}

class Descriptor {
  public:
    Descriptor() = default;
    explicit Descriptor(int number) : number_(number) {}
    // Opens a file with the flags of open(2); false if that fails.
    Descriptor(const std::filesystem::path& file, int flags);
    ~Descriptor() { close(); }
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }

    explicit operator bool() const { return number_ >= 0; }
    int number() const { return number_; }
    bool close();  // network file systems report a full disk only here

    bool write(std::string_view bytes);
    bool write_at(std::uint64_t at, std::string_view bytes);  // does not move `write`
    // Reads up to `size` bytes; fewer at the end of the file. −1: an error.
    std::ptrdiff_t read(void* to, std::size_t size);
    std::ptrdiff_t read_at(std::uint64_t at, void* to, std::size_t size) const;
    std::uint64_t size() const;  // [bytes]; 0 if it is unknown

    // An exclusive lock, until it is closed. False: another process has it, or the file system cannot lock.
    bool lock();      // waits for the other process
    bool try_lock();  // does not wait

  private:
    int number_ = -1;
};

}  // namespace beamcam::output
