#include "output/data/table_reader.hpp"

#include <algorithm>
#include <cctype>

#include "output/files/atomic_file.hpp"
#include "output/json/source.hpp"

namespace beamcam::output {
namespace {

constexpr const char* kTextEndings[] = {".csv", ".tsv", ".txt", ".dat"};

}  // namespace

ColumnTable read_columns(const std::filesystem::path& file, const std::function<bool(const std::string&)>& wanted) {
    const std::string name = file.string();
    std::string ending = file.extension().string();
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const bool text = std::ranges::find(kTextEndings, ending) != std::end(kTextEndings);
    if (ending == ".nc")
        throw IoError("cannot read " + name + ": NetCDF files are written only; write .npz or .csv, too");
    if (!text && ending != ".npz")
        throw IoError("cannot read " + name + ": tables end in .csv or .npz; export the table as .csv");
    const std::string bytes = read_regular_file(file);
    return text ? parse_csv(bytes, name) : parse_npz(bytes, name, wanted);
}

ColumnTable read_table(const std::filesystem::path& file) {
    ColumnTable table = read_columns(file, [](const std::string&) { return true; });
    for (const TableColumn& column : table.columns) {
        const bool texts = !column.texts.empty();
        if (!texts && !column.problem.empty()) throw IoError(column.problem);
        if (column.values.size() != table.rows())
            throw IoError("cannot read " + file.string() + ": the array " + in_quotes(column.name) + " has " +
                          std::to_string(column.values.size()) + " rows, others have " + std::to_string(table.rows()));
    }
    return table;
}

}  // namespace beamcam::output
