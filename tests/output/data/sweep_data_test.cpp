// Sweeps as files: what was written reads back, and the gaps of a part stay gaps.
#include "output/data/sweep_data.hpp"

#include <cmath>
#include <sstream>

#include "output/data/netcdf_library.hpp"
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
    std::ostringstream out;
    SweepData data = grid();
    data.axes.pop_back();
    data.seeds = 1;
    write_sweep_csv(out, data);
    EXPECT_EQ(out.str(),
              "cam.speed,seed,class,period,impacts_per_period,exponent,exponent_error,sample,t,theta\n"
              "1,0,rest,,,0,,,,\n"
              "2,0,periodic,1,,0.14285714285714285,,0,1,1.1000000000000001\n"
              "3,0,rest,2,,0.2857142857142857,,0,2,2.1000000000000001\n"
              "3,0,rest,2,,0.2857142857142857,,1,2.2000000000000002,2.2999999999999998\n");
}

TEST(SweepData, ReadsBackFromNetcdfWithTheGapsOfAPart) {
    const Scratch scratch;
    const SweepData data = grid(7);
    write_sweep(scratch / "a.nc", data);
    const SweepData back = netcdf_library().open(scratch / "a.nc");
    ASSERT_EQ(back.points(), 12u);
    ASSERT_EQ(back.axes.size(), 2u);
    EXPECT_EQ(back.axes[0].name, "cam.speed");
    EXPECT_EQ(back.axes[1].values, data.axes[1].values);
    EXPECT_EQ(back.classes, data.classes);
    EXPECT_EQ(back.attributes, data.attributes);
    ASSERT_EQ(back.columns.size(), 2u);
    EXPECT_EQ(back.columns[1].name, "theta");
    for (std::uint64_t k = 0; k < 12; ++k) {
        ASSERT_EQ(back.has(k), k != 7) << k;
        if (k == 7) continue;
        const StoredPoint a = data.read(k), b = back.read(k);
        EXPECT_EQ(back.rows(k), k % 3);
        EXPECT_EQ(a.kind, b.kind);
        EXPECT_EQ(a.period, b.period);
        EXPECT_EQ(a.exponent, b.exponent);
        EXPECT_TRUE(std::isnan(b.impacts_per_period));
        EXPECT_EQ(a.samples, b.samples);
    }
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

TEST(SweepData, RefusesAFileThatIsNoSweep) {
    const Scratch scratch;
    write_file(scratch / "a.nc", "no netcdf");
    EXPECT_THROW(netcdf_library().open(scratch / "a.nc"), IoError);
    EXPECT_THROW(netcdf_library().open(scratch / "none.nc"), IoError);
}

TEST(SweepData, IsReadByNetcdf4Python) {
    const Scratch scratch;
    write_sweep(scratch / "a.nc", grid(7));
    if (std::system("/usr/bin/python3 -c 'import netCDF4' 2>/dev/null") != 0) GTEST_SKIP() << "no python3-netcdf4";
    const std::string script =
        "import netCDF4 as n; d = n.Dataset(\"" + (scratch / "a.nc").string() +
        "\"); v = d.variables; assert v[\"theta\"].dimensions == (\"gravity\", \"cam.speed\", "
        "\"seed\", \"sample\"); assert v[\"theta\"].units == \"rad\"; assert v[\"theta\"][0, 2, 1, "
        "1] == 5.3; assert v[\"class\"].flag_meanings == \"rest periodic\"; assert "
        "v[\"sample_count\"][1, 0, 1] is n.numpy.ma.masked; assert d.source == \"beamcam\"";
    EXPECT_EQ(std::system(("/usr/bin/python3 -c '" + script + "'").c_str()), 0);
}

}  // namespace
}  // namespace beamcam::output
