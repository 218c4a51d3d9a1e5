// The differences of two tables of a motion, column by column, at the common instants.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "output/data/tables.hpp"

namespace beamcam::output {

struct ColumnDifference {
    std::string name;
    double largest = 0;         // |b − a|, in the column's unit
    double t = 0;               // its instant; without a column "t", the number of the row, from 0; NaN: "t" is empty
    double range = 0;           // of `a` over the rows compared: largest minus smallest value
    double share = 0;           // largest / range; with no range: largest / |a|, or 1 where `a` is 0
    std::size_t undefined = 0;  // rows where one of the two is empty and the other is not
    std::size_t texts = 0;      // rows with different texts or classes, or with a text in one of the two only
    bool identical = true;      // every bit, empty cells included
};

struct OtherInstant {
    std::size_t row;  // of `a`, from 0
    double a, b;
};

struct TableDifference {
    std::size_t rows_a = 0, rows_b = 0, rows_compared = 0;
    std::optional<OtherInstant> other_instant;      // the first, in the order of the instants
    std::vector<std::string> only_in_a, only_in_b;  // columns
    std::vector<ColumnDifference> columns;          // in the order of `a`

    bool same_shape() const {
        return rows_a == rows_b && rows_compared == rows_a && only_in_a.empty() && only_in_b.empty();
    }
    bool identical() const;
    // No value differs by more than `share` of its column's range, and no text or class at all.
    bool within(double share) const;
};

// Compares rows with equal "t" (to a billionth), or with equal numbers if a table has no "t"; rows with an empty "t" in
// their order. Rows with t > `until` are not compared.
TableDifference difference(const ColumnTable& a, const ColumnTable& b,
                           double until = std::numeric_limits<double>::infinity());

}  // namespace beamcam::output
