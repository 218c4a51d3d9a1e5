#include "output/data/tables.hpp"

#include <functional>
#include <string>
#include <vector>

#include "output/data/npz.hpp"
#include "output/files/atomic_file.hpp"
#include "output/files/numbers.hpp"

namespace beamcam::output {

namespace {

constexpr std::size_t kChunk = 1 << 16;  // [bytes] gathered before they are written

// Columns by name.
struct Columns {
    std::vector<std::string> names;
    const std::vector<std::vector<double>>& values;
    std::size_t rows() const { return values.empty() ? 0 : values.front().size(); }
};
Columns columns_of(const sim::Table& table) {
    std::vector<std::string> names;
    for (const sim::Channel& channel : table.channels) names.push_back(sim::name(channel));
    return {std::move(names), table.values};
}

void csv(const Columns& table, const std::function<void(const std::string&)>& write) {
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
        if (text.size() < kChunk) continue;
        write(text);
        text.clear();
    }
    write(text);
}

void write_csv(const Target& file, const Columns& table) {
    AtomicFile atomic(file);
    csv(table, [&atomic](const std::string& text) { atomic.write(text); });
    atomic.commit();
}

void write_npz(const Target& file, const Columns& table) {
    std::vector<NpzArray> arrays;
    for (std::size_t c = 0; c < table.names.size(); ++c)
        arrays.push_back({table.names[c], table.rows(),
                          [&table, c](const auto& put) { put(std::span(table.values[c].data(), table.rows())); }});
    write_npz(file, arrays);
}

void write_columns(const Target& file, const Columns& table) {
    const std::string ending = file.path.extension().string();
    if (ending == ".csv") return write_csv(file, table);
    if (ending == ".npz") return write_npz(file, table);
    throw UnsupportedOption("cannot write " + file.path.string() + ": tables end in .csv or .npz");
}

}  // namespace

void write_csv(std::ostream& out, const sim::Table& table) {
    csv(columns_of(table), [&out](const std::string& text) {
        if (!out.write(text.data(), static_cast<std::streamsize>(text.size())))
            throw IoError("cannot write the table: the output was closed or the disk is full");
    });
    if (!out.flush()) throw IoError("cannot write the table: the output was closed or the disk is full");
}

void write_csv(const Target& file, const sim::Table& table) { write_csv(file, columns_of(table)); }
void write_npz(const Target& file, const sim::Table& table) { write_npz(file, columns_of(table)); }
void write_table(const Target& file, const sim::Table& table) { write_columns(file, columns_of(table)); }
void write_table(const Target& file, const NamedTable& table) { write_columns(file, {table.names, table.columns}); }

}  // namespace beamcam::output
