// The module: writes sweeps as NetCDF-4. https://docs.unidata.ucar.edu/netcdf-c, https://cfconventions.org
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hdf5.h>
#include <netcdf.h>
#include <stdlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <limits>
#include <numeric>

#include "output/data/netcdf_library.hpp"
#include "output/files/errors.hpp"
#include "render/base/modules.hpp"

namespace beamcam::output {
namespace {

constexpr std::size_t kChunk = 1 << 17;  // approximate size of a chunk in numbers: 1 MB
constexpr std::size_t kUneven = 4;       // a point is long if it has this multiple of the mean number of samples
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr int kMissing = -1;  // class, period and count of samples of a point that was not computed
constexpr signed char kMissingClass = kMissing;

using Extent = std::array<std::size_t, 4>;  // second axis, first axis, seeds, samples

class NcSweep {
  public:
    NcSweep(const std::filesystem::path& file, std::filesystem::path named, const SweepData& data)
        : named_(std::move(named)), data_(data), columns_(data.columns.size()) {
        const std::size_t first = data.axes[0].values.size(), points = data.points();
        extent_ = {points / data.seeds / first, first, data.seeds, std::max<std::size_t>(1, data.most_rows())};
        chunk_ = extent_;
        // Where a few points have many more samples than the others, a chunk holds a part of them, but all samples of
        // the others, so that little space is empty.
        const std::size_t usual = std::max<std::size_t>(1, kUneven * data.rows_in_all() / points), most = extent_[3];
        if (most > usual)
            chunk_[3] = static_cast<std::size_t>(std::sqrt(static_cast<double>(most) * static_cast<double>(usual)));
        std::size_t room = kChunk;
        for (std::size_t d = 4; d-- > 0; room /= chunk_[d]) chunk_[d] = std::clamp<std::size_t>(room, 1, chunk_[d]);
        errno = 0;
        need(nc_create(file.c_str(), NC_NETCDF4 | NC_CLOBBER, &file_));
    }
    ~NcSweep() {
        if (file_ >= 0) nc_close(file_);
    }
    NcSweep(const NcSweep&) = delete;
    NcSweep& operator=(const NcSweep&) = delete;

    void write() {
        define();
        for (std::size_t row = 0; row < extent_[0]; row += chunk_[0])
            for (std::size_t value = 0; value < extent_[1]; value += chunk_[1])
                for (std::size_t seed = 0; seed < extent_[2]; seed += chunk_[2]) write_block({row, value, seed, 0});
        need(nc_close(std::exchange(file_, -1)));
    }

  private:
    // HDF5 does not name the reason of its failure, but the system does.
    void need(int status) const {
        if (status == NC_EHDFERR && errno != 0) throw write_error(named_, errno);
        if (status != NC_NOERR)
            throw IoError(fmt::format("{}: cannot be written ({})", named_.string(), nc_strerror(status)));
    }

    void set(int variable, const std::string& attribute, const std::string& value) const {
        need(nc_put_att_text(file_, variable, attribute.c_str(), value.size(), value.c_str()));
    }
    // `fill`: the number in cells that are not written; null: all are.
    int variable(const std::string& name, int type, const std::vector<int>& dimensions, const std::string& unit,
                 const std::string& meaning, const void* fill = nullptr, bool compressed = false) const {
        int id = 0;
        need(nc_def_var(file_, name.c_str(), type, static_cast<int>(dimensions.size()), dimensions.data(), &id));
        set(id, "units", unit);
        set(id, "long_name", meaning);
        if (fill) need(nc_def_var_fill(file_, id, NC_FILL, fill));
        constexpr int kLevel = 1;  // higher levels take three times as long for a few per cent
        if (compressed) need(nc_def_var_deflate(file_, id, 1, 1, kLevel));
        return id;
    }

    // A dimension, and the variable with its values.
    int dimension(const std::string& name, const std::string& unit, const std::string& meaning,
                  const std::vector<double>& values) const {
        int id = 0;
        need(nc_def_dim(file_, name.c_str(), values.size(), &id));
        need(nc_put_var_double(file_, variable(name, NC_DOUBLE, {id}, unit, meaning), values.data()));
        return id;
    }
    int dimension(const std::string& name, const std::string& meaning, std::size_t size) const {
        std::vector<double> numbers(size);
        std::iota(numbers.begin(), numbers.end(), 0);
        return dimension(name, "1", meaning, numbers);
    }

    void define() {
        std::vector<int> point;
        for (std::size_t a = data_.axes.size(); a-- > 0;) {
            const SweepAxis& axis = data_.axes[a];
            point.push_back(dimension(axis.name, axis.unit, axis.name, axis.values));
        }
        point.push_back(dimension("seed", "Number of the start", data_.seeds));
        std::vector<int> all = point;
        all.push_back(dimension("sample", "Number of the sample", extent_[3]));
        class_ = variable("class", NC_BYTE, point, "1", "What the motion settles to", &kMissingClass, true);
        period_ = variable("period", NC_INT, point, "1", "Period in turns of the cam; 0: none", &kMissing, true);
        count_ = variable("sample_count", NC_INT, point, "1", "Samples of the point; -1: the point was not computed",
                          &kMissing, true);
        for (const PointNumber& number : kPointNumbers)
            numbers_.push_back(variable(number.name, NC_DOUBLE, point, number.unit, number.meaning, &kNoNumber, true));
        // zlib takes 1.5 s for 10⁶ rows of eight columns and makes the numbers of motions only a quarter smaller.
        const bool is_sparse = 2 * data_.rows_in_all() < data_.points() * extent_[3];
        for (std::size_t c = 0; c < columns_.size(); ++c) {
            const TableColumn& column = data_.columns[c];
            columns_[c] = variable(column.name, NC_DOUBLE, all, column.unit, column.meaning, &kNoNumber, is_sparse);
            need(nc_def_var_chunking(file_, columns_[c], NC_CHUNKED, dimensions_of(chunk_)));
        }
        name_classes();
        for (const auto& [name, value] : data_.attributes) set(NC_GLOBAL, name, value);
    }
    void name_classes() const {
        std::vector<signed char> values;
        for (std::size_t i = 0; i < data_.classes.size(); ++i) values.push_back(static_cast<signed char>(i));
        need(nc_put_att_schar(file_, class_, "flag_values", NC_BYTE, values.size(), values.data()));
        set(class_, "flag_meanings", fmt::format("{}", fmt::join(data_.classes, " ")));
    }

    // A sweep of one key has no dimension of the second axis.
    const std::size_t* dimensions_of(const Extent& extent) const {
        return extent.data() + (data_.axes.size() == 1 ? 1 : 0);
    }

    // The points of one chunk, which follow each other; those that were not computed stay empty.
    void write_block(Extent at) const {
        Extent size;
        for (std::size_t d = 0; d < 4; ++d) size[d] = std::min(chunk_[d], extent_[d] - at[d]);
        const std::size_t begin = (at[0] * extent_[1] + at[1]) * extent_[2] + at[2];
        std::vector<StoredPoint> points(size[0] * size[1] * size[2]);
        std::vector<signed char> kinds;
        std::vector<int> periods, counts;
        std::size_t most = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const bool here = data_.has(begin + i);
            if (here) points[i] = data_.read(begin + i);
            const std::size_t rows = points[i].samples.size() / columns_.size();
            kinds.push_back(here ? static_cast<signed char>(points[i].kind) : kMissingClass);
            periods.push_back(here ? points[i].period : kMissing);
            counts.push_back(here ? static_cast<int>(rows) : kMissing);
            most = std::max(most, rows);
        }
        const std::size_t *from = dimensions_of(at), *count = dimensions_of(size);
        need(nc_put_vara_schar(file_, class_, from, count, kinds.data()));
        need(nc_put_vara_int(file_, period_, from, count, periods.data()));
        need(nc_put_vara_int(file_, count_, from, count, counts.data()));
        std::vector<double> numbers(points.size());
        for (std::size_t n = 0; n < numbers_.size(); ++n) {
            for (std::size_t i = 0; i < points.size(); ++i) numbers[i] = points[i].*kPointNumbers[n].value;
            need(nc_put_vara_double(file_, numbers_[n], from, count, numbers.data()));
        }
        for (; at[3] < most; at[3] += chunk_[3]) {
            size[3] = std::min(chunk_[3], extent_[3] - at[3]);
            write_samples(at, size, points);
        }
    }

    // The samples from at[3] on of these points, as many as fit into a chunk.
    void write_samples(const Extent& at, const Extent& size, const std::vector<StoredPoint>& points) const {
        for (std::size_t c = 0; c < columns_.size(); ++c) {
            std::vector<double> numbers(points.size() * size[3], kNoNumber);
            for (std::size_t i = 0; i < points.size(); ++i) {
                const std::size_t end = std::min(points[i].samples.size() / columns_.size(), at[3] + size[3]);
                for (std::size_t row = at[3]; row < end; ++row)
                    numbers[i * size[3] + row - at[3]] = points[i].samples[row * columns_.size() + c];
            }
            need(nc_put_vara_double(file_, columns_[c], dimensions_of(at), dimensions_of(size), numbers.data()));
        }
    }

    const std::filesystem::path named_;
    const SweepData& data_;
    Extent extent_, chunk_;
    int file_ = -1;
    int class_ = 0, period_ = 0, count_ = 0;  // variables
    std::vector<int> numbers_, columns_;
};

class Library final : public NetcdfLibrary {
  public:
    // Before the first use of HDF5, which would refuse to open the file that AtomicFile holds locked, and which at exit
    // would close a file again that it could not write, and crash.
    Library() {
        setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);
        H5dont_atexit();
    }

    void write(const std::filesystem::path& file, const std::filesystem::path& named,
               const SweepData& data) const override {
        NcSweep(file, named, data).write();
    }
};

const Library library;

}  // namespace
}  // namespace beamcam::output

BEAMCAM_MODULE(static_cast<const beamcam::output::NetcdfLibrary&>(beamcam::output::library))
