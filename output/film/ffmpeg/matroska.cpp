// The size of Matroska files, which FFmpeg does not check.
#include <cstdint>
#include <fstream>
#include <limits>
#include <optional>

#include "output/film/ffmpeg/library.hpp"

namespace beamcam::output::ffmpeg {
namespace {

// Reads a Matroska number of variable length: 1 to 8 bytes; the first byte states the length.
std::optional<std::uint64_t> read_number(std::istream& in, bool keep_marker) {
    const int first = in.get();
    if (first <= 0) return std::nullopt;
    int more = 0;
    while ((first & (0x80 >> more)) == 0) ++more;
    std::uint64_t value = static_cast<unsigned>(keep_marker ? first : first & (0x7f >> more));
    bool unknown = (first & (0x7f >> more)) == 0x7f >> more;  // all ones: unknown size
    for (int i = 0; i < more; ++i) {
        const int byte = in.get();
        if (byte < 0) return std::nullopt;
        unknown = unknown && byte == 0xff;
        value = value << 8 | static_cast<unsigned>(byte);
    }
    return unknown && !keep_marker ? std::numeric_limits<std::uint64_t>::max() : value;
}

}  // namespace

bool is_cut_matroska(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    constexpr std::uint64_t kHeader = 0x1A45DFA3, kSegment = 0x18538067;
    if (read_number(in, true) != kHeader) return false;
    const auto header = read_number(in, false);
    if (!header || *header > 4096) return false;
    in.seekg(static_cast<std::streamoff>(*header), std::ios::cur);
    if (read_number(in, true) != kSegment) return false;
    const auto size = read_number(in, false);
    if (!size || *size == std::numeric_limits<std::uint64_t>::max()) return false;
    const auto begin = static_cast<std::uint64_t>(in.tellg());
    std::error_code error;
    const auto actual = std::filesystem::file_size(file, error);
    return !error && actual - begin < *size;
}

}  // namespace beamcam::output::ffmpeg
