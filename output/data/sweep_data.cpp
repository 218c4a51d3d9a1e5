#include "output/data/sweep_data.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "output/data/netcdf_library.hpp"
#include "output/data/npz.hpp"
#include "output/files/atomic_file.hpp"
#include "output/files/numbers.hpp"

namespace beamcam::output {
namespace {

constexpr std::size_t kTextBuffer = 1 << 16;  // [bytes] written at once
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// The columns that are equal in all rows of a point; they follow the swept keys.
constexpr const char* kPointColumns[] = {"seed", "class", "period", "impacts_per_period", "exponent", "exponent_error"};
enum PointColumn : std::size_t { kSeed, kClass, kPeriod, kImpacts, kExponent, kExponentError, kPointColumnCount };

double point_value(const SweepData& data, const StoredPoint& p, std::size_t column) {
    switch (static_cast<PointColumn>(column)) {
        case kSeed:
            return static_cast<double>(p.point % data.seeds);
        case kClass:
            return p.kind;
        case kPeriod:
            return p.period > 0 ? p.period : kNone;
        case kImpacts:
            return p.impacts_per_period;
        case kExponent:
            return p.exponent;
        case kExponentError:
            return p.exponent_error;
        case kPointColumnCount:
            break;
    }
    return kNone;
}

// Calls visit(point) for the points of this file, in order.
template <class Visit>
void each_point(const SweepData& data, Visit&& visit) {
    for (std::uint64_t k = 0; k < data.points(); ++k)
        if (data.has(k)) visit(data.read(k));
}

std::string header(const SweepData& data) {
    std::string text;
    for (const SweepAxis& axis : data.axes) text += axis.name + ",";
    for (const char* name : kPointColumns) text += std::string(name) + ",";
    text += "sample";
    for (const SweepColumn& column : data.columns) text += "," + column.name;
    return text + "\n";
}

void csv(const SweepData& data, const std::function<void(const std::string&)>& write) {
    std::string text = header(data);
    each_point(data, [&](const StoredPoint& p) {
        std::string common;
        for (const double value : data.place(p.point)) {
            append_number(common, value);
            common += ',';
        }
        for (std::size_t c = 0; c < kPointColumnCount; ++c) {
            if (c == kClass)
                common += data.classes[static_cast<std::size_t>(p.kind)];
            else
                append_number(common, point_value(data, p, c));
            common += ',';
        }
        const std::size_t width = data.columns.size(), rows = p.samples.size() / width;
        for (std::size_t row = 0; row < std::max<std::size_t>(rows, 1); ++row) {
            text += common;
            if (rows > 0) text += std::to_string(row);
            for (std::size_t c = 0; c < width; ++c) {
                text += ',';
                if (rows > 0) append_number(text, p.samples[row * width + c]);
            }
            text += '\n';
        }
        if (text.size() < kTextBuffer) return;
        write(text);
        text.clear();
    });
    write(text);
}

void npz(const Target& file, const SweepData& data) {
    std::vector<NpzArray> arrays;
    const std::uint64_t all = data.rows_in_all();
    for (const SweepAxis& axis : data.axes) arrays.push_back({axis.name, all});
    for (const char* name : kPointColumns) arrays.push_back({name, all});
    arrays.push_back({"sample", all});
    for (const SweepColumn& column : data.columns) arrays.push_back({column.name, all});
    NpzFile archive(file, arrays);
    const std::size_t width = data.columns.size();
    std::vector<double> values;  // of one array
    each_point(data, [&](const StoredPoint& p) {
        const std::size_t samples = p.samples.size() / width, rows = std::max<std::size_t>(samples, 1);
        std::size_t array = 0;
        const auto append = [&](auto&& value) {
            values.assign(rows, kNone);
            for (std::size_t row = 0; row < rows; ++row) values[row] = value(row);
            archive.append(array++, values);
        };
        for (const double value : data.place(p.point)) append([=](std::size_t) { return value; });
        for (std::size_t c = 0; c < kPointColumnCount; ++c)
            append([value = point_value(data, p, c)](std::size_t) { return value; });
        append([=](std::size_t row) { return samples == 0 ? kNone : static_cast<double>(row); });
        for (std::size_t c = 0; c < width; ++c)
            append([&, c](std::size_t row) { return samples == 0 ? kNone : p.samples[row * width + c]; });
    });
    archive.commit();
}

}  // namespace

void write_sweep_csv(std::ostream& out, const SweepData& data) {
    csv(data, [&out](const std::string& text) {
        if (!out.write(text.data(), static_cast<std::streamsize>(text.size())))
            throw IoError("cannot write the table: the output was closed or the disk is full");
    });
    if (!out.flush()) throw IoError("cannot write the table: the output was closed or the disk is full");
}

const std::string* SweepData::attribute(const std::string& name) const {
    const auto found = std::ranges::find(attributes, name, &std::pair<std::string, std::string>::first);
    return found == attributes.end() ? nullptr : &found->second;
}

void write_sweep(const Target& file, const SweepData& data) {
    const std::string ending = file.path.extension().string();
    if (ending == ".npz") return npz(file, data);
    if (ending == ".nc") {
        AtomicFile atomic(file);
        netcdf_library().write(atomic.temporary_path(), file.path, data);
        atomic.commit();
        return;
    }
    if (ending != ".csv")
        throw UnsupportedOption("cannot write " + file.path.string() + ": tables of sweeps end in .csv, .npz or .nc");
    AtomicFile atomic(file);
    csv(data, [&atomic](const std::string& text) { atomic.write(text); });
    atomic.commit();
}

}  // namespace beamcam::output
