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

void csv(const sim::Table& table, const std::function<void(const std::string&)>& write) {
    std::string text;
    for (std::size_t c = 0; c < table.channels.size(); ++c) {
        if (c > 0) text += ',';
        text += sim::name(table.channels[c]);
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

}  // namespace

void write_csv(std::ostream& out, const sim::Table& table) {
    csv(table, [&out](const std::string& text) {
        if (!out.write(text.data(), static_cast<std::streamsize>(text.size())))
            throw IoError("cannot write the table: the output was closed or the disk is full");
    });
    if (!out.flush()) throw IoError("cannot write the table: the output was closed or the disk is full");
}

void write_csv(const Target& file, const sim::Table& table) {
    AtomicFile atomic(file);
    csv(table, [&atomic](const std::string& text) { atomic.write(text); });
    atomic.commit();
}

void write_npz(const Target& file, const sim::Table& table) {
    std::vector<NpzArray> arrays;
    for (std::size_t c = 0; c < table.channels.size(); ++c)
        arrays.push_back({sim::name(table.channels[c]), table.rows(),
                          [&table, c](const auto& put) { put(std::span(table.values[c].data(), table.rows())); }});
    write_npz(file, arrays);
}

void write_table(const Target& file, const sim::Table& table) {
    const std::string ending = file.path.extension().string();
    if (ending == ".csv") return write_csv(file, table);
    if (ending == ".npz") return write_npz(file, table);
    throw UnsupportedOption("cannot write " + file.path.string() + ": tables end in .csv or .npz");
}

}  // namespace beamcam::output
