// NPZ archives for numpy: arrays of float64 by name, in a plain zip archive without compression.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "output/files/atomic_file.hpp"

namespace beamcam::output {

struct NpzArray {
    std::string name;
    std::uint64_t rows = 0;
};

// An archive whose arrays can be filled in any order: each has its place from the start.
class NpzFile {
  public:
    // Throws UnsupportedOption above 4 GiB, IoError.
    NpzFile(const FileTarget& file, const std::vector<NpzArray>& arrays);
    // Adds the next numbers of an array. Throws IoError.
    void append(std::size_t array, std::span<const double> numbers);
    // To be called once, after all numbers. Throws IoError.
    void commit();

  private:
    struct Member {
        std::string name, header;
        std::uint64_t size = 0, offset = 0,
                      written = 0;  // [bytes]: header and numbers; place of its record; numbers so far
        std::uint32_t crc = 0;
        std::vector<double> buffer;  // not written yet
    };
    static std::string common_record(const Member& member);
    void flush(Member& member);

    AtomicFile atomic_;
    std::vector<Member> members_;
};

}  // namespace beamcam::output
