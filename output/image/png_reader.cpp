#include "output/image/png_reader.hpp"

#include <png.h>

#include <array>
#include <csetjmp>
#include <cstring>
#include <fstream>
#include <vector>

#include "output/files/atomic_file.hpp"

namespace beamcam::output {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
constexpr png_alloc_size_t kLongestText = 256u << 20;  // [bytes]: a scene with a drive table of a million points

std::uint32_t big_endian(const char* p) {
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(p[i]);
    return value;
}

// libpng reports errors by longjmp: the functions that it may leave must have no objects with destructors between
// setjmp and the last call of the library.
class PngDecoder {
  public:
    PngDecoder(const fs::path& file, std::string bytes) : file_(file), bytes_(std::move(bytes)) {
        require_picture();
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
        info_ = png_ != nullptr ? png_create_info_struct(png_) : nullptr;
        if (info_ == nullptr) {
            png_destroy_read_struct(&png_, nullptr, nullptr);
            throw std::bad_alloc();
        }
        png_set_read_fn(png_, this, on_read);
        png_set_user_limits(png_, kLargestSide, kLargestSide);
        png_set_chunk_malloc_max(png_, kLongestText);
    }
    ~PngDecoder() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngDecoder(const PngDecoder&) = delete;
    PngDecoder& operator=(const PngDecoder&) = delete;

    PngInfo info() {
        if (!guarded(&PngDecoder::read_header)) fail();
        png_textp text = nullptr;
        const int count = png_get_text(png_, info_, &text, nullptr);
        PngInfo found{static_cast<int>(png_get_image_width(png_, info_)),
                      static_cast<int>(png_get_image_height(png_, info_)),
                      {}};
        for (int i = 0; i < count; ++i) found.metadata[text[i].key] = text[i].text != nullptr ? text[i].text : "";
        return found;
    }

    Raster pixels() {
        if (!guarded(&PngDecoder::read_header)) fail();
        raster_.resize(static_cast<int>(png_get_image_width(png_, info_)),
                       static_cast<int>(png_get_image_height(png_, info_)));
        rows_.resize(static_cast<std::size_t>(raster_.height));
        for (std::size_t y = 0; y < rows_.size(); ++y)
            rows_[y] = raster_.rgba.data() + y * 4 * static_cast<std::size_t>(raster_.width);
        if (!guarded(&PngDecoder::read_pixels)) fail();
        return std::move(raster_);
    }

  private:
    [[noreturn]] void refuse(const std::string& what) const {
        throw IoError("cannot read " + file_.string() + ": " + what);
    }
    [[noreturn]] void fail() const {
        refuse(std::string("the picture is damaged or cut off (libpng: ") + reason_.data() +
               "); make or copy it again");
    }

    void require_picture() const {
        if (bytes_.empty()) refuse("the file is empty");
        if (!bytes_.starts_with(kSignature)) refuse("it is not a PNG file");
        if (bytes_.size() < 24) refuse("the picture is cut off after its first bytes; make or copy it again");
        const std::uint32_t width = big_endian(bytes_.data() + 16), height = big_endian(bytes_.data() + 20);
        if (width == 0 || height == 0)
            refuse("its size is " + std::to_string(width) + "x" + std::to_string(height) + " pixels");
        if (width > kLargestSide || height > kLargestSide)
            refuse(std::to_string(width) + "x" + std::to_string(height) + " pixels are more than the " +
                   std::to_string(kLargestSide) + "x" + std::to_string(kLargestSide) + " that beamcam handles");
    }

    bool guarded(void (PngDecoder::*step)()) {
        if (setjmp(png_jmpbuf(png_)) != 0) return false;
        (this->*step)();
        return true;
    }
    void read_header() { png_read_info(png_, info_); }
    void read_pixels() {
        png_set_expand(png_);    // palettes, fewer than 8 bits, transparent colours
        png_set_strip_16(png_);  // for callers that do not use FFmpeg
        png_set_gray_to_rgb(png_);
        png_set_add_alpha(png_, 0xff, PNG_FILLER_AFTER);
        png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        png_read_image(png_, rows_.data());
        png_read_end(png_, nullptr);  // the end must exist, too
    }

    static void on_error(png_structp png, png_const_charp what) {
        PngDecoder& self = *static_cast<PngDecoder*>(png_get_error_ptr(png));
        std::strncpy(self.reason_.data(), what, self.reason_.size() - 1);
        png_longjmp(png, 1);
    }
    static void on_warning(png_structp, png_const_charp) {}
    static void on_read(png_structp png, png_bytep to, std::size_t count) {
        PngDecoder& self = *static_cast<PngDecoder*>(png_get_io_ptr(png));
        if (count > self.bytes_.size() - self.at_) png_error(png, "the file ends too early");
        std::memcpy(to, self.bytes_.data() + self.at_, count);
        self.at_ += count;
    }

    fs::path file_;
    std::string bytes_;
    std::size_t at_ = 0;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    Raster raster_;
    std::vector<png_bytep> rows_;
    std::array<char, 128> reason_{};
};

}  // namespace

PngKind png_kind(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::array<char, 25> head{};
    in.read(head.data(), head.size());
    const std::string_view got(head.data(), static_cast<std::size_t>(in.gcount()));
    if (!got.starts_with(kSignature)) return PngKind::none;
    return got.size() == head.size() && got.back() == 16 ? PngKind::of_16_bits : PngKind::up_to_8_bits;
}

Raster read_png(const fs::path& file) { return PngDecoder(file, read_file(file)).pixels(); }

PngInfo read_png_info(const fs::path& file) { return PngDecoder(file, read_file(file)).info(); }

}  // namespace beamcam::output
