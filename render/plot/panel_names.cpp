#include "render/plot/panel_names.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "render/plot/drawn_curve.hpp"

namespace beamcam::render::figure {
namespace {

// In sizes of letters: between lines; the height of a row of the legend, and the space between its entries.
constexpr double kLineStep = 1.25, kRow = 1.35, kBetween = 0.75;

// Breaks a label at spaces outside of formulas into lines that fit.
std::vector<std::string> lines_of(const std::string& markup, double room, const TextStyle& lettering,
                                  const PageCanvas& sheet) {
    std::vector<std::string> lines;
    std::string word;
    int depth = 0;
    bool formula = false;
    const auto end_word = [&] {
        if (!lines.empty() && sheet.measure(lines.back() + " " + word, lettering).w <= room)
            lines.back() += " " + word;
        else if (!word.empty())
            lines.push_back(word);
        word.clear();
    };
    for (std::size_t i = 0; i < markup.size(); ++i) {
        const char c = markup[i];
        if (c == '$') formula = !formula;
        depth += c == '{' || c == '(' ? 1 : c == '}' || c == ')' ? -1 : 0;
        if (c == ' ' && !formula && depth == 0) {
            end_word();
            continue;
        }
        word += c;
        if (c == '\\' && i + 1 < markup.size()) word += markup[++i];
    }
    end_word();
    return lines;
}

// The labels of the lines that look like `first`, which share an entry; empty if an earlier line has it.
std::string shared_label(const std::vector<Series>& all, const Series& first) {
    std::string label;
    for (const Series& s : all) {
        const bool alike =
            &s == &first || (s.line && first.line && s.look == first.look && color_of(s) == color_of(first));
        if (!alike || s.label.empty()) continue;
        if (label.empty() && &s != &first) return {};
        label += (label.empty() ? "" : ", ") + s.label;
    }
    return label;
}
}  // namespace

// ---- measuring ----------------------------------------------------------------------------------------

PanelNames::PanelNames(const Panel& panel, const PlotStyle& style, PageCanvas& sheet, bool lowest, bool legend)
    : panel_(panel), style_(style), sheet_(sheet), lowest_(lowest) {
    const auto add = [&](const std::string& label, const Series* series, Color color, bool dots) {
        if (label.empty()) return;
        const double width = kSampleLength * style_.letters + style_.gap + sheet_.measure(label, style_.words()).w;
        entries_.push_back({label, series, color, dots, width, {}});
        widest_entry_ = std::max(widest_entry_, width);
    };
    if (!legend) return;
    for (const Series& s : panel_.series)
        if (!s.label.empty()) add(shared_label(panel_.series, s), &s, {}, false);
    for (const Band& b : panel_.bands) add(b.label, nullptr, pale(look(b.look).color, 0.72), false);
    for (const Cloud& c : panel_.clouds) add(c.label, nullptr, c.color, true);
    for (const Swatch& w : panel_.swatches) add(w.label, nullptr, w.color, false);
}

PanelNames::Label PanelNames::broken(std::string label, double room) const {
    if (const std::size_t unit = label.rfind(" / "); unit != std::string::npos)
        label.replace(unit + 2, 1, "\u00A0");  // not broken after the stroke
    Label out{lines_of(label, room, style_.words(), sheet_)};
    if (out.lines.size() > 1) out.beside = static_cast<double>(out.lines.size() - 1) * kLineStep * style_.letters;
    return out;
}

double PanelNames::widest(const AxisMap& axis) const {
    double w = 0;
    for (const Tick& t : axis.ticks())
        if (!t.label.empty()) w = std::max(w, sheet_.measure(t.label, style_.tick_numbers()).w);
    return w;
}

void PanelNames::fit(const Plot& plot, double width, double height) {
    x_ = broken(plot.x().label(), 1.1 * width);
    y_ = broken(plot.y().label(), 1.05 * height);
    widest_y_ = widest(plot.y());
    widest_bar_ = plot.bar() ? widest(*plot.bar()) : 0;
    below_ = sheet_.cap_height(style_.numbers);
    beyond_left_ = beyond_right_ = 0;
    for (const Tick& tick : plot.x().ticks()) {
        if (!lowest_ || !panel_.x.numbered || tick.label.empty()) continue;
        const double half = 0.5 * sheet_.measure(tick.label, style_.tick_numbers()).w;
        beyond_left_ = std::max(beyond_left_, half - tick.at * width);
        beyond_right_ = std::max(beyond_right_, half - (1 - tick.at) * width);
    }
    below_ += plot.drop(sheet_);
    title_ = lines_of(panel_.title, width - (panel_.letter.empty() ? 0 : 2 * style_.letters), style_.words(), sheet_);
    titles_height_ = 0;
    if (!panel_.letter.empty() || !panel_.title.empty())
        titles_height_ = style_.letters + style_.gap +
                         (std::max(1.0, static_cast<double>(title_.size())) - 1) * kLineStep * style_.letters;
    arrange_legend(width - (has_letter_in_legend() ? letter_width() : 0));
    margins_ = room_around(plot);
}

void PanelNames::arrange_legend(double width) {
    Vec2 next;
    for (Entry& entry : entries_) {
        if (next.x > 0 && next.x + entry.width > width) next = {0, next.y + kRow * style_.letters};
        entry.at = next;
        next.x += entry.width + kBetween * style_.letters;
    }
}

double PanelNames::legend_height() const {
    return entries_.empty() ? 0 : entries_.back().at.y + kRow * style_.letters + style_.gap;
}

Margins PanelNames::room_around(const Plot& plot) const {
    const double number = sheet_.cap_height(style_.numbers), letter = style_.letters;
    Margins m;
    m.left = widest_y_ + (widest_y_ > 0 ? style_.gap : 0) + (panel_.y.label.empty() ? 0 : letter + 1.3 * style_.gap) +
             y_.beside;
    m.left = std::max(m.left, beyond_left_);
    m.bottom = number / 2;
    if (lowest_) {
        m.bottom = panel_.x.numbered ? below_ + style_.gap * 1.1 : style_.gap;
        if (!panel_.x.label.empty()) m.bottom += 1.05 * letter + style_.gap + x_.beside;
    }
    m.top = std::max(number / 2 + 0.5, titles_height_);
    if (!plot.y().common().empty()) m.top += style_.numbers + style_.gap;
    m.top += legend_height() - (has_letter_in_legend() ? titles_height_ : 0);
    m.right = std::max(1.3 * style_.numbers, beyond_right_);
    if (plot.bar()) m.right = before_bar() + 0.9 * letter + style_.gap + widest_bar_ + letter + 1.6 * style_.gap;
    return m;
}

// ---- drawing ------------------------------------------------------------------------------------------

void PanelNames::draw(const Plot& plot, const Box& bar_beside) const {
    if (lowest_) draw_label_below(plot);
    draw_labels_beside(plot);
    draw_common_factors(plot);
    const bool behind = has_letter_in_legend();
    const double top = plot.box().y - margins_.top,
                 baseline = behind ? 0.5 * (kRow * style_.letters + sheet_.cap_height(style_.letters)) : style_.letters;
    draw_legend({plot.box().x + (behind ? letter_width() : 0), top + (behind ? 0 : titles_height_)});
    draw_titles(plot, top + baseline, plot.y().common().empty() && entries_.empty());
    if (plot.bar() && !bar_beside.empty()) draw_color_bar(plot, bar_beside);
}

void PanelNames::draw_sample_of(const Entry& entry, Vec2 left, double width) const {
    if (entry.series) {
        draw_sample(sheet_, style_, *entry.series, left, left + Vec2{width, 0});
    } else if (entry.dots) {
        for (const double share : {0.2, 0.5, 0.8}) {
            sheet_.circle(left + Vec2{share * width, 0}, 0.5 * style_.marker);
            sheet_.fill(entry.color);
        }
    } else {
        sheet_.rectangle({left.x, left.y - 0.3 * style_.letters, width, 0.6 * style_.letters});
        sheet_.fill(entry.color);
    }
}

void PanelNames::draw_legend(Vec2 top_left) const {
    const double sample = kSampleLength * style_.letters;
    TextStyle l = style_.words();
    l.valign = VAlign::middle;
    for (const Entry& entry : entries_) {
        const Vec2 at = top_left + entry.at + Vec2{0, 0.5 * kRow * style_.letters};
        draw_sample_of(entry, at, sample);
        sheet_.text(at + Vec2{sample + style_.gap, 0}, entry.label, l);
    }
}

void PanelNames::draw_label_below(const Plot& plot) const {
    const Box& box = plot.box();
    const std::string& common = plot.x().common();
    if (!panel_.x.label.empty()) {
        TextStyle l = style_.words();
        l.align = HAlign::centre, l.valign = VAlign::top;
        double y = box.bottom() + (panel_.x.numbered ? below_ + style_.gap : 0) + 1.4 * style_.gap;
        // Clear of the power of ten at the right end.
        const double beside = common.empty() ? 0 : sheet_.measure(common, style_.tick_numbers()).w + 2 * style_.gap;
        for (const std::string& line : x_.lines) {
            const double half = 0.5 * sheet_.measure(line, l).w;
            const double x = beside > 0 ? std::min(box.centre().x, box.right() - beside - half) : box.centre().x;
            sheet_.text({x, y}, line, l), y += kLineStep * style_.letters;
        }
    }
    if (common.empty()) return;
    TextStyle numbers = style_.tick_numbers();
    numbers.align = HAlign::right, numbers.valign = VAlign::top;
    sheet_.text({box.right(), box.bottom() + below_ + 2.4 * style_.gap}, common, numbers);
}

void PanelNames::draw_labels_beside(const Plot& plot) const {
    const Box& box = plot.box();
    const double step = kLineStep * style_.letters;
    TextStyle l = style_.words();
    l.align = HAlign::centre;
    l.turned = std::numbers::pi / 2;
    double x = box.x - style_.gap - widest_y_ - 1.6 * style_.gap - y_.beside;
    for (const std::string& line : y_.lines) sheet_.text({x, box.centre().y}, line, l), x += step;
}

void PanelNames::draw_common_factors(const Plot& plot) const {
    const double y = plot.box().y - style_.gap;
    TextStyle common = style_.tick_numbers();
    if (!plot.y().common().empty()) sheet_.text({plot.box().x, y}, plot.y().common(), common);
}

TextStyle PanelNames::letter_style() const {
    TextStyle style = style_.words();
    style.weight = Weight::bold;
    return style;
}

double PanelNames::letter_width() const {
    if (panel_.letter.empty()) return 0;
    return sheet_.measure("(" + panel_.letter + ")", letter_style()).w + 0.5 * style_.letters;
}

void PanelNames::draw_titles(const Plot& plot, double top, bool alone) const {
    const double step = kLineStep * style_.letters;
    double y = top, x = plot.box().x;
    if (alone) y = plot.box().y - style_.gap - step * std::max(0.0, static_cast<double>(title_.size()) - 1);
    const TextStyle title = style_.words();
    if (!panel_.letter.empty()) sheet_.text({x, y}, "(" + panel_.letter + ")", letter_style());
    x += letter_width();
    for (const std::string& line : title_) sheet_.text({x, y}, line, title), y += step;
}

Color color_of(const ColorBar& bar, double place) {
    constexpr double kLinear = 0.02;  // share below which the root is a straight line
    const double share = bar.is_signed ? 2 * place - 1 : place;
    const double shown = bar.root ? share / std::sqrt(std::max(std::abs(share), kLinear)) : share;
    return bar.is_signed ? signed_color(shown) : map_color(shown);
}

void PanelNames::draw_color_bar(const Plot& plot, const Box& beside) const {
    const AxisMap& axis = *plot.bar();
    const Box bar{beside.right() + before_bar(), beside.y, 0.9 * style_.letters, beside.h};
    std::vector<Color> colors;
    constexpr int kSteps = 128;
    for (int k = 0; k <= kSteps; ++k) colors.push_back(color_of(*panel_.color_bar, static_cast<double>(k) / kSteps));
    sheet_.gradient(bar, colors);
    plot.draw_page_ticks(sheet_, axis, bar, Side::right, true, 0.6 * style_.tick, 0.35 * style_.tick);
    sheet_.rectangle(bar);
    sheet_.stroke({kInk, style_.frame, {}, Cap::butt});
    TextStyle l = style_.words();
    l.turned = std::numbers::pi / 2;
    l.align = HAlign::centre, l.valign = VAlign::top;
    std::string label = axis.label();
    if (!axis.common().empty()) label += "  (" + axis.common() + ")";
    sheet_.text({bar.right() + 2.2 * style_.gap + widest_bar_, bar.centre().y}, label, l);
}

}  // namespace beamcam::render::figure
