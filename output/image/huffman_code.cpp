#include "output/image/huffman_code.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>

namespace beamcam::output {

namespace {

constexpr int kLongest = 15;  // [bit]

// An item of package-merge: a symbol, or two lighter items of the previous list.
struct Item {
    std::uint64_t weight;
    bool symbol;
};

// The symbols that need words, lightest first; at least two, since a code of one word is not complete.
std::vector<std::size_t> by_weight(std::span<const std::uint32_t> weights) {
    std::vector<std::size_t> symbols;
    for (std::size_t s = 0; s < weights.size(); ++s)
        if (weights[s] > 0) symbols.push_back(s);
    for (std::size_t s = 0; symbols.size() < 2; ++s)
        if (weights[s] == 0) symbols.push_back(s);
    std::ranges::sort(
        symbols, [&](std::size_t a, std::size_t b) { return std::pair(weights[a], a) < std::pair(weights[b], b); });
    return symbols;
}

// The symbols and the pairs of `lighter` in order of weight; of equal weight, symbols come first.
std::vector<Item> merged(const std::vector<Item>& symbols, const std::vector<Item>& lighter) {
    std::vector<Item> pairs(lighter.size() / 2), all(symbols.size() + pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i)
        pairs[i] = {lighter[2 * i].weight + lighter[2 * i + 1].weight, false};
    std::merge(symbols.begin(), symbols.end(), pairs.begin(), pairs.end(), all.begin(),
               [](const Item& a, const Item& b) { return a.weight < b.weight; });
    return all;
}

// A symbol's length is the number of lists from which it is taken: of the last list the lightest 2n − 2 items,
// of each list before what the pairs taken behind it consist of.
std::vector<std::uint8_t> limited_lengths(std::span<const std::uint32_t> weights, int longest) {
    const std::vector<std::size_t> order = by_weight(weights);
    std::vector<Item> symbols;
    for (std::size_t s : order) symbols.push_back({weights[s], true});
    std::vector<std::vector<Item>> lists{symbols};
    while (lists.size() < static_cast<std::size_t>(longest)) lists.push_back(merged(symbols, lists.back()));

    std::vector<std::uint8_t> lengths(weights.size(), 0);
    std::size_t taken = 2 * symbols.size() - 2;
    for (auto list = lists.rbegin(); list != lists.rend(); ++list) {
        std::size_t lightest = 0;
        for (std::size_t i = 0; i < taken; ++i)
            if ((*list)[i].symbol) ++lengths[order[lightest++]];
        taken = 2 * (taken - lightest);
    }
    return lengths;
}

std::uint16_t reversed(unsigned word, int length) {
    unsigned result = 0;
    for (int i = 0; i < length; ++i) result |= (word >> i & 1) << (length - 1 - i);
    return static_cast<std::uint16_t>(result);
}

// Words of one length count upwards in the order of the symbols, behind all shorter ones.
std::vector<std::uint16_t> canonical_words(const std::vector<std::uint8_t>& lengths) {
    std::array<unsigned, kLongest + 1> count{}, next{};
    for (std::uint8_t length : lengths) ++count[length];
    count[0] = 0;
    for (std::size_t length = 1; length < next.size(); ++length)
        next[length] = (next[length - 1] + count[length - 1]) << 1;
    std::vector<std::uint16_t> words(lengths.size(), 0);
    for (std::size_t s = 0; s < lengths.size(); ++s)
        if (lengths[s] > 0) words[s] = reversed(next[lengths[s]]++, lengths[s]);
    return words;
}

}  // namespace

HuffmanCode huffman_code(std::span<const std::uint32_t> weights, int longest) {
    const auto used = std::ranges::count_if(weights, [](std::uint32_t w) { return w > 0; });
    if (weights.size() < 2 || longest < 1 || longest > kLongest || used > std::ptrdiff_t{1} << longest)
        throw std::logic_error("huffman_code: no such code");
    HuffmanCode code{limited_lengths(weights, longest), {}};
    code.words = canonical_words(code.lengths);
    return code;
}

}  // namespace beamcam::output
