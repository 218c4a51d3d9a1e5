// Writes a sweep as NetCDF-4. https://cfconventions.org
#include <netcdf.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "output/data/netcdf/nc_file.hpp"

namespace beamcam::output {
namespace {

constexpr std::size_t kChunk = 1 << 17;  // approximate size of a chunk in numbers: 1 MB
constexpr std::size_t kUneven = 4;       // a point is long if it has this multiple of the mean number of samples

using Extent = std::array<std::size_t, 4>;  // second axis, first axis, seeds, samples

class SweepWriter {
  public:
    SweepWriter(const std::filesystem::path& file, std::filesystem::path named, const SweepData& data)
        : data_(data), file_(NcFile::create(file, std::move(named))) {
        const std::size_t first = data.axes[0].values.size(), points = data.points();
        const std::size_t most = std::max<std::size_t>(1, data.most_rows());
        extent_ = {points / data.seeds / first, first, data.seeds, most};
        chunk_ = extent_;
        // Where a few points have many more samples than the others, a chunk holds a part of them, but all samples of
        // the others, so that little space is empty.
        const std::size_t usual = std::max<std::size_t>(1, kUneven * data.rows_in_all() / points);
        if (most > usual)
            chunk_[3] = static_cast<std::size_t>(std::sqrt(static_cast<double>(most) * static_cast<double>(usual)));
        std::size_t room = kChunk;
        for (std::size_t d = 4; d-- > 0; room /= chunk_[d]) chunk_[d] = std::clamp<std::size_t>(room, 1, chunk_[d]);
    }

    void write() {
        define();
        file_->need(nc_enddef(file_->id));
        write_coordinates();
        for (std::size_t row = 0; row < extent_[0]; row += chunk_[0])
            for (std::size_t value = 0; value < extent_[1]; value += chunk_[1])
                for (std::size_t seed = 0; seed < extent_[2]; seed += chunk_[2]) write_block({row, value, seed, 0});
        file_->close();
    }

  private:
    int dimension(const std::string& name, std::size_t size) {
        int id = 0;
        file_->need(nc_def_dim(file_->id, name.c_str(), size, &id));
        return id;
    }
    // A sweep of one key has no dimension of the second axis.
    const std::size_t* dimensions_of(const Extent& extent) const {
        return extent.data() + (data_.axes.size() == 1 ? 1 : 0);
    }

    void define() {
        std::vector<int> point;
        for (std::size_t a = data_.axes.size(); a-- > 0;) {
            const SweepAxis& axis = data_.axes[a];
            point.push_back(dimension(axis.name, axis.values.size()));
            axes_.push_back(file_->define(axis.name, NC_DOUBLE, {point.back()}, axis.unit, axis.name));
        }
        std::ranges::reverse(axes_);
        point.push_back(dimension("seed", data_.seeds));
        seed_ = file_->define("seed", NC_INT, {point.back()}, "1", "Number of the start");
        std::vector<int> all = point;
        all.push_back(dimension("sample", extent_[3]));
        sample_ = file_->define("sample", NC_INT, {all.back()}, "1", "Number of the sample");
        class_ = file_->define_filled("class", NC_BYTE, point, "1", "What the motion settles to");
        period_ = file_->define_filled("period", NC_INT, point, "1", "Period in turns of the cam; 0: none");
        count_ = file_->define_filled("sample_count", NC_INT, point, "1",
                                      "Samples of the point; -1: the point was not computed");
        for (const PointNumber& number : kPointNumbers)
            numbers_.push_back(file_->define_filled(number.name, NC_DOUBLE, point, number.unit, number.meaning));
        for (const int variable : {class_, period_, count_}) file_->compress(variable);
        for (const int variable : numbers_) file_->compress(variable);
        // Columns are compressed only if most cells of the grid are empty: zlib takes 1.5 s for 10⁶ rows of eight
        // columns and makes the numbers of motions only a quarter smaller.
        const bool is_sparse = 2 * data_.rows_in_all() < data_.points() * extent_[3];
        for (const TableColumn& column : data_.columns) {
            columns_.push_back(file_->define_filled(column.name, NC_DOUBLE, all, column.unit, column.meaning));
            file_->need(nc_def_var_chunking(file_->id, columns_.back(), NC_CHUNKED, dimensions_of(chunk_)));
            if (is_sparse) file_->compress(columns_.back());
        }
        name_classes();
        for (const auto& [name, value] : data_.attributes) file_->set(NC_GLOBAL, name.c_str(), value);
    }
    void name_classes() {
        std::vector<signed char> values;
        std::string meanings;
        for (const std::string& name : data_.classes) {
            values.push_back(static_cast<signed char>(values.size()));
            meanings += (meanings.empty() ? "" : " ") + name;
        }
        file_->need(nc_put_att_schar(file_->id, class_, "flag_values", NC_BYTE, values.size(), values.data()));
        file_->set(class_, "flag_meanings", meanings);
    }

    void write_coordinates() {
        for (std::size_t a = 0; a < data_.axes.size(); ++a)
            file_->need(nc_put_var_double(file_->id, axes_[a], data_.axes[a].values.data()));
        for (const auto& [id, size] : {std::pair{seed_, extent_[2]}, std::pair{sample_, extent_[3]}}) {
            std::vector<int> numbers(size);
            for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<int>(i);
            file_->need(nc_put_var_int(file_->id, id, numbers.data()));
        }
    }

    // The points of one chunk; those that were not computed stay empty.
    void write_block(const Extent& at) const {
        Extent size;
        for (std::size_t d = 0; d < 4; ++d) size[d] = std::min(chunk_[d], extent_[d] - at[d]);
        std::vector<StoredPoint> points;
        for (std::size_t i = 0; i < size[0]; ++i)
            for (std::size_t j = 0; j < size[1]; ++j)
                for (std::size_t k = 0; k < size[2]; ++k) {
                    const std::size_t index = ((at[0] + i) * extent_[1] + at[1] + j) * extent_[2] + at[2] + k;
                    const bool here = data_.has(index);
                    points.push_back(here ? data_.read(index) : StoredPoint());
                    if (!here) points.back().kind = kMissingPoint;
                }
        write_points(at, size, points);
        std::size_t most = 0;
        for (const StoredPoint& p : points) most = std::max(most, p.samples.size() / columns_.size());
        for (Extent from = at; from[3] < most; from[3] += chunk_[3]) {
            size[3] = std::min(chunk_[3], extent_[3] - from[3]);
            write_samples(from, size, points);
        }
    }

    void write_points(const Extent& at, const Extent& size, const std::vector<StoredPoint>& points) const {
        std::vector<signed char> kinds;
        std::vector<int> periods, counts;
        for (const StoredPoint& p : points) {
            const bool here = p.kind != kMissingPoint;
            kinds.push_back(static_cast<signed char>(p.kind));
            periods.push_back(here ? p.period : kMissingPoint);
            counts.push_back(here ? static_cast<int>(p.samples.size() / columns_.size()) : kMissingPoint);
        }
        const std::size_t *from = dimensions_of(at), *count = dimensions_of(size);
        file_->need(nc_put_vara_schar(file_->id, class_, from, count, kinds.data()));
        file_->need(nc_put_vara_int(file_->id, period_, from, count, periods.data()));
        file_->need(nc_put_vara_int(file_->id, count_, from, count, counts.data()));
        for (std::size_t k = 0; k < numbers_.size(); ++k) {
            std::vector<double> numbers;
            for (const StoredPoint& p : points) numbers.push_back(p.*kPointNumbers[k].value);
            file_->need(nc_put_vara_double(file_->id, numbers_[k], from, count, numbers.data()));
        }
    }

    // The samples from `at[3]` on of these points, as many as fit into a chunk.
    void write_samples(const Extent& at, const Extent& size, const std::vector<StoredPoint>& points) const {
        const std::size_t width = columns_.size(), length = size[3];
        std::vector<double> numbers(points.size() * length);
        for (std::size_t c = 0; c < width; ++c) {
            std::ranges::fill(numbers, kNoNumber);
            for (std::size_t p = 0; p < points.size(); ++p) {
                const std::size_t rows = points[p].samples.size() / width;
                for (std::size_t row = at[3]; row < std::min(rows, at[3] + length); ++row)
                    numbers[p * length + row - at[3]] = points[p].samples[row * width + c];
            }
            file_->need(
                nc_put_vara_double(file_->id, columns_[c], dimensions_of(at), dimensions_of(size), numbers.data()));
        }
    }

    const SweepData& data_;
    std::shared_ptr<NcFile> file_;
    Extent extent_, chunk_;
    int class_ = 0, period_ = 0, count_ = 0, seed_ = 0, sample_ = 0;  // variables
    std::vector<int> axes_, numbers_, columns_;
};

}  // namespace

void write_nc_sweep(const std::filesystem::path& file, const std::filesystem::path& named, const SweepData& data) {
    SweepWriter(file, named, data).write();
}

}  // namespace beamcam::output
