// The reader of CSV tables: columns of one length, each with numbers alone or with the place of what is wrong.
#include "output/data/table_reader.hpp"
#include "tests/fuzz/support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace beamcam;
    try {
        const output::ColumnTable table = output::parse_csv(fuzz::text_of(data, size), "fuzz.csv");
        fuzz::claim(!table.columns.empty(), "there are columns");
        fuzz::claim(table.lines.size() == table.rows(), "each row has its line");
        for (const auto& column : table.columns) {
            fuzz::claim(column.values.size() == table.rows(), "columns are of one length");
            fuzz::claim(column.texts.size() <= table.rows(), "texts belong to rows");
            fuzz::claim(column.texts.empty() || !column.problem.empty(), "a column with texts says where");
        }
        for (const std::string& name : table.names())
            fuzz::claim(table.column(name) != nullptr, "a name finds its column");
    } catch (const output::IoError& error) {
        fuzz::claim(error.what()[0] != 0, "a refusal says why");
    }
    return 0;
}
