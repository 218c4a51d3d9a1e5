#include "scenes/figures/prefixes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "render/plot/ticks.hpp"

namespace beamcam::scenes {
namespace {

using render::figure::Figure;
using render::figure::Inset;
using render::figure::Panel;
using render::figure::Series;

// What axes show without a power of ten (render/plot/axis.cpp).
constexpr double kSmallest = 0.01, kLargest = 1e4;

struct PrefixedUnit {
    std::string symbol;  // of the label, before " / "
    double factor = 1;   // of its prefix
    std::string base;
};

std::optional<PrefixedUnit> unit_of(const std::string& label) {
    const std::size_t at = label.rfind(" / ");
    if (at == std::string::npos) return std::nullopt;
    const std::string text = label.substr(at + 3);
    constexpr render::Prefix kPrefixes[] = {{"", 1}, {"k", 1e3}, {"M", 1e6}, {"m", 1e-3}, {"µ", 1e-6}, {"n", 1e-9}};
    for (const char* base : {"m", "N", "J", "s", "Hz"})
        for (const render::Prefix& prefix : kPrefixes)
            if (text == std::string(prefix.symbol) + base)
                return PrefixedUnit{label.substr(0, at), prefix.factor, base};
    return std::nullopt;
}

// The largest number along an axis.
class Largest {
  public:
    void see(std::span<const double> values) {
        for (const double v : values)
            if (std::isfinite(v)) value_ = std::max(value_, std::abs(v));
    }
    void see(const std::optional<double>& value) {
        if (value) see({&*value, 1});
    }
    double value() const { return value_; }

  private:
    double value_ = 0;
};

// By what the numbers under this label are multiplied, and the label then.
std::pair<double, std::string> change(const std::string& label, double largest) {
    if (!(largest > 0) || (largest >= kSmallest && largest < kLargest)) return {1, label};
    constexpr std::string_view kThousandths = " / 10^{−3}", kMillionths = " / 10^{−6}";
    if (label.ends_with(kThousandths) && largest < kSmallest)
        return {1e3, label.substr(0, label.size() - kThousandths.size()) + std::string(kMillionths)};
    const std::optional<PrefixedUnit> unit = unit_of(label);
    if (!unit) return {1, label};
    const render::Prefix prefix = render::prefix_for(largest * unit->factor);
    return {unit->factor / prefix.factor, unit->symbol + " / " + prefix.symbol + unit->base};
}

void multiply(std::vector<double>& values, double factor) {
    for (double& v : values) v *= factor;
}
void multiply(std::optional<double>& value, double factor) {
    if (value) *value *= factor;
}

Largest largest_x(const Panel& p) {
    Largest out;
    for (const Series& s : p.series) out.see(s.x);
    for (const auto& c : p.cells) out.see(c.x);
    out.see(p.x.from), out.see(p.x.to);
    return out;
}
Largest largest_y(const Panel& p, bool right) {
    Largest out;
    for (const Series& s : p.series)
        if (s.right == right) out.see(s.y);
    for (const auto& c : p.cells)
        if (!right) out.see(c.y);
    const render::figure::Axis& axis = right ? *p.right : p.y;
    out.see(axis.from), out.see(axis.to);
    return out;
}

void scale_x(Panel& p, double factor) {
    if (factor == 1) return;
    for (Series& s : p.series) multiply(s.x, factor);
    for (auto& b : p.bands) multiply(b.x, factor);
    for (auto& c : p.cells) multiply(c.x, factor);
    for (auto& s : p.spans) s.from *= factor, s.to *= factor;
    for (auto& r : p.rules)
        if (r.vertical) r.at *= factor;
    for (auto& m : p.marks) m.x *= factor;
    for (Inset& i : p.insets)
        if (i.source) i.source->x_from *= factor, i.source->x_to *= factor;
    multiply(p.x.from, factor), multiply(p.x.to, factor);
}

void scale_y(Panel& p, bool right, double factor) {
    if (factor == 1) return;
    for (Series& s : p.series)
        if (s.right == right) multiply(s.y, factor);
    for (auto& m : p.marks)
        if (m.right == right) m.y *= factor;
    render::figure::Axis& axis = right ? *p.right : p.y;
    multiply(axis.from, factor), multiply(axis.to, factor);
    if (right) return;
    for (auto& b : p.bands) multiply(b.low, factor), multiply(b.high, factor);
    for (auto& c : p.cells) multiply(c.y, factor);
    for (auto& r : p.rules)
        if (!r.vertical) r.at *= factor;
    for (Inset& i : p.insets)
        if (i.source) i.source->y_from *= factor, i.source->y_to *= factor;
}

void scale_colors(Panel& p) {
    if (!p.color_bar || p.color_bar->scale == render::figure::Scale::logarithmic) return;
    Largest most;
    for (const Series& s : p.series) most.see(s.value);
    most.see(p.color_bar->from), most.see(p.color_bar->to);
    const auto [factor, label] = change(p.color_bar->label, most.value());
    if (factor == 1) return;
    p.color_bar->label = label;
    multiply(p.color_bar->from, factor), multiply(p.color_bar->to, factor);
    for (Series& s : p.series) multiply(s.value, factor);
    for (auto& c : p.cells) multiply(c.values, factor);
    for (Inset& i : p.insets) {  // in the colours of the panel around it
        Panel& inner = i.panel.front();
        if (!inner.color_bar || !inner.color_bar->hidden) continue;
        multiply(inner.color_bar->from, factor), multiply(inner.color_bar->to, factor);
        for (Series& s : inner.series) multiply(s.value, factor);
    }
}

void choose(std::span<Panel> panels) {
    std::map<std::string, double> along;  // panels above each other share the axis
    for (const Panel& p : panels) {
        double& most = along[p.x.label];
        most = std::max(most, largest_x(p).value());
    }
    for (Panel& p : panels) {
        const auto [across, x] = change(p.x.label, along[p.x.label]);
        scale_x(p, across), p.x.label = x;
        for (const bool right : {false, true}) {
            if (right && !p.right) continue;
            render::figure::Axis& axis = right ? *p.right : p.y;
            if (axis.scale == render::figure::Scale::logarithmic) continue;  // its marks are powers of ten
            const auto [up, y] = change(axis.label, largest_y(p, right).value());
            scale_y(p, right, up), axis.label = y;
        }
        scale_colors(p);
        for (Inset& i : p.insets) choose(i.panel);
    }
}

}  // namespace

void choose_prefixes(Figure& figure) { choose(figure.panels); }

}  // namespace beamcam::scenes
