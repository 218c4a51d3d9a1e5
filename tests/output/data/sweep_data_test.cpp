// Sweeps as files: what was written reads back, and what other programs read.
#include "output/data/sweep_data.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>

#include "output/data/table_reader.hpp"
#include "output/files/atomic_file.hpp"
#include "tests/output/scratch.hpp"

namespace beamcam::output {
namespace {

SweepData grid(std::uint64_t missing = 1000) {
    SweepData data;
    data.axes = {{"cam.speed", "rad/s", {1, 2, 3}}, {"gravity", "m/s^2", {9, 10}}};
    data.seeds = 2;
    data.columns = {{"t", "s", "Time"}, {"theta", "rad", "Angle"}};
    data.classes = {"rest", "periodic"};
    data.attributes = {{"source", "beamcam"}};
    data.has = [missing](std::uint64_t k) { return k != missing; };
    data.rows = [](std::uint64_t k) { return k % 3; };
    data.read = [](std::uint64_t k) {
        StoredPoint p;
        p.point = k;
        p.kind = static_cast<int>(k % 2);
        p.period = static_cast<int>(k);
        p.exponent = static_cast<double>(k) / 7;
        for (std::uint64_t i = 0; i < 2 * (k % 3); ++i)
            p.samples.push_back(static_cast<double>(k) + 0.1 * static_cast<double>(i));
        return p;
    };
    return data;
}

TEST(SweepData, IsACsvWithARowASample) {
    std::string out;
    SweepData data = grid();
    data.axes.pop_back();
    data.seeds = 1;
    write_sweep_csv([&out](const std::string& text) { out += text; }, data);
    EXPECT_EQ(out,
              "cam.speed,seed,class,period,impacts_per_period,exponent,exponent_error,sample,t,theta\n"
              "1,0,rest,,,0,,,,\n"
              "2,0,periodic,1,,0.14285714285714285,,0,1,1.1000000000000001\n"
              "3,0,rest,2,,0.2857142857142857,,0,2,2.1000000000000001\n"
              "3,0,rest,2,,0.2857142857142857,,1,2.2000000000000002,2.2999999999999998\n");
}

TEST(SweepData, HasTheSameRowsAsCsvAndNpz) {
    const Scratch scratch;
    std::string csv;
    write_sweep_csv([&csv](const std::string& text) { csv += text; }, grid(7));
    const ColumnTable own = parse_csv(csv, "a.csv");
    write_sweep(scratch / "a.npz", grid(7));
    const ColumnTable read = read_table(scratch / "a.npz");
    EXPECT_EQ(own.names(), read.names());
    ASSERT_EQ(own.rows(), read.rows());
    for (std::size_t c = 0; c < own.columns.size(); ++c)
        for (std::size_t row = 0; row < own.rows(); ++row)
            EXPECT_TRUE(own.columns[c].values[row] == read.columns[c].values[row] ||
                        std::isnan(read.columns[c].values[row]) || own.columns[c].name == "class")  // not those of sim/
                << own.columns[c].name;
    EXPECT_TRUE(std::isnan(own.find("sample")->front()));
}

TEST(SweepData, HasTheSameBytesFromTheSameNumbers) {
    const Scratch scratch;
    for (const char* ending : {".nc", ".npz", ".csv"}) {
        write_sweep(scratch / (std::string("a") + ending), grid());
        write_sweep(scratch / (std::string("b") + ending), grid());
        EXPECT_EQ(read_file(scratch / (std::string("a") + ending)), read_file(scratch / (std::string("b") + ending)));
    }
    EXPECT_THROW(write_sweep(scratch / "a.txt", grid()), UnsupportedOption);
}

// The samples of a point with `rows` rows, its columns numbers that compress badly.
StoredPoint noisy(std::uint64_t k, std::uint64_t rows, std::size_t width) {
    StoredPoint p;
    p.point = k;
    p.kind = 1;
    for (std::uint64_t i = 0; i < rows * width; ++i)
        p.samples.push_back(std::sin(static_cast<double>(k * 7919 + i * i)));
    return p;
}

SweepData wide(std::uint64_t rows, std::uint64_t values, std::uint64_t seeds,
               const std::function<std::uint64_t(std::uint64_t)>& samples) {
    SweepData data = grid();
    data.axes = {{"cam.speed", "rad/s", std::vector<double>(values)}, {"gravity", "m/s^2", std::vector<double>(rows)}};
    for (SweepAxis& axis : data.axes)
        for (std::size_t i = 0; i < axis.values.size(); ++i) axis.values[i] = static_cast<double>(i);
    if (rows == 1) data.axes.pop_back();
    data.seeds = seeds;
    data.has = [](std::uint64_t) { return true; };
    data.rows = samples;
    data.read = [samples](std::uint64_t k) { return noisy(k, samples(k), 2); };
    return data;
}

// Whether Python, which is not beamcam's, finds the number of each sample where it should be.
void expect_samples(const Scratch& scratch, const SweepData& data) {
    if (std::system("/usr/bin/python3 -c 'import netCDF4' 2>/dev/null") != 0) GTEST_SKIP() << "no netCDF4";
    write_sweep(scratch / "a.nc", data);
    std::string script = "import netCDF4 as n; v = n.Dataset(\"" + (scratch / "a.nc").string() +
                         "\").variables; t = v[\"theta\"]; c = v[\"sample_count\"]; s = t.shape\n";
    const bool grid = data.axes.size() > 1;
    for (std::uint64_t k = 0; k < data.points(); k += 1 + data.points() / 17) {
        const std::uint64_t seed = k % data.seeds, cell = k / data.seeds, first = data.axes[0].values.size();
        const std::string at =
            grid ? fmt::format("{}, {}, {}", cell / first, cell % first, seed) : fmt::format("{}, {}", cell, seed);
        script += fmt::format("assert c[{}] == {}\n", at, data.rows(k));
        const StoredPoint point = data.read(k);
        if (data.rows(k) > 0)
            script += fmt::format("assert t[{}, {}] == {:.17g}\n", at, data.rows(k) - 1, point.samples.back());
    }
    write_file(scratch / "check.py", script);
    EXPECT_EQ(std::system(("/usr/bin/python3 " + (scratch / "check.py").string()).c_str()), 0);
}

TEST(SweepData, HasAllSamplesInNetcdfOverTheEdgesOfItsBlocks) {
    const Scratch scratch;
    expect_samples(scratch,
                   wide(3, 700, 2, [](std::uint64_t k) { return 60 + k % 41; }));          // several blocks in each row
    expect_samples(scratch, wide(301, 7, 3, [](std::uint64_t k) { return 50 - k % 3; }));  // a row in each block
    expect_samples(scratch, wide(1, 3, 150'000, [](std::uint64_t k) { return k % 2; }));   // seeds beyond a block
    expect_samples(scratch, wide(1, 2, 2, [](std::uint64_t k) { return 200'000 * k; }));   // a point beyond a block
}

TEST(SweepData, TakesNoRoomForSamplesThatFewPointsHave) {
    const Scratch scratch;
    // One point of 20 000 has 20 000 samples: the grid would hold 6 GB of empty numbers.
    const SweepData data = wide(1, 20'000, 1, [](std::uint64_t k) { return k == 777 ? 20'000 : 1; });
    write_sweep(scratch / "a.nc", data);
    EXPECT_LT(std::filesystem::file_size(scratch / "a.nc"), 3'000'000u);
}

// Whether a reader in Python, which is not beamcam's, finds everything as it should.
void expect_reads(const Scratch& scratch, const char* module, const std::string& script) {
    write_sweep(scratch / "a.nc", grid(7));
    const std::string python = "/usr/bin/python3 -c '";
    if (std::system((python + "import " + module + "' 2>/dev/null").c_str()) != 0) GTEST_SKIP() << "no " << module;
    const std::string file = "f = \"" + (scratch / "a.nc").string() + "\"; ";
    EXPECT_EQ(std::system((python + file + script + "'").c_str()), 0);
}

TEST(SweepData, IsReadByNetcdf4Python) {
    const Scratch scratch;
    expect_reads(scratch, "netCDF4",
                 "import netCDF4 as n; d = n.Dataset(f); v = d.variables; assert v[\"theta\"].dimensions == "
                 "(\"gravity\", \"cam.speed\", \"seed\", \"sample\"); assert v[\"theta\"].units == \"rad\"; assert "
                 "v[\"theta\"][0, 2, 1, 1] == 5.3; assert v[\"class\"].flag_meanings == \"rest periodic\"; assert "
                 "v[\"sample_count\"][1, 0, 1] is n.numpy.ma.masked; assert d.source == \"beamcam\"");
}

TEST(SweepData, IsReadByH5py) {
    const Scratch scratch;
    expect_reads(scratch, "h5py",
                 "import h5py, numpy; d = h5py.File(f); t = d[\"theta\"]; assert t.shape == (2, 3, 2, 2); assert "
                 "t[0, 2, 1, 1] == 5.3; assert numpy.isnan(t[1, 0, 1, 0]); assert [t.dims[i][0].name for i in "
                 "range(4)] == [\"/gravity\", \"/cam.speed\", \"/seed\", \"/sample\"]; assert t.attrs[\"units\"] == "
                 "b\"rad\"; assert list(d[\"cam.speed\"]) == [1, 2, 3]; assert d[\"sample_count\"][1, 0, 1] == -1");
}

TEST(SweepData, IsReadByXarray) {
    const Scratch scratch;
    expect_reads(scratch, "xarray",
                 "import xarray, numpy; r = xarray.open_dataset(f); assert r.theta.sel({\"cam.speed\": 3, "
                 "\"gravity\": 9, \"seed\": 1, \"sample\": 1}) == 5.3; assert r.theta.units == \"rad\"; assert "
                 "numpy.isnan(r.sample_count.values[1, 0, 1]); assert r.source == \"beamcam\"");
}

TEST(SweepData, IsReadByOctave) {
    const Scratch scratch;
    write_sweep(scratch / "a.nc", grid(7));
    if (std::system("octave --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no Octave";
    const std::string script = "d = load(\"" + (scratch / "a.nc").string() +
                               "\"); assert(size(d.theta), [2 2 3 2]); assert(d.theta(2, 2, 3, 1), 5.3); "
                               "assert(isnan(d.theta(1, 2, 1, 2))); assert(d.sample_count(2, 1, 2) == -1);";
    EXPECT_EQ(std::system(("octave --no-gui --no-init-file --quiet --eval '" + script + "'").c_str()), 0);
}

}  // namespace
}  // namespace beamcam::output
