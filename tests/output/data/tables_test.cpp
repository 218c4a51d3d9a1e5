#include "output/data/tables.hpp"

#include <cmath>
#include <limits>
#include <sstream>

#include "output/files/atomic_file.hpp"
#include "tests/output/scratch.hpp"

namespace beamcam::output {
namespace {

using sim::ChannelKind;
const double kNone = std::numeric_limits<double>::quiet_NaN();

sim::Table table_with_gaps() {
    return {{{ChannelKind::t, 0}, {ChannelKind::q, 2}, {ChannelKind::gap, 0}},
            {{0, 0.1, 1e300}, {-1.5, 1.0 / 3, 5e-324}, {kNone, 2, kNone}}};
}

TEST(Csv, HasAHeaderSeventeenDigitsAndEmptyCells) {
    std::string out;
    write_csv([&out](const std::string& text) { out += text; }, table_with_gaps());
    EXPECT_EQ(out,
              "t,q2,gap\n"
              "0,-1.5,\n"
              "0.10000000000000001,0.33333333333333331,2\n"
              "1.0000000000000001e+300,4.9406564584124654e-324,\n");
}

TEST(Csv, EveryNumberReadsBackToTheSameBits) {
    sim::Table table{{{ChannelKind::theta, 0}}, {{}}};
    for (int i = 0; i < 20000; ++i) table.values[0].push_back(std::ldexp(std::sin(i * 1.7), i % 200 - 100));
    std::string out;
    write_csv([&out](const std::string& text) { out += text; }, table);
    std::istringstream in(out);
    std::string line;
    std::getline(in, line);
    for (double value : table.values[0]) {
        std::getline(in, line);
        ASSERT_EQ(std::stod(line), value);
    }
}

TEST(Csv, AFileHoldsTheSameText) {
    Scratch scratch;
    std::string out;
    write_csv([&out](const std::string& text) { out += text; }, table_with_gaps());
    write_table(scratch / "a.csv", table_with_gaps());
    EXPECT_EQ(read_file(scratch / "a.csv"), out);
}

TEST(Npz, NumpyReadsTheSameNumbers) {
    Scratch scratch;
    write_table(scratch / "a.npz", table_with_gaps());
    const std::string printed = output_of(
        "/usr/bin/python3 -c 'import numpy, sys\n"
        "z = numpy.load(sys.argv[1])\n"
        "for name in z.files: print(name, z[name].dtype, z[name].shape, [float(v).hex() for v in z[name]])' " +
        (scratch / "a.npz").string());
    EXPECT_EQ(printed,
              "t float64 (3,) ['0x0.0p+0', '0x1.999999999999ap-4', '0x1.7e43c8800759cp+996']\n"
              "q2 float64 (3,) ['-0x1.8000000000000p+0', '0x1.5555555555555p-2', '0x0.0000000000001p-1022']\n"
              "gap float64 (3,) ['nan', '0x1.0000000000000p+1', 'nan']\n");
}

TEST(Npz, IsASoundZipArchiveWithAlignedData) {
    Scratch scratch;
    write_table(scratch / "a.npz", table_with_gaps());
    EXPECT_EQ(output_of("/usr/bin/python3 -c 'import zipfile, sys; print(zipfile.ZipFile(sys.argv[1]).testzip())' " +
                        (scratch / "a.npz").string()),
              "None\n");
}

TEST(Npz, HoldsTablesWithoutRows) {
    Scratch scratch;
    write_table(scratch / "a.npz", sim::Table{{{ChannelKind::t, 0}}, {{}}});
    EXPECT_EQ(output_of("/usr/bin/python3 -c 'import numpy, sys; print(numpy.load(sys.argv[1])[\"t\"].size)' " +
                        (scratch / "a.npz").string()),
              "0\n");
}

TEST(Npz, RefusesMoreThanTheArchiveCanHold) {
    Scratch scratch;
    sim::Table table;
    table.channels.assign(70000, {ChannelKind::t, 0});
    table.values.assign(70000, {});
    EXPECT_THROW(write_table(scratch / "a.npz", table), UnsupportedOption);
    EXPECT_TRUE(scratch.names().empty());
}

TEST(Tables, AreWrittenByTheirEnding) {
    Scratch scratch;
    write_table(scratch / "a.csv", table_with_gaps());
    write_table(scratch / "a.npz", table_with_gaps());
    EXPECT_EQ(read_file(scratch / "a.csv").substr(0, 2), "t,");
    EXPECT_EQ(read_file(scratch / "a.npz").substr(0, 2), "PK");
    EXPECT_THROW(write_table(scratch / "a.txt", table_with_gaps()), UnsupportedOption);
}

}  // namespace
}  // namespace beamcam::output
