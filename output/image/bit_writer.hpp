// Packs bits into bytes, the lowest bit first, as deflate does (RFC 1951, section 3.1.1).
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
    // Writes the word of each token, `bits` bits in total.
    void put(std::span<const std::uint16_t> tokens, std::span<const BitWord> words, std::size_t bits) {
        static_assert(std::endian::native == std::endian::little, "words are stored whole, lowest byte first");
        bytes_.resize(size_ + bits / 8 + 2 * sizeof begun_);
        char* to = bytes_.data() + size_;
        std::uint64_t begun = begun_;  // local copies: compilers assume that `to` may point to the members
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

    // Fills the last byte with zeros.
    void align() { put(0, (8 - begun_count_) % 8); }

    // Returns the written bytes; at most once.
    std::string finish() && {
        bytes_.resize(size_);
        return std::move(bytes_);
    }

  private:
    std::string bytes_;         // longer than the written part
    std::size_t size_ = 0;      // complete bytes
    std::uint64_t begun_ = 0;   // the incomplete byte
    unsigned begun_count_ = 0;  // its bits, 0 … 7
};

}  // namespace beamcam::output
