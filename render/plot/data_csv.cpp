// The plotted numbers of a figure as a table.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "render/draw/markup.hpp"
#include "render/plot/figure.hpp"

namespace beamcam::render::figure {
namespace {

void append(std::string& out, double value) {
    if (!std::isfinite(value)) return;
    char buffer[32];
    out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 17).ptr);
}

// A CSV cell, quoted if it holds commas or quotes.
std::string csv_cell(const std::string& plain) {
    if (plain.find_first_of(",\"\n") == std::string::npos) return plain;
    std::string out = "\"";
    for (const char c : plain) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + '"';
}
std::string cell_text(const std::string& markup) { return csv_cell(to_plain(markup)); }

std::string quantity_of(const Axis& axis) { return axis.label.substr(0, axis.label.rfind(" / ")); }

// The end of a step is sampled again as the beginning of the next one; where the motion jumps, both values stay.
Series without_repeats(const Series& curve) {
    constexpr double kRounding = 1e-12;  // of the value
    Series out = curve;
    out.x.clear(), out.y.clear(), out.value.clear();
    for (std::size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i) {
        const double y = curve.y[i];
        if (!out.x.empty() && out.x.back() == curve.x[i] && std::abs(out.y.back() - y) <= kRounding * std::abs(y))
            continue;
        out.add(curve.x[i], y);
        if (i < curve.value.size()) out.value.push_back(curve.value[i]);
    }
    return out;
}

// Adds the rows of a panel.
class PanelRows {
  public:
    PanelRows(std::string& out, const Panel& panel, std::string name)
        : out_(out), panel_(panel), name_(std::move(name)) {}

    void add() {
        for (const Series& drawn : panel_.series) {
            const Series s = drawn.line ? without_repeats(drawn) : drawn;
            rows(cell_text(!s.name.empty()    ? s.name
                           : !s.label.empty() ? s.label
                                              : quantity_of(panel_.y)),
                 panel_.y, s.x, s.y, s.value);
        }
        for (const Band& b : panel_.bands) {
            const std::string band = cell_text(b.label.empty() ? quantity_of(panel_.y) : b.label);
            rows(band + " (low)", panel_.y, b.x, b.low);
            rows(band + " (high)", panel_.y, b.x, b.high);
        }
        for (const Cells& c : panel_.cells) add_cells(c);
        for (const Cloud& c : panel_.clouds) rows(text_or(c.label, "points"), panel_.y, c.x, c.y);
        for (const Rule& r : panel_.rules)
            rows(text_or(r.label, "line"), panel_.y, {r.vertical ? r.at : NAN}, {r.vertical ? NAN : r.at});
        for (const Mark& m : panel_.marks) rows(text_or(m.label, "mark"), panel_.y, {m.x}, {m.y});
        for (const Shape& s : panel_.shapes) add_shape(s);
    }

  private:
    static std::string text_or(const std::string& label, const char* otherwise) {
        return label.empty() ? otherwise : cell_text(label);
    }

    void rows(const std::string& series, const Axis& y, const std::vector<double>& xs, const std::vector<double>& ys,
              const std::vector<double>& values = {}) {
        const std::string head = fmt::format("{},{},{},", name_, series, cell_text(panel_.x.label));
        const std::string middle = fmt::format(",{},", cell_text(y.label));
        for (std::size_t i = 0; i < std::min(xs.size(), ys.size()); ++i) {
            out_ += head;
            append(out_, xs[i]);
            out_ += middle;
            append(out_, ys[i]);
            out_ += ',';
            if (i < values.size()) append(out_, values[i]);
            out_ += '\n';
        }
    }

    void add_cells(const Cells& c) {
        const std::string what = panel_.color_bar ? cell_text(panel_.color_bar->label) : "cells";
        const std::size_t columns = c.x.size() - 1;
        std::vector<double> xs, ys;  // middles
        for (std::size_t i = 0; i < c.values.size(); ++i) {
            xs.push_back(0.5 * (c.x[i % columns] + c.x[i % columns + 1]));
            ys.push_back(0.5 * (c.y[i / columns] + c.y[i / columns + 1]));
        }
        rows(what, panel_.y, xs, ys, c.values);
    }

    void add_shape(const Shape& s) {
        if (s.kind == Shape::Kind::label || s.radius_points != 0) return;
        const bool round = s.kind == Shape::Kind::circle || s.kind == Shape::Kind::disc;
        std::vector<double> xs, ys;
        for (const Vec2 p : s.points) xs.push_back(p.x), ys.push_back(p.y);
        if (round) xs.push_back(s.centre.x), ys.push_back(s.centre.y);
        rows(round ? "circle (radius in the last column)" : "shape", panel_.y, xs, ys,
             round ? std::vector<double>{s.radius} : std::vector<double>{});
    }

    std::string& out_;
    const Panel& panel_;
    std::string name_;
};

// ---- one column a curve ------------------------------------------------------------------------

// Points of a curve in the order of a key, which is x or t.
struct CurveColumn {
    std::string name;
    std::vector<std::pair<double, double>> points;  // key, value

    // Sorts, and removes repetitions and gaps beside values of the same key.
    void finish() {
        constexpr double kRounding = 1e-12;  // of the value
        std::erase_if(points, [](const auto& point) { return std::isnan(point.first); });
        std::ranges::stable_sort(points, {}, &std::pair<double, double>::first);
        std::vector<std::pair<double, double>> kept;
        for (const auto& [key, value] : points) {
            const bool again = !kept.empty() && kept.back().first == key;
            const double before = again ? kept.back().second : NAN;
            if (again && (std::isnan(value) || std::abs(before - value) <= kRounding * std::abs(value))) continue;
            if (again && std::isnan(before)) kept.pop_back();
            kept.emplace_back(key, value);
        }
        points = std::move(kept);
    }
};

class CurveTable {
  public:
    // The label of the key; empty: the figure is no table of curves.
    static std::string key_of(const Figure& figure) {
        bool timed = true, ascending = true, same_x = true, any = false;
        for (const Panel& panel : figure.panels) {
            if (!panel.cells.empty() || !panel.clouds.empty() || !panel.shapes.empty()) return "";
            same_x = same_x && panel.x.label == figure.panels.front().x.label;
            for (const Series& curve : panel.series) {
                any = true;
                timed = timed && curve.t.size() == curve.x.size();
                ascending = ascending && std::ranges::is_sorted(curve.x);
            }
        }
        if (!any) return "";
        std::string x = to_plain(figure.panels.front().x.label);
        if (same_x && ascending) return x;
        return timed ? kTime : "";
    }

    CurveTable(const Figure& figure, const std::string& key) : key_(key) {
        for (const Panel& panel : figure.panels) {
            by_x_ = to_plain(panel.x.label) == key;
            add(panel);
        }
        for (CurveColumn& column : columns_) column.finish();
    }

    std::string csv() const {
        std::string out = csv_cell(key_);
        for (const CurveColumn& column : columns_) out += "," + csv_cell(column.name);
        out += "\n";
        std::vector<std::size_t> next(columns_.size(), 0);
        for (double key = first_key(next); std::isfinite(key); key = first_key(next)) add_rows(out, next, key);
        return out;
    }

  private:
    static constexpr const char* kTime = "t / s";

    void add(const Panel& panel) {
        const Series* faded = nullptr;  // a part of the next curve
        std::size_t begun = 0;
        for (const Series& curve : panel.series) {
            const bool goes_on = faded && faded->look == curve.look;
            if (!goes_on) {
                begun = columns_.size();
                if (!by_x_) columns_.push_back({name_of(panel, panel.x, curve), {}});
                columns_.push_back({name_of(panel, panel.y, curve), {}});
                if (!curve.value.empty() && panel.color_bar)
                    columns_.push_back({name_of(panel, Axis{.label = panel.color_bar->label}, curve), {}});
            } else if (!curve.label.empty()) {  // the part that is reproducible has the name
                CurveColumn& column = columns_[begun + (by_x_ ? 0 : 1)];
                column.name.clear();
                column.name = name_of(panel, panel.y, curve);
            }
            add_points(curve, begun);
            faded = curve.faded ? &curve : nullptr;
        }
        for (const Band& band : panel.bands)
            for (const auto& [end, values] : {std::pair{"low", &band.low}, std::pair{"high", &band.high}})
                if (by_x_) {
                    columns_.push_back(
                        {fmt::format("{} ({})", name_of(panel, panel.y, {.label = band.label}), end), {}});
                    for (std::size_t i = 0; i < std::min(band.x.size(), values->size()); ++i)
                        columns_.back().points.emplace_back(band.x[i], (*values)[i]);
                }
    }

    void add_points(const Series& curve, std::size_t column) {
        const std::vector<double>& keys = by_x_ ? curve.x : curve.t;
        const auto fill = [&](const std::vector<double>& values) {
            for (std::size_t i = 0; i < std::min(keys.size(), values.size()); ++i)
                columns_[column].points.emplace_back(keys[i], values[i]);
            ++column;
        };
        if (!by_x_) fill(curve.x);
        fill(curve.y);
        if (column < columns_.size() && !curve.value.empty()) fill(curve.value);
    }

    // "θ / rad"; after the name of a curve that is not listed in the label, and with a number if it is taken.
    std::string name_of(const Panel& panel, const Axis& axis, const Series& curve) const {
        const std::string own = !curve.name.empty() ? curve.name : curve.label, quantity = to_plain(axis.label);
        const std::size_t unit = std::min(quantity.rfind(" / "), quantity.size());
        const bool listed = (", " + quantity.substr(0, unit) + ",").find(", " + to_plain(own) + ",") != quantity.npos;
        std::string name = own.empty() ? quantity
                           : listed    ? to_plain(own) + quantity.substr(unit)
                                       : to_plain(own) + ": " + quantity;
        const auto taken = [&](const std::string& other) {
            return other == key_ || std::ranges::find(columns_, other, &CurveColumn::name) != columns_.end();
        };
        if (taken(name) && !panel.letter.empty()) name = panel.letter + ": " + name;
        const std::string base = name;
        for (int number = 2; taken(name); ++number) name = fmt::format("{} ({})", base, number);
        return name;
    }

    double first_key(const std::vector<std::size_t>& next) const {
        double least = INFINITY;
        for (std::size_t c = 0; c < columns_.size(); ++c)
            if (next[c] < columns_[c].points.size()) least = std::min(least, columns_[c].points[next[c]].first);
        return least;
    }

    // The rows of a key; a curve with one point there has it in all of them.
    void add_rows(std::string& out, std::vector<std::size_t>& next, double key) const {
        std::size_t rows = 1;
        std::vector<std::size_t> counts;
        for (std::size_t c = 0; c < columns_.size(); ++c) {
            const auto& points = columns_[c].points;
            std::size_t count = 0;
            while (next[c] + count < points.size() && points[next[c] + count].first == key) ++count;
            counts.push_back(count);
            rows = std::max(rows, count);
        }
        for (std::size_t row = 0; row < rows; ++row) {
            append(out, key);
            for (std::size_t c = 0; c < columns_.size(); ++c) {
                out += ',';
                if (counts[c] > 0) append(out, columns_[c].points[next[c] + std::min(row, counts[c] - 1)].second);
            }
            out += '\n';
        }
        for (std::size_t c = 0; c < columns_.size(); ++c) next[c] += counts[c];
    }

    std::string key_;
    bool by_x_ = true;  // of the panel
    std::vector<CurveColumn> columns_;
};

}  // namespace

std::string data_csv(const Figure& figure) {
    if (const std::string key = CurveTable::key_of(figure); !key.empty()) return CurveTable(figure, key).csv();
    std::string out = "panel,series,x_quantity,x,y_quantity,y,value\n";
    int number = 0;
    for (const Panel& panel : figure.panels) {
        ++number;
        PanelRows(out, panel, !panel.letter.empty() ? panel.letter : std::to_string(number)).add();
    }
    return out;
}

}  // namespace beamcam::render::figure
