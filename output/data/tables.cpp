#include "output/data/tables.hpp"

#include <libdeflate.h>

#include <bit>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

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

// ---- NPZ: https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html in PKWARE's APPNOTE ----------

constexpr std::uint64_t kLargestArchive = 0xffffffff;  // beyond that zip needs 64-bit records
constexpr std::size_t kMostEntries = 0xffff;
static_assert(std::endian::native == std::endian::little, "NPZ is written in memory order");

void put(std::string& out, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) out.push_back(static_cast<char>(value >> (8 * i) & 0xff));
}

// Magic, version 1.0, and a Python literal padded so that the data begin at a multiple of 64 bytes.
std::string npy_header(std::size_t rows) {
    std::string text = "{'descr': '<f8', 'fortran_order': False, 'shape': (" + std::to_string(rows) + ",), }";
    while ((10 + text.size() + 1) % 64 != 0) text += ' ';
    text += '\n';
    std::string header = "\x93NUMPY";
    put(header, 1, 1), put(header, 0, 1), put(header, text.size(), 2);
    return header + text;
}

struct ArchiveMember {
    std::string name;
    std::uint32_t crc = 0;
    std::uint64_t size = 0, offset = 0;
};

// What the local and the central record of an entry have in common.
std::string common_record(const ArchiveMember& entry) {
    std::string record;
    put(record, 20, 2), put(record, 0, 2), put(record, 0, 2);  // needs zip 2.0, no flags, stored
    put(record, 0, 2), put(record, 1 << 5 | 1, 2);             // midnight, 1 January 1980: no clock in the bytes
    put(record, entry.crc, 4), put(record, entry.size, 4), put(record, entry.size, 4);
    put(record, entry.name.size(), 2), put(record, 0, 2);  // no extra field
    return record;
}

std::string local_record(const ArchiveMember& entry) { return "PK\x03\x04" + common_record(entry) + entry.name; }

std::string central_record(const ArchiveMember& entry) {
    std::string record = "PK\x01\x02";
    put(record, 20, 2);  // made by zip 2.0
    record += common_record(entry);
    put(record, 0, 2), put(record, 0, 2), put(record, 0, 2);  // no comment, first disk, binary
    put(record, 0, 4), put(record, entry.offset, 4);
    return record + entry.name;
}

std::string end_record(std::size_t count, std::uint64_t size, std::uint64_t offset) {
    std::string record = "PK\x05\x06";
    put(record, 0, 2), put(record, 0, 2), put(record, count, 2), put(record, count, 2);
    put(record, size, 4), put(record, offset, 4), put(record, 0, 2);
    return record;
}

void refuse_what_zip_cannot_hold(const std::filesystem::path& file, const sim::Table& table) {
    constexpr std::uint64_t per_entry = 512;  // records and header of one channel, generously
    const std::uint64_t columns = table.channels.size();
    const std::uint64_t total = columns * (table.rows() * sizeof(double) + per_entry);
    if (columns <= kMostEntries && total <= kLargestArchive) return;
    throw UnsupportedOption(
        "cannot write " + file.string() + ": a table of " + std::to_string(columns) + " channels and " +
        std::to_string(table.rows()) +
        " rows is larger than the 4 GiB of an NPZ file; ask for fewer channels or a lower rate, or write .csv");
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
    refuse_what_zip_cannot_hold(file.path, table);
    AtomicFile atomic(file);
    const std::string header = npy_header(table.rows());
    std::uint64_t offset = 0;
    std::string directory;
    for (std::size_t c = 0; c < table.channels.size(); ++c) {
        const std::string_view data(reinterpret_cast<const char*>(table.values[c].data()),
                                    table.rows() * sizeof(double));
        ArchiveMember entry{sim::name(table.channels[c]) + ".npy", 0, header.size() + data.size(), offset};
        entry.crc = libdeflate_crc32(0, header.data(), header.size());
        if (!data.empty()) entry.crc = libdeflate_crc32(entry.crc, data.data(), data.size());
        const std::string record = local_record(entry);
        for (std::string_view part : {std::string_view(record), std::string_view(header), data}) atomic.write(part);
        offset += record.size() + entry.size;
        directory += central_record(entry);
    }
    atomic.write(directory);
    atomic.write(end_record(table.channels.size(), directory.size(), offset));
    atomic.commit();
}

void write_table(const Target& file, const sim::Table& table) {
    const std::string ending = file.path.extension().string();
    if (ending == ".csv") return write_csv(file, table);
    if (ending == ".npz") return write_npz(file, table);
    throw UnsupportedOption("cannot write " + file.path.string() + ": tables end in .csv or .npz");
}

}  // namespace beamcam::output
