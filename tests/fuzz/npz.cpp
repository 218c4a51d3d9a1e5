// The reader of NPZ archives: columns of numbers, or what is wrong. Check sums are mended first, as a fuzzer would
// hardly ever guess one.
#include <libdeflate.h>

#include "output/data/table_reader.hpp"
#include "tests/fuzz/support.hpp"

namespace {

// Of every stored (not packed) member that the directory names.
void mend_check_sums(std::string& bytes) {
    const auto value = [&](std::size_t at, std::size_t size) {
        std::size_t number = 0;
        for (std::size_t i = 0; i < size; ++i)
            number |= std::size_t(static_cast<unsigned char>(bytes[at + i])) << 8 * i;
        return number;
    };
    for (std::size_t at = 0; (at = bytes.find("PK\x01\x02", at)) != std::string::npos && at + 46 <= bytes.size();
         ++at) {
        const std::size_t size = value(at + 20, 4), offset = value(at + 42, 4);
        if (value(at + 10, 2) != 0 || offset + 30 > bytes.size()) continue;
        const std::size_t begin = offset + 30 + value(offset + 26, 2) + value(offset + 28, 2);
        if (begin > bytes.size() || size > bytes.size() - begin) continue;
        const std::size_t sum = libdeflate_crc32(0, bytes.data() + begin, size);
        for (std::size_t i = 0; i < 4; ++i) bytes[at + 16 + i] = static_cast<char>(sum >> 8 * i);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace beamcam;
    std::string bytes(fuzz::text_of(data, size));
    mend_check_sums(bytes);
    try {
        const output::ColumnTable table = output::parse_npz(bytes, "fuzz.npz", [](const std::string&) { return true; });
        for (const auto& column : table.columns)
            fuzz::claim(column.values.size() <= bytes.size() * 1100, "a column is no longer than its bytes allow");
    } catch (const output::IoError& error) {
        fuzz::claim(error.what()[0] != 0, "a refusal says why");
    }
    return 0;
}
