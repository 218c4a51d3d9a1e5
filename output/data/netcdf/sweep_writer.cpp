// Writes a sweep as NetCDF-4: libnetcdf defines the variables, ChunkFile fills them. https://cfconventions.org
#include <netcdf.h>

#include <algorithm>
#include <cmath>

#include "output/data/netcdf/chunk_file.hpp"
#include "output/data/netcdf/nc_file.hpp"

namespace beamcam::output {
namespace {

constexpr std::uint64_t kChunk = 1 << 17;  // approximate size of a chunk in numbers: 1 MB
constexpr std::uint64_t kUneven = 4;       // a point is long if it has this multiple of the mean number of samples
constexpr std::uint64_t kUnevenShare = 8;  // divisor of the chunk size if there are long points

class SweepWriter {
  public:
    SweepWriter(const std::filesystem::path& file, std::filesystem::path named, const SweepData& data)
        : path_(file), data_(data), file_(NcFile::create(file, std::move(named))) {
        const std::uint64_t first = data.axes[0].values.size(), points = data.points();
        const std::uint64_t most = std::max<std::uint64_t>(1, data.most_rows());
        extent_ = {points / data.seeds / first, first, data.seeds, most};
        // A chunk contains whole points, and whole rows of the grid if they are small. If a few points have many more
        // samples than the others, chunks are smaller: they contain parts of the long points, but all of the short
        // ones, so that little space is empty.
        std::uint64_t room = kChunk;
        chunk_ = extent_;
        const std::uint64_t usual = std::max<std::uint64_t>(1, kUneven * data.rows_in_all() / points);
        if (most > usual) {
            room /= kUnevenShare;
            chunk_[3] = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(most) * static_cast<double>(usual)));
        }
        for (std::size_t d = 4; d-- > 0; room /= chunk_[d]) chunk_[d] = std::clamp<std::uint64_t>(room, 1, chunk_[d]);
    }

    void write() {
        define();
        need(nc_enddef(file_->id));
        coordinates();
        file_->close();
        ChunkFile chunks(path_, file_->named);
        open_variables(chunks);
        for (std::uint64_t row = 0; row < extent_[0]; row += chunk_[0])
            for (std::uint64_t value = 0; value < extent_[1]; value += chunk_[1])
                for (std::uint64_t seed = 0; seed < extent_[2]; seed += chunk_[2]) block(chunks, {row, value, seed});
        chunks.close();
    }

  private:
    void need(int status) const { file_->need_written(status); }

    int dimension(const std::string& name, std::uint64_t size) {
        int id = 0;
        need(nc_def_dim(file_->id, name.c_str(), size, &id));
        return id;
    }
    int variable(const std::string& name, nc_type type, const std::vector<int>& dimensions, const std::string& unit,
                 const std::string& meaning) {
        int id = 0;
        need(nc_def_var(file_->id, name.c_str(), type, static_cast<int>(dimensions.size()), dimensions.data(), &id));
        if (!unit.empty()) file_->set(id, "units", udunits(unit));
        if (!meaning.empty()) file_->set(id, "long_name", meaning);
        return id;
    }
    // Without the dimension of the second axis if there is only one axis.
    template <class Numbers>
    Numbers dimensions_of(Numbers numbers) const {
        if (data_.axes.size() == 1) numbers.erase(numbers.begin());
        return numbers;
    }
    void compress(int id, std::vector<std::size_t> chunk) {
        chunk = dimensions_of(std::move(chunk));
        need(nc_def_var_chunking(file_->id, id, NC_CHUNKED, chunk.data()));
        need(nc_def_var_deflate(file_->id, id, 1, 1, kDeflate));
    }

    void define() {
        std::vector<int> point;
        for (std::size_t a = data_.axes.size(); a-- > 0;) {
            const SweepAxis& axis = data_.axes[a];
            point.push_back(dimension(axis.name, axis.values.size()));
            axes_.push_back(variable(axis.name, NC_DOUBLE, {point.back()}, axis.unit, axis.name));
        }
        std::ranges::reverse(axes_);
        point.push_back(dimension("seed", data_.seeds));
        seed_ = variable("seed", NC_INT, {point.back()}, "1", "Number of the start");
        std::vector<int> all = point;
        all.push_back(dimension("sample", extent_[3]));
        sample_ = variable("sample", NC_INT, {all.back()}, "1", "Number of the sample");
        define_points(point);
        for (const TableColumn& column : data_.columns) {
            const int id = variable(column.name, NC_DOUBLE, all, column.unit, column.meaning);
            need(nc_def_var_fill(file_->id, id, NC_FILL, &kNoNumber));
            compress(id, {chunk_.begin(), chunk_.end()});
        }
        for (const auto& [name, value] : data_.attributes) file_->set(NC_GLOBAL, name.c_str(), value);
    }
    void define_points(const std::vector<int>& point) {
        const int kind = variable("class", NC_BYTE, point, "1", "What the motion settles to");
        const signed char missing = kMissingPoint;
        need(nc_def_var_fill(file_->id, kind, NC_FILL, &missing));
        std::vector<signed char> values;
        std::string meanings;
        for (const std::string& name : data_.classes) {
            values.push_back(static_cast<signed char>(values.size()));
            meanings += (meanings.empty() ? "" : " ") + name;
        }
        need(nc_put_att_schar(file_->id, kind, "flag_values", NC_BYTE, values.size(), values.data()));
        file_->set(kind, "flag_meanings", meanings);
        std::vector<int> all{
            kind, variable("period", NC_INT, point, "1", "Period in turns of the cam; 0: none"),
            variable("sample_count", NC_INT, point, "1", "Samples of the point; -1: not in this file")};
        for (const int id : {all[1], all[2]}) need(nc_def_var_fill(file_->id, id, NC_FILL, &kMissingPoint));
        for (const PointNumber& number : kPointNumbers) {
            all.push_back(variable(number.name, NC_DOUBLE, point, number.unit, number.meaning));
            need(nc_def_var_fill(file_->id, all.back(), NC_FILL, &kNoNumber));
        }
        std::vector<std::size_t> chunk(3);
        std::uint64_t room = kChunk;
        for (std::size_t d = 3; d-- > 0; room /= chunk[d]) chunk[d] = std::clamp<std::uint64_t>(room, 1, extent_[d]);
        for (const int id : all) compress(id, chunk);
    }

    void coordinates() {
        for (std::size_t a = 0; a < data_.axes.size(); ++a)
            need(nc_put_var_double(file_->id, axes_[a], data_.axes[a].values.data()));
        for (const auto& [id, size] : {std::pair{seed_, extent_[2]}, std::pair{sample_, extent_[3]}}) {
            std::vector<int> numbers(size);
            for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<int>(i);
            need(nc_put_var_int(file_->id, id, numbers.data()));
        }
    }

    void open_variables(ChunkFile& chunks) {
        class_ = chunks.variable("class");
        period_ = chunks.variable("period");
        count_ = chunks.variable("sample_count");
        for (const PointNumber& number : kPointNumbers) numbers_.push_back(chunks.variable(number.name));
        for (const TableColumn& column : data_.columns) columns_.push_back(chunks.variable(column.name));
    }

    // The points of one chunk; points that this file does not contain are empty.
    void block(ChunkFile& chunks, const Extent& at) const {
        Extent size(3);
        for (std::size_t d = 0; d < 3; ++d) size[d] = std::min(chunk_[d], extent_[d] - at[d]);
        std::vector<StoredPoint> points;
        bool any = false;
        for (std::uint64_t i = 0; i < size[0]; ++i)
            for (std::uint64_t j = 0; j < size[1]; ++j)
                for (std::uint64_t k = 0; k < size[2]; ++k) {
                    const std::uint64_t index = ((at[0] + i) * extent_[1] + at[1] + j) * extent_[2] + at[2] + k;
                    const bool here = data_.has(index);
                    points.push_back(here ? data_.read(index) : StoredPoint());
                    if (!here) points.back().kind = kMissingPoint;
                    any = any || here;
                }
        if (!any) return;
        write_points(chunks, dimensions_of(at), dimensions_of(size), points);
        write_samples(chunks, at, size, points);
    }

    void write_points(ChunkFile& chunks, const Extent& at, const Extent& size,
                      const std::vector<StoredPoint>& points) const {
        std::vector<signed char> kinds;
        std::vector<int> periods, counts;
        std::vector<double> numbers[std::size(kPointNumbers)];
        for (const StoredPoint& p : points) {
            const bool here = p.kind != kMissingPoint;
            kinds.push_back(static_cast<signed char>(p.kind));
            periods.push_back(here ? p.period : kMissingPoint);
            counts.push_back(here ? static_cast<int>(p.samples.size() / columns_.size()) : kMissingPoint);
            for (std::size_t k = 0; k < std::size(kPointNumbers); ++k) numbers[k].push_back(p.*kPointNumbers[k].value);
        }
        chunks.write(class_, at, size, kinds.data());
        chunks.write(period_, at, size, periods.data());
        chunks.write(count_, at, size, counts.data());
        for (std::size_t k = 0; k < numbers_.size(); ++k) chunks.write(numbers_[k], at, size, numbers[k].data());
    }

    void write_samples(ChunkFile& chunks, const Extent& at, const Extent& size,
                       const std::vector<StoredPoint>& points) const {
        const std::size_t width = columns_.size(), length = chunk_[3];
        std::size_t most = 0;
        for (const StoredPoint& p : points) most = std::max(most, p.samples.size() / width);
        std::vector<double> numbers(chunk_[0] * chunk_[1] * chunk_[2] * length);
        for (std::size_t first = 0; first < most; first += length)
            for (std::size_t c = 0; c < width; ++c) {
                std::ranges::fill(numbers, kNoNumber);
                for (std::size_t p = 0; p < points.size(); ++p) {
                    const std::size_t k = p % size[2], j = p / size[2] % size[1], i = p / size[2] / size[1];
                    double* out = &numbers[((i * chunk_[1] + j) * chunk_[2] + k) * length];
                    const std::vector<double>& samples = points[p].samples;
                    const std::size_t rows = samples.size() / width;
                    for (std::size_t row = first; row < std::min(rows, first + length); ++row)
                        *out++ = samples[row * width + c];
                }
                chunks.write_chunk(columns_[c], dimensions_of(Extent{at[0], at[1], at[2], first}), numbers);
            }
    }

    const std::filesystem::path& path_;
    const SweepData& data_;
    std::shared_ptr<NcFile> file_;
    Extent extent_, chunk_;  // second axis, first axis, seeds, samples
    std::vector<int> axes_;
    int seed_ = 0, sample_ = 0;
    std::vector<std::size_t> numbers_, columns_;  // of ChunkFile
    std::size_t class_ = 0, period_ = 0, count_ = 0;
};

}  // namespace

void write_nc_sweep(const std::filesystem::path& file, const std::filesystem::path& named, const SweepData& data) {
    SweepWriter(file, named, data).write();
}

}  // namespace beamcam::output
