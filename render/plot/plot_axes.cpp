#include "render/plot/plot_axes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace beamcam::render::figure {
namespace {

constexpr double kLineStep = 1.25;  // between lines, in letters

// Breaks a label at spaces outside of formulas into lines that fit.
std::vector<std::string> lines_of(const std::string& markup, double room, const TextStyle& lettering,
                                  PageCanvas& sheet) {
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

struct Extents {
    Extent x, y, right, color;
};
Extents extents_of(const Panel& panel) {
    Extents all;
    const auto add = [&](std::span<const double> x, std::span<const double> y, bool right = false) {
        all.x.add(x, panel.x.scale);
        right ? all.right.add(y, panel.right ? panel.right->scale : panel.y.scale) : all.y.add(y, panel.y.scale);
    };
    for (const Series& s : panel.series) {
        const auto shows = [](double v, Scale scale) { return std::isfinite(v) && (scale == Scale::linear || v > 0); };
        const Scale vertical = s.right && panel.right ? panel.right->scale : panel.y.scale;
        // Only points with two valid numbers.
        for (std::size_t i = 0; i < std::min(s.x.size(), s.y.size()); ++i)
            if (shows(s.x[i], panel.x.scale) && shows(s.y[i], vertical)) add({&s.x[i], 1}, {&s.y[i], 1}, s.right);
        all.color.add(s.value, panel.color_bar ? panel.color_bar->scale : Scale::linear);
    }
    for (const Band& b : panel.bands) add(b.x, b.low), add(b.x, b.high);
    for (const Cells& c : panel.cells) add(c.x, c.y);
    for (const Cloud& c : panel.clouds) add(c.x, c.y);
    for (const Mark& m : panel.marks) add({&m.x, 1}, {&m.y, 1}, m.right);
    return all;
}

}  // namespace

void PlotAxes::fit(double width, double height) {
    width_ = width, height_ = height;
    const auto [ex, ey, er, eb] = extents_of(panel_);
    const int across = std::clamp(static_cast<int>(width / (4.2 * style_.numbers)), 3, 9);
    const int up = std::clamp(static_cast<int>(height / (2.3 * style_.numbers)), 3, 8);
    double widest_name = 1;
    for (const std::string& name : panel_.x.names)
        widest_name = std::max(widest_name, sheet_.measure(name, style_.tick_numbers()).w + style_.gap);
    x_.emplace(panel_.x, ex, panel_.x.names.empty() ? across : static_cast<int>(width / widest_name),
               what_ + ", horizontal axis");
    y_.emplace(panel_.y, ey, panel_.y.names.empty() ? up : static_cast<int>(height / (1.3 * style_.numbers)),
               what_ + ", vertical axis");
    right_.reset();
    if (panel_.right) right_.emplace(*panel_.right, er, up, what_ + ", right axis");
    bar_.reset();
    if (panel_.color_bar)
        bar_.emplace(Axis{.label = panel_.color_bar->label,
                          .scale = panel_.color_bar->scale,
                          .from = panel_.color_bar->from,
                          .to = panel_.color_bar->to,
                          .tight = true},
                     eb, up, what_ + ", colour bar");
    widest_y_ = widest(y_);
    widest_right_ = widest(right_);
    widest_bar_ = widest(bar_);
}

double PlotAxes::widest(const std::optional<AxisMap>& axis) const {
    double w = 0;
    for (const Tick& t : axis ? axis->ticks() : std::vector<Tick>())
        if (!t.label.empty()) w = std::max(w, sheet_.measure(t.label, style_.tick_numbers()).w);
    return w;
}

// How much the numbers below the plot are lowered so that they do not touch those beside it at a corner.
double PlotAxes::drop() const {
    if (!lowest_ || !panel_.x.numbered) return 0;
    double out = 0;
    const auto corner = [&](const std::optional<AxisMap>& vertical, bool left) {
        for (const Tick& below : x_->ticks()) {
            const double out_of_plot =
                0.5 * sheet_.measure(below.label, style_.tick_numbers()).w - width_ * (left ? below.at : 1 - below.at);
            if (below.label.empty() || out_of_plot < 0.6 * style_.gap) continue;
            for (const Tick& beside : vertical->ticks())
                if (!beside.label.empty())
                    out = std::max(out, 0.35 * style_.numbers + 0.5 * sheet_.cap_height(style_.numbers) - style_.gap -
                                            beside.at * height_);
        }
    };
    corner(y_, true);
    if (right_) corner(right_, false);
    return out;
}

Vec2 PlotAxes::at(double x, double y, bool right) const {
    const AxisMap& vertical = right && right_ ? *right_ : *y_;
    return {along_x(x), plot_.bottom() - plot_.h * vertical.place(y)};
}

Margins PlotAxes::margins() const {
    const double number = sheet_.cap_height(style_.numbers), letter = style_.letters;
    Margins m;
    m.left = widest_y_ + (widest_y_ > 0 ? style_.gap : 0) + (panel_.y.label.empty() ? 0 : letter + 1.3 * style_.gap) +
             label_height(*y_);
    m.bottom = number / 2;
    if (lowest_) {
        m.bottom = panel_.x.numbered ? number + style_.gap * 1.1 + drop() : style_.gap;
        if (!panel_.x.label.empty()) m.bottom += 1.05 * letter + style_.gap + label_height(*x_);
    }
    m.top = number / 2 + 0.5;
    m.top = std::max(m.top, titles_height());
    if (!y_->common().empty() || (right_ && !right_->common().empty())) m.top += style_.numbers + style_.gap;
    m.right = 1.3 * style_.numbers;  // the last x number overhangs
    if (right_) m.right = widest_right_ + style_.gap + letter + 1.5 * style_.gap + label_height(*right_);
    if (bar_ && !panel_.color_bar->hidden)
        m.right = 2.2 * style_.gap + 0.9 * letter + style_.gap + widest_bar_ + letter + 1.6 * style_.gap;
    return m;
}

void PlotAxes::draw_ticks(const AxisMap& axis, const Box& plot, Side side, bool labelled, double major,
                          double minor) const {
    TickStyle style{.pen = {kInk, style_.frame, {}, Cap::butt}, .major = major, .minor = minor};
    if (labelled) style.numbers = style_.tick_numbers();
    if (labelled && side == Side::bottom) {
        style.numbers->align = HAlign::centre, style.numbers->valign = VAlign::top;
        style.beside = {0, style_.gap + drop()};
    } else if (labelled) {
        style.numbers->align = side == Side::left ? HAlign::right : HAlign::left;
        style.numbers->valign = VAlign::middle;
        style.beside = {side == Side::left ? -style_.gap : style_.gap, 0};
    }
    render::draw_ticks(sheet_, axis.ticks(), plot, side, style);
}

void PlotAxes::draw_frame() const {
    const auto ticks = [&](const AxisMap& axis, Side side, bool labelled) {
        draw_ticks(axis, plot_, side, labelled, style_.tick, style_.minor_tick);
    };
    ticks(*x_, Side::bottom, lowest_);
    ticks(*x_, Side::top, false);
    ticks(*y_, Side::left, true);
    ticks(right_ ? *right_ : *y_, Side::right, right_.has_value());
    sheet_.rectangle(plot_);
    sheet_.stroke({kInk, style_.frame, {}, Cap::butt});
}

void PlotAxes::draw_labels() const {
    const double step = kLineStep * style_.letters;
    const double number = sheet_.cap_height(style_.numbers) + drop();
    TextStyle l = style_.words();
    l.align = HAlign::centre;
    if (lowest_ && !panel_.x.label.empty()) {
        l.valign = VAlign::top;
        double y = plot_.bottom() + (panel_.x.numbered ? number + style_.gap : 0) + 1.4 * style_.gap;
        // Clear of the power of ten at the right end.
        const double common =
            x_->common().empty() ? 0 : sheet_.measure(x_->common(), style_.tick_numbers()).w + 2 * style_.gap;
        for (const std::string& line : label_lines(*x_)) {
            const double half = 0.5 * sheet_.measure(line, l).w;
            const double x = common > 0 ? std::min(plot_.centre().x, plot_.right() - common - half) : plot_.centre().x;
            sheet_.text({x, y}, line, l), y += step;
        }
    }
    if (lowest_ && !x_->common().empty()) {
        TextStyle common = style_.tick_numbers();
        common.align = HAlign::right;
        common.valign = VAlign::top;
        sheet_.text({plot_.right(), plot_.bottom() + number + 2.4 * style_.gap}, x_->common(), common);
    }
    l.turned = std::numbers::pi / 2;
    l.valign = VAlign::baseline;
    double x = plot_.x - style_.gap - widest_y_ - 1.6 * style_.gap - label_height(*y_);
    for (const std::string& line : label_lines(*y_)) sheet_.text({x, plot_.centre().y}, line, l), x += step;
    if (right_) {
        l.valign = VAlign::top;
        x = plot_.right() + style_.gap + widest_right_ + 1.4 * style_.gap;
        for (const std::string& line : label_lines(*right_)) sheet_.text({x, plot_.centre().y}, line, l), x += step;
    }
    double y = plot_.y - style_.gap;
    TextStyle common = style_.tick_numbers();
    if (!y_->common().empty()) sheet_.text({plot_.x, y}, y_->common(), common);
    if (right_ && !right_->common().empty()) {
        common.align = HAlign::right;
        sheet_.text({plot_.right(), y}, right_->common(), common);
    }
}

std::vector<std::string> PlotAxes::title_lines() const {
    const double indent = panel_.letter.empty() ? 0 : 2 * style_.letters;
    return lines_of(panel_.title, width_ - indent, style_.words(), sheet_);
}
std::vector<std::string> PlotAxes::label_lines(const AxisMap& axis) const {
    std::string label = axis.label();
    if (const std::size_t unit = label.rfind(" / "); unit != std::string::npos)
        label.replace(unit + 2, 1, "\u00A0");  // not broken after the stroke
    return lines_of(label, &axis == &*x_ ? 1.1 * width_ : 1.05 * height_, style_.words(), sheet_);
}
double PlotAxes::label_height(const AxisMap& axis) const {
    const std::size_t lines = label_lines(axis).size();
    return lines > 1 ? static_cast<double>(lines - 1) * kLineStep * style_.letters : 0;
}

double PlotAxes::titles_height() const {
    if (panel_.letter.empty() && panel_.title.empty()) return 0;
    const double lines = std::max(1.0, static_cast<double>(title_lines().size()));
    return style_.letters + style_.gap + (lines - 1) * kLineStep * style_.letters;
}

void PlotAxes::draw_titles(double top, bool legend_above) const {
    draw_labels();
    const std::vector<std::string> lines = title_lines();
    const double step = kLineStep * style_.letters;
    const bool alone = y_->common().empty() && !legend_above;
    double y = top, x = plot_.x;
    if (alone) y = plot_.y - style_.gap - step * std::max(0.0, static_cast<double>(lines.size()) - 1);
    TextStyle title = style_.words();
    if (!panel_.letter.empty()) {
        title.weight = Weight::bold;
        x += sheet_.text({x, y}, "(" + panel_.letter + ")", title).w + 0.5 * style_.letters;
        title.weight = Weight::regular;
    }
    for (const std::string& line : lines) sheet_.text({x, y}, line, title), y += step;
}

void PlotAxes::draw_color_bar() const {
    if (!bar_ || panel_.color_bar->hidden) return;
    const Box bar{plot_.right() + 2.2 * style_.gap, plot_.y, 0.9 * style_.letters, plot_.h};
    std::vector<Color> colors;
    for (int k = 0; k <= 32; ++k)
        colors.push_back(panel_.color_bar->is_signed ? signed_color(k / 16.0 - 1) : map_color(k / 32.0));
    sheet_.gradient(bar, colors);
    draw_ticks(*bar_, bar, Side::right, true, 0.6 * style_.tick, 0.35 * style_.tick);
    sheet_.rectangle(bar);
    sheet_.stroke({kInk, style_.frame, {}, Cap::butt});
    TextStyle l = style_.words();
    l.turned = std::numbers::pi / 2;
    l.align = HAlign::centre;
    l.valign = VAlign::top;
    std::string label = bar_->label();
    if (!bar_->common().empty()) label += "  (" + bar_->common() + ")";
    sheet_.text({bar.right() + 2.2 * style_.gap + widest_bar_, bar.centre().y}, label, l);
}

}  // namespace beamcam::render::figure
