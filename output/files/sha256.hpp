// SHA-256 as FIPS 180-4 defines it, by OpenSSL's libcrypto, which uses the SHA instructions of the processor. It
// identifies the content of pictures and files.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace beamcam::output {

class Sha256 {
  public:
    Sha256();
    ~Sha256();
    Sha256(const Sha256&) = delete;
    Sha256& operator=(const Sha256&) = delete;

    void update(std::string_view bytes);
    void update(const void* data, std::size_t size) { update({static_cast<const char*>(data), size}); }
    std::string hex();  // 64 lower-case digits; at most once

  private:
    struct Context;
    std::unique_ptr<Context> context_;
};

std::string sha256(std::string_view bytes);
std::string sha256_of_file(const std::filesystem::path& file);  // throws IoError

}  // namespace beamcam::output
