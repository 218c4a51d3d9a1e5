#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <set>

#include "output/data/tables.hpp"
#include "output/files/inflate.hpp"
#include "output/files/numbers.hpp"
#include "sim/problem/keys.hpp"
#include "sim/sweep/attractor.hpp"

namespace beamcam::output {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

// ---- CSV ---------------------------------------------------------------------------------------

class CsvParser {
  public:
    CsvParser(std::string_view text, const std::string& file, Texts texts) : text_(text), file_(file), texts_(texts) {
        if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
    }

    ColumnTable parse() {
        std::string_view line;
        if (!next_line(line)) throw IoError("cannot read " + file_ + ": the file is empty");
        read_header(line);
        while (next_line(line)) {
            if (line.empty() && at_ >= text_.size()) break;
            read_row(line);
        }
        return std::move(table_);
    }

  private:
    // At this byte of the row, counted from 1; cells with line breaks may precede it.
    [[noreturn]] void refuse(std::size_t byte, const std::string& what) const {
        const std::string_view before = row_.substr(0, byte - 1);
        const auto breaks = static_cast<std::size_t>(std::ranges::count(before, '\n'));
        const std::size_t column = before.size() - (before.rfind('\n') + 1) + 1;  // npos + 1 is 0
        throw IoError(file_ + ":" + std::to_string(line_ + breaks) + ":" + std::to_string(column) + ": " + what);
    }

    bool next_line(std::string_view& line) {
        if (at_ >= text_.size()) return false;
        const std::size_t end = end_of_line();
        line_ += lines_;
        row_ = line = text_.substr(at_, end - at_);
        lines_ = 1 + static_cast<std::size_t>(std::ranges::count(line, '\n'));
        at_ = end + 1;
        if (line.ends_with('\r')) line.remove_suffix(1);
        return true;
    }

    // Line breaks in quotes belong to their cell (RFC 4180).
    std::size_t end_of_line() const {
        std::size_t end = std::min(text_.find('\n', at_), text_.size());
        if (text_.substr(at_, end - at_).find('"') == text_.npos) return end;
        for (std::size_t begin = at_;; begin = end + 1) {
            end = std::min(text_.find_first_of(",\n", end_of_quotes(text_, begin)), text_.size());
            if (end == text_.size() || text_[end] == '\n') break;
        }
        return end;
    }

    // Calls visit(cell, column of its first byte, number of the cell).
    template <typename Visit>
    static void for_cells(std::string_view line, Visit visit) {
        std::size_t begin = 0;
        for (std::size_t count = 0;; ++count) {
            const std::size_t end = std::min(line.find(',', end_of_quotes(line, begin)), line.size());
            std::string_view cell = line.substr(begin, end - begin);
            while (cell.starts_with(' ')) cell.remove_prefix(1);
            while (cell.ends_with(' ')) cell.remove_suffix(1);
            visit(cell, begin + 1, count);
            if (end == line.size()) return;
            begin = end + 1;
        }
    }

    // The end of the cell's part in quotes; `begin` if it has none.
    static std::size_t end_of_quotes(std::string_view line, std::size_t begin) {
        std::size_t at = std::min(line.find_first_not_of(' ', begin), line.size());
        if (at == line.size() || line[at] != '"') return begin;
        while ((at = line.find('"', at + 1)) != line.npos && line.substr(at + 1).starts_with('"')) ++at;
        return at == line.npos ? begin : at + 1;
    }

    static std::string unquoted(std::string_view cell) {
        if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return std::string(cell);
        std::string text;
        // A quote is written twice.
        for (std::size_t i = 1; i + 1 < cell.size(); i += cell[i] == '"' ? 2 : 1) text.push_back(cell[i]);
        return text;
    }

    void read_header(std::string_view line) {
        if (line.starts_with("# ")) line.remove_prefix(2);  // numpy.savetxt
        if (const std::size_t other = line.find_first_of(";\t"); other != line.npos && line.find(',') == line.npos)
            refuse(other + 1, std::string("columns are separated by ") + (line[other] == ';' ? "semicolons" : "tabs") +
                                  "; use commas, and a decimal point as in 0.5");
        for_cells(line, [&](std::string_view raw, std::size_t column, std::size_t) {
            const std::string cell = unquoted(raw);
            if (cell.empty()) refuse(column, "a column without a name in the header");
            if (number(cell)) refuse(column, in_quotes(cell) + " where the name of a column should be");
            if (!known_.emplace(cell).second)
                refuse(column, "the column " + in_quotes(cell) + " occurs twice in the header");
            table_.columns.push_back({cell});
        });
    }

    void read_row(std::string_view line) {
        std::size_t cells = 0;
        for_cells(line, [&](std::string_view raw, std::size_t column, std::size_t count) {
            cells = count + 1;
            if (count >= table_.columns.size()) return;
            const std::string cell = unquoted(raw);
            std::optional<double> value = cell.empty() ? kNothing : number(cell);
            if (!value && table_.columns[count].name == "class") value = class_number(cell);
            if (!value && texts_ == Texts::kept) {
                std::vector<std::string>& texts = table_.columns[count].texts;
                texts.resize(table_.columns[count].values.size());
                texts.push_back(cell);
                value = kNothing;
            }
            if (!value) refuse(column, in_quotes(cell) + " is not a number");
            if (std::isinf(*value) && table_.columns[count].name != "exponent")  // of a sweep: −∞ is a valid exponent
                refuse(column, in_quotes(cell) + " is not a finite number; leave cells without a value empty");
            table_.columns[count].values.push_back(*value);
        });
        if (cells != table_.columns.size())
            refuse(1, std::to_string(cells) + " cells in this row, but the header has " +
                          std::to_string(table_.columns.size()) + "; the file may be cut off");
    }

    static std::optional<double> number(std::string_view cell) {
        if (cell.starts_with('+')) cell.remove_prefix(1);
        return number_in<double>(cell);
    }

    // The number of a class of motion, as in .npz and .nc.
    static std::optional<double> class_number(std::string_view cell) {
        for (const auto& each : sim::names(sim::AttractorClass{}))
            if (each.name == cell) return static_cast<double>(each.value);
        return std::nullopt;
    }

    // Shortened, without control characters.
    static std::string in_quotes(std::string_view cell) {
        std::string text;
        text.push_back('"');
        for (const char c : cell.substr(0, 40)) text.push_back(c >= ' ' && c <= '~' ? c : '?');
        text.append(cell.size() > 40 ? "...\"" : "\"");
        return text;
    }

    std::string_view text_;
    const std::string& file_;
    Texts texts_;
    std::size_t at_ = 0, line_ = 0, lines_ = 1;  // of the file: the first of this row, their number in it
    std::string_view row_;
    ColumnTable table_;
    std::set<std::string> known_;  // its names
};

// ---- NPZ: PKWARE's APPNOTE, and https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html --------

static_assert(std::endian::native == std::endian::little, "NPZ is read in memory order");

class NpzParser {
  public:
    NpzParser(std::string_view bytes, const std::string& file)
        : bytes_(bytes), file_(file), inflater_(kLargestArchive), unread_(bytes.size()) {}

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
        if (offset == 0xffffffff || size >= kLargestArchive) refuse("archives above 4 GiB cannot be read");
        const std::size_t data = offset + 30 + value(offset + 26, 2) + value(offset + 28, 2);
        read_array(name, decompressed(name, part(data, packed), method, size, crc));
        return at + 46 + name_size + value(at + 30, 2) + value(at + 32, 2);
    }

    std::string decompressed(const std::string& name, std::string_view compressed, std::size_t method, std::size_t size,
                             std::size_t crc) {
        // Arrays that share bytes could expand without limit.
        if (compressed.size() > unread_) damaged();
        unread_ -= compressed.size();
        std::string data;
        if (method == 0) {
            data = compressed;
        } else if (method == 8) {
            auto plain = inflater_.deflate(compressed, size);
            if (!plain) damaged();
            data = std::move(*plain);
        } else {
            refuse("the array \"" + name + "\" has a compression method that numpy does not use");
        }
        if (data.size() != size || libdeflate_crc32(0, data.data(), data.size()) != crc) damaged();
        return data;
    }

    void read_array(const std::string& name, const std::string& npy) {
        const auto wrong = [&](const std::string& what) { refuse("the array \"" + name + "\" " + what); };
        if (!npy.starts_with("\x93NUMPY") || npy.size() < 12) wrong("is not in numpy's format");
        const bool old = npy[6] == 1;
        std::size_t header_size = 0;
        for (std::size_t i = 0; i < (old ? 2u : 4u); ++i)
            header_size |= std::size_t(static_cast<unsigned char>(npy[8 + i])) << (8 * i);
        const std::size_t begin = old ? 10 : 12;
        if (header_size > npy.size() - begin) wrong("is cut off");
        const std::string_view header(npy.data() + begin, header_size);
        const std::string_view data(npy.data() + begin + header_size, npy.size() - begin - header_size);

        std::vector<double> column;
        const std::string type = between(header, "'descr': '", "'");
        if (type == "<f8")
            column = numbers<double>(data);
        else if (type == "<f4")
            column = numbers<float>(data);
        else if (type == "<i8")
            column = numbers<std::int64_t>(data);
        else if (type == "<i4")
            column = numbers<std::int32_t>(data);
        else
            wrong("has elements of type \"" + type + "\"; only numbers (<f8, <f4, <i8, <i4) can be compared");
        const std::string shape = between(header, "'shape': (", ")");
        if (shape != std::to_string(column.size()) + "," && !(shape.empty() && column.size() == 1))
            wrong("has the shape (" + shape + "); a column has one dimension");
        if (!table_.columns.empty() && column.size() != table_.rows())
            wrong("has " + std::to_string(column.size()) + " rows, others have " + std::to_string(table_.rows()));
        if (!known_.insert(name).second) refuse("two arrays have the name \"" + name + "\"");
        table_.columns.push_back({name, {}, {}, std::move(column)});
    }

    static std::string between(std::string_view text, std::string_view before, std::string_view after) {
        const std::size_t found = text.find(before);
        if (found == std::string_view::npos) return {};
        const std::size_t begin = found + before.size();
        const std::size_t end = text.find(after, begin);
        return end == std::string_view::npos ? std::string() : std::string(text.substr(begin, end - begin));
    }

    template <typename Number>
    static std::vector<double> numbers(std::string_view data) {
        std::vector<double> column(data.size() / sizeof(Number));
        for (std::size_t i = 0; i < column.size(); ++i) {
            Number value;
            std::memcpy(&value, data.data() + i * sizeof value, sizeof value);
            column[i] = static_cast<double>(value);
        }
        return column;
    }

    static constexpr std::size_t kLargestArchive = 0xffffffff;  // [bytes], decompressed: the limit of the format

    std::string_view bytes_;
    const std::string& file_;
    Inflater inflater_;
    std::size_t unread_;  // bytes of the file that belong to no array yet
    ColumnTable table_;
    std::set<std::string> known_;  // its names
};

}  // namespace

ColumnTable parse_csv(std::string_view text, const std::string& file_name, Texts texts) {
    return CsvParser(text, file_name, texts).parse();
}
ColumnTable parse_npz(std::string_view bytes, const std::string& file_name) {
    return NpzParser(bytes, file_name).parse();
}

}  // namespace beamcam::output
