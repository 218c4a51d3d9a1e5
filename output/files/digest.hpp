// Digests: SHA-256 as FIPS 180-4 defines it, by OpenSSL's libcrypto, identifies the content of pictures and files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

struct evp_md_ctx_st;

namespace beamcam::output {

class Sha256 {
  public:
    Sha256();
    void update(std::string_view bytes);
    std::string hex();  // 64 lower-case digits; at most once

  private:
    struct Free {
        void operator()(evp_md_ctx_st* context) const;
    };
    std::unique_ptr<evp_md_ctx_st, Free> context_;
};

std::string sha256(std::string_view bytes);
std::string sha256_of_file(const std::filesystem::path& file);  // throws IoError

}  // namespace beamcam::output
