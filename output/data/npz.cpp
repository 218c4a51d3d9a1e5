#include "output/data/npz.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <string_view>

#include "output/files/numbers.hpp"

namespace beamcam::output {
namespace {

// ---- NPZ: https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html in PKWARE's APPNOTE ----------

constexpr std::uint64_t kLargestArchive = 0xffffffff;  // larger archives need 64-bit records
constexpr std::size_t kMostEntries = 0xffff;
constexpr std::size_t kNumbersAtOnce = 1 << 13;  // numbers of an array that are written together
static_assert(std::endian::native == std::endian::little, "NPZ is written in memory order");

// Magic, version 1.0, and a Python literal padded so that the data begin at a multiple of 64 bytes.
std::string npy_header(std::size_t rows) {
    std::string text = "{'descr': '<f8', 'fortran_order': False, 'shape': (" + std::to_string(rows) + ",), }";
    while ((10 + text.size() + 1) % 64 != 0) text += ' ';
    text += '\n';
    std::string header = "\x93NUMPY";
    append_bytes(header, 1, 1), append_bytes(header, 0, 1), append_bytes(header, text.size(), 2);
    return header + text;
}

constexpr std::size_t kLocalRecord = 30;  // [bytes] before the name

std::string end_record(std::size_t count, std::uint64_t size, std::uint64_t offset) {
    std::string record = "PK\x05\x06";
    append_bytes(record, 0, 2), append_bytes(record, 0, 2), append_bytes(record, count, 2),
        append_bytes(record, count, 2);
    append_bytes(record, size, 4), append_bytes(record, offset, 4), append_bytes(record, 0, 2);
    return record;
}

// Throws UnsupportedOption if the arrays are too large for zip.
const FileTarget& checked_target(const FileTarget& file, const std::vector<NpzArray>& arrays) {
    constexpr std::uint64_t per_entry = 512;  // records and header of one array, generously
    std::uint64_t total = 0, rows = 0;
    for (const NpzArray& array : arrays) {
        total += array.rows * sizeof(double) + per_entry;
        rows = std::max(rows, array.rows);
    }
    if (arrays.size() <= kMostEntries && total <= kLargestArchive) return file;
    throw UnsupportedOption("cannot write " + file.path.string() + ": a table of " + std::to_string(arrays.size()) +
                            " channels and " + std::to_string(rows) +
                            " rows is larger than the 4 GiB of an NPZ file; ask for fewer channels or a lower rate, or "
                            "write .csv");
}

}  // namespace

NpzFile::NpzFile(const FileTarget& file, const std::vector<NpzArray>& arrays) : atomic_(checked_target(file, arrays)) {
    std::uint64_t offset = 0;
    for (const NpzArray& array : arrays) {
        Member member{array.name + ".npy", npy_header(array.rows), 0, offset, 0, 0, {}};
        member.size = member.header.size() + array.rows * sizeof(double);
        member.crc = libdeflate_crc32(0, member.header.data(), member.header.size());
        offset += kLocalRecord + member.name.size() + member.size;
        members_.push_back(std::move(member));
    }
}

// The common part of the local and the central record of an array.
std::string NpzFile::common_record(const Member& member) {
    std::string record;
    append_bytes(record, 20, 2), append_bytes(record, 0, 2),
        append_bytes(record, 0, 2);                                   // needs zip 2.0, no flags, stored
    append_bytes(record, 0, 2), append_bytes(record, 1 << 5 | 1, 2);  // midnight, 1 January 1980: no clock in the bytes
    append_bytes(record, member.crc, 4), append_bytes(record, member.size, 4), append_bytes(record, member.size, 4);
    append_bytes(record, member.name.size(), 2), append_bytes(record, 0, 2);  // no extra field
    return record;
}

void NpzFile::append(std::size_t array, std::span<const double> numbers) {
    Member& member = members_[array];
    member.buffer.insert(member.buffer.end(), numbers.begin(), numbers.end());
    if (member.buffer.size() >= kNumbersAtOnce) flush(member);
}

void NpzFile::flush(Member& member) {
    if (member.buffer.empty()) return;
    const std::string_view bytes = bytes_of(member.buffer);
    member.crc = libdeflate_crc32(member.crc, bytes.data(), bytes.size());
    atomic_.write_at(member.offset + kLocalRecord + member.name.size() + member.header.size() + member.written, bytes);
    member.written += bytes.size();
    member.buffer.clear();
}

void NpzFile::commit() {
    std::uint64_t end = 0;
    std::string directory;
    for (Member& member : members_) {
        flush(member);
        if (member.header.size() + member.written != member.size)
            throw std::logic_error("NpzFile: " + member.name + ": wrong number of rows");
        const std::string common = common_record(member);
        atomic_.write_at(member.offset, "PK\x03\x04" + common + member.name + member.header);
        end = member.offset + kLocalRecord + member.name.size() + member.size;
        directory += "PK\x01\x02";
        append_bytes(directory, 20, 2);  // made by zip 2.0
        directory += common;
        append_bytes(directory, 0, 2), append_bytes(directory, 0, 2),
            append_bytes(directory, 0, 2);  // no comment, first disk, binary
        append_bytes(directory, 0, 4), append_bytes(directory, member.offset, 4);
        directory += member.name;
    }
    atomic_.write_at(end, directory + end_record(members_.size(), directory.size(), end));
    atomic_.commit();
}

}  // namespace beamcam::output
