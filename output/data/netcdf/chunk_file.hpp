// Fills the variables of a NetCDF-4 file, which libnetcdf has defined and closed, through HDF5. libdeflate compresses
// whole chunks in a third of the time of HDF5's filter. https://docs.hdfgroup.org/hdf5/v1_14/group___h5_d.html
// (H5Dwrite_chunk)
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct libdeflate_compressor;

namespace beamcam::output {

// [numbers] along each dimension of a variable.
using Extent = std::vector<std::uint64_t>;

// At exit HDF5 would close a file again that it could not write, and crash. Called before any other use of HDF5.
void leave_files_at_exit();

class ChunkFile {
  public:
    // Messages call the file `named`. All functions throw IoError.
    ChunkFile(const std::filesystem::path& file, std::filesystem::path named);
    ~ChunkFile();
    ChunkFile(const ChunkFile&) = delete;
    ChunkFile& operator=(const ChunkFile&) = delete;

    std::size_t variable(const std::string& name);  // returns its number for the functions below
    // A whole chunk of a variable of doubles with the filters shuffle and deflate; `at`: its first number.
    void write_chunk(std::size_t variable, const Extent& at, std::span<const double> numbers);
    // Any block, through the cache of the variable.
    void write(std::size_t variable, const Extent& at, const Extent& size, const double* numbers);
    void write(std::size_t variable, const Extent& at, const Extent& size, const int* numbers);
    void write(std::size_t variable, const Extent& at, const Extent& size, const signed char* numbers);
    void close();

  private:
    using Handle = std::int64_t;  // hid_t of HDF5

    void need(bool done) const;
    void write(std::size_t variable, const Extent& at, const Extent& size, Handle type, const void* numbers);

    std::filesystem::path named_;
    Handle file_ = -1;
    std::vector<Handle> variables_;
    std::vector<unsigned char> shuffled_, compressed_;
    std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor_;
};

}  // namespace beamcam::output
