#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <set>

#include "output/data/table_reader.hpp"
#include "output/files/numbers.hpp"
#include "output/json/source.hpp"

namespace beamcam::output {
namespace {

// ---- NPZ: PKWARE's APPNOTE, and https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html --------

static_assert(std::endian::native == std::endian::little, "NPZ is read in memory order");

using Wanted = std::function<bool(const std::string&)>;

constexpr std::size_t kLargestMember = 0xffffffff;           // [bytes]: the limit of the format
constexpr std::size_t kMostExpanded = std::size_t{1} << 28;  // [bytes] of all compressed arrays that are wanted
constexpr std::size_t kLargestRatio = 1100;                  // deflate compresses at most 1032 bytes into one

template <typename Number>
std::vector<double> numbers(std::string_view data) {
    std::vector<double> column(data.size() / sizeof(Number));
    for (std::size_t i = 0; i < column.size(); ++i) {
        Number value;
        std::memcpy(&value, data.data() + i * sizeof value, sizeof value);
        column[i] = static_cast<double>(value);
    }
    return column;
}

// The types of elements that are numbers, in numpy's notation.
struct Element {
    std::string_view type;
    std::size_t size;
    std::vector<double> (*numbers)(std::string_view data);
};
constexpr Element kElements[] = {{"<f8", 8, numbers<double>},        {"<f4", 4, numbers<float>},
                                 {"<i8", 8, numbers<std::int64_t>},  {"<i4", 4, numbers<std::int32_t>},
                                 {"<i2", 2, numbers<std::int16_t>},  {"|i1", 1, numbers<std::int8_t>},
                                 {"<u8", 8, numbers<std::uint64_t>}, {"<u4", 4, numbers<std::uint32_t>},
                                 {"<u2", 2, numbers<std::uint16_t>}, {"|u1", 1, numbers<std::uint8_t>}};

class NpzParser {
  public:
    NpzParser(std::string_view bytes, const std::string& file, const Wanted& wanted)
        : bytes_(bytes), file_(file), wanted_(wanted), unread_(bytes.size()) {}

    ColumnTable parse() {
        const std::size_t end = find_end();
        const std::size_t count = value(end + 10, 2);
        std::size_t at = value(end + 16, 4);
        for (std::size_t i = 0; i < count; ++i) at = read_entry(at);
        return std::move(table_);
    }

  private:
    [[noreturn]] void refuse(const std::string& what) const { throw IoError("cannot read " + file_ + ": " + what); }
    [[noreturn]] void damaged() const { refuse("the archive is damaged or cut off; make or copy it again"); }

    std::string_view part(std::size_t at, std::size_t size) const {
        if (at > bytes_.size() || size > bytes_.size() - at) damaged();
        return bytes_.substr(at, size);
    }
    std::size_t value(std::size_t at, std::size_t size) const {
        std::size_t number = 0;
        const std::string_view raw = part(at, size);
        for (std::size_t i = 0; i < size; ++i) number |= std::size_t(static_cast<unsigned char>(raw[i])) << (8 * i);
        return number;
    }

    std::size_t find_end() const {
        if (!bytes_.starts_with("PK")) refuse(bytes_.empty() ? "the file is empty" : "it is not an NPZ archive");
        const std::size_t found = bytes_.rfind("PK\x05\x06");
        if (found == std::string_view::npos || found + 22 > bytes_.size()) damaged();
        return found;
    }

    // Reads one record of the directory; returns the place of the next.
    std::size_t read_entry(std::size_t at) {
        if (part(at, 4) != "PK\x01\x02") damaged();
        const std::size_t method = value(at + 10, 2), crc = value(at + 16, 4), packed = value(at + 20, 4),
                          size = value(at + 24, 4), name_size = value(at + 28, 2), offset = value(at + 42, 4);
        std::string name(part(at + 46, name_size));
        if (name.ends_with(".npy")) name.resize(name.size() - 4);
        if (offset == 0xffffffff || size >= kLargestMember) refuse("archives above 4 GiB cannot be read");
        if (!known_.insert(name).second) refuse("two arrays have the name " + in_quotes(name));
        table_.columns.push_back({name});
        if (wanted_(name)) {
            const std::size_t data = offset + 30 + value(offset + 26, 2) + value(offset + 28, 2);
            read_array(table_.columns.back(), part(data, packed), method, size, crc);
        }
        return at + 46 + name_size + value(at + 30, 2) + value(at + 32, 2);
    }

    // Reads an array into its column; an array that is no column of numbers is the column's problem.
    void read_array(TableColumn& column, std::string_view packed, std::size_t method, std::size_t size,
                    std::size_t crc) {
        if (packed.size() > unread_) damaged();  // arrays that share bytes could expand without limit
        unread_ -= packed.size();
        if (method != 0 && method != 8)
            refuse("the array " + in_quotes(column.name) + " has a compression method that numpy does not use");
        const std::string plain = method == 8 ? expanded(packed, size) : std::string();
        const std::string_view data = method == 8 ? plain : packed;
        if (data.size() != size || libdeflate_crc32(0, data.data(), data.size()) != crc) damaged();
        if (const std::string wrong = values_of(data, column.values); !wrong.empty())
            column.problem = "cannot read " + file_ + ": the array " + in_quotes(column.name) + " " + wrong;
    }

    // An array of this size. A few bytes may claim to expand to gigabytes.
    std::string expanded(std::string_view packed, std::size_t size) {
        if (size > kMostExpanded - expanded_)
            refuse("the arrays expand to more than " + std::to_string(kMostExpanded >> 20) +
                   " MiB; write them without compression, by numpy.savez");
        if (size / kLargestRatio > packed.size()) damaged();
        const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> decompressor(
            libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
        if (!decompressor) throw std::bad_alloc();
        std::string plain(size, '\0');
        if (libdeflate_deflate_decompress(decompressor.get(), packed.data(), packed.size(), plain.data(), size,
                                          nullptr) != LIBDEFLATE_SUCCESS)
            damaged();
        expanded_ += size;
        return plain;
    }

    // Reads numpy's format. Returns what is wrong, or nothing.
    static std::string values_of(std::string_view npy, std::vector<double>& values) {
        if (!npy.starts_with("\x93NUMPY") || npy.size() < 12) return "is not in numpy's format";
        const bool old = npy[6] == 1;
        std::size_t header_size = 0;
        for (std::size_t i = 0; i < (old ? 2u : 4u); ++i)
            header_size |= std::size_t(static_cast<unsigned char>(npy[8 + i])) << (8 * i);
        const std::size_t begin = old ? 10 : 12;
        if (header_size > npy.size() - begin) return "is cut off";
        const std::string_view header = npy.substr(begin, header_size), data = npy.substr(begin + header_size);
        const std::string type = between(header, "'descr': '", "'"), shape = between(header, "'shape': (", ")");
        const auto known = std::ranges::find(kElements, type, &Element::type);
        if (known == std::end(kElements))
            return "has elements of type " + in_quotes(type) + "; only numbers are columns: write astype(float)";
        std::string length = shape.empty() ? "1" : shape;  // "(3,)", or "()" of a single number
        if (length.ends_with(',')) length.pop_back();
        const auto rows = number_in<std::uint64_t>(length);
        if (!rows) return "has the shape " + in_quotes("(" + shape + ")") + "; a column has one dimension";
        if (data.size() % known->size != 0 || data.size() / known->size != *rows)
            return "has another size than its shape";
        values = known->numbers(data);
        return "";
    }

    static std::string between(std::string_view text, std::string_view before, std::string_view after) {
        const std::size_t found = text.find(before);
        if (found == std::string_view::npos) return {};
        const std::size_t begin = found + before.size();
        const std::size_t end = text.find(after, begin);
        return end == std::string_view::npos ? std::string() : std::string(text.substr(begin, end - begin));
    }

    std::string_view bytes_;
    const std::string& file_;
    const Wanted& wanted_;
    std::size_t unread_;        // bytes of the file that belong to no array yet
    std::size_t expanded_ = 0;  // [bytes]
    ColumnTable table_;
    std::set<std::string> known_;  // its names
};

}  // namespace

ColumnTable parse_npz(std::string_view bytes, const std::string& file_name,
                      const std::function<bool(const std::string&)>& wanted) {
    return NpzParser(bytes, file_name, wanted).parse();
}

}  // namespace beamcam::output
