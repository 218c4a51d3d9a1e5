#include "output/image/png_reader.hpp"

#include <spng.h>

#include <array>
#include <fstream>
#include <memory>
#include <new>
#include <vector>

#include "output/files/atomic_file.hpp"

namespace beamcam::output {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
constexpr std::string_view kEnd("\0\0\0\0IEND\xAE\x42\x60\x82", 12);  // the chunk at the end
constexpr std::size_t kLongestText = 256u << 20;  // [bytes]: a scene with a drive table of a million points

class PngDecoder {
  public:
    explicit PngDecoder(const fs::path& file) : file_(file), bytes_(read_regular_file(file)), png_(spng_ctx_new(0)) {
        if (!png_) throw std::bad_alloc();
        if (bytes_.empty()) refuse("the file is empty");
        if (!bytes_.starts_with(kSignature)) refuse("it is not a PNG file; ffmpeg -i FILM name-%04d.png gives the pictures of a film");
        require(spng_set_png_buffer(png_.get(), bytes_.data(), bytes_.size()));
        require(spng_set_chunk_limits(png_.get(), kLongestText, kLongestText));
        require(spng_get_ihdr(png_.get(), &header_));
        if (header_.width > kLargestSide || header_.height > kLargestSide)
            refuse(std::to_string(header_.width) + "x" + std::to_string(header_.height) + " pixels are more than the " +
                   std::to_string(kLargestSide) + "x" + std::to_string(kLargestSide) + " that beamcam handles");
    }

    PngInfo info() {
        PngInfo found{static_cast<int>(header_.width), static_cast<int>(header_.height), {}};
        std::uint32_t count = 0;
        const int code = spng_get_text(png_.get(), nullptr, &count);
        if (code == SPNG_ECHUNKAVAIL) return found;
        require(code);
        std::vector<spng_text> texts(count);
        require(spng_get_text(png_.get(), texts.data(), &count));
        for (const spng_text& text : texts) found.metadata[text.keyword] = text.text;
        return found;
    }

    Raster pixels() {
        Raster raster;
        raster.resize(static_cast<int>(header_.width), static_cast<int>(header_.height));
        require(
            spng_decode_image(png_.get(), raster.rgba.data(), raster.rgba.size(), SPNG_FMT_RGBA8, SPNG_DECODE_TRNS));
        require(spng_decode_chunks(png_.get()));
        if (bytes_.rfind(kEnd) == bytes_.npos) refuse("the picture is cut off; make or copy it again");
        return raster;
    }

  private:
    [[noreturn]] void refuse(const std::string& what) const {
        throw IoError("cannot read " + file_.string() + ": " + what);
    }
    void require(int code) const {
        if (code == SPNG_EMEM) throw std::bad_alloc();
        if (code == SPNG_OK) return;
        if (code == SPNG_ECHUNK_LIMITS) refuse("it has more than 256 MiB of texts, or more than a thousand of them");
        refuse(std::string("the picture is damaged or cut off (libspng: ") + spng_strerror(code) +
               "); make or copy it again");
    }

    struct Free {
        void operator()(spng_ctx* png) const { spng_ctx_free(png); }
    };

    const fs::path& file_;
    std::string bytes_;
    std::unique_ptr<spng_ctx, Free> png_;
    spng_ihdr header_{};
};

}  // namespace

bool is_png(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::array<char, kSignature.size()> head{};
    in.read(head.data(), head.size());
    return std::string_view(head.data(), static_cast<std::size_t>(in.gcount())) == kSignature;
}

Raster read_png(const fs::path& file) { return PngDecoder(file).pixels(); }

PngInfo read_png_info(const fs::path& file) { return PngDecoder(file).info(); }

}  // namespace beamcam::output
