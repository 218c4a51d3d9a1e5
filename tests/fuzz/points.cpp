// The reader of files of points: points that a sweep can have, or what is wrong. Check sums are mended first.
#include <libdeflate.h>

#include <cstring>
#include <filesystem>

#include "output/data/point_store.hpp"
#include "output/files/atomic_file.hpp"
#include "tests/fuzz/support.hpp"

namespace {

constexpr std::size_t kHeader = 80;  // [bytes] of a point, its checksum last

// Of the points behind the head, as long as their counts lead from one to the next.
void mend_check_sums(std::string& bytes, std::size_t at) {
    while (at + kHeader <= bytes.size()) {
        std::uint64_t counts[4];
        std::memcpy(counts, bytes.data() + at, sizeof counts);
        const std::uint64_t room = bytes.size() - at - kHeader;
        if (counts[1] > room / 8 || counts[2] > room / 8 || counts[3] > room) return;
        const std::uint64_t size = kHeader + 8 * (counts[1] + counts[2]) + counts[3];
        if (size > bytes.size() - at) return;
        std::uint64_t sum = 0;
        std::memcpy(bytes.data() + at + kHeader - 8, &sum, 8);
        sum = libdeflate_crc32(0, bytes.data() + at, size);
        std::memcpy(bytes.data() + at + kHeader - 8, &sum, 8);
        at += size;
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace beamcam;
    std::string bytes(fuzz::text_of(data, size));
    if (const std::size_t end = bytes.find('\n'); end != std::string::npos) mend_check_sums(bytes, end + 1);
    const std::filesystem::path file = std::filesystem::temp_directory_path() / "beamcam-fuzz.points";
    output::write_file(file, bytes, output::Durability::buffered);
    try {
        constexpr output::PointShape kShape{8, 3, 5};
        output::PointFile points(file);
        points.find_points(kShape);
        for (std::uint64_t k = 0; k < kShape.points; ++k) {
            if (!points.has(k)) continue;
            const output::StoredPoint point = points.read(k);
            fuzz::claim(point.point == k, "a point has its number");
            fuzz::claim(point.kind >= 0 && point.kind < kShape.classes, "a class exists");
            fuzz::claim(point.period >= 0, "a period is not negative");
            fuzz::claim(point.samples.size() == points.numbers(k) && point.samples.size() % kShape.columns == 0,
                        "samples are whole rows");
        }
    } catch (const output::IoError& error) {
        fuzz::claim(error.what()[0] != 0, "a refusal says why");
    }
    return 0;
}
