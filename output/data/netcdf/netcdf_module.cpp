// Sweeps and tables as NetCDF-4 files. https://docs.unidata.ucar.edu/netcdf-c, https://cfconventions.org
#include <fmt/format.h>
#include <netcdf.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "output/data/netcdf_library.hpp"
#include "render/base/modules.hpp"

namespace beamcam::output {
namespace {

constexpr std::uint64_t kChunk = 1 << 17;  // numbers of one chunk, about: 1 MB
constexpr int kDeflate = 1;                // more takes three times as long for a few per cent
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr int kMissing = -1;  // class and count of a point that is not in this file

class File {
  public:
    // Modes of nc_create and nc_open.
    static std::shared_ptr<File> create(const std::filesystem::path& file, const std::filesystem::path& named) {
        auto made = std::make_shared<File>(named);
        made->need(nc_create(file.c_str(), NC_NETCDF4 | NC_CLOBBER, &made->id), "cannot be made");
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
    void need(int status, const char* what = "is no sweep of beamcam") const {
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

// Names and numbers of the variables that a point has once, in the order of StoredPoint.
constexpr const char* kPointNumbers[] = {"impacts_per_period", "exponent", "exponent_error"};
constexpr const char* kPointMeanings[] = {"Impacts in a period; in a turn of the cam where there is none",
                                          "Largest Lyapunov exponent", "Its standard error"};
constexpr const char* kPointUnits[] = {"1", "s-1", "s-1"};

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

class Writer {
  public:
    Writer(File& file, const SweepData& data)
        : file_(file),
          data_(data),
          first_(data.axes[0].values.size()),
          samples_(std::max<std::uint64_t>(1, data.most_rows())) {}

    void write() {
        define();
        need(nc_enddef(file_.id));
        coordinates();
        const std::uint64_t point = std::max<std::uint64_t>(1, kChunk / samples_);
        const std::uint64_t seeds = std::min(data_.seeds, point), values = chunk_values();
        for (std::uint64_t row = 0; row < data_.points() / data_.seeds / first_; ++row)
            for (std::uint64_t value = 0; value < first_; value += values)
                for (std::uint64_t seed = 0; seed < data_.seeds; seed += seeds)
                    block(row, value, std::min(values, first_ - value), seed, std::min(seeds, data_.seeds - seed));
    }

  private:
    void need(int status) const { file_.need(status, "cannot be written"); }
    // Values of the first axis in a chunk: all seeds of several of them, or some of one.
    std::uint64_t chunk_values() const {
        return std::clamp<std::uint64_t>(kChunk / (samples_ * data_.seeds), 1, first_);
    }

    int dimension(const std::string& name, std::uint64_t size) {
        int id = 0;
        need(nc_def_dim(file_.id, name.c_str(), size, &id));
        return id;
    }
    int variable(const std::string& name, nc_type type, const std::vector<int>& dimensions, const std::string& unit,
                 const std::string& meaning) {
        int id = 0;
        need(nc_def_var(file_.id, name.c_str(), type, static_cast<int>(dimensions.size()), dimensions.data(), &id));
        if (!unit.empty()) file_.set(id, "units", udunits(unit));
        if (!meaning.empty()) file_.set(id, "long_name", meaning);
        return id;
    }
    void compress(int id, bool with_samples) {
        const std::uint64_t point = std::max<std::uint64_t>(1, kChunk / samples_);
        std::vector<std::size_t> chunk;
        if (data_.axes.size() > 1) chunk.push_back(1);
        chunk.push_back(with_samples ? chunk_values() : first_);
        chunk.push_back(std::min(data_.seeds, with_samples ? point : kChunk));
        if (with_samples) chunk.push_back(samples_);
        need(nc_def_var_chunking(file_.id, id, NC_CHUNKED, chunk.data()));
        need(nc_def_var_deflate(file_.id, id, 1, 1, kDeflate));
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
        all.push_back(dimension("sample", samples_));
        sample_ = variable("sample", NC_INT, {all.back()}, "1", "Number of the sample");
        define_points(point);
        for (const SweepColumn& column : data_.columns) {
            columns_.push_back(variable(column.name, NC_DOUBLE, all, column.unit, column.meaning));
            need(nc_def_var_fill(file_.id, columns_.back(), NC_FILL, &kNone));
            compress(columns_.back(), true);
        }
        for (const auto& [name, value] : data_.attributes) file_.set(NC_GLOBAL, name.c_str(), value);
    }
    void define_points(const std::vector<int>& point) {
        class_ = variable("class", NC_BYTE, point, "1", "What the motion settles to");
        const signed char missing = kMissing;
        need(nc_def_var_fill(file_.id, class_, NC_FILL, &missing));
        std::vector<signed char> values;
        std::string meanings;
        for (const std::string& name : data_.classes) {
            values.push_back(static_cast<signed char>(values.size()));
            meanings += (meanings.empty() ? "" : " ") + name;
        }
        need(nc_put_att_schar(file_.id, class_, "flag_values", NC_BYTE, values.size(), values.data()));
        file_.set(class_, "flag_meanings", meanings);
        period_ = variable("period", NC_INT, point, "1", "Period in turns of the cam; 0: none");
        count_ = variable("sample_count", NC_INT, point, "1", "Samples of the point; -1: not in this file");
        for (const int id : {period_, count_}) need(nc_def_var_fill(file_.id, id, NC_FILL, &kMissing));
        for (std::size_t k = 0; k < std::size(kPointNumbers); ++k) {
            numbers_.push_back(variable(kPointNumbers[k], NC_DOUBLE, point, kPointUnits[k], kPointMeanings[k]));
            need(nc_def_var_fill(file_.id, numbers_.back(), NC_FILL, &kNone));
        }
        for (const int id : {class_, period_, count_}) compress(id, false);
        for (const int id : numbers_) compress(id, false);
    }

    void coordinates() {
        for (std::size_t a = 0; a < data_.axes.size(); ++a)
            need(nc_put_var_double(file_.id, axes_[a], data_.axes[a].values.data()));
        for (const auto& [id, size] : {std::pair{seed_, data_.seeds}, std::pair{sample_, samples_}}) {
            std::vector<int> numbers(size);
            for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<int>(i);
            need(nc_put_var_int(file_.id, id, numbers.data()));
        }
    }

    // A block of points, one chunk of each variable.
    void block(std::uint64_t row, std::uint64_t value, std::uint64_t values, std::uint64_t seed, std::uint64_t seeds) {
        const std::size_t points = values * seeds, width = columns_.size();
        std::vector<std::vector<double>> samples(width, std::vector<double>(points * samples_, kNone));
        std::vector<std::vector<double>> numbers(numbers_.size(), std::vector<double>(points, kNone));
        std::vector<int> periods(points, kMissing), counts(points, kMissing);
        std::vector<signed char> classes(points, kMissing);
        bool any = false;
        for (std::uint64_t i = 0; i < points; ++i) {
            const std::uint64_t index = ((row * first_ + value + i / seeds) * data_.seeds) + seed + i % seeds;
            if (!data_.has(index)) continue;
            any = true;
            const StoredPoint p = data_.read(index);
            classes[i] = static_cast<signed char>(p.kind);
            periods[i] = p.period;
            counts[i] = static_cast<int>(p.samples.size() / width);
            numbers[0][i] = p.impacts_per_period;
            numbers[1][i] = p.exponent;
            numbers[2][i] = p.exponent_error;
            for (std::size_t k = 0; k < p.samples.size(); ++k)
                samples[k % width][i * samples_ + k / width] = p.samples[k];
        }
        if (!any) return;
        std::vector<std::size_t> start, count;
        if (data_.axes.size() > 1) start.push_back(row), count.push_back(1);
        start.insert(start.end(), {value, seed, 0});
        count.insert(count.end(), {values, seeds, samples_});
        const auto at = start.data(), size = count.data();
        need(nc_put_vara_schar(file_.id, class_, at, size, classes.data()));
        need(nc_put_vara_int(file_.id, period_, at, size, periods.data()));
        need(nc_put_vara_int(file_.id, count_, at, size, counts.data()));
        for (std::size_t k = 0; k < numbers_.size(); ++k)
            need(nc_put_vara_double(file_.id, numbers_[k], at, size, numbers[k].data()));
        for (std::size_t c = 0; c < width; ++c)
            need(nc_put_vara_double(file_.id, columns_[c], at, size, samples[c].data()));
    }

    File& file_;
    const SweepData& data_;
    std::uint64_t first_, samples_;
    std::vector<int> axes_, numbers_, columns_;
    int seed_ = 0, sample_ = 0, class_ = 0, period_ = 0, count_ = 0;
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

// Reads points of a file as they are asked for.
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
        double* const numbers[] = {&p.impacts_per_period, &p.exponent, &p.exponent_error};
        for (std::size_t k = 0; k < std::size(numbers); ++k)
            need(nc_get_var1_double(file_->id, file_->variable(kPointNumbers[k]), at.data(), numbers[k]));
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
        const std::shared_ptr<File> made = File::create(file, named);
        Writer(*made, data).write();
        made->close();
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
