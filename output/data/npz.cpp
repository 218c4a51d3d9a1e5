#include "output/data/npz.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <string_view>

#include "output/files/atomic_file.hpp"

namespace beamcam::output {
namespace {

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

void refuse_what_zip_cannot_hold(const std::filesystem::path& file, const std::vector<NpzArray>& arrays) {
    constexpr std::uint64_t per_entry = 512;  // records and header of one array, generously
    std::uint64_t total = 0, rows = 0;
    for (const NpzArray& array : arrays) {
        total += array.rows * sizeof(double) + per_entry;
        rows = std::max(rows, array.rows);
    }
    if (arrays.size() <= kMostEntries && total <= kLargestArchive) return;
    throw UnsupportedOption("cannot write " + file.string() + ": a table of " + std::to_string(arrays.size()) +
                            " channels and " + std::to_string(rows) +
                            " rows is larger than the 4 GiB of an NPZ file; ask for fewer channels or a lower rate, or "
                            "write .csv");
}

std::string_view bytes_of(std::span<const double> numbers) {
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()};
}

}  // namespace

void write_npz(const Target& file, const std::vector<NpzArray>& arrays) {
    refuse_what_zip_cannot_hold(file.path, arrays);
    AtomicFile atomic(file);
    std::uint64_t offset = 0;
    std::string directory;
    for (const NpzArray& array : arrays) {
        const std::string header = npy_header(array.rows);
        ArchiveMember entry{array.name + ".npy", 0, header.size() + array.rows * sizeof(double), offset};
        entry.crc = libdeflate_crc32(0, header.data(), header.size());
        array.numbers([&entry](std::span<const double> piece) {
            if (!piece.empty()) entry.crc = libdeflate_crc32(entry.crc, piece.data(), piece.size_bytes());
        });
        const std::string record = local_record(entry);
        atomic.write(record);
        atomic.write(header);
        array.numbers([&atomic](std::span<const double> piece) { atomic.write(bytes_of(piece)); });
        offset += record.size() + entry.size;
        directory += central_record(entry);
    }
    atomic.write(directory);
    atomic.write(end_record(arrays.size(), directory.size(), offset));
    atomic.commit();
}

}  // namespace beamcam::output
