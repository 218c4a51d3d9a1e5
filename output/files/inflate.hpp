// Compression by libdeflate. Decompression of the parts of an untrusted file within a total budget: a few bytes may
// claim to expand to gigabytes, and many parts may be the same bytes.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct libdeflate_decompressor;

namespace beamcam::output {

// A zlib stream. Higher levels, up to 12, take longer.
std::string zlib_compressed(std::string_view bytes, int level);

class Inflater {
  public:
    explicit Inflater(std::size_t budget);  // [bytes], of all decompressed data

    // A deflate stream of known size; nothing if it is damaged, has another size, or exceeds the budget.
    std::optional<std::string> deflate(std::string_view packed, std::size_t size);

  private:
    struct Free {
        void operator()(libdeflate_decompressor* decompressor) const;
    };
    std::unique_ptr<libdeflate_decompressor, Free> decompressor_;
    std::size_t budget_;
};

}  // namespace beamcam::output
