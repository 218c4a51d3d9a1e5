// Digests of pixels and files.

#include "output/files/digest.hpp"

#include "output/files/atomic_file.hpp"
#include "output/image/raster.hpp"
#include "tests/output/scratch.hpp"

namespace beamcam::output {
namespace {

// FIPS 180-2 appendix B, and the empty message of NIST's CAVP vectors.
TEST(Sha256, AgreesWithThePublishedVectors) {
    EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(sha256(std::string(1000000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, DoesNotDependOnHowTheBytesArrive) {
    std::string bytes;
    for (int i = 0; i < 1000; ++i) bytes.push_back(static_cast<char>(i * 7));
    for (std::size_t step : {1u, 3u, 63u, 64u, 65u, 200u}) {
        Sha256 hash;
        for (std::size_t at = 0; at < bytes.size(); at += step) hash.update(std::string_view(bytes).substr(at, step));
        EXPECT_EQ(hash.hex(), sha256(bytes)) << step;
    }
}

TEST(Sha256, AgreesWithCoreutilsOnAFile) {
    Scratch scratch;
    write_file(scratch / "f", std::string(300000, 'x'));
    EXPECT_EQ(sha256_of_file(scratch / "f"), output_of("sha256sum < " + (scratch / "f").string()).substr(0, 64));
}

TEST(Pixels, OpaqueColoursPassUnchanged) {
    EXPECT_EQ(rgba_bytes(flat_image(1, 1, 0xff102030)), std::string("\x10\x20\x30\xff"));
}

TEST(Pixels, HalfTransparentColoursAreDividedByTheirAlpha) {
    // Cairo stores 50 % red as 0x80800000.
    EXPECT_EQ(rgba_bytes(flat_image(1, 1, 0x80800000)), std::string("\xff\0\0\x80", 4));
    // 0x40 of 0x80: 64·255/128 = 127.5, rounded up.
    EXPECT_EQ(rgba_bytes(flat_image(1, 1, 0x80400000)), std::string("\x80\0\0\x80", 4));
}

TEST(Pixels, NothingShowsWhereAlphaIsZero) { EXPECT_EQ(rgba_bytes(flat_image(1, 1, 0)), std::string(4, '\0')); }

TEST(Pixels, EveryPremultipliedColourComesBack) {
    for (std::uint32_t alpha = 1; alpha <= 255; ++alpha)
        for (std::uint32_t channel = 0; channel <= alpha; ++channel) {
            const std::string rgba = rgba_bytes(flat_image(1, 1, alpha << 24 | channel));
            const auto straight = static_cast<unsigned char>(rgba[2]);
            // Premultiplying again must give what was stored: |c·a/255 − c'| <= 1/2.
            EXPECT_LE(std::abs(straight * double(alpha) / 255 - channel), 0.5) << alpha << " " << channel;
        }
}

TEST(Digest, IsTheHashOfTheDecodedPixels) {
    EXPECT_EQ(digest(flat_image(2, 1, 0xff102030)), sha256("\x10\x20\x30\xff\x10\x20\x30\xff"));
}

}  // namespace
}  // namespace beamcam::output
