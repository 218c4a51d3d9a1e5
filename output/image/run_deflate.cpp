// Section numbers are those of RFC 1951.
#include "output/image/run_deflate.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "output/image/huffman_code.hpp"

namespace beamcam::output {

namespace {

// Tokens: the 256 literals, then runs of 3 … 258 equal bytes, then those of equal pixels.
constexpr std::size_t kLiterals = 256, kLengths = 256, kTokens = kLiterals + 2 * kLengths;
constexpr std::size_t kShortestRun = 3, kLongestRun = 258;  // 3.2.5
constexpr std::size_t kBlock = 65536;     // [token]: fits the cache, and headers are below a percent of it
constexpr std::size_t kLongestPixel = 4;  // [byte]
constexpr std::size_t kEndOfBlock = 256, kSymbols = 286;
constexpr int kLongestWord = 15, kLongestPieceWord = 7;  // [bit]
constexpr std::uint32_t kAdlerModulus = 65521;           // RFC 1950, section 9

std::uint64_t eight_bytes(const std::uint8_t* from) {
    std::uint64_t value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

// The number of equal bytes at the beginning of `a` and `b`, at most `size`. Mostly few or very many are equal.
std::size_t equal_bytes(const std::uint8_t* a, const std::uint8_t* b, std::size_t size) {
    const auto differing = [&](std::size_t at) { return eight_bytes(a + at) ^ eight_bytes(b + at); };
    const auto first_in = [](std::uint64_t bits) { return static_cast<std::size_t>(std::countr_zero(bits)) / 8; };
    std::size_t i = 0;
    for (; i + 8 <= size; i += 8) {
        if (const std::uint64_t bits = differing(i)) return i + first_in(bits);
        while (i + 40 <= size && (differing(i + 8) | differing(i + 16) | differing(i + 24) | differing(i + 32)) == 0)
            i += 32;
    }
    while (i < size && a[i] == b[i]) ++i;
    return i;
}

// Whether at least the shortest run's bytes are equal.
bool begins_run(const std::uint8_t* a, const std::uint8_t* b, std::size_t size) {
    return size >= kShortestRun && a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

// A run's length as symbol and further bits (3.2.5).
struct LengthSymbol {
    std::size_t symbol;
    unsigned extra_count;  // [bit]
    std::uint64_t extra;
};

LengthSymbol length_symbol(std::size_t length) {
    if (length == kLongestRun) return {285, 0, 0};
    const std::size_t above = length - kShortestRun;
    if (above < 8) return {257 + above, 0, 0};
    // Four symbols for each power of two: the two bits after the leading one select the symbol, the rest is extra.
    const auto extra_count = static_cast<unsigned>(std::bit_width(above)) - 3;
    const std::size_t quarter = above >> extra_count & 3;
    return {261 + 4 * static_cast<std::size_t>(extra_count) + quarter, extra_count,
            above & ((std::size_t{1} << extra_count) - 1)};
}

// Distances 1 and `pixel` are the symbols 0 and pixel − 1 without further bits (3.2.5), their words one bit each.
constexpr std::size_t kByteDistance = 0, kPixelDistance = 1;

std::vector<std::uint8_t> distance_lengths(std::size_t pixel) {
    std::vector<std::uint8_t> lengths(pixel, 0);
    lengths.front() = lengths.back() = 1;
    return lengths;
}

// A piece of a list of word lengths (3.2.7): a length, 16 for repetitions of the last length, 17 and 18 for zeros.
struct LengthPiece {
    std::size_t symbol;
    std::uint64_t extra = 0;
    unsigned extra_count = 0;  // [bit]
};
constexpr std::size_t kPieceSymbols = 19;
// The order of their own lengths in the stream: likely ones first.
constexpr std::array<std::size_t, kPieceSymbols> kPieceOrder = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                                11, 4,  12, 3, 13, 2, 14, 1, 15};

std::vector<LengthPiece> pieces_of(const std::vector<std::uint8_t>& lengths) {
    std::vector<LengthPiece> pieces;
    for (std::size_t i = 0; i < lengths.size();) {
        std::size_t same = 1;
        while (i + same < lengths.size() && lengths[i + same] == lengths[i]) ++same;
        if (lengths[i] == 0 && same >= 11) {
            same = std::min<std::size_t>(same, 138);
            pieces.push_back({18, same - 11, 7});
        } else if (lengths[i] == 0 && same >= 3) {
            pieces.push_back({17, same - 3, 3});
        } else if (i > 0 && lengths[i - 1] == lengths[i] && same >= 3) {
            same = std::min<std::size_t>(same, 6);
            pieces.push_back({16, same - 3, 2});
        } else {
            same = 1;
            pieces.push_back({lengths[i]});
        }
        i += same;
    }
    return pieces;
}

// The bits of each token; of a run: the word of the length, its extra bits, and the word of the distance.
std::vector<BitWord> token_words(const HuffmanCode& code) {
    std::vector<BitWord> words(kTokens);
    for (std::size_t b = 0; b < kLiterals; ++b) words[b] = {code.words[b], code.lengths[b]};
    for (std::size_t run = 0; run < 2 * kLengths; ++run) {
        const auto [symbol, extra_count, extra] = length_symbol(run % kLengths + kShortestRun);
        const std::uint64_t distance = run / kLengths;
        const unsigned length = code.lengths[symbol];
        words[kLiterals + run] = {code.words[symbol] | extra << length | distance << (length + extra_count),
                                  length + extra_count + 1};
    }
    return words;
}

// 3.2.7: the numbers of words, then the lengths of all words in a code that precedes them.
void put_header(BitWriter& out, bool last, std::vector<std::uint8_t> lengths,
                const std::vector<std::uint8_t>& distances) {
    const std::size_t symbols = lengths.size();
    lengths.insert(lengths.end(), distances.begin(), distances.end());
    const std::vector<LengthPiece> pieces = pieces_of(lengths);
    std::vector<std::uint32_t> weights(kPieceSymbols, 0);
    for (const LengthPiece& piece : pieces) ++weights[piece.symbol];
    const HuffmanCode code = huffman_code(weights, kLongestPieceWord);
    std::size_t sent = kPieceSymbols;
    while (sent > 4 && code.lengths[kPieceOrder[sent - 1]] == 0) --sent;

    out.put(last ? 1 : 0, 1);
    out.put(2, 2);  // own codes
    out.put(symbols - 257, 5);
    out.put(distances.size() - 1, 5);
    out.put(sent - 4, 4);
    for (std::size_t i = 0; i < sent; ++i) out.put(code.lengths[kPieceOrder[i]], 3);
    for (const LengthPiece& piece : pieces) {
        out.put(code.words[piece.symbol], code.lengths[piece.symbol]);
        out.put(piece.extra, piece.extra_count);
    }
}

}  // namespace

RunDeflate::RunDeflate(std::size_t pixel) : pixel_(pixel), tokens_(kBlock) {
    if (pixel < 2 || pixel > kLongestPixel) throw std::logic_error("RunDeflate: a pixel has 2 to 4 bytes");
    out_.put(0x0178, 16);  // RFC 1950: deflate, a window of 32 KiB, the fastest level
}

void RunDeflate::bytes(std::span<const std::uint8_t> data) {
    if (data.empty()) return;
    adler_ = libdeflate_adler32(adler_, data.data(), data.size());
    const auto first = std::ranges::find_if(data, [](std::uint8_t b) { return b != 0; });
    zeros_ += static_cast<std::size_t>(first - data.begin());
    if (first == data.end()) return;
    put_zeros();
    while (data.back() == 0) {
        ++zeros_;
        data = data.first(data.size() - 1);
    }
    put_bytes({first, data.end()});
}

void RunDeflate::zeros(std::size_t count) {
    // Adler's second sum grows by the first one with every byte.
    const std::uint64_t first = adler_ & 0xffff, second = adler_ >> 16;
    adler_ = static_cast<std::uint32_t>((second + count % kAdlerModulus * first) % kAdlerModulus << 16 | first);
    zeros_ += count;
}

std::string RunDeflate::finish() && {
    put_zeros();
    end_block(true);
    out_.align();
    for (int shift = 24; shift >= 0; shift -= 8) out_.put(adler_ >> shift & 0xff, 8);
    return std::move(out_).finish();
}

// Pixel by pixel: a run of pixels, a byte and a run of bytes equal to it, or as many literals as a pixel has bytes.
void RunDeflate::put_bytes(std::span<const std::uint8_t> data) {
    for (std::size_t i = 0; i < data.size();) {
        const std::uint8_t* now = data.data() + i;
        const std::size_t rest = data.size() - i;
        if (held_ + kLongestPixel > kBlock) end_block(false);
        if (i >= pixel_ && begins_run(now - pixel_, now, rest)) {
            i += put_run(equal_bytes(now - pixel_, now, rest), kPixelDistance);
        } else if (begins_run(now, now + 1, rest - 1)) {
            put(*now);
            i += 1 + put_run(equal_bytes(now, now + 1, rest - 1), kByteDistance);
        } else {
            const std::size_t literals = std::min(pixel_, rest);
            for (std::size_t k = 0; k < literals; ++k) tokens_[held_ + k] = now[k];
            held_ += literals;
            i += literals;
        }
    }
}

void RunDeflate::put_zeros() {
    if (zeros_ == 0) return;
    put(0);
    for (std::size_t left = zeros_ - 1 - put_run(zeros_ - 1, kByteDistance); left > 0; --left) put(0);
    zeros_ = 0;
}

void RunDeflate::put(std::size_t token) {
    if (held_ == kBlock) end_block(false);
    tokens_[held_++] = static_cast<std::uint16_t>(token);
}

// Puts as much of a run as whole tokens can hold, and returns that length: one or two bytes may be left.
std::size_t RunDeflate::put_run(std::size_t length, std::size_t distance) {
    std::size_t left = length;
    while (left >= kShortestRun) {
        const std::size_t now = std::min(left, kLongestRun);
        put(kLiterals + distance * kLengths + now - kShortestRun);
        left -= now;
    }
    return length - left;
}

// 3.2.3: header, tokens, end.
void RunDeflate::end_block(bool last) {
    const std::span<const std::uint16_t> tokens(tokens_.data(), held_);
    std::vector<std::uint32_t> counts(kTokens, 0), weights(kSymbols, 0);
    for (const std::uint16_t token : tokens) ++counts[token];
    std::copy_n(counts.begin(), kLiterals, weights.begin());
    weights[kEndOfBlock] = 1;
    for (std::size_t run = 0; run < 2 * kLengths; ++run)
        weights[length_symbol(run % kLengths + kShortestRun).symbol] += counts[kLiterals + run];
    const HuffmanCode code = huffman_code(weights, kLongestWord);

    put_header(out_, last, code.lengths, distance_lengths(pixel_));
    const std::vector<BitWord> words = token_words(code);
    std::size_t bits = 0;
    for (std::size_t token = 0; token < kTokens; ++token) bits += std::size_t{counts[token]} * words[token].count;
    out_.put(tokens, words, bits);
    out_.put(code.words[kEndOfBlock], code.lengths[kEndOfBlock]);
    held_ = 0;
}

}  // namespace beamcam::output
