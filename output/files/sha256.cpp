#include "output/files/sha256.hpp"

#include <fcntl.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <new>
#include <stdexcept>
#include <vector>

#include "output/files/errors.hpp"

namespace beamcam::output {

namespace {

// Without the configuration file of the library, which takes time and could select other implementations.
const EVP_MD* algorithm() {
    static const EVP_MD* const found = [] {
        OPENSSL_init_crypto(OPENSSL_INIT_NO_LOAD_CONFIG | OPENSSL_INIT_NO_ATEXIT, nullptr);
        return EVP_sha256();
    }();
    return found;
}

}  // namespace

struct Sha256::Context {
    EVP_MD_CTX* handle = EVP_MD_CTX_new();

    Context() {
        if (handle == nullptr) throw std::bad_alloc();
    }
    ~Context() { EVP_MD_CTX_free(handle); }
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;
};

Sha256::Sha256() : context_(std::make_unique<Context>()) {
    if (EVP_DigestInit_ex(context_->handle, algorithm(), nullptr) != 1)
        throw std::runtime_error("SHA-256 cannot be set up in OpenSSL's libcrypto");
}

Sha256::~Sha256() = default;

void Sha256::update(std::string_view bytes) {
    if (EVP_DigestUpdate(context_->handle, bytes.data(), bytes.size()) != 1)
        throw std::runtime_error("SHA-256 failed in OpenSSL's libcrypto");
}

std::string Sha256::hex() {
    std::array<unsigned char, 32> raw{};
    if (EVP_DigestFinal_ex(context_->handle, raw.data(), nullptr) != 1)
        throw std::runtime_error("SHA-256 failed in OpenSSL's libcrypto");
    constexpr const char* digits = "0123456789abcdef";
    std::string text;
    for (const unsigned char byte : raw) {
        text.push_back(digits[byte >> 4]);
        text.push_back(digits[byte & 0xf]);
    }
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
