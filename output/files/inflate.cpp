#include "output/files/inflate.hpp"

#include <libdeflate.h>

#include <new>

namespace beamcam::output {
namespace {

constexpr std::size_t kLargestRatio = 1100;  // deflate compresses at most 1032 bytes into one

}  // namespace

std::string zlib_compressed(std::string_view bytes, int level) {
    const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
        libdeflate_alloc_compressor(level), libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    // Uninitialized: most of it is never used, and the system provides only memory that is used.
    const std::size_t most = libdeflate_zlib_compress_bound(compressor.get(), bytes.size());
    const auto room = std::make_unique_for_overwrite<char[]>(most);
    return {room.get(), libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), room.get(), most)};
}

void Inflater::Free::operator()(libdeflate_decompressor* decompressor) const {
    libdeflate_free_decompressor(decompressor);
}

Inflater::Inflater(std::size_t budget) : decompressor_(libdeflate_alloc_decompressor()), budget_(budget) {
    if (!decompressor_) throw std::bad_alloc();
}

std::optional<std::string> Inflater::deflate(std::string_view packed, std::size_t size) {
    if (size > budget_ || size / kLargestRatio > packed.size()) return std::nullopt;
    std::string plain(size, '\0');
    if (libdeflate_deflate_decompress(decompressor_.get(), packed.data(), packed.size(), plain.data(), size, nullptr) !=
        LIBDEFLATE_SUCCESS)
        return std::nullopt;
    budget_ -= size;
    return plain;
}

}  // namespace beamcam::output
