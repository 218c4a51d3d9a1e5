#include <glib.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>

#include "output/data/table_reader.hpp"
#include "output/files/numbers.hpp"
#include "output/json/source.hpp"
#include "output/json/tree.hpp"
#include "sim/problem/keys.hpp"
#include "sim/sweep/attractor.hpp"

namespace beamcam::output {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kSampledRows = 200;  // enough to recognize the separator
constexpr std::size_t kMostColumns = 10000;

constexpr char kSeparators[] = {'\t', ';', ',', ' '};  // the first one counts where several fit

constexpr std::string_view kMissing[] = {"", "na", "n/a", "nan", "null", "none", "-", "--", "?", "#n/a"};

// ---- encoding ----------------------------------------------------------------------------------

std::string converted(std::string_view bytes, const char* encoding, const std::string& file) {
    gsize size = 0;
    const std::unique_ptr<char, void (*)(void*)> text(
        g_convert(bytes.data(), static_cast<gssize>(bytes.size()), "UTF-8", encoding, nullptr, &size, nullptr), g_free);
    if (!text) throw IoError("cannot read " + file + ": it is not valid " + encoding + "; save it as UTF-8");
    return {text.get(), size};
}

// The encoding of a text that is not UTF-8. Latin text in UTF-16 has a zero byte in each character.
const char* other_encoding(std::string_view bytes) {
    if (bytes.starts_with("\xFF\xFE") || (bytes.size() > 1 && bytes[0] != 0 && bytes[1] == 0)) return "UTF-16LE";
    if (bytes.starts_with("\xFE\xFF") || (bytes.size() > 1 && bytes[0] == 0 && bytes[1] != 0)) return "UTF-16BE";
    return g_utf8_validate(bytes.data(), static_cast<gssize>(bytes.size()), nullptr) ? nullptr : "WINDOWS-1252";
}

// UTF-8 without a byte order mark, with lines that end in "\n".
std::string plain_text(std::string_view bytes, const std::string& file) {
    const char* encoding = other_encoding(bytes);
    std::string text = encoding ? converted(bytes, encoding, file) : std::string(bytes);
    if (text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
    if (text.find('\0') != text.npos)
        throw IoError("cannot read " + file + ": it contains zero bytes; save it as CSV in UTF-8");
    if (text.find('\n') == text.npos) std::ranges::replace(text, '\r', '\n');
    return text;
}

// ---- rows and cells ----------------------------------------------------------------------------

bool is_quoted(std::string_view cell) { return cell.size() > 1 && cell.front() == '"' && cell.back() == '"'; }

std::string unquoted(std::string_view cell) {
    if (!is_quoted(cell)) return std::string(cell);
    std::string text;
    for (std::size_t i = 1; i + 1 < cell.size(); i += cell[i] == '"' ? 2 : 1) text.push_back(cell[i]);  // "" is a quote
    return text;
}

struct Row {
    std::string_view text;                // without the end of the line
    std::size_t line = 0;                 // of the file, from 1
    std::vector<std::string_view> cells;  // trimmed, with their quotes

    bool is_blank() const { return trimmed(text).empty(); }
    bool is_comment() const {  // also the hint of Excel, "sep=;"
        return text.starts_with('#') || text.starts_with('%') || text.starts_with("sep=");
    }
    bool is_empty() const {
        return std::ranges::all_of(cells, [](std::string_view cell) { return cell.empty(); });
    }
};

// Splits a text into rows and cells. Separators and line breaks in quotes belong to their cell (RFC 4180).
class Rows {
  public:
    Rows(std::string_view text, char separator, std::size_t first_line = 1)
        : text_(text), separator_(separator), line_(first_line) {}

    bool next(Row& row) {
        if (at_ >= text_.size()) return false;
        const std::size_t end = end_of_row();
        row.text = text_.substr(at_, end - at_);
        row.line = line_;
        line_ += 1 + static_cast<std::size_t>(std::ranges::count(row.text, '\n'));
        at_ = end + 1;
        if (row.text.ends_with('\r')) row.text.remove_suffix(1);
        split(row);
        return true;
    }

  private:
    std::size_t end_of_row() const {
        std::size_t end = std::min(text_.find('\n', at_), text_.size());
        if (text_.substr(at_, end - at_).find('"') == text_.npos) return end;
        const char ends[] = {separator_, '\n'};
        for (std::size_t begin = at_;; begin = end + 1) {
            end = std::min(text_.find_first_of({ends, 2}, end_of_quotes(text_, begin)), text_.size());
            if (end == text_.size() || text_[end] == '\n') return end;
        }
    }

    void split(Row& row) const {
        row.cells.clear();
        for (std::size_t begin = 0;;) {
            if (separator_ == ' ') {  // several spaces are one separator
                begin = std::min(row.text.find_first_not_of(" \t\r", begin), row.text.size());
                if (begin == row.text.size() && !row.cells.empty()) return;
            }
            const std::size_t end =
                std::min(row.text.find(separator_, end_of_quotes(row.text, begin)), row.text.size());
            row.cells.push_back(trimmed(row.text.substr(begin, end - begin)));
            if (end == row.text.size()) return;
            begin = end + 1;
        }
    }

    // The end of the cell's part in quotes; `begin` if it has none.
    static std::size_t end_of_quotes(std::string_view text, std::size_t begin) {
        std::size_t at = std::min(text.find_first_not_of(' ', begin), text.size());
        if (at == text.size() || text[at] != '"') return begin;
        while ((at = text.find('"', at + 1)) != text.npos && text.substr(at + 1).starts_with('"')) ++at;
        return at == text.npos ? begin : at + 1;
    }

    std::string_view text_;
    char separator_;
    std::size_t at_ = 0, line_;
};

// The usual number of cells in a row, and how many of the first rows have it.
struct Width {
    std::size_t cells = 1, rows = 0;
};
Width usual_width(std::string_view text, char separator) {
    std::map<std::size_t, std::size_t> counts;
    Rows rows(text, separator);
    Row row;
    for (std::size_t i = 0; i < kSampledRows && rows.next(row); ++i)
        if (!row.is_blank() && !row.is_comment()) ++counts[row.cells.size()];
    Width usual;
    for (const auto& [cells, count] : counts)
        if (count >= usual.rows) usual = {cells, count};
    return usual;
}

// ---- cells as numbers --------------------------------------------------------------------------

struct Number {
    double value = kNothing;
    char decimal_sign = 0;  // '.', ',' or none
};

bool is_missing(std::string_view cell) {
    std::string lower(cell);
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return std::ranges::find(kMissing, lower) != std::end(kMissing);
}

// "1,5" is a number, too; nothing for a text.
std::optional<Number> number(std::string_view cell) {
    if (is_quoted(cell)) cell = trimmed(cell.substr(1, cell.size() - 2));
    const std::string_view digits = cell.starts_with('+') ? cell.substr(1) : cell;
    if (const auto value = number_in<double>(digits))
        return Number{*value, digits.find('.') == digits.npos ? char{} : '.'};
    if (is_missing(cell)) return Number{};
    if (std::ranges::count(digits, ',') != 1 || digits.find('.') != digits.npos) return std::nullopt;
    std::string with_point(digits);
    with_point[digits.find(',')] = '.';
    const auto value = number_in<double>(with_point);
    return value ? std::optional(Number{*value, ','}) : std::nullopt;
}

bool is_text(std::string_view cell) { return !number(cell); }
bool has_number(std::string_view cell) {
    const auto found = number(cell);
    return found && !std::isnan(found->value);
}

// The number of a class of motion, as in .npz.
std::optional<double> class_number(std::string_view cell) {
    for (const auto& each : sim::names(sim::AttractorClass{}))
        if (each.name == cell) return static_cast<double>(each.value);
    return std::nullopt;
}

// "[deg]" and "(deg)" → "deg".
std::string without_brackets(std::string text) {
    const bool bracketed =
        text.size() > 1 && ((text.front() == '[' && text.back() == ']') || (text.front() == '(' && text.back() == ')'));
    return bracketed ? text.substr(1, text.size() - 2) : text;
}

// The unit in the name of a column such as "angle [deg]" or "Time (ms)"; empty: there is none.
std::string unit_in(const std::string& name) {
    const std::size_t open = name.find_last_of("[(");
    if (open == name.npos || open == 0) return "";
    const std::string end = name.substr(open), inside = without_brackets(end);
    return inside == end ? "" : inside;
}

// ---- the table ---------------------------------------------------------------------------------

class CsvParser {
  public:
    CsvParser(std::string_view bytes, const std::string& file) : file_(file), text_(plain_text(bytes, file)) {}

    ColumnTable parse() {
        if (text_.find_first_not_of(" \t\r\n") == text_.npos)
            throw IoError("cannot read " + file_ + ": the file is empty");
        choose_separator();
        Rows rows(text_, separator_);
        find_names(rows);
        skip_units(rows);
        for (Row row; rows.next(row);)
            if (!is_skipped(row)) read_row(row);
        drop_empty_end();
        check_decimal_signs();
        return std::move(table_);
    }

  private:
    // A column of numbers while it is read.
    struct Signs {
        char sign = 0;           // the decimal sign of its first number with one
        std::string first = {};  // the place of that cell, and its text
    };

    std::string place_of(const Row& row, std::string_view cell) const {
        const LineColumn at = locate(row.text, static_cast<std::size_t>(cell.data() - row.text.data()));
        return file_ + ":" + std::to_string(row.line + at.line - 1) + ":" + std::to_string(at.column) + ": ";
    }
    [[noreturn]] void refuse(const Row& row, const std::string& what) const {
        throw IoError(place_of(row, row.text) + what);
    }

    void choose_separator() {
        Width best;
        for (const char each : kSeparators) {
            const Width width = usual_width(text_, each);
            if (width.cells < 2 || width.rows <= best.rows || (each == ' ' && best.rows > 0)) continue;
            best = width;
            separator_ = each;
        }
        width_ = best.cells;
    }

    // Blank lines and comments; in a table of one column a blank line is a missing value.
    bool is_skipped(const Row& row) const { return row.text.starts_with('#') || (row.is_blank() && width_ > 1); }

    // Reads the names of the columns; `rows` continues after them.
    void find_names(Rows& rows) {
        Row row, comment;
        bool skipped = false;
        for (Rows before = rows; rows.next(row); before = rows) {
            if (row.is_blank()) continue;
            if (row.is_comment()) {
                if (Row found = without_mark(row); found.cells.size() == width_ && !row.text.starts_with("sep="))
                    comment = std::move(found);
                continue;
            }
            if (row.cells.size() < width_) {
                skipped = true;
                continue;
            }
            const bool numbers = std::ranges::none_of(row.cells, is_text);
            if (numbers && !comment.cells.empty()) {  // "# t,theta"
                rows = before;
                return set_names(comment);
            }
            if (numbers || (skipped && std::ranges::any_of(row.cells, has_number)))
                refuse(row, "a number where the names of the columns should be; write a line with " +
                                std::to_string(width_) +
                                " names above; if numbers have decimal commas, separate the "
                                "columns by semicolons");
            return set_names(row);
        }
        if (comment.cells.empty()) throw IoError("cannot read " + file_ + ": it has no line with names of columns");
        set_names(comment);
    }
    Row without_mark(const Row& comment) const {
        Row row;
        Rows(comment.text.substr(1), separator_, comment.line).next(row);
        row.line = comment.line;
        return row;
    }
    void set_names(const Row& row) {
        width_ = row.cells.size();
        if (width_ > kMostColumns) refuse(row, "the table has more than " + std::to_string(kMostColumns) + " columns");
        std::map<std::string, std::size_t> known;
        for (const std::string_view cell : row.cells) {
            TableColumn column{unquoted(cell)};
            column.unit = unit_in(column.name);
            const auto [other, added] = known.emplace(column.name, table_.columns.size());
            if (!added)
                column.problem = table_.columns[other->second].problem = place_of(row, cell) + "the column " +
                                                                         in_quotes(column.name) +
                                                                         " occurs twice; give each its own name";
            table_.columns.push_back(std::move(column));
        }
        signs_.resize(width_);
    }

    // A line of texts between the names and rows with numbers in the same columns states units.
    void skip_units(Rows& rows) {
        Rows ahead = rows;
        Row units, first;
        const auto next = [&](Row& row) {
            while (ahead.next(row))
                if (!row.is_blank() && !row.is_comment()) return true;
            return false;
        };
        if (!next(units) || units.cells.size() != width_ || std::ranges::any_of(units.cells, has_number)) return;
        const Rows after = ahead;
        if (!next(first)) return;
        bool found = false;
        for (std::size_t c = 0; c < std::min(width_, first.cells.size()); ++c)
            found = found || (is_text(units.cells[c]) && has_number(first.cells[c]));
        if (!found) return;
        for (std::size_t c = 0; c < width_; ++c)
            if (is_text(units.cells[c])) table_.columns[c].unit = without_brackets(unquoted(units.cells[c]));
        rows = after;
    }

    void read_row(const Row& row) {
        const std::size_t count = row.cells.size();
        const bool fits =
            count == width_ || (count > width_ && std::all_of(row.cells.begin() + static_cast<std::ptrdiff_t>(width_),
                                                              row.cells.end(), [](auto cell) { return cell.empty(); }));
        if (!fits)
            refuse(row, "the number of cells is " + std::to_string(count) + " here, but " + std::to_string(width_) +
                            " in the header" +
                            (count < width_ ? "; the file may be cut off, or cells are missing"
                                            : "; put texts that contain the separator in quotes"));
        empty_end_ = row.is_empty() ? empty_end_ + 1 : 0;
        table_.lines.push_back(row.line);
        for (std::size_t c = 0; c < width_; ++c) read_cell(row, c);
    }

    void read_cell(const Row& row, std::size_t c) {
        TableColumn& column = table_.columns[c];
        const std::string_view cell = row.cells[c];
        std::optional<Number> found = number(cell);
        if (!found && column.name == "class")
            if (const auto value = class_number(unquoted(cell))) found = Number{*value};
        if (found && found->decimal_sign && !signs_[c].sign)
            signs_[c] = {found->decimal_sign, place_of(row, cell) + in_quotes(unquoted(cell))};
        const bool other_sign = found && found->decimal_sign && found->decimal_sign != signs_[c].sign;
        const bool infinite = found && std::isinf(found->value) && column.name != "exponent";  // −∞ is an exponent
        if (found && !other_sign && !infinite) return column.values.push_back(found->value);
        if (column.problem.empty())
            column.problem = place_of(row, cell) + in_quotes(unquoted(cell)) +
                             (other_sign ? " has another decimal sign than the numbers above"
                              : infinite ? " is not a finite number"
                                         : (cell.find(':') == cell.npos ? " is not a number; correct this cell"
                                                                        : " is not a number; write times in seconds"));
        column.texts.resize(column.values.size());
        column.texts.push_back(unquoted(cell));
        column.values.push_back(kNothing);
    }

    // Spreadsheets write rows without any value below the last one.
    void drop_empty_end() {
        const std::size_t rows = table_.lines.size() - empty_end_;
        table_.lines.resize(rows);
        for (TableColumn& column : table_.columns) column.values.resize(rows);
    }

    // Where one column has points, commas in another separate thousands or are a mistake.
    void check_decimal_signs() {
        const bool points = std::ranges::find(signs_, '.', &Signs::sign) != signs_.end();
        for (std::size_t c = 0; c < width_; ++c)
            if (points && signs_[c].sign == ',' && table_.columns[c].problem.empty())
                table_.columns[c].problem =
                    signs_[c].first + " has a decimal comma, but other columns have points; use one of them";
    }

    const std::string& file_;
    ColumnTable table_;
    const std::string text_;
    char separator_ = ',';
    std::size_t width_ = 1, empty_end_ = 0;  // cells in a row; rows without a value at the end
    std::vector<Signs> signs_;               // by column
};

}  // namespace

ColumnTable parse_csv(std::string_view bytes, const std::string& file_name) {
    return CsvParser(bytes, file_name).parse();
}

}  // namespace beamcam::output
