#include "output/image/huffman_code.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <queue>
#include <random>
#include <stdexcept>

namespace beamcam::output {
namespace {

using Weights = std::vector<std::uint32_t>;

std::uint64_t total_length(const Weights& weights, const std::vector<std::uint8_t>& lengths) {
    std::uint64_t total = 0;
    for (std::size_t s = 0; s < weights.size(); ++s) total += std::uint64_t{weights[s]} * lengths[s];
    return total;
}

// Kraft's sum times 2^15: 2^15 where every sequence of bits is a word's beginning, and none is that of two.
std::uint64_t kraft(const std::vector<std::uint8_t>& lengths) {
    std::uint64_t sum = 0;
    for (std::uint8_t length : lengths)
        if (length > 0) sum += std::uint64_t{1} << (15 - length);
    return sum;
}

// Huffman's own algorithm: the total length is the sum of all weights that are joined.
std::uint64_t least_unlimited(const Weights& weights) {
    std::priority_queue<std::uint64_t, std::vector<std::uint64_t>, std::greater<>> left;
    for (std::uint32_t w : weights)
        if (w > 0) left.push(w);
    std::uint64_t total = 0;
    while (left.size() > 1) {
        const std::uint64_t a = left.top();
        left.pop();
        const std::uint64_t b = left.top();
        left.pop();
        left.push(a + b);
        total += a + b;
    }
    return total;
}

// The least total length of all codes, by trying every list of lengths.
std::uint64_t least_limited(const Weights& weights, int longest) {
    std::vector<std::uint8_t> lengths(weights.size(), 1);
    std::uint64_t least = ~std::uint64_t{0};
    for (;;) {
        if (kraft(lengths) <= 1 << 15) least = std::min(least, total_length(weights, lengths));
        std::size_t s = 0;
        while (s < lengths.size() && lengths[s] == longest) lengths[s++] = 1;
        if (s == lengths.size()) return least;
        ++lengths[s];
    }
}

Weights random_weights(std::mt19937& random, std::size_t symbols, int spread) {
    Weights weights(symbols);
    for (std::uint32_t& w : weights)
        w = static_cast<std::uint32_t>(random()) >> (random() % static_cast<unsigned>(spread));
    weights[0] = weights[1] = 1;
    return weights;
}

TEST(HuffmanCode, IsCompleteAndAsShortAsHuffmans) {
    std::mt19937 random(1);
    for (std::size_t symbols = 2; symbols < 287; symbols += 3) {
        const Weights weights = random_weights(random, symbols, 5);  // too even for words of 15 bits, nearly always
        const HuffmanCode code = huffman_code(weights, 15);
        EXPECT_EQ(kraft(code.lengths), 1u << 15) << symbols;
        if (*std::max_element(code.lengths.begin(), code.lengths.end()) < 15) {
            EXPECT_EQ(total_length(weights, code.lengths), least_unlimited(weights)) << symbols;
        }
    }
}

TEST(HuffmanCode, IsTheShortestOfThoseWithinTheLimit) {
    std::mt19937 random(2);
    for (int trial = 0; trial < 40; ++trial) {
        const Weights weights = random_weights(random, 6, 32);
        for (int longest : {3, 4, 5}) {
            const HuffmanCode code = huffman_code(weights, longest);
            Weights used;  // the others need no word
            for (std::uint32_t w : weights)
                if (w > 0) used.push_back(w);
            EXPECT_LE(*std::max_element(code.lengths.begin(), code.lengths.end()), longest);
            EXPECT_EQ(kraft(code.lengths), 1u << 15);
            EXPECT_EQ(total_length(weights, code.lengths), least_limited(used, longest)) << trial << " " << longest;
        }
    }
}

// Without a limit the n-th of Fibonacci's weights has a word of as many bits as there are heavier ones.
TEST(HuffmanCode, KeepsTheLimitWhereWeightsGrowLikeFibonaccis) {
    Weights weights{1, 1};
    while (weights.size() < 40) weights.push_back(weights[weights.size() - 1] + weights[weights.size() - 2]);
    for (int longest : {6, 7, 15}) {
        const HuffmanCode code = huffman_code(weights, longest);
        EXPECT_EQ(*std::max_element(code.lengths.begin(), code.lengths.end()), longest);
        EXPECT_EQ(kraft(code.lengths), 1u << 15);
        EXPECT_TRUE(std::is_sorted(code.lengths.rbegin(), code.lengths.rend()));
    }
}

// The example of RFC 1951, section 3.2.2: lengths 3, 3, 3, 3, 3, 2, 4, 4; the words there begin with the highest bit.
TEST(HuffmanCode, HasTheWordsOfTheStandard) {
    const HuffmanCode code = huffman_code(Weights{4, 4, 4, 4, 4, 8, 2, 2}, 15);
    EXPECT_EQ(code.lengths, (std::vector<std::uint8_t>{3, 3, 3, 3, 3, 2, 4, 4}));
    EXPECT_EQ(code.words, (std::vector<std::uint16_t>{0b010, 0b110, 0b001, 0b101, 0b011, 0b00, 0b0111, 0b1111}));
}

TEST(HuffmanCode, HasTwoWordsAtLeast) {
    EXPECT_EQ(huffman_code(Weights{0, 0, 7}, 15).lengths, (std::vector<std::uint8_t>{1, 0, 1}));
    EXPECT_EQ(huffman_code(Weights{0, 0, 0}, 15).lengths, (std::vector<std::uint8_t>{1, 1, 0}));
}

TEST(HuffmanCode, FillsEveryWordOfTheLimit) {
    EXPECT_EQ(huffman_code(Weights{1, 10, 100, 1000}, 2).lengths, (std::vector<std::uint8_t>{2, 2, 2, 2}));
}

TEST(HuffmanCode, RefusesWhatHasNoCode) {
    EXPECT_THROW(huffman_code(Weights{1}, 15), std::logic_error);
    EXPECT_THROW(huffman_code(Weights(5, 1), 2), std::logic_error);
    EXPECT_THROW(huffman_code(Weights(5, 1), 16), std::logic_error);
}

}  // namespace
}  // namespace beamcam::output
