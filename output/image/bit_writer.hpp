// Bits one after the other into bytes, the lowest bit of a byte first, as deflate packs them (RFC 1951, section 3.1.1).
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <utility>

namespace beamcam::output {

// The lowest `count` bits of `bits`, at most 56; those above are 0.
struct BitWord {
    std::uint64_t bits = 0;
    unsigned count = 0;
};

class BitWriter {
  public:
    // The word of each token, `bits` in all.
    void put(std::span<const std::uint16_t> tokens, std::span<const BitWord> words, std::size_t bits) {
        static_assert(std::endian::native == std::endian::little, "words are stored whole, lowest byte first");
        bytes_.resize(size_ + bits / 8 + 2 * sizeof begun_);
        char* to = bytes_.data() + size_;
        std::uint64_t begun = begun_;  // copies: for all that compilers know, `to` points to the members
        unsigned count = begun_count_;
        for (const std::uint16_t token : tokens) {
            const BitWord word = words[token];
            begun |= word.bits << count;
            count += word.count;
            std::memcpy(to, &begun, sizeof begun);
            to += count / 8;
            begun >>= count / 8 * 8;
            count %= 8;
        }
        size_ = static_cast<std::size_t>(to - bytes_.data());
        begun_ = begun;
        begun_count_ = count;
    }

    void put(std::uint64_t bits, unsigned count) {
        const std::uint16_t token = 0;
        const BitWord word{bits, count};
        put({&token, 1}, {&word, 1}, count);
    }

    // Fills the byte begun with zeros.
    void align() { put(0, (8 - begun_count_) % 8); }

    // The whole bytes written; the writer is used up.
    std::string finish() && {
        bytes_.resize(size_);
        return std::move(bytes_);
    }

  private:
    std::string bytes_;         // longer than what is written
    std::size_t size_ = 0;      // whole bytes written
    std::uint64_t begun_ = 0;   // the byte begun
    unsigned begun_count_ = 0;  // [bit] of it, 0 … 7
};

}  // namespace beamcam::output
