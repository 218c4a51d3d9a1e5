#include "output/sha256.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <vector>

#include "output/errors.hpp"

namespace beamcam::output {

namespace {

// FIPS 180-4 §4.2.2: the first 32 bits of the fractional parts of the cube roots of the first 64 primes. They are
// computed here rather than listed: ⌊∛p · 2³²⌋ is the largest r with r³ ≤ p · 2⁹⁶, found bit by bit in exact integers.
__extension__ using Wide = unsigned __int128;

constexpr bool cube_is_at_most(std::uint64_t r, std::uint32_t p) {
    // r < 2³⁵, so r² < 2⁷⁰ and r³ < 2¹⁰⁵ fit.
    return Wide(r) * r * r <= (Wide(p) << 96);
}

constexpr std::array<std::uint32_t, 64> round_constants() {
    std::array<std::uint32_t, 64> k{};
    std::size_t count = 0;
    for (std::uint32_t p = 2; count < k.size(); ++p) {
        bool prime = true;
        for (std::uint32_t d = 2; d * d <= p; ++d) prime = prime && p % d != 0;
        if (!prime) continue;
        std::uint64_t root = 0;
        for (int bit = 34; bit >= 0; --bit) {
            const std::uint64_t candidate = root | (std::uint64_t(1) << bit);
            if (cube_is_at_most(candidate, p)) root = candidate;
        }
        k[count++] = static_cast<std::uint32_t>(root);
    }
    return k;
}

constexpr std::array<std::uint32_t, 64> kRound = round_constants();
static_assert(kRound[0] == 0x428a2f98 && kRound[63] == 0xc67178f2);

std::uint32_t big_endian(const unsigned char* p) {
    return std::uint32_t(p[0]) << 24 | std::uint32_t(p[1]) << 16 | std::uint32_t(p[2]) << 8 | std::uint32_t(p[3]);
}

// FIPS 180-4 §6.2.2, for `count` consecutive blocks.
void compress(std::array<std::uint32_t, 8>& state, const unsigned char* data, std::size_t count) {
    using std::rotr;
    for (; count > 0; --count, data += 64) {
        std::array<std::uint32_t, 64> w{};
        for (std::size_t t = 0; t < 16; ++t) w[t] = big_endian(data + 4 * t);
        for (std::size_t t = 16; t < 64; ++t) {
            const std::uint32_t s0 = rotr(w[t - 15], 7) ^ rotr(w[t - 15], 18) ^ (w[t - 15] >> 3);
            const std::uint32_t s1 = rotr(w[t - 2], 17) ^ rotr(w[t - 2], 19) ^ (w[t - 2] >> 10);
            w[t] = s1 + w[t - 7] + s0 + w[t - 16];
        }
        auto [a, b, c, d, e, f, g, h] = state;
        for (std::size_t t = 0; t < 64; ++t) {
            const std::uint32_t t1 =
                h + (rotr(e, 6) ^ rotr(e, 11) ^ rotr(e, 25)) + ((e & f) ^ (~e & g)) + kRound[t] + w[t];
            const std::uint32_t t2 = (rotr(a, 2) ^ rotr(a, 13) ^ rotr(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
            h = g, g = f, f = e, e = d + t1, d = c, c = b, b = a, a = t1 + t2;
        }
        const std::array<std::uint32_t, 8> mixed{a, b, c, d, e, f, g, h};
        for (std::size_t i = 0; i < 8; ++i) state[i] += mixed[i];
    }
}

}  // namespace

void Sha256::update(std::string_view bytes) {
    const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    std::size_t left = bytes.size();
    const std::size_t held = length_ % 64;
    length_ += left;
    if (held > 0) {
        const std::size_t taken = std::min(left, 64 - held);
        std::memcpy(block_.data() + held, data, taken);
        data += taken, left -= taken;
        if (held + taken < 64) return;
        compress(state_, block_.data(), 1);
    }
    compress(state_, data, left / 64);
    if (left % 64 > 0) std::memcpy(block_.data(), data + left / 64 * 64, left % 64);
}

std::string Sha256::hex() {
    // §5.1.1: a one bit, zeros, and the length in bits as 64 bits, up to a multiple of 64 bytes.
    const std::uint64_t bits = length_ * 8;
    std::string padding(1, char(0x80));
    while ((length_ + padding.size()) % 64 != 56) padding.push_back('\0');
    for (int shift = 56; shift >= 0; shift -= 8) padding.push_back(static_cast<char>(bits >> shift & 0xff));
    update(padding);

    constexpr const char* digits = "0123456789abcdef";
    std::string text;
    for (std::uint32_t word : state_)
        for (int shift = 28; shift >= 0; shift -= 4) text.push_back(digits[word >> shift & 0xf]);
    return text;
}

std::string sha256(std::string_view bytes) {
    Sha256 hash;
    hash.update(bytes);
    return hash.hex();
}

std::string sha256_of_file(const std::filesystem::path& file) {
    const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) throw read_error(file, errno);
    Sha256 hash;
    std::vector<char> chunk(1 << 18);
    for (;;) {
        const ssize_t got = read(descriptor, chunk.data(), chunk.size());
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) {
            const int error_number = errno;
            close(descriptor);
            if (got < 0) throw read_error(file, error_number);
            return hash.hex();
        }
        hash.update(chunk.data(), static_cast<std::size_t>(got));
    }
}

}  // namespace beamcam::output
