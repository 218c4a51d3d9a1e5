// Sweeps and tables as NetCDF-4 files. https://docs.unidata.ucar.edu/netcdf-c, https://cfconventions.org
#include <fmt/format.h>
#include <netcdf.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "output/data/netcdf/chunk_file.hpp"
#include "output/data/netcdf_library.hpp"
#include "render/base/modules.hpp"

namespace beamcam::output {
namespace {

constexpr std::uint64_t kChunk = 1 << 17;  // approximate size of a chunk in numbers: 1 MB
constexpr std::uint64_t kUneven = 4;       // a point is long if it has this multiple of the mean number of samples
constexpr std::uint64_t kUnevenShare = 8;  // divisor of the chunk size if there are long points
constexpr int kDeflate = 1;                // higher levels take three times as long for a few per cent
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr int kMissing = -1;  // class and sample count of a point that this file does not contain

class File {
  public:
    // Modes of nc_create and nc_open.
    static std::shared_ptr<File> create(const std::filesystem::path& file, const std::filesystem::path& named) {
        auto made = std::make_shared<File>(named);
        made->need(nc_create(file.c_str(), NC_NETCDF4 | NC_CLOBBER, &made->id), "cannot be created");
        return made;
    }
    static std::shared_ptr<File> open(const std::filesystem::path& file) {
        auto found = std::make_shared<File>(file);
        found->need(nc_open(file.c_str(), NC_NOWRITE, &found->id), "cannot be read");
        return found;
    }
    explicit File(std::filesystem::path file) : named(std::move(file)) {}
    ~File() {
        if (id >= 0) nc_close(id);
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;

    void close() {
        const int closed = nc_close(id);
        id = -1;
        need(closed, "cannot be written");
    }
    void need(int status, const char* what = "is not a sweep of beamcam") const {
        if (status != NC_NOERR) throw IoError(fmt::format("{}: {} ({})", named.string(), what, nc_strerror(status)));
    }
    int variable(const std::string& name) const {
        int found = -1;
        need(nc_inq_varid(id, name.c_str(), &found));
        return found;
    }
    std::string text(int variable, const char* attribute) const {
        std::size_t size = 0;
        if (nc_inq_attlen(id, variable, attribute, &size) != NC_NOERR) return "";
        std::string out(size, '\0');
        need(nc_get_att_text(id, variable, attribute, out.data()));
        return out;
    }
    void set(int variable, const char* attribute, const std::string& value) const {
        need(nc_put_att_text(id, variable, attribute, value.size(), value.c_str()), "cannot be written");
    }

    std::filesystem::path named;
    int id = -1;
};

std::string udunits(const std::string& unit) {
    if (unit == "rad/s") return "rad s-1";
    if (unit == "m/s") return "m s-1";
    return unit;
}

std::string from_udunits(const std::string& unit) {
    for (const char* ours : {"rad/s", "m/s"})
        if (udunits(ours) == unit) return ours;
    return unit;
}

// A sweep's variables: libnetcdf defines them, ChunkFile fills them.
class Writer {
  public:
    Writer(const std::filesystem::path& file, std::filesystem::path named, const SweepData& data)
        : path_(file), data_(data), file_(File::create(file, std::move(named))) {
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
    void need(int status) const { file_->need(status, "cannot be written"); }

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
            need(nc_def_var_fill(file_->id, id, NC_FILL, &kNone));
            compress(id, {chunk_.begin(), chunk_.end()});
        }
        for (const auto& [name, value] : data_.attributes) file_->set(NC_GLOBAL, name.c_str(), value);
    }
    void define_points(const std::vector<int>& point) {
        const int kind = variable("class", NC_BYTE, point, "1", "What the motion settles to");
        const signed char missing = kMissing;
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
        for (const int id : {all[1], all[2]}) need(nc_def_var_fill(file_->id, id, NC_FILL, &kMissing));
        for (const PointNumber& number : kPointNumbers) {
            all.push_back(variable(number.name, NC_DOUBLE, point, number.unit, number.meaning));
            need(nc_def_var_fill(file_->id, all.back(), NC_FILL, &kNone));
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
                    if (!here) points.back().kind = kMissing;
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
            const bool here = p.kind != kMissing;
            kinds.push_back(static_cast<signed char>(p.kind));
            periods.push_back(here ? p.period : kMissing);
            counts.push_back(here ? static_cast<int>(p.samples.size() / columns_.size()) : kMissing);
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
                std::ranges::fill(numbers, kNone);
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
    std::shared_ptr<File> file_;
    Extent extent_, chunk_;  // second axis, first axis, seeds, samples
    std::vector<int> axes_;
    int seed_ = 0, sample_ = 0;
    std::vector<std::size_t> numbers_, columns_;  // of ChunkFile
    std::size_t class_ = 0, period_ = 0, count_ = 0;
};

void write_columns(const File& file, const ColumnTable& table) {
    const auto need = [&file](int status) { file.need(status, "cannot be written"); };
    int row = 0;
    need(nc_def_dim(file.id, "row", table.rows(), &row));
    std::vector<int> ids;
    for (const TableColumn& column : table.columns) {
        ids.push_back(0);
        need(nc_def_var(file.id, column.name.c_str(), NC_DOUBLE, 1, &row, &ids.back()));
        need(nc_def_var_fill(file.id, ids.back(), NC_FILL, &kNone));
        need(nc_def_var_deflate(file.id, ids.back(), 1, 1, kDeflate));
        file.set(ids.back(), "units", udunits(column.unit));
        file.set(ids.back(), "long_name", column.meaning);
    }
    for (const auto& [name, value] : table.attributes) file.set(NC_GLOBAL, name.c_str(), value);
    need(nc_enddef(file.id));
    for (std::size_t c = 0; c < ids.size(); ++c)
        need(nc_put_var_double(file.id, ids[c], table.columns[c].values.data()));
}

// Reads points of a file on demand.
class Reader {
  public:
    explicit Reader(const std::filesystem::path& file) : file_(File::open(file)) {}

    SweepData data() {
        SweepData data;
        int dimensions[NC_MAX_VAR_DIMS], count = 0;
        need(nc_inq_varndims(file_->id, file_->variable("class"), &count));
        need(nc_inq_vardimid(file_->id, file_->variable("class"), dimensions));
        if (count != 2 && count != 3) file_->need(NC_EBADDIM);
        for (int d = count - 2; d >= 0; --d) {
            char name[NC_MAX_NAME + 1];
            std::size_t size = 0;
            need(nc_inq_dim(file_->id, dimensions[d], name, &size));
            SweepAxis axis{name, from_udunits(file_->text(file_->variable(name), "units")), std::vector<double>(size)};
            need(nc_get_var_double(file_->id, file_->variable(name), axis.values.data()));
            data.axes.push_back(std::move(axis));
        }
        std::size_t seeds = 0;
        need(nc_inq_dimlen(file_->id, dimensions[count - 1], &seeds));
        data.seeds = seeds;
        attributes(data);
        columns(data);
        counts_.resize(data.points());
        need(nc_get_var_int(file_->id, file_->variable("sample_count"), counts_.data()));
        axes_ = data.axes.size();
        first_ = data.axes[0].values.size();
        seeds_ = seeds;
        return data;
    }
    bool has(std::uint64_t point) const { return counts_[point] >= 0; }
    std::uint64_t rows(std::uint64_t point) const { return static_cast<std::uint64_t>(counts_[point]); }

    StoredPoint read(std::uint64_t point) const {
        StoredPoint p;
        p.point = point;
        std::vector<std::size_t> at;
        if (axes_ > 1) at.push_back(point / seeds_ / first_);
        at.insert(at.end(), {point / seeds_ % first_, point % seeds_, 0});
        signed char kind = 0;
        need(nc_get_var1_schar(file_->id, file_->variable("class"), at.data(), &kind));
        p.kind = kind;
        need(nc_get_var1_int(file_->id, file_->variable("period"), at.data(), &p.period));
        for (const PointNumber& number : kPointNumbers)
            need(nc_get_var1_double(file_->id, file_->variable(number.name), at.data(), &(p.*number.value)));
        const std::size_t rows = static_cast<std::size_t>(counts_[point]), width = columns_.size();
        std::vector<std::size_t> size(at.size(), 1);
        size.back() = rows;
        p.samples.resize(rows * width);
        std::vector<double> column(rows);
        for (std::size_t c = 0; c < width && rows > 0; ++c) {
            need(nc_get_vara_double(file_->id, columns_[c], at.data(), size.data(), column.data()));
            for (std::size_t row = 0; row < rows; ++row) p.samples[row * width + c] = column[row];
        }
        return p;
    }

  private:
    void need(int status) const { file_->need(status); }

    void attributes(SweepData& data) const {
        int count = 0;
        need(nc_inq_natts(file_->id, &count));
        for (int a = 0; a < count; ++a) {
            char name[NC_MAX_NAME + 1];
            need(nc_inq_attname(file_->id, NC_GLOBAL, a, name));
            data.attributes.emplace_back(name, file_->text(NC_GLOBAL, name));
        }
        const std::string meanings = file_->text(file_->variable("class"), "flag_meanings");
        for (std::size_t from = 0; from < meanings.size();) {
            const std::size_t to = std::min(meanings.find(' ', from), meanings.size());
            data.classes.push_back(meanings.substr(from, to - from));
            from = to + 1;
        }
    }
    // The variables over samples, in the order of the file.
    void columns(SweepData& data) {
        int variables = 0, sample = 0;
        need(nc_inq_nvars(file_->id, &variables));
        need(nc_inq_dimid(file_->id, "sample", &sample));
        for (int v = 0; v < variables; ++v) {
            char name[NC_MAX_NAME + 1];
            int dimensions[NC_MAX_VAR_DIMS], count = 0;
            need(nc_inq_var(file_->id, v, name, nullptr, &count, dimensions, nullptr));
            if (count < 3 || dimensions[count - 1] != sample) continue;
            columns_.push_back(v);
            data.columns.push_back({name, from_udunits(file_->text(v, "units")), file_->text(v, "long_name")});
        }
    }

    std::shared_ptr<File> file_;
    std::vector<int> counts_, columns_;
    std::size_t axes_ = 1;
    std::uint64_t first_ = 1, seeds_ = 1;
};

class Library final : public NetcdfLibrary {
  public:
    void write(const std::filesystem::path& file, const std::filesystem::path& named,
               const SweepData& data) const override {
        Writer(file, named, data).write();
    }
    void write(const std::filesystem::path& file, const std::filesystem::path& named,
               const ColumnTable& table) const override {
        const std::shared_ptr<File> made = File::create(file, named);
        write_columns(*made, table);
        made->close();
    }
    SweepData open(const std::filesystem::path& file) const override {
        auto reader = std::make_shared<Reader>(file);
        SweepData data = reader->data();
        data.has = [reader](std::uint64_t point) { return reader->has(point); };
        data.rows = [reader](std::uint64_t point) { return reader->rows(point); };
        data.read = [reader](std::uint64_t point) { return reader->read(point); };
        return data;
    }
    std::string version() const override { return nc_inq_libvers(); }
};

const Library library;

}  // namespace
}  // namespace beamcam::output

BEAMCAM_MODULE(static_cast<const beamcam::output::NetcdfLibrary&>(beamcam::output::library))
