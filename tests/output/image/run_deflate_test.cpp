#include "output/image/run_deflate.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <random>
#include <stdexcept>

namespace beamcam::output {
namespace {

using Bytes = std::vector<std::uint8_t>;

// zlib's reading of the stream, which it must use up: a witness that shares no code with the writer and looks at the
// checksum.
Bytes inflated(const std::string& stream, std::size_t expected) {
    Bytes result(expected + 1);
    uLongf size = result.size();
    uLong used = stream.size();
    EXPECT_EQ(uncompress2(result.data(), &size, reinterpret_cast<const Bytef*>(stream.data()), &used), Z_OK);
    EXPECT_EQ(used, stream.size());
    result.resize(size);
    return result;
}

std::string deflated(const Bytes& data, std::size_t pixel) {
    RunDeflate stream(pixel);
    stream.bytes(data);
    return std::move(stream).finish();
}

void expect_same(const Bytes& data, std::size_t pixel, const std::string& what) {
    EXPECT_TRUE(inflated(deflated(data, pixel), data.size()) == data) << what << ", pixels of " << pixel << " bytes";
}

Bytes noise(std::size_t size, std::uint32_t values, unsigned seed = 1) {
    std::mt19937 random(seed);
    Bytes data(size);
    for (std::uint8_t& b : data) b = static_cast<std::uint8_t>(random() % values);
    return data;
}

TEST(RunDeflate, InflatesToTheSameWhateverTheData) {
    for (std::size_t pixel : {2, 3, 4})
        for (std::size_t size : {1, 2, 3, 4, 5, 7, 8, 9, 31, 257, 258, 259, 5761, 100'000}) {
            for (std::uint32_t values : {1, 2, 3, 5, 256}) expect_same(noise(size, values), pixel, "noise");
            expect_same(Bytes(size, 255), pixel, "one value");
            Bytes gradient(size), pixels(size);
            for (std::size_t i = 0; i < size; ++i) {
                gradient[i] = static_cast<std::uint8_t>(i / 7);
                pixels[i] = static_cast<std::uint8_t>(17 * (i % pixel) + i / 1000);
            }
            expect_same(gradient, pixel, "gradient");
            expect_same(pixels, pixel, "pixels");
        }
}

TEST(RunDeflate, InflatesToTheSameForEveryLengthOfRuns) {
    for (std::size_t pixel : {2, 3, 4})
        for (std::uint8_t value : {0, 9})
            for (bool of_pixels : {false, true}) {
                Bytes data;
                for (std::size_t length = 1; length <= 600; ++length) {
                    for (std::size_t i = 0; i < length; ++i)
                        data.push_back(static_cast<std::uint8_t>(of_pixels ? value + i % pixel : value));
                    data.push_back(static_cast<std::uint8_t>(100 + length % 7));
                }
                expect_same(data, pixel, of_pixels ? "runs of pixels" : "runs of bytes");
            }
}

// Blocks have 65536 tokens; these data are literals alone.
TEST(RunDeflate, InflatesToTheSameWhereverBlocksEnd) {
    Bytes data(3 * 65536 + 5);
    for (std::size_t i = 0; i < data.size(); ++i) data[i] = static_cast<std::uint8_t>(i * 37 + i / 256);
    for (std::size_t size : {65531, 65532, 65533, 65534, 65535, 65536, 65537, 131071, 131072, 131073, 196608, 196613})
        expect_same({data.begin(), data.begin() + static_cast<std::ptrdiff_t>(size)}, 3, std::to_string(size));
}

// Values as frequent as Fibonacci's numbers, none beside its like: Huffman's words of the rarest would have 20 bits.
TEST(RunDeflate, InflatesToTheSameWhereWordsAreAsLongAsTheyMayBe) {
    Bytes sorted;
    for (std::size_t value = 0, count = 1, next = 1; value < 21; ++value) {
        sorted.insert(sorted.end(), count, static_cast<std::uint8_t>(200 - value));
        count = std::exchange(next, count + next);
    }
    Bytes data(sorted.size());
    const std::size_t odd = data.size() / 2;
    for (std::size_t i = 0; i < data.size(); ++i) data[i < odd ? 2 * i + 1 : 2 * (i - odd)] = sorted[i];
    expect_same(data, 3, "Fibonacci");
}

// Zeros that are told are zeros that are read, in however many calls, and whatever stands around them.
TEST(RunDeflate, TakesZerosUnread) {
    for (std::size_t zeros : {1, 2, 3, 4, 258, 259, 260, 261, 70'000, 3'000'000}) {
        const Bytes before{1, 2, 0}, after{0, 0, 5, 0, 0};
        RunDeflate told(3), halved(3);
        told.bytes(before);
        told.zeros(zeros);
        told.bytes(after);
        halved.bytes(before);
        halved.zeros(zeros / 2);
        halved.zeros(0);
        halved.bytes({});
        halved.zeros(zeros - zeros / 2);
        halved.bytes(after);
        Bytes whole = before;
        whole.insert(whole.end(), zeros, 0);
        whole.insert(whole.end(), after.begin(), after.end());
        const std::string stream = std::move(told).finish();
        EXPECT_TRUE(inflated(stream, whole.size()) == whole) << zeros;
        EXPECT_EQ(std::move(halved).finish(), stream) << zeros;
    }
}

TEST(RunDeflate, HoldsNothingToo) {
    EXPECT_TRUE(inflated(RunDeflate(3).finish(), 0).empty());
    EXPECT_TRUE(inflated(deflated({}, 4), 0).empty());
}

// 258 zeros take two bits: a word of one bit for their length and one for the distance. Noise grows by its headers.
TEST(RunDeflate, IsShortForRunsAndNotLongerThanNoise) {
    RunDeflate zeros(3);
    zeros.zeros(258'000'000);
    EXPECT_LT(std::move(zeros).finish().size(), 1'000'000 * 2 / 8 * 1.01);
    Bytes pixels;
    for (int i = 0; i < 258'000; ++i) pixels.push_back(static_cast<std::uint8_t>(10 + i % 3));
    EXPECT_LT(deflated(pixels, 3).size(), 1000u * 3 * 2 / 8 + 100);
    EXPECT_LT(deflated(noise(1'000'000, 256), 3).size(), 1'010'000u);
}

TEST(RunDeflate, GivesTheSameStreamForTheSameCalls) {
    const Bytes data = noise(300'000, 3);
    const std::string stream = deflated(data, 3);
    for (int i = 0; i < 5; ++i) {
        const std::vector<std::uint64_t> dirt(1 << 16, 0x5a5a5a5a5a5a5a5aU * static_cast<unsigned>(i + 1));
        EXPECT_EQ(deflated(data, 3), stream) << dirt.front();
    }
}

TEST(RunDeflate, RefusesOtherPixels) {
    EXPECT_THROW(RunDeflate(1), std::logic_error);
    EXPECT_THROW(RunDeflate(5), std::logic_error);
}

}  // namespace
}  // namespace beamcam::output
