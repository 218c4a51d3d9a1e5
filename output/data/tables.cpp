#include "output/data/tables.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "output/data/npz.hpp"
#include "output/files/atomic_file.hpp"
#include "output/files/numbers.hpp"

namespace beamcam::output {

namespace {

constexpr std::size_t kWrittenAtOnce = 1 << 16;  // [bytes] written at once

// Names and values of columns; the values belong to another object.
struct Columns {
    std::vector<std::string> names = {};
    std::vector<std::span<const double>> values = {};
    std::size_t rows() const { return values.empty() ? 0 : values.front().size(); }
};
Columns columns_of(const sim::Table& table) {
    Columns columns;
    for (const sim::Channel& channel : table.channels) columns.names.push_back(sim::name(channel));
    columns.values.assign(table.values.begin(), table.values.end());
    return columns;
}
Columns columns_of(const ColumnTable& table) {
    Columns columns{table.names()};
    for (const TableColumn& column : table.columns) columns.values.emplace_back(column.values);
    return columns;
}

void csv(const Columns& table, const TextSink& write) {
    std::string text;
    for (std::size_t c = 0; c < table.names.size(); ++c) {
        if (c > 0) text += ',';
        text += table.names[c];
    }
    text += '\n';
    for (std::size_t row = 0; row < table.rows(); ++row) {
        for (std::size_t c = 0; c < table.values.size(); ++c) {
            if (c > 0) text += ',';
            append_number(text, table.values[c][row]);
        }
        text += '\n';
        if (text.size() < kWrittenAtOnce) continue;
        write(text);
        text.clear();
    }
    write(text);
}

void write_csv(const FileTarget& file, const Columns& table) {
    AtomicFile atomic(file);
    csv(table, [&atomic](const std::string& text) { atomic.write(text); });
    atomic.commit();
}

void write_npz(const FileTarget& file, const Columns& table) {
    std::vector<NpzArray> arrays;
    for (const auto& name : table.names) arrays.push_back({std::string(name), table.rows()});
    NpzFile npz(file, arrays);
    for (std::size_t c = 0; c < arrays.size(); ++c) npz.append(c, table.values[c]);
    npz.commit();
}

void write_columns(const FileTarget& file, const Columns& table) {
    const std::string ending = file.path.extension().string();
    if (ending == ".csv") return write_csv(file, table);
    if (ending == ".npz") return write_npz(file, table);
    throw UnsupportedOption("cannot write " + file.path.string() + ": tables end in .csv or .npz");
}

}  // namespace

const TableColumn* ColumnTable::column(std::string_view name) const {
    const auto found = std::ranges::find(columns, name, &TableColumn::name);
    if (found != columns.end()) return &*found;
    const auto is_without_unit = [name](const TableColumn& c) {
        const std::string_view heading(c.name), bare = heading.substr(0, heading.find_last_of("[("));
        return !c.unit.empty() && bare.substr(0, bare.find_last_not_of(' ') + 1) == name;
    };
    const auto first = std::ranges::find_if(columns, is_without_unit);
    return std::ranges::count_if(columns, is_without_unit) == 1 ? &*first : nullptr;
}

const std::vector<double>* ColumnTable::find(std::string_view name) const {
    const TableColumn* found = column(name);
    if (found && !found->problem.empty()) throw IoError(found->problem);
    return found ? &found->values : nullptr;
}

std::string ColumnTable::row_name(std::size_t row) const {
    return row < lines.size() ? "line " + std::to_string(lines[row]) : "row " + std::to_string(row + 1);
}

std::vector<std::string> ColumnTable::names() const {
    std::vector<std::string> all;
    for (const TableColumn& column : columns) all.push_back(column.name);
    return all;
}

void write_csv(const TextSink& write, const sim::Table& table) { csv(columns_of(table), write); }

void write_table(const FileTarget& file, const sim::Table& table) { write_columns(file, columns_of(table)); }

void write_table(const FileTarget& file, const ColumnTable& table) { write_columns(file, columns_of(table)); }

}  // namespace beamcam::output
