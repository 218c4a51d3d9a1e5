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
std::string cell_text(const std::string& markup) {
    std::string plain = to_plain(markup);
    if (plain.find_first_of(",\"\n") == std::string::npos) return plain;
    std::string out = "\"";
    for (const char c : plain) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + '"';
}

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
            const Axis& axis = vertical(drawn.right);
            const Series s = drawn.line ? without_repeats(drawn) : drawn;
            rows(cell_text(!s.name.empty()    ? s.name
                           : !s.label.empty() ? s.label
                                              : quantity_of(axis)),
                 axis, s.x, s.y, s.value);
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
        for (const Mark& m : panel_.marks) rows(text_or(m.label, "mark"), vertical(m.right), {m.x}, {m.y});
        for (const Span& s : panel_.spans) rows(text_or(s.label, "interval"), panel_.y, {s.from, s.to}, {NAN, NAN});
        for (const Inset& inset : panel_.insets) PanelRows(out_, inset.panel.front(), name_ + " inset").add();
        for (const Shape& s : panel_.shapes) add_shape(s);
    }

  private:
    const Axis& vertical(bool right) const { return right && panel_.right ? *panel_.right : panel_.y; }
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

}  // namespace

std::string data_csv(const Figure& figure) {
    std::string out = "panel,series,x_quantity,x,y_quantity,y,value\n";
    int number = 0;
    for (const Panel& panel : figure.panels) {
        ++number;
        PanelRows(out, panel, !panel.letter.empty() ? panel.letter : std::to_string(number)).add();
    }
    return out;
}

}  // namespace beamcam::render::figure
