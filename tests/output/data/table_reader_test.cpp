// Tables of beamcam, of other programs and of attackers.
#include "output/data/table_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libdeflate.h>
#include <sys/stat.h>

#include <cmath>

#include "output/files/atomic_file.hpp"
#include "output/files/numbers.hpp"
#include "tests/output/scratch.hpp"

namespace beamcam::output {
namespace {

std::string problem_of(const std::string& text, const char* column) {
    return io_error_of([&] { parse_csv(text, "q.csv").find(column); });
}

TEST(TableReader, ArraysThatShareTheirBytesAreRefused) {
    Scratch scratch;
    const std::string command =
        "cd '" + scratch.path().string() +
        "' && /usr/bin/python3 -c \"import numpy; numpy.savez_compressed('a.npz', t=numpy.zeros(3))\"";
    output_of(command);
    const std::string whole = read_file(scratch / "a.npz");
    ASSERT_EQ(read_table(scratch / "a.npz").rows(), 3U);
    const std::size_t end = whole.rfind("PK\5\6"), begin = whole.rfind("PK\1\2");
    std::string shared = whole.substr(0, end), second = whole.substr(begin, end - begin), tail = whole.substr(end);
    for (char name = 'a'; name < 'k'; ++name) {
        second[46] = name;
        shared += second;
    }
    tail[8] = tail[10] = 11;
    write_file(scratch / "b.npz", shared + tail);
    EXPECT_NE(io_error_of([&] { read_table(scratch / "b.npz"); }).find("damaged"), std::string::npos);
}

sim::Table small_table() {
    using sim::ChannelKind;
    return {{{ChannelKind::t, 0}, {ChannelKind::theta, 0}, {ChannelKind::gap, 0}},
            {{0, 0.1, 1.0 / 3}, {1, -2e-300, 3}, {NAN, 5e-324, 1.7976931348623157e308}}};
}

TEST(TableReader, BothFormatsGiveTheSameBitsBack) {
    Scratch scratch;
    const sim::Table table = small_table();
    for (const char* name : {"a.csv", "a.npz"}) {
        write_table(scratch / name, table);
        const ColumnTable read = read_table(scratch / name);
        EXPECT_EQ(read.names(), (std::vector<std::string>{"t", "theta", "gap"}));
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t r = 0; r < 3; ++r)
                if (std::isnan(table.values[c][r]))
                    EXPECT_TRUE(std::isnan(read.columns[c].values[r]));
                else
                    EXPECT_EQ(read.columns[c].values[r], table.values[c][r]) << name << " " << c << " " << r;
    }
}

TEST(TableReader, ReadsWhatNumpyAndSpreadsheetsWrite) {
    Scratch scratch;
    output_of(
        "cd " + in_shell(scratch.path()) +
        " && /usr/bin/python3 -c \"import numpy as n; n.savez_compressed('a.npz', t=n.arange(3.), k=n.arange(3)); "
        "n.savetxt('a.csv', n.ones((2, 2)), header='rig 7\\nt,x', delimiter=',')\"");
    const ColumnTable npz = read_table(scratch / "a.npz"), csv = read_table(scratch / "a.csv");
    EXPECT_EQ(*npz.find("k"), (std::vector<double>{0, 1, 2}));
    EXPECT_EQ(*csv.find("x"), (std::vector<double>{1, 1}));
    // Quotes carry no meaning (RFC 4180), but for commas and line breaks within them; lines of the file are counted.
    const ColumnTable quoted = parse_csv("a,note\n\"2\",\"one\ntwo, \"\"three\"\"\"\n3,4\n", "q.csv");
    EXPECT_EQ(quoted.columns[0].values, (std::vector<double>{2, 3}));
    EXPECT_EQ(quoted.columns[1].text(0), "one\ntwo, \"three\"");
    EXPECT_THAT(problem_of("a,b\n1,\"2\n\"\nx,1\n", "b"), ::testing::StartsWith("q.csv:2:3: "));
    EXPECT_THAT(problem_of("a,\"b\nc\"\nx,1\n1,1\n", "a"), ::testing::StartsWith("q.csv:3:1: "));
    EXPECT_THAT(problem_of("a,note,b\n1,\"one\ntwo\",inf\n", "b"), ::testing::StartsWith("q.csv:3:6: "));
    const ColumnTable excel = parse_csv("\xEF\xBB\xBF\"t\", x\r\n1,+2\r\n3,\r\n", "e.csv");
    EXPECT_EQ(*excel.find("t"), (std::vector<double>{1, 3}));
    EXPECT_EQ(excel.find("x")->front(), 2);
    EXPECT_TRUE(std::isnan(excel.find("x")->back()));
}

// Each text holds the same columns t and x as machines write them.
TEST(TableReader, ReadsWhatMachinesWrite) {
    for (const std::string text :
         {"t,x\n0,1.5\n0.5,-2e-3\n", "t;x\n0;1,5\n0,5;-2e-3\n", "t\tx\r\n0\t1,5\r\n0,5\t-0,002\r\n\r\n\r\n",
          "sep=;\nt;x\n0;1,5\n0,5;-2e-3\n", "t x\n  0  1.5\n  0.5  -2e-3\n", "\xEF\xBB\xBFt,x\r0,1.5\r0.5,-2e-3\r",
          ",t,x\n0,0,1.5\n1,0.5,-0.002\n", "t,x\ns,m\n0,1.5\n0.5,-2e-3\n", "t,note,x\n0,ok,1.5\n0.5,\"a, b\",-2e-3\n",
          "# rig 7\n# 2026-11-28\nt,x\n0,1.5\n0.5,-2e-3\n", "% t,x\n0,1.5\n0.5,-2e-3\n",
          "Rig 7\nOperator: X\n\nt;x;y\n[s];[m];[m]\n0;1,5;NA\n0,5;-0,002;\n;;\n;;\n",
          "when,t,x\n2026-11-28 12:00:00,0,1.5\n2026-11-28 12:00:01,0.5,-2e-3\n", "t,x,x2,x2\n0,1.5,a,b\n0.5,-2e-3,,\n",
          "t,x,\n0,1.5,\n0.5,-2e-3,\n", "t,x,y\n0,1.5,inf\n0.5,-2e-3,1e999\n", "t,x\n\n0,1.5\n# pause\n0.5,-2e-3"}) {
        const ColumnTable table = parse_csv(text, "a.csv");
        ASSERT_TRUE(table.find("t") && table.find("x")) << text;
        EXPECT_EQ(*table.find("t"), (std::vector<double>{0, 0.5})) << text;
        EXPECT_EQ(*table.find("x"), (std::vector<double>{1.5, -2e-3})) << text;
    }
}

TEST(TableReader, ReadsUtf16AndWindows1252) {
    const std::string plain = "t,\xCE\xB8\n0,1\n";
    for (const bool little : {true, false})
        for (const bool mark : {true, false}) {
            std::string wide;
            for (const unsigned c : {mark ? 0xFEFFu : 't', mark ? unsigned('t') : ',', mark ? unsigned(',') : 0x3B8u,
                                     mark ? 0x3B8u : '\n', mark ? unsigned('\n') : '0', mark ? unsigned('0') : ',',
                                     mark ? unsigned(',') : '1', mark ? unsigned('1') : '\n'}) {
                const char low = static_cast<char>(c & 0xff), high = static_cast<char>(c >> 8);
                wide += little ? std::string{low, high} : std::string{high, low};
            }
            const ColumnTable table = parse_csv(wide, "a.csv");
            EXPECT_EQ(table.names(), parse_csv(plain, "a.csv").names()) << little << mark;
            EXPECT_EQ(*table.find("\xCE\xB8"), (std::vector<double>{1}));
        }
    EXPECT_EQ(parse_csv("t,\x80 \xB0\n0,1\n", "a.csv").names().back(), "\xE2\x82\xAC \xC2\xB0");  // "€ °"
    EXPECT_THAT(io_error_of([] { parse_csv(std::string("t,x\n0,1\0\n", 9), "a.csv"); }),
                ::testing::HasSubstr("zero bytes"));
    EXPECT_THAT(io_error_of([] { parse_csv("\xFF\xFEt", "a.csv"); }), ::testing::HasSubstr("not valid UTF-16LE"));
}

TEST(TableReader, ReadsUnitsBelowTheNamesOfASpreadsheetWithDecimalCommas) {
    const ColumnTable table = parse_csv("rig\nt;angle [deg]\ns;\n0;1,5\n", "a.csv");
    EXPECT_EQ(table.names(), (std::vector<std::string>{"t", "angle [deg]"}));
    EXPECT_EQ(table.columns[1].values, (std::vector<double>{1.5}));
    EXPECT_EQ(table.columns[0].unit, "s");
    EXPECT_EQ(table.columns[1].unit, "deg");
    EXPECT_EQ(table.row_name(0), "line 4");
}

TEST(TableReader, AColumnHasItsNameWithoutTheUnit) {
    const ColumnTable table = parse_csv("X [mm],Y(mm),r [m],r (mm),[deg]\n1,2,3,4,5\n", "a.csv");
    ASSERT_TRUE(table.column("X") && table.column("Y"));
    EXPECT_EQ(table.column("X")->unit, "mm");
    EXPECT_EQ(table.column("Y")->values[0], 2);
    EXPECT_EQ(table.column("r (mm)")->values[0], 4);
    for (const char* name : {"r", "x", "X [", "", "X [mm"}) EXPECT_EQ(table.column(name), nullptr) << name;
}

// A class by its number, and an exponent of −∞.
TEST(TableReader, ReadsTheTablesOfSweeps) {
    const ColumnTable table =
        parse_csv("cam.speed,class,exponent\n1,following,-inf\n2,periodic,-3\n3,rest,\n", "r.csv");
    EXPECT_EQ(*table.find("class"), (std::vector<double>{1, 2, 0}));
    EXPECT_EQ((*table.find("exponent"))[0], -std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::isnan((*table.find("exponent"))[2]));
}

TEST(TableReader, SaysWhereACsvIsWrong) {
    const auto error = [](const std::string& text) { return io_error_of([&] { parse_csv(text, "a.csv"); }); };
    EXPECT_EQ(problem_of("t,x\n1,2\n3,abc\n", "x"), "q.csv:3:3: \"abc\" is not a number; correct this cell");
    EXPECT_THAT(problem_of("t,x\n1,2\n3, -inf\n", "x"), ::testing::HasSubstr(":3:4: \"-inf\" is not a finite number"));
    EXPECT_THAT(problem_of("t,t\n1,2\n", "t"), ::testing::HasSubstr("occurs twice"));
    EXPECT_THAT(problem_of("t\tx\n1\t2.5\n2\t3,5\n", "x"), ::testing::HasSubstr(":3:3: \"3,5\" has another decimal"));
    EXPECT_THAT(problem_of("t\tx\n1.5\t2\n2.5\t3,567\n", "x"), ::testing::HasSubstr("a decimal comma, but other"));
    EXPECT_NE(error("t,x\n1,2\n3\n").find("a.csv:3:1: the number of cells is 1 here"), std::string::npos);
    EXPECT_NE(error("t,x\n1,2\n3,4,5\n").find("a.csv:3:1: the number of cells is 3 here"), std::string::npos);
    EXPECT_NE(error("").find("empty"), std::string::npos);
    EXPECT_NE(error("\n \n").find("empty"), std::string::npos);
    EXPECT_NE(error("1,2\n").find("a.csv:1:1: a number where the names"), std::string::npos);
    EXPECT_NE(error("t,x\n0,5,1,5\n1,5,2,5\n").find("decimal commas"), std::string::npos);
    EXPECT_NE(error(std::string(30000, ',') + "\n").find("columns"), std::string::npos);
}

// Columns that nobody asks for may hold anything, and are not even expanded.
TEST(TableReader, ArraysThatNobodyAsksForDoNotMatter) {
    Scratch scratch;
    output_of("cd " + in_shell(scratch.path()) +
              " && /usr/bin/python3 -c \"import numpy as n; n.savez_compressed('a.npz', big=n.zeros(40000000), "
              "t=n.arange(3.), x=n.arange(3, dtype='i2'), name=n.array(['a']), grid=n.zeros((2, 3)), one=n.array(7), "
              "long=n.arange(9), c=n.arange(3)*1j, o=n.array([None]))\"");
    const auto some = [](const std::string& name) { return name == "t" || name == "x"; };
    const ColumnTable table = read_columns(scratch / "a.npz", some);
    EXPECT_EQ(*table.find("t"), (std::vector<double>{0, 1, 2}));
    EXPECT_EQ(*table.find("x"), (std::vector<double>{0, 1, 2}));
    EXPECT_EQ(table.names().size(), 9U);
    const auto error = [&](const std::string& name) {
        return io_error_of([&] {
            read_columns(scratch / "a.npz", [&](const std::string& other) { return other == name; }).find(name);
        });
    };
    EXPECT_THAT(error("big"), ::testing::HasSubstr("256 MiB"));
    EXPECT_THAT(error("name"), ::testing::HasSubstr("elements of type"));
    EXPECT_THAT(error("grid"), ::testing::HasSubstr("\"(2, 3)\"; a column has one dimension"));
    EXPECT_THAT(error("c"), ::testing::HasSubstr("<c16"));
    EXPECT_THAT(error("o"), ::testing::HasSubstr("|O"));
    EXPECT_THAT(io_error_of([&] { read_table(scratch / "a.npz"); }), ::testing::HasSubstr("a.npz"));
}

// An archive with one stored array, whose header is this text.
std::string archive_of(const std::string& header, const std::string& data) {
    std::string npy = "\x93NUMPY";
    append_bytes(npy, 1, 1), append_bytes(npy, 0, 1), append_bytes(npy, header.size(), 2);
    npy += header + data;
    std::string record;
    for (const std::uint64_t zero : {20, 0, 0, 0, 0}) append_bytes(record, zero, 2);
    append_bytes(record, libdeflate_crc32(0, npy.data(), npy.size()), 4);
    append_bytes(record, npy.size(), 4), append_bytes(record, npy.size(), 4), append_bytes(record, 5, 2);
    append_bytes(record, 0, 2);
    std::string bytes = "PK\3\4" + record + "t.npy" + npy;
    const std::size_t directory = bytes.size();
    bytes += "PK\1\2";
    append_bytes(bytes, 20, 2);
    bytes += record;
    for (const int size : {2, 2, 2, 4, 4}) append_bytes(bytes, 0, size);
    bytes += "t.npy";
    const std::size_t end = bytes.size();
    bytes += "PK\5\6";
    append_bytes(bytes, 0, 4), append_bytes(bytes, 1, 2), append_bytes(bytes, 1, 2);
    append_bytes(bytes, end - directory, 4), append_bytes(bytes, directory, 4), append_bytes(bytes, 0, 2);
    return bytes;
}

TEST(TableReader, HeadersThatLieAboutTheirArraysAreRefused) {
    const auto all = [](const std::string&) { return true; };
    const auto header = [](const std::string& type, const std::string& shape) {
        return "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + shape + "), }\n";
    };
    const std::string data(24, '\0');
    const ColumnTable table = parse_npz(archive_of(header("<f8", "3,"), data), "a.npz", all);
    EXPECT_EQ(*table.find("t"), (std::vector<double>{0, 0, 0}));
    for (const auto& [type, shape] :
         {std::pair{"<f8", "-3,"}, std::pair{"<f8", "4,"}, std::pair{"<f8", "2,"},
          std::pair{"<f8", "99999999999999999999,"}, std::pair{"<f8", "4611686018427387907,"}, std::pair{"<f8", "3, 1"},
          std::pair{"<f8", ""}, std::pair{"<f8", "3,,"}, std::pair{"<f8 ", "3,"}, std::pair{"|O", "3,"},
          std::pair{"", "3,"}, std::pair{">f8", "3,"}, std::pair{"<f16", "1,"}, std::pair{"<i4", "5,"}})
        EXPECT_NE(io_error_of([&] { parse_npz(archive_of(header(type, shape), data), "a.npz", all).find("t"); }), "")
            << type << " " << shape;
    for (const std::string text : {"", "{", "{'descr': '<f8'", "{'descr': '<f8', 'shape': (3"})
        EXPECT_NE(io_error_of([&] { parse_npz(archive_of(text, data), "a.npz", all).find("t"); }), "") << text;
}

TEST(TableReader, TakesEndingsInCapitalsAndRefusesPipes) {
    Scratch scratch;
    write_file(scratch / "A.CSV", "t\n1\n");
    write_file(scratch / "a.Txt", "t\n1\n");
    for (const char* name : {"A.CSV", "a.Txt"}) EXPECT_EQ(read_table(scratch / name).rows(), 1U);
    EXPECT_THAT(io_error_of([&] { read_table(scratch / "a.nc"); }), ::testing::HasSubstr("written only"));
    EXPECT_THAT(io_error_of([&] { read_table(scratch / "a.xlsx"); }), ::testing::HasSubstr("export the table as .csv"));
    ASSERT_EQ(mkfifo((scratch / "p.csv").c_str(), 0600), 0);
    EXPECT_THAT(io_error_of([&] { read_table(scratch / "p.csv"); }), ::testing::HasSubstr("not a regular file"));
}

TEST(TableReader, EveryCutOfAnArchiveIsRefused) {
    Scratch scratch;
    write_table(scratch / "a.npz", small_table());
    const std::string whole = read_file(scratch / "a.npz");
    for (std::size_t size = 0; size < whole.size(); size += 5) {
        write_file(scratch / "cut.npz", whole.substr(0, size), Durability::buffered);
        EXPECT_NE(io_error_of([&] { read_table(scratch / "cut.npz"); }).find("cut.npz"), std::string::npos) << size;
    }
    for (std::size_t at = 0; at < whole.size(); at += 3) {  // never a crash; an unread byte may change nothing
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0xff);
        write_file(scratch / "bad.npz", damaged, Durability::buffered);
        try {
            EXPECT_EQ(read_table(scratch / "bad.npz").rows(), 3u) << at;
        } catch (const IoError&) {
        }
    }
}

}  // namespace
}  // namespace beamcam::output
