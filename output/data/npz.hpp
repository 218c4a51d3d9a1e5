// NPZ archives for numpy: arrays of float64 by name, in a plain zip archive without compression.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "output/files/errors.hpp"
#include "output/files/target.hpp"

namespace beamcam::output {

struct NpzArray {
    std::string name;
    std::uint64_t rows = 0;
    // Hands the numbers on in pieces, in order; called twice: a checksum stands before them.
    std::function<void(const std::function<void(std::span<const double>)>& put)> numbers;
};

// Throws UnsupportedOption beyond 4 GiB; IoError.
void write_npz(const Target& file, const std::vector<NpzArray>& arrays);

}  // namespace beamcam::output
