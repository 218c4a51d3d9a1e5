// SHA-256 as FIPS 180-4 defines it: names the content of pictures and files, guards no secret.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace beamcam::output {

class Sha256 {
  public:
    void update(std::string_view bytes);
    void update(const void* data, std::size_t size) { update({static_cast<const char*>(data), size}); }
    std::string hex();  // 64 lower-case digits; the object is spent afterwards

  private:
    std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                        0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    std::array<unsigned char, 64> block_{};
    std::uint64_t length_ = 0;  // [bytes] seen so far
};

std::string sha256(std::string_view bytes);
std::string sha256_of_file(const std::filesystem::path& file);  // throws IoError

}  // namespace beamcam::output
