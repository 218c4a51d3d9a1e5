#include "output/data/sweep_data.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "output/data/netcdf_library.hpp"
#include "output/data/npz.hpp"
#include "output/files/atomic_file.hpp"
#include "output/files/numbers.hpp"

namespace beamcam::output {
namespace {

constexpr std::size_t kTextBuffer = 1 << 16;  // [bytes] written at once
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double period_of(const StoredPoint& p) { return p.period > 0 ? p.period : kNone; }

// Calls visit(point) for the points of this file, in order.
template <class Visit>
void each_point(const SweepData& data, Visit&& visit) {
    for (std::uint64_t k = 0; k < data.points(); ++k)
        if (data.has(k)) visit(data.read(k));
}

std::vector<std::string> column_names(const SweepData& data) {
    std::vector<std::string> names;
    for (const SweepAxis& axis : data.axes) names.push_back(axis.name);
    names.insert(names.end(), {"seed", "class", "period"});
    for (const PointNumber& number : kPointNumbers) names.emplace_back(number.name);
    names.emplace_back("sample");
    for (const TableColumn& column : data.columns) names.push_back(column.name);
    return names;
}

// Calls visit(number of the column, values in the rows of the point) for every column.
template <class Visit>
void each_column(const SweepData& data, const StoredPoint& p, Visit&& visit) {
    const std::size_t width = data.columns.size(), samples = p.samples.size() / width;
    std::vector<double> values(std::max<std::size_t>(samples, 1));
    std::size_t column = 0;
    const auto constant = [&](double value) {
        std::ranges::fill(values, value);
        visit(column++, values);
    };
    for (const double value : data.place(p.point)) constant(value);
    constant(static_cast<double>(p.point % data.seeds));
    constant(p.kind);
    constant(period_of(p));
    for (const PointNumber& number : kPointNumbers) constant(p.*number.value);
    std::ranges::fill(values, kNone);
    for (std::size_t row = 0; row < samples; ++row) values[row] = static_cast<double>(row);
    visit(column++, values);
    for (std::size_t c = 0; c < width; ++c) {
        for (std::size_t row = 0; row < samples; ++row) values[row] = p.samples[row * width + c];
        if (samples == 0) values.front() = kNone;
        visit(column++, values);
    }
}

void csv(const SweepData& data, const TextSink& write) {
    const std::size_t class_column = data.axes.size() + 1;  // a name in CSV, after the seed
    std::string text = fmt::format("{}\n", fmt::join(column_names(data), ","));
    each_point(data, [&](const StoredPoint& p) {
        std::vector<std::vector<double>> columns;
        each_column(data, p, [&](std::size_t, const std::vector<double>& values) { columns.push_back(values); });
        for (std::size_t row = 0; row < columns.front().size(); ++row) {
            for (std::size_t c = 0; c < columns.size(); ++c) {
                if (c > 0) text += ',';
                if (c == class_column)
                    text += data.classes[static_cast<std::size_t>(p.kind)];
                else
                    append_number(text, columns[c][row]);
            }
            text += '\n';
        }
        if (text.size() < kTextBuffer) return;
        write(text);
        text.clear();
    });
    write(text);
}

// The points follow in the order of their numbers, so that the bytes do not depend on the order in which the points
// were made.
void points(const SweepData& data, const TextSink& write) {
    write(text_of(data.head));
    each_point(data, [&](const StoredPoint& p) { write(text_of(p)); });
}

void npz(const FileTarget& file, const SweepData& data) {
    std::vector<NpzArray> arrays;
    const std::uint64_t rows = data.rows_in_all();
    for (const std::string& name : column_names(data)) arrays.push_back({name, rows});
    NpzFile archive(file, arrays);
    each_point(data, [&](const StoredPoint& p) {
        each_column(data, p, [&](std::size_t c, const std::vector<double>& values) { archive.append(c, values); });
    });
    archive.commit();
}

}  // namespace

void write_sweep_csv(const TextSink& write, const SweepData& data) { csv(data, write); }

void write_sweep(const FileTarget& file, const SweepData& data) {
    const std::string ending = file.path.extension().string();
    if (ending == ".npz") return npz(file, data);
    if (ending == ".nc") {
        AtomicFile atomic(file);
        netcdf_library().write(atomic.temporary_path(), file.path, data);
        atomic.commit();
        return;
    }
    if (ending != ".csv" && ending != kPartEnding)
        throw UnsupportedOption("cannot write " + file.path.string() + ": tables of sweeps end in .csv, .npz or .nc");
    AtomicFile atomic(file);
    if (ending == ".csv")
        csv(data, [&atomic](const std::string& text) { atomic.write(text); });
    else
        points(data, [&atomic](const std::string& text) { atomic.write(text); });
    atomic.commit();
}

}  // namespace beamcam::output
