#include "output/data/netcdf/chunk_file.hpp"

#include <hdf5.h>
#include <libdeflate.h>

#include <cerrno>
#include <utility>

#include "output/files/errors.hpp"

namespace beamcam::output {
namespace {

constexpr int kLevel = 1;                       // higher levels take longer for a few per cent
constexpr std::size_t kCacheBytes = 4'000'000;  // of a variable that is written in blocks
constexpr std::size_t kCacheSlots = 521;        // as HDF5 has by default

static_assert(sizeof(hid_t) <= sizeof(std::int64_t) && sizeof(hsize_t) == sizeof(std::uint64_t));
std::vector<hsize_t> sizes(const Extent& extent) { return {extent.begin(), extent.end()}; }

// The shuffle filter of HDF5: the first bytes of all numbers, then the second bytes, and so on.
void shuffle(std::span<const double> numbers, unsigned char* out) {
    constexpr std::size_t kBytes = sizeof(double);
    const std::size_t count = numbers.size();
    const auto* from = reinterpret_cast<const unsigned char*>(numbers.data());
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t b = 0; b < kBytes; ++b) out[b * count + i] = from[i * kBytes + b];
}

bool is_shuffled_and_deflated(hid_t variable) {
    const hid_t properties = H5Dget_create_plist(variable);
    const auto filter = [&](unsigned index) {
        unsigned flags = 0, config = 0;
        std::size_t count = 0;
        return H5Pget_filter2(properties, index, &flags, &count, nullptr, 0, nullptr, &config);
    };
    const bool is =
        H5Pget_nfilters(properties) == 2 && filter(0) == H5Z_FILTER_SHUFFLE && filter(1) == H5Z_FILTER_DEFLATE;
    H5Pclose(properties);
    return is;
}

}  // namespace

void leave_files_at_exit() { H5dont_atexit(); }

ChunkFile::ChunkFile(const std::filesystem::path& file, std::filesystem::path named)
    : named_(std::move(named)), compressor_(libdeflate_alloc_compressor(kLevel), &libdeflate_free_compressor) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are thrown, not printed
    file_ = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    need(file_ >= 0 && compressor_);
}

ChunkFile::~ChunkFile() {
    for (const hid_t variable : variables_) H5Dclose(variable);
    if (file_ >= 0) H5Fclose(file_);
}

void ChunkFile::need(bool done) const {
    if (!done && errno != 0) throw write_error(named_, errno);
    if (!done) throw IoError(named_.string() + ": cannot be written");
}

std::size_t ChunkFile::variable(const std::string& name) {
    const hid_t access = H5Pcreate(H5P_DATASET_ACCESS);
    H5Pset_chunk_cache(access, kCacheSlots, kCacheBytes, 1);
    variables_.push_back(H5Dopen2(file_, name.c_str(), access));
    H5Pclose(access);
    need(variables_.back() >= 0);
    return variables_.size() - 1;
}

void ChunkFile::write_chunk(std::size_t variable, const Extent& at, std::span<const double> numbers) {
    if (shuffled_.size() != numbers.size_bytes()) {
        need(is_shuffled_and_deflated(variables_[variable]));
        shuffled_.resize(numbers.size_bytes());
        compressed_.resize(libdeflate_zlib_compress_bound(compressor_.get(), shuffled_.size()));
    }
    shuffle(numbers, shuffled_.data());
    const std::size_t size = libdeflate_zlib_compress(compressor_.get(), shuffled_.data(), shuffled_.size(),
                                                      compressed_.data(), compressed_.size());
    errno = 0;
    need(size > 0 &&
         H5Dwrite_chunk(variables_[variable], H5P_DEFAULT, 0, sizes(at).data(), size, compressed_.data()) >= 0);
}

void ChunkFile::write(std::size_t variable, const Extent& at, const Extent& size, const double* numbers) {
    write(variable, at, size, H5T_NATIVE_DOUBLE, numbers);
}
void ChunkFile::write(std::size_t variable, const Extent& at, const Extent& size, const int* numbers) {
    write(variable, at, size, H5T_NATIVE_INT, numbers);
}
void ChunkFile::write(std::size_t variable, const Extent& at, const Extent& size, const signed char* numbers) {
    write(variable, at, size, H5T_NATIVE_SCHAR, numbers);
}

void ChunkFile::write(std::size_t variable, const Extent& at, const Extent& size, Handle type, const void* numbers) {
    errno = 0;
    const hid_t in_file = H5Dget_space(variables_[variable]),
                in_memory = H5Screate_simple(static_cast<int>(size.size()), sizes(size).data(), nullptr);
    const bool done =
        H5Sselect_hyperslab(in_file, H5S_SELECT_SET, sizes(at).data(), nullptr, sizes(size).data(), nullptr) >= 0 &&
        H5Dwrite(variables_[variable], type, in_memory, in_file, H5P_DEFAULT, numbers) >= 0;
    H5Sclose(in_memory);
    H5Sclose(in_file);
    need(done);
}

void ChunkFile::close() {
    errno = 0;
    bool done = true;
    for (const hid_t variable : std::exchange(variables_, {})) done = H5Dclose(variable) >= 0 && done;
    done = H5Fclose(std::exchange(file_, -1)) >= 0 && done;
    need(done);
}

}  // namespace beamcam::output
