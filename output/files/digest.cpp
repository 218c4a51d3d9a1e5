#include "output/files/digest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>

#include <array>
#include <new>
#include <stdexcept>

#include "output/files/atomic_file.hpp"

namespace beamcam::output {

namespace {

// The configuration file of the library is not read: it takes time and could select other implementations.
const EVP_MD* algorithm() {
    static const EVP_MD* const found = [] {
        OPENSSL_init_crypto(OPENSSL_INIT_NO_LOAD_CONFIG | OPENSSL_INIT_NO_ATEXIT, nullptr);
        return EVP_sha256();
    }();
    return found;
}

void require(int status) {
    if (status != 1) throw std::runtime_error("SHA-256 failed in OpenSSL's libcrypto");
}

}  // namespace

void Sha256::Free::operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }

Sha256::Sha256() : context_(EVP_MD_CTX_new()) {
    if (!context_) throw std::bad_alloc();
    require(EVP_DigestInit_ex(context_.get(), algorithm(), nullptr));
}

void Sha256::update(std::string_view bytes) { require(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size())); }

std::string Sha256::hex() {
    std::array<unsigned char, 32> raw{};
    require(EVP_DigestFinal_ex(context_.get(), raw.data(), nullptr));
    return fmt::format("{:02x}", fmt::join(raw, ""));
}

std::string sha256(std::string_view bytes) {
    Sha256 hash;
    hash.update(bytes);
    return hash.hex();
}

std::string sha256_of_file(const std::filesystem::path& file) {
    Sha256 hash;
    read_pieces(file, [&hash](std::string_view piece) { hash.update(piece); });
    return hash.hex();
}

}  // namespace beamcam::output
