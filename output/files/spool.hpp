// A byte buffer that moves from memory to an unnamed temporary file when it grows large. The file disappears when the
// program ends, however it ends. If no such file can be created, or the disk is full, the bytes stay in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "output/files/descriptor.hpp"

namespace beamcam::output {

class Spool {
  public:
    // `limit`: largest size in memory [bytes]. The file is in $TMPDIR, else /var/tmp, else /tmp.
    explicit Spool(std::size_t limit = 1 << 18) : limit_(limit) {}

    // One thread at a time.
    void write(std::uint64_t at, std::span<const std::byte> bytes);
    // Bytes that were never written are zero. From any number of threads while none writes. Throws IoError.
    void read(std::uint64_t at, std::span<std::byte> into) const;

  private:
    void move_to_file();
    void read_back();

    std::size_t limit_;
    std::vector<std::byte> memory_;  // all bytes, if there is no file
    std::uint64_t size_ = 0;
    Descriptor file_;
    bool no_file_ = false;  // a file could not be created
};

}  // namespace beamcam::output
