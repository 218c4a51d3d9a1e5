// Compression of data that mostly repeat themselves, such as the rows of a drawing less the rows above: a zlib stream
// (RFC 1950) in deflate's format (RFC 1951) of literals and runs alone, a run being bytes equal to the one before or to
// the one a pixel before, in blocks with Huffman codes of their own. What repeats at other distances is not found.
// The stream depends on the calls and their data alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "output/image/bit_writer.hpp"

namespace beamcam::output {

class RunDeflate {
  public:
    // `pixel`: the size of a pixel, 2 … 4 bytes. Throws std::logic_error for others.
    explicit RunDeflate(std::size_t pixel);

    // Appends data. Runs are looked for within one call: rows should come whole.
    void bytes(std::span<const std::uint8_t> data);
    // Appends `count` zeros, of which nobody need keep a copy.
    void zeros(std::size_t count);
    // The whole stream; the object is used up.
    std::string finish() &&;

  private:
    void put_bytes(std::span<const std::uint8_t> data);
    void put_zeros();
    void put(std::size_t token);
    std::size_t put_run(std::size_t length, std::size_t distance);
    void end_block(bool last);

    std::size_t pixel_;  // [byte]
    std::uint32_t adler_ = 1;
    std::size_t zeros_ = 0;              // appended, not yet among the tokens
    std::vector<std::uint16_t> tokens_;  // the block at hand: literals, runs of equal bytes, runs of equal pixels
    std::size_t held_ = 0;               // of them
    BitWriter out_;
};

}  // namespace beamcam::output
