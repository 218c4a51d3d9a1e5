// Reads sweeps in NetCDF-4 files.
#include <netcdf.h>

#include <algorithm>

#include "output/data/netcdf/nc_file.hpp"

namespace beamcam::output {
namespace {

// Reads points of a file on demand.
class SweepReader {
  public:
    explicit SweepReader(const std::filesystem::path& file) : file_(NcFile::open(file)) {}

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

    std::shared_ptr<NcFile> file_;
    std::vector<int> counts_, columns_;
    std::size_t axes_ = 1;
    std::uint64_t first_ = 1, seeds_ = 1;
};

}  // namespace

SweepData open_nc_sweep(const std::filesystem::path& file) {
    auto reader = std::make_shared<SweepReader>(file);
    SweepData data = reader->data();
    data.has = [reader](std::uint64_t point) { return reader->has(point); };
    data.rows = [reader](std::uint64_t point) { return reader->rows(point); };
    data.read = [reader](std::uint64_t point) { return reader->read(point); };
    return data;
}

}  // namespace beamcam::output
