// Bytes that would be too many to hold in memory: the first few are held, more of them stand in a file without a name,
// which is gone with the program however it ends. Where no such file can be made, or the disk is full, memory holds
// them after all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace beamcam::output {

class Spool {
  public:
    // `held`: that many are held in memory [bytes]. The file stands in $TMPDIR, else /var/tmp, else /tmp.
    explicit Spool(std::size_t held = 1 << 18) : held_(held) {}
    ~Spool();
    Spool(const Spool&) = delete;
    Spool& operator=(const Spool&) = delete;

    // One thread at a time.
    void write(std::uint64_t at, std::span<const std::byte> bytes);
    // Bytes that were never written are zero. By any number of threads while nobody writes. Throws IoError.
    void read(std::uint64_t at, std::span<std::byte> into) const;

    std::uint64_t size() const { return size_; }
    bool on_disk() const { return descriptor_ >= 0; }

  private:
    bool write_to_file(std::uint64_t at, std::span<const std::byte> bytes);
    void take_back();

    std::size_t held_;
    std::vector<std::byte> memory_;  // all of them, when there is no file
    std::uint64_t size_ = 0;
    int descriptor_ = -1;
    bool no_file_ = false;  // it was tried
};

}  // namespace beamcam::output
