// Prefix codes of least total length among those with a bound on the word length: package-merge, Larmore and
// Hirschberg, "A fast algorithm for optimal length-limited Huffman codes", J. ACM 37 (1990). The words are the
// canonical ones of RFC 1951, section 3.2.2. Symbols of equal weight keep their order, so that the code
// of a histogram is unique.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace beamcam::output {

struct HuffmanCode {
    std::vector<std::uint8_t> lengths;  // [bit] of each symbol's word; 0: unused symbol
    std::vector<std::uint16_t> words;   // the lowest bit is written first
};

// Code for symbols that occur `weights` times; no word is longer than `longest` ≤ 15 bits. The code is complete:
// symbols of weight 0 have words only where fewer than two occur. Throws std::logic_error for fewer than two symbols or
// more than 2^longest.
HuffmanCode huffman_code(std::span<const std::uint32_t> weights, int longest);

}  // namespace beamcam::output
