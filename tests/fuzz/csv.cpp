// The reader of CSV tables: columns of one length, or the place of what is wrong.
#include "output/data/tables.hpp"
#include "tests/fuzz/support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace beamcam;
    for (const output::Texts texts : {output::Texts::rejected, output::Texts::kept}) try {
            const output::ColumnTable table = output::parse_csv(fuzz::text_of(data, size), "fuzz.csv", texts);
            fuzz::claim(!table.columns.empty(), "there are columns");
            for (const auto& column : table.columns) {
                fuzz::claim(column.values.size() == table.rows(), "columns are of one length");
                fuzz::claim(column.texts.size() <= (texts == output::Texts::kept ? table.rows() : 0), "texts are kept");
            }
            for (const std::string& name : table.names())
                fuzz::claim(table.find(name) != nullptr, "a name finds its column");
        } catch (const output::IoError& error) {
            fuzz::claim(error.what()[0] != 0, "a refusal says why");
        }
    return 0;
}
