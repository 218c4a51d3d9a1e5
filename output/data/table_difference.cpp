#include "output/data/table_difference.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>

namespace beamcam::output {

namespace {

constexpr double kSameInstant = 1e-9;  // [s], relative beyond one second: far below any sampling, far above rounding

struct Pair {
    std::size_t a, b;  // rows
    double t;
};

// An order of all numbers: empty cells come last.
bool comes_before(double x, double y) { return x < y || (std::isnan(y) && !std::isnan(x)); }

bool is_same_instant(double x, double y) {
    if (std::isnan(x) || std::isnan(y)) return std::isnan(x) && std::isnan(y);
    return x == y || std::abs(x - y) <= kSameInstant * std::max(1.0, std::abs(x));
}

std::vector<std::size_t> in_order_of(const std::vector<double>& t) {
    std::vector<std::size_t> order(t.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(order, [&](std::size_t i, std::size_t k) { return comes_before(t[i], t[k]); });
    return order;
}

std::vector<Pair> common_rows(const ColumnTable& a, const ColumnTable& b, double until,
                              std::optional<OtherInstant>& other) {
    std::vector<Pair> pairs;
    const auto instants = [](const ColumnTable& table) {  // null also if they are texts
        const TableColumn* t = table.column("t");
        return t && t->problem.empty() ? &t->values : nullptr;
    };
    const std::vector<double>*ta = instants(a), *tb = instants(b);
    if (ta == nullptr || tb == nullptr) {
        for (std::size_t i = 0; i < std::min(a.rows(), b.rows()); ++i) pairs.push_back({i, i, NAN});
        return pairs;
    }
    const std::vector<std::size_t> oa = in_order_of(*ta), ob = in_order_of(*tb);
    for (std::size_t i = 0, k = 0; i < oa.size() && k < ob.size();) {
        const double x = (*ta)[oa[i]], y = (*tb)[ob[k]];
        if (is_same_instant(x, y)) {
            if (!(x > until)) pairs.push_back({oa[i], ob[k], x});
            ++i, ++k;
            continue;
        }
        if (!other) other = {oa[i], x, y};
        ++(comes_before(x, y) ? i : k);
    }
    return pairs;
}

// The first of equal names counts.
std::map<std::string, const TableColumn*> by_name(const ColumnTable& table) {
    std::map<std::string, const TableColumn*> columns;
    for (const TableColumn& column : table.columns) columns.try_emplace(column.name, &column);
    return columns;
}

bool same_bits(double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y) || (std::isnan(x) && std::isnan(y));
}

ColumnDifference compare(const TableColumn& a, const TableColumn& b, const std::vector<Pair>& rows) {
    ColumnDifference d;
    d.name = a.name;
    double least = INFINITY, most = -INFINITY;
    for (const Pair& row : rows) {
        const double x = a.values[row.a], y = b.values[row.b];
        const bool is_class = a.name == "class";  // a name, although tables hold its number
        if (a.text(row.a) != b.text(row.b) || (is_class && !same_bits(x, y))) ++d.texts, d.identical = false;
        if (is_class || !a.text(row.a).empty() || !b.text(row.b).empty()) continue;
        if (!same_bits(x, y)) d.identical = false;
        if (std::isnan(x) != std::isnan(y)) ++d.undefined;
        if (std::isfinite(x)) least = std::min(least, x), most = std::max(most, x);
        const double step = std::isnan(x) || std::isnan(y) || x == y ? 0 : std::abs(y - x);
        if (step > d.largest) d.largest = step, d.t = row.t;
    }
    d.range = most > least ? most - least : 0;
    const double scale = d.range > 0 ? d.range : std::abs(most);
    d.share = d.largest == 0 ? 0 : scale > 0 && std::isfinite(scale) ? d.largest / scale : 1;
    return d;
}

}  // namespace

bool TableDifference::identical() const {
    return same_shape() && std::ranges::all_of(columns, &ColumnDifference::identical);
}

bool TableDifference::within(double share) const {
    return same_shape() && std::ranges::all_of(columns, [share](const ColumnDifference& c) {
               return c.undefined == 0 && c.texts == 0 && c.share <= share;
           });
}

TableDifference difference(const ColumnTable& a, const ColumnTable& b, double until) {
    TableDifference d;
    d.rows_a = a.rows();
    d.rows_b = b.rows();
    const std::vector<Pair> rows = common_rows(a, b, until, d.other_instant);
    d.rows_compared = rows.size();
    const std::map<std::string, const TableColumn*> in_a = by_name(a), in_b = by_name(b);
    for (const TableColumn& column : a.columns) {
        if (const auto other = in_b.find(column.name); other != in_b.end())
            d.columns.push_back(compare(column, *other->second, rows));
        else
            d.only_in_a.push_back(column.name);
    }
    for (const TableColumn& column : b.columns)
        if (!in_a.contains(column.name)) d.only_in_b.push_back(column.name);
    return d;
}

}  // namespace beamcam::output
