#include "render/plot/panel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include "render/base/error.hpp"
#include "render/plot/reduce.hpp"

namespace beamcam::render::figure {
namespace {

constexpr Color kInk = rgb(0x000000), kMuted = rgb(0x555555), kWhite = rgb(0xFFFFFF);
constexpr double kSample = 2.6;  // length of a line in a legend, in letters
constexpr double kCovers = 1.5;  // cells that a label may touch before it counts as covering data
constexpr double kCell = 1.5;    // of the grid of what is covered: resolves letters [pt]
constexpr int kMostDirect = 4;   // more labels than that are told apart better in a box
constexpr int kFewMarkers = 8;   // along a line

std::vector<double> dashes(const std::vector<double>& widths, double width) {
    std::vector<double> out;
    for (const double d : widths) out.push_back(d * width);
    return out;
}

bool inside(const Box& b, Vec2 p, double slack = 0) { return b.contains({p.x, p.y, 0, 0}, slack); }

// Does the segment a–b enter the box?
bool enters(const Box& box, Vec2 a, Vec2 b) {
    const Box inner = box.inset(0.5);
    for (int k = 0; k <= 200; ++k)
        if (inside(inner, a + (b - a) * (k / 200.0))) return true;
    return false;
}

// Two corners of the inset's plot joined to those of what it shows, through neither box.
std::vector<std::pair<Vec2, Vec2>> connectors(const Box& from, const Box& plot) {
    const auto corners = [](const Box& c) {
        return std::array<Vec2, 4>{Vec2{c.x, c.y}, {c.right(), c.y}, {c.right(), c.bottom()}, {c.x, c.bottom()}};
    };
    const auto c0 = corners(from), c1 = corners(plot);
    std::vector<std::pair<Vec2, Vec2>> lines;
    for (std::size_t k = 0; k < 4; ++k)
        if (!enters(from, c0[k], c1[k]) && !enters(plot, c0[k], c1[k])) lines.emplace_back(c0[k], c1[k]);
    if (lines.size() < 2) return lines;
    // The outermost two, seen along the way from one box to the other.
    const Vec2 way = plot.centre() - from.centre(), across{-way.y, way.x};
    const auto [least, most] = std::minmax_element(lines.begin(), lines.end(), [&](const auto& a, const auto& b) {
        return dot(a.second, across) < dot(b.second, across);
    });
    return {*least, *most};
}

// Which markers later ones leave to be seen: of those within `apart` only the last.
std::vector<bool> not_covered(const std::vector<Vec2>& points, double apart) {
    std::vector<bool> seen(points.size(), false);
    std::set<std::pair<long, long>> taken;
    for (std::size_t i = points.size(); i-- > 0;)
        if (std::isfinite(points[i].x + points[i].y))
            seen[i] = taken.emplace(std::lround(points[i].x / apart), std::lround(points[i].y / apart)).second;
    return seen;
}

Box without(const Box& outer, const Margins& m) {
    return {outer.x + m.left, outer.y + m.top, outer.w - m.left - m.right, outer.h - m.top - m.bottom};
}

}  // namespace

Color color_of(const Series& s) { return s.color.value_or(look(s.look).color); }

Pen curve_pen(const Series& s, const Style& style) {
    const double width = style.line * s.weight * (s.faded ? 0.7 : 1);
    Pen pen{color_of(s), width, s.solid ? std::vector<double>() : dashes(look(s.look).dash, width), Cap::butt};
    if (s.faded) pen.color = pale(pen.color);
    return pen;
}

PanelDrawing::PanelDrawing(const Panel& panel, const Style& style, Sheet& sheet, double width, double height,
                           bool lowest, const std::string& what)
    : panel_(panel), style_(style), sheet_(sheet), lowest_(lowest), what_(what) {
    make_axes(width, height);
}

Lettering PanelDrawing::words() const { return {.size = style_.letters, .color = kInk}; }
Lettering PanelDrawing::numbers() const { return {.size = style_.numbers, .color = kInk}; }

Vec2 PanelDrawing::at(double x, double y, bool right) const {
    const AxisMap& vertical = right && !right_.empty() ? right_.front() : y_.front();
    return {plot_.x + plot_.w * x_.front().place(x), plot_.bottom() - plot_.h * vertical.place(y)};
}

// ---- axes ------------------------------------------------------------------------------------------

void PanelDrawing::make_axes(double width, double height) {
    Extent ex, ey, er, eb;
    for (const Series& s : panel_.series) {
        // A point counts where both numbers do.
        std::vector<double> xs, ys;
        const Scale vertical = s.right && panel_.right ? panel_.right->scale : panel_.y.scale;
        for (std::size_t i = 0; i < std::min(s.x.size(), s.y.size()); ++i) {
            const bool shows = std::isfinite(s.x[i]) && std::isfinite(s.y[i]) &&
                               (panel_.x.scale == Scale::linear || s.x[i] > 0) &&
                               (vertical == Scale::linear || s.y[i] > 0);
            if (!shows) continue;
            xs.push_back(s.x[i]);
            ys.push_back(s.y[i]);
        }
        ex.add(xs, panel_.x.scale);
        (s.right ? er : ey).add(ys, vertical);
        eb.add(s.value, panel_.color_bar ? panel_.color_bar->scale : Scale::linear);
    }
    for (const Band& b : panel_.bands) {
        ex.add(b.x, panel_.x.scale);
        ey.add(b.low, panel_.y.scale);
        ey.add(b.high, panel_.y.scale);
    }
    for (const Mark& m : panel_.marks) {
        ex.add({&m.x, 1}, panel_.x.scale);
        (m.right ? er : ey).add({&m.y, 1}, panel_.y.scale);
    }
    const int across = std::clamp(static_cast<int>(width / (4.2 * style_.numbers)), 3, 9);
    const int up = std::clamp(static_cast<int>(height / (2.3 * style_.numbers)), 3, 8);
    x_ = {AxisMap(panel_.x, ex, across, what_ + ", horizontal axis")};
    y_ = {AxisMap(panel_.y, ey, up, what_ + ", vertical axis")};
    right_.clear();
    if (panel_.right) right_ = {AxisMap(*panel_.right, er, up, what_ + ", right axis")};
    bar_.clear();
    if (panel_.color_bar)
        bar_ = {AxisMap(Axis{.label = {},
                             .scale = panel_.color_bar->scale,
                             .from = panel_.color_bar->from,
                             .to = panel_.color_bar->to,
                             .tight = true},
                        eb, up, what_ + ", colour bar")};
    const auto widest = [&](const std::vector<AxisMap>& axis) {
        double w = 0;
        for (const AxisMap& a : axis)
            for (const Tick& t : a.ticks())
                if (!t.label.empty()) w = std::max(w, sheet_.measure(t.label, numbers()).w);
        return w;
    };
    widest_y_ = widest(y_);
    widest_right_ = widest(right_);
    widest_bar_ = widest(bar_);
}

Margins PanelDrawing::margins() const {
    const double number = sheet_.cap_height(style_.numbers), letter = style_.letters;
    Margins m;
    m.left = widest_y_ + (widest_y_ > 0 ? style_.gap : 0) + (panel_.y.label.empty() ? 0 : letter + 1.3 * style_.gap);
    m.bottom = number / 2;
    if (lowest_) {
        m.bottom = panel_.x.numbered ? number + style_.gap * 1.1 : style_.gap;
        if (!panel_.x.label.empty()) m.bottom += 1.05 * letter + style_.gap;
    }
    m.top = number / 2 + 0.5;
    if (!panel_.letter.empty() || !panel_.title.empty()) m.top = std::max(m.top, letter + style_.gap);
    if (!y_.front().common().empty() || (!right_.empty() && !right_.front().common().empty()))
        m.top += style_.numbers + style_.gap;
    m.right = 1.3 * style_.numbers;  // the last x number overhangs
    if (!right_.empty()) m.right = widest_right_ + style_.gap + letter + 1.5 * style_.gap;
    if (!bar_.empty() && !panel_.color_bar->hidden)
        m.right = 2.2 * style_.gap + 0.9 * letter + style_.gap + widest_bar_ + letter + 1.6 * style_.gap;
    if (legend_above_) m.top += legend_above_height_ + style_.gap;
    return m;
}

// ---- what stands where -------------------------------------------------------------------------------

bool PanelDrawing::place(const Box& plot) {
    plot_ = plot;
    make_axes(plot.w, plot.h);
    writings_.clear();
    inset_outer_.clear();
    make_curves();
    // Legend and insets compete for the free corners: whichever order covers less. Labels at marks and curves go
    // around everything.
    const bool boxed = panel_.legend == Legend::box;
    if (boxed && !panel_.insets.empty() && !legend_above_) {
        const std::vector<OccupancyGrid> before = taken_;
        const double legend_first = place_boxes(true);
        taken_ = before;
        const double insets_first = place_boxes(false);
        taken_ = before;
        legend_above_ = false;
        place_boxes(legend_first <= insets_first);
    } else {
        place_boxes(true);
    }
    place_marks();
    place_rules();
    return boxed ? settled_ : place_labels();
}

constexpr double kColumn = 4;          // grains: a pixel, in which swings are not told apart
constexpr double kTonesOfASwing = 24;  // of a curve that is coloured by a value

// Those of the items with these indices, `broken` for kBreak.
template <class Item>
std::vector<Item> taken(const std::vector<std::size_t>& indices, const std::vector<Item>& from, Item broken) {
    std::vector<Item> all;
    all.reserve(indices.size());
    for (const std::size_t i : indices) all.push_back(i == kBreak ? broken : from[i]);
    return all;
}

// A million points draw and weigh as little as a few thousand.
void PanelDrawing::lighten(Curve& curve) const {
    const double grain = sheet_.grain();
    const Vec2 broken{std::nan(""), std::nan("")};
    const std::vector<Swing> fast = swings(curve.points, kColumn * grain);
    const std::size_t count = curve.points.size();
    if (!curve.value.empty()) {
        if (!fast.empty()) thin_out_tones(curve, without(fast, count, true));
        return;
    }
    for (const Swing& swing : fast) curve.bands.push_back(outline(swing, curve.points));
    curve.line = reduce(taken(without(fast, count, false), curve.points, broken), grain);
    curve.points = fast.empty() ? curve.line : reduce(taken(without(fast, count, true), curve.points, broken), grain);
}

// Keeps these points of a curve that is coloured by a value, and goes from one to the next in a few tones.
void PanelDrawing::thin_out_tones(Curve& curve, const std::vector<std::size_t>& kept) {
    const std::vector<double> value = taken(kept, std::exchange(curve.value, {}), 0.0);
    const std::vector<Vec2> points = taken(kept, std::exchange(curve.points, {}), Vec2{});
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double rise = i > 0 ? value[i] - value[i - 1] : 0;
        const int tones =
            std::isfinite(rise) ? std::max(1, static_cast<int>(std::ceil(std::abs(rise) * kTonesOfASwing))) : 1;
        for (int k = 1; k < tones; ++k) {
            const double share = double(k) / tones;
            curve.points.push_back(points[i - 1] + (points[i] - points[i - 1]) * share);
            curve.value.push_back(value[i - 1] + rise * share);
        }
        curve.points.push_back(points[i]);
        curve.value.push_back(value[i]);
    }
}

void PanelDrawing::make_curves() {
    curves_.clear();
    taken_ = {OccupancyGrid(plot_, kCell)};
    for (const Series& s : panel_.series) {
        Curve curve;
        curve.series = &s;
        const std::size_t count = std::min(s.x.size(), s.y.size());
        curve.points.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            Vec2 p = at(s.x[i], s.y[i], s.right);
            // Far beyond the plot is as good as just beyond it, and Cairo's numbers are finite.
            p.x = std::clamp(p.x, plot_.x - 20 * plot_.w, plot_.right() + 20 * plot_.w);
            p.y = std::clamp(p.y, plot_.y - 20 * plot_.h, plot_.bottom() + 20 * plot_.h);
            curve.points.push_back(p);
        }
        for (std::size_t i = 0; i < std::min(count, s.value.size()); ++i)
            curve.value.push_back(bar_.empty() ? 0 : bar_.front().place(s.value[i]));
        if (s.line && !s.every_point) lighten(curve);
        if (s.line) taken_.front().cover(curve.points, s.faded ? 0.7 : 1);
        if (s.every_point)
            for (const Vec2 p : curve.points) taken_.front().cover(Box{p.x, p.y, 0, 0}.inset(-style_.marker));
        curves_.push_back(std::move(curve));
    }
    for (const Band& b : panel_.bands)
        for (const auto* edge : {&b.low, &b.high}) {
            std::vector<Vec2> points;
            for (std::size_t i = 0; i < std::min(b.x.size(), edge->size()); ++i)
                points.push_back(at(b.x[i], (*edge)[i]));
            taken_.front().cover(points, 0.5);
        }
    for (const Rule& r : panel_.rules) {
        const Vec2 p = at(r.vertical ? r.at : panel_.series.empty() ? 0 : x_.front().low(), r.vertical ? 0 : r.at);
        const Vec2 line[2] = {r.vertical ? Vec2{p.x, plot_.y} : Vec2{plot_.x, p.y},
                              r.vertical ? Vec2{p.x, plot_.bottom()} : Vec2{plot_.right(), p.y}};
        taken_.front().cover(line, 0.4);
    }
}

// What boxes cover when they are placed in this order; a legend that finds no room is dear.
double PanelDrawing::place_boxes(bool legend_first) {
    constexpr double kNoRoom = 25;  // cells: rather above the plot than over this much of a curve
    legend_box_.reset();
    inset_outer_.clear();
    settled_ = true;
    double cost = 0;
    const auto legend = [&] {
        if (panel_.legend != Legend::box) return;
        settled_ = place_labels();
        if (!settled_) cost += kNoRoom;
    };
    if (legend_first) legend();
    cost += place_insets();
    if (!legend_first) legend();
    return cost;
}

// Its frame; never so small that it is a dot.
Box PanelDrawing::shown_enlarged(const Inset::Source& source) const {
    const Vec2 a = at(source.x_from, source.y_from), b = at(source.x_to, source.y_to);
    const Box box{std::min(a.x, b.x), std::min(a.y, b.y), std::abs(b.x - a.x), std::abs(b.y - a.y)};
    return box.inset(-std::max({0.0, 4 - box.w, 4 - box.h}) / 2);
}

double PanelDrawing::place_insets() {
    double cost = 0;
    for (const Inset& inset : panel_.insets) {
        if (inset.source) taken_.front().cover(shown_enlarged(*inset.source));
        // With its numbers and labels.
        const double w = inset.width * plot_.w, h = inset.height * plot_.h;
        const Margins m = PanelDrawing(inset.panel.front(), style_, sheet_, w, h, true, what_ + ", inset").margins();
        const Place place = best_place(taken_.front(), w + m.left + m.right, h + m.top + m.bottom, 2 * style_.gap);
        inset_outer_.push_back(place.box);
        taken_.front().cover(place.box);
        cost += place.cost;
        if (!inset.source) continue;
        for (const auto& [from, to] : connectors(shown_enlarged(*inset.source), without(place.box, m)))
            taken_.front().cover(std::vector<Vec2>{from, to});
    }
    return cost;
}

void PanelDrawing::place_marks() {
    for (const Mark& m : panel_.marks) {
        const Vec2 p = at(m.x, m.y, m.right);
        taken_.front().cover(Box{p.x, p.y, 0, 0}.inset(-style_.marker));
    }
    for (const Mark& m : panel_.marks) {
        if (m.label.empty()) continue;
        const Vec2 p = at(m.x, m.y, m.right);
        Lettering l = numbers();
        l.color = look(m.look).color;
        const Box size = sheet_.measure(m.label, l);
        Writing best;
        double least = std::numeric_limits<double>::infinity();
        // Around the mark, near first.
        for (const double far : {1.0, 2.0, 3.5, 5.5, 8.0})
            for (int k = 0; k < 16; ++k) {
                const double turn = (k + 0.5) * std::numbers::pi / 8;
                const double reach = style_.marker + far * 1.2 * style_.gap;
                const Vec2 middle{p.x + std::cos(turn) * (reach + size.w / 2),
                                  p.y - std::sin(turn) * (reach + size.h / 2)};
                const Box box{middle.x - size.w / 2, middle.y - size.h / 2, size.w, size.h};
                const Box air = box.inset(-0.8);
                const Vec2 end{std::clamp(p.x, air.x, air.right()), std::clamp(p.y, air.y, air.bottom())};
                double cost = 10 * taken_.front().cost(box.inset(-2.2)) + 2 * far - 0.5 * std::cos(turn);
                if (cost >= least) continue;
                // A leader that crosses curves is better led elsewhere.
                for (int s = 6; far > 2 && s < 20; ++s) {
                    const Vec2 on = p + (end - p) * (s / 20.0);
                    cost += std::min(1.0, taken_.front().cost(Box{on.x, on.y, 0, 0}.inset(-0.4)));
                }
                if (cost >= least) continue;
                least = cost;
                best = {{box.x, box.y - size.y}, m.label, l, {}};
                if (far > 2) best.leader = {p, end};
            }
        taken_.front().cover(Box{best.at.x, best.at.y + size.y, size.w, size.h});
        if (best.leader) taken_.front().cover(std::vector<Vec2>{best.leader->first, best.leader->second}, 4);
        writings_.push_back(std::move(best));
    }
}

// Small words on the rules that have them, where least is covered; the right end wins ties.
void PanelDrawing::place_rules() {
    Lettering l = numbers();
    l.color = kMuted;
    for (const Rule& r : panel_.rules) {
        const double share = (r.vertical ? x_ : y_).front().place(r.at);
        if (r.label.empty() || !(share >= 0 && share <= 1)) continue;
        const Box size = sheet_.measure(r.label, l);
        const double along = r.vertical ? plot_.x + share * plot_.w : plot_.bottom() - share * plot_.h;
        const double room = (r.vertical ? plot_.h - size.h : plot_.w - size.w) - 2 * style_.gap;
        Box best;
        double least = std::numeric_limits<double>::infinity();
        for (int k = 0; k <= 20; ++k)
            for (const double side : {-1.0, 1.0}) {  // above or left of the rule, below or right of it
                const double from = style_.gap + room * (1 - k / 20.0), off = 0.7 * style_.gap;
                const double beside = side < 0 ? along - off - (r.vertical ? size.w : size.h) : along + off;
                const Box box = r.vertical ? Box{beside, plot_.y + room + 2 * style_.gap - from, size.w, size.h}
                                           : Box{plot_.x + from, beside, size.w, size.h};
                const double cost = 10 * taken_.front().cost(box.inset(-1)) + 0.1 * k + 0.05 * side;
                if (cost < least) least = cost, best = box;
            }
        taken_.front().cover(best);
        writings_.push_back({{best.x, best.y - size.y}, r.label, l, {}});
    }
}

bool PanelDrawing::place_labels() {
    int labelled = 0;
    for (const Series& s : panel_.series) labelled += !s.label.empty();
    for (const Band& b : panel_.bands) labelled += !b.label.empty();
    if (labelled == 0 || panel_.legend == Legend::none) return true;
    if (legend_above_) {
        legend_box_ = legend_size();
        const bool settled = legend_box_->h <= legend_above_height_ + 0.01;
        legend_above_height_ = legend_box_->h;
        legend_box_->x = plot_.x;
        legend_box_->y =
            plot_.y - margins().top + (panel_.letter.empty() && panel_.title.empty() ? 0 : style_.letters + style_.gap);
        return settled;
    }
    if (panel_.legend == Legend::direct && labelled <= kMostDirect && panel_.bands.empty() && place_direct())
        return true;
    return place_legend();
}

// How much nearer another curve is than the label's own: such a label misleads.
double PanelDrawing::crowding(const Box& box, const Curve& own) const {
    const auto distance = [&](const Curve& c) {
        double least = 1e9;
        for (const Vec2 p : c.points) {
            const double dx = std::max({box.x - p.x, p.x - box.right(), 0.0});
            const double dy = std::max({box.y - p.y, p.y - box.bottom(), 0.0});
            least = std::min(least, std::hypot(dx, dy));
        }
        return least;
    };
    const double mine = distance(own);
    double worst = 0;
    for (const Curve& c : curves_)
        if (c.series != own.series) worst = std::max(worst, mine + 1.5 * style_.gap - distance(c));
    return worst;
}

double PanelDrawing::best_direct(const Curve& curve, Writing& out) {
    Lettering l = words();
    l.color = color_of(*curve.series);
    const Box size = sheet_.measure(curve.series->label, l);
    double least = std::numeric_limits<double>::infinity();
    const std::size_t stride = std::max<std::size_t>(1, curve.points.size() / 60);
    for (std::size_t i = 0; i < curve.points.size(); i += stride) {
        const Vec2 p = curve.points[i];
        if (!inside(plot_, p)) continue;
        for (const double up : {1.0, -1.0, 0.0})
            for (const double side : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
                if (up == 0 && std::abs(side) < 1) continue;
                const Vec2 middle{p.x + side * (size.w / 2 + style_.gap), p.y - up * (size.h / 2 + 1.0 * style_.gap)};
                const Box box{middle.x - size.w / 2, middle.y - size.h / 2, size.w, size.h};
                const double cover = taken_.front().cost(box.inset(-1));
                if (cover >= 1e5) continue;
                const double cost = 10 * cover + 3 * std::max(0.0, crowding(box, curve)) +
                                    0.02 * (plot_.right() - middle.x) + std::abs(side);
                if (cost >= least) continue;
                least = cost;
                out = {{box.x, box.y - size.y}, curve.series->label, l, {}};
            }
    }
    return least;
}

bool PanelDrawing::place_direct() {
    const OccupancyGrid before = taken_.front();
    const std::size_t written = writings_.size();
    for (const Curve& curve : curves_) {
        if (curve.series->label.empty()) continue;
        Writing label;
        if (best_direct(curve, label) > 10 * kCovers + 12) {
            taken_ = {before};
            writings_.resize(written);
            return false;
        }
        const Box size = sheet_.measure(label.markup, label.lettering);
        taken_.front().cover(Box{label.at.x, label.at.y + size.y, size.w, size.h});
        writings_.push_back(std::move(label));
    }
    return true;
}

Box PanelDrawing::legend_size() {
    const double row = 1.35 * style_.letters, sample = kSample * style_.letters;
    double widest = 0;
    int rows = 0;
    const auto add = [&](const std::string& label) {
        if (label.empty()) return;
        ++rows;
        widest = std::max(widest, sheet_.measure(label, words()).w);
    };
    for (const Series& s : panel_.series) add(s.label);
    for (const Band& b : panel_.bands) add(b.label);
    // Inside the plot one below the other; above it as many beside each other as the width holds.
    legend_entry_ = sample + style_.gap + widest;
    const double apart = 2 * style_.gap;
    legend_columns_ =
        legend_above_ ? std::clamp(static_cast<int>((plot_.w + apart) / (legend_entry_ + apart)), 1, rows) : 1;
    const int lines = (rows + legend_columns_ - 1) / legend_columns_;
    return {0, 0, legend_columns_ * (legend_entry_ + apart) - apart, lines * row};
}

bool PanelDrawing::place_legend() {
    const Box size = legend_size();
    const Place place = best_place(taken_.front(), size.w, size.h, 1.6 * style_.gap);
    if (place.cost <= kCovers && size.w < plot_.w && size.h < plot_.h) {
        legend_box_ = place.box;
        taken_.front().cover(place.box);
        return true;
    }
    legend_above_ = true;
    legend_box_ = legend_size();
    legend_above_height_ = legend_box_->h;
    return false;
}

// ---- drawing -----------------------------------------------------------------------------------------

void PanelDrawing::draw() {
    draw_grounds();
    draw_curves();
    draw_frame();
    draw_marks();
    draw_insets();
    for (const Writing& w : writings_) {
        if (w.leader) {
            sheet_.move_to(w.leader->first);
            sheet_.line_to(w.leader->second);
            sheet_.stroke({kMuted, 0.6 * style_.frame, {}, Cap::butt});
        }
        sheet_.text(w.at, w.markup, w.lettering);
    }
    draw_legend();
    draw_titles();
    draw_color_bar();
}

void PanelDrawing::draw_grounds() {
    sheet_.clip(plot_);
    for (const Span& s : panel_.spans) {
        const double a = at(s.from, 0).x, b = at(s.to, 0).x;
        // Never too thin to be seen.
        const double width = std::max(std::abs(b - a), 0.4);
        sheet_.rectangle({std::min(a, b), plot_.y, width, plot_.h});
        sheet_.fill(s.color);
    }
    for (const Band& b : panel_.bands) {
        std::vector<Vec2> edge;
        const std::size_t count = std::min({b.x.size(), b.low.size(), b.high.size()});
        for (std::size_t i = 0; i < count; ++i) edge.push_back(at(b.x[i], b.high[i]));
        for (std::size_t i = count; i-- > 0;) edge.push_back(at(b.x[i], b.low[i]));
        std::erase_if(edge, [](Vec2 p) { return !std::isfinite(p.x + p.y); });
        sheet_.polyline(edge);
        sheet_.close();
        sheet_.fill(pale(look(b.look).color, 0.72));
    }
    for (const Rule& r : panel_.rules) {
        const double place =
            r.vertical ? plot_.x + plot_.w * x_.front().place(r.at) : plot_.bottom() - plot_.h * y_.front().place(r.at);
        sheet_.move_to(r.vertical ? Vec2{place, plot_.y} : Vec2{plot_.x, place});
        sheet_.line_to(r.vertical ? Vec2{place, plot_.bottom()} : Vec2{plot_.right(), place});
        sheet_.stroke({rgb(0x888888), 0.75 * style_.frame, {3.3 * style_.frame, 3.3 * style_.frame}, Cap::butt});
    }
    sheet_.unclip();
}

void PanelDrawing::marker(Marker shape, Vec2 p, double r, Color color, bool hollow) {
    const auto polygon = [&](std::initializer_list<Vec2> corners) {
        bool first = true;
        for (const Vec2 c : corners) {
            first ? sheet_.move_to(p + c * r) : sheet_.line_to(p + c * r);
            first = false;
        }
        sheet_.close();
    };
    switch (shape) {
        case Marker::circle:
            sheet_.circle(p, r);
            break;
        case Marker::square:
            polygon({{-0.9, -0.9}, {0.9, -0.9}, {0.9, 0.9}, {-0.9, 0.9}});
            break;
        case Marker::triangle:
            polygon({{0, -1.2}, {1.1, 0.8}, {-1.1, 0.8}});
            break;
        case Marker::diamond:
            polygon({{0, -1.25}, {1.25, 0}, {0, 1.25}, {-1.25, 0}});
            break;
        case Marker::down:
            polygon({{0, 1.2}, {1.1, -0.8}, {-1.1, -0.8}});
            break;
        case Marker::cross:
            sheet_.move_to(p + Vec2{-r, -r});
            sheet_.line_to(p + Vec2{r, r});
            sheet_.move_to(p + Vec2{-r, r});
            sheet_.line_to(p + Vec2{r, -r});
            return sheet_.stroke({color, style_.line, {}, Cap::butt});
    }
    if (!hollow) return sheet_.fill(color);
    sheet_.fill_keeping_path(kWhite);
    sheet_.stroke({color, 0.8 * style_.line, {}, Cap::butt});
}

void PanelDrawing::draw_bands(const Curve& curve, Pen pen) {
    pen.dash.clear();
    for (const std::vector<Vec2>& band : curve.bands) {
        sheet_.polyline(band);
        sheet_.close();
        sheet_.fill_keeping_path(pen.color);
        sheet_.stroke(pen);
    }
}

void PanelDrawing::draw_curve(const Curve& curve) {
    const Series& s = *curve.series;
    Pen pen = curve_pen(s, style_);
    if (!curve.value.empty()) {
        // Strokes of one colour each, in 48 steps that the eye does not tell apart.
        constexpr int kSteps = 48;
        const auto step = [&](std::size_t i) {
            const double v = curve.value[i];
            return std::isfinite(v) ? static_cast<int>(std::lround(std::clamp(v, 0.0, 1.0) * kSteps)) : -1;
        };
        pen.dash.clear();
        const double apart = 2 * sheet_.grain();
        for (std::size_t i = 0; s.line && i + 1 < curve.points.size();) {
            const int tone = step(i);
            std::vector<Vec2> piece{curve.points[i]};
            std::size_t k = i + 1;
            for (; k < curve.points.size(); ++k) {
                const bool ends = step(k) != tone;
                if (ends || !(norm(curve.points[k] - piece.back()) < apart)) piece.push_back(curve.points[k]);
                if (ends) break;
            }
            if (tone >= 0) {
                pen.color = map_color(static_cast<double>(tone) / kSteps);
                pen.cap = Cap::round;
                sheet_.polyline(piece);
                sheet_.stroke(pen);
            }
            i = k;
        }
        const std::vector<bool> seen =
            s.every_point ? not_covered(curve.points, 0.15 * style_.marker) : std::vector<bool>();
        for (std::size_t i = 0; s.every_point && i < curve.points.size(); ++i)
            if (seen[i] && step(i) >= 0 && inside(plot_, curve.points[i], style_.marker))
                marker(look(s.look).marker, curve.points[i], 0.8 * style_.marker, map_color(curve.value[i]), false);
        return;
    }
    if (s.line) {
        sheet_.curve(s.every_point ? curve.points : curve.line, pen);
        draw_bands(curve, pen);
        // A single point draws no line; show it all the same.
        std::size_t finite = 0;
        Vec2 only;
        for (const Vec2 p : curve.points)
            if (std::isfinite(p.x + p.y)) ++finite, only = p;
        if (finite == 1 && !s.every_point) marker(look(s.look).marker, only, style_.marker, pen.color, false);
    }
    if (s.every_point)
        for (const Vec2 p : curve.points)
            if (std::isfinite(p.x + p.y) && inside(plot_, p, style_.marker))
                marker(look(s.look).marker, p, style_.marker, pen.color, s.look % 2 == 1);
    if (s.some_markers && curve.points.size() > 1) {
        // Equally spaced across the plot, each curve a little further on, so that they do not pile up.
        const double spacing = plot_.w / kFewMarkers;
        double next = plot_.x + spacing * (0.3 + 0.17 * s.look);
        for (const Vec2 p : curve.points) {
            if (!std::isfinite(p.x + p.y) || p.x < next || !inside(plot_, p)) continue;
            marker(look(s.look).marker, p, style_.marker, pen.color, s.look % 2 == 1);
            next = p.x + spacing;
        }
    }
}

void PanelDrawing::draw_curves() {
    sheet_.clip(plot_);
    for (const Curve& curve : curves_) draw_curve(curve);
    sheet_.unclip();
}

void PanelDrawing::draw_marks() {
    for (const Mark& m : panel_.marks) {
        const Vec2 p = at(m.x, m.y, m.right);
        if (inside(plot_, p, 1)) marker(look(m.look).marker, p, 1.1 * style_.marker, look(m.look).color, m.hollow);
    }
}

// Ticks point inwards; l, r, b, t: the side.
void PanelDrawing::draw_ticks(const AxisMap& axis, char side, bool labelled) {
    const Pen pen{kInk, style_.frame, {}, Cap::butt};
    for (const Tick& t : axis.ticks()) {
        const double length = t.major ? style_.tick : style_.minor_tick;
        const bool across = side == 'b' || side == 't';
        const double x = across ? plot_.x + t.at * plot_.w : side == 'l' ? plot_.x : plot_.right();
        const double y = across ? (side == 'b' ? plot_.bottom() : plot_.y) : plot_.bottom() - t.at * plot_.h;
        const Vec2 in = side == 'l'   ? Vec2{length, 0}
                        : side == 'r' ? Vec2{-length, 0}
                        : side == 'b' ? Vec2{0, -length}
                                      : Vec2{0, length};
        sheet_.move_to({x, y});
        sheet_.line_to(Vec2{x, y} + in);
        sheet_.stroke(pen);
        if (!labelled || t.label.empty()) continue;
        Lettering l = numbers();
        if (across) {
            l.align = HAlign::centre;
            l.valign = VAlign::top;
            sheet_.text({x, y + style_.gap}, t.label, l);
        } else {
            l.align = side == 'l' ? HAlign::right : HAlign::left;
            l.valign = VAlign::middle;
            sheet_.text({x + (side == 'l' ? -style_.gap : style_.gap), y}, t.label, l);
        }
    }
}

void PanelDrawing::draw_frame() {
    draw_ticks(x_.front(), 'b', lowest_);
    draw_ticks(x_.front(), 't', false);
    draw_ticks(y_.front(), 'l', true);
    if (right_.empty())
        draw_ticks(y_.front(), 'r', false);
    else
        draw_ticks(right_.front(), 'r', true);
    sheet_.rectangle(plot_);
    sheet_.stroke({kInk, style_.frame, {}, Cap::butt});
}

void PanelDrawing::draw_titles() {
    const double number = sheet_.cap_height(style_.numbers);
    Lettering l = words();
    l.align = HAlign::centre;
    if (lowest_ && !panel_.x.label.empty()) {
        l.valign = VAlign::top;
        const double y = plot_.bottom() + (panel_.x.numbered ? number + style_.gap : 0) + 1.4 * style_.gap;
        sheet_.text({plot_.centre().x, y}, panel_.x.label, l);
    }
    if (lowest_ && !x_.front().common().empty()) {
        Lettering common = numbers();
        common.align = HAlign::right;
        common.valign = VAlign::top;
        sheet_.text({plot_.right(), plot_.bottom() + number + 2.4 * style_.gap}, x_.front().common(), common);
    }
    l.turned = std::numbers::pi / 2;
    l.valign = VAlign::baseline;
    if (!panel_.y.label.empty())
        sheet_.text({plot_.x - style_.gap - widest_y_ - 1.6 * style_.gap, plot_.centre().y}, panel_.y.label, l);
    if (!right_.empty()) {
        l.valign = VAlign::top;
        sheet_.text({plot_.right() + style_.gap + widest_right_ + 1.4 * style_.gap, plot_.centre().y},
                    panel_.right->label, l);
    }
    double y = plot_.y - style_.gap;
    Lettering common = numbers();
    if (!y_.front().common().empty()) sheet_.text({plot_.x, y}, y_.front().common(), common);
    if (!right_.empty() && !right_.front().common().empty()) {
        common.align = HAlign::right;
        sheet_.text({plot_.right(), y}, right_.front().common(), common);
    }
    const double top = plot_.y - margins().top + style_.letters;
    const bool alone = y_.front().common().empty() && !legend_above_;
    double x = plot_.x;
    Lettering title = words();
    if (!panel_.letter.empty()) {
        title.bold = true;
        x += sheet_.text({x, alone ? y : top}, "(" + panel_.letter + ")", title).w + 0.5 * style_.letters;
        title.bold = false;
    }
    if (!panel_.title.empty()) sheet_.text({x, alone ? y : top}, panel_.title, title);
}

void PanelDrawing::draw_color_bar() {
    if (bar_.empty() || panel_.color_bar->hidden) return;
    const Box bar{plot_.right() + 2.2 * style_.gap, plot_.y, 0.9 * style_.letters, plot_.h};
    std::vector<Color> colors;
    for (int k = 0; k <= 32; ++k) colors.push_back(map_color(k / 32.0));
    sheet_.gradient(bar, colors);
    const Pen pen{kInk, style_.frame, {}, Cap::butt};
    Lettering l = numbers();
    l.valign = VAlign::middle;
    for (const Tick& t : bar_.front().ticks()) {
        const double y = bar.bottom() - t.at * bar.h;
        sheet_.move_to({bar.right(), y});
        sheet_.line_to({bar.right() - (t.major ? 0.6 : 0.35) * style_.tick, y});
        sheet_.stroke(pen);
        if (!t.label.empty()) sheet_.text({bar.right() + style_.gap, y}, t.label, l);
    }
    sheet_.rectangle(bar);
    sheet_.stroke(pen);
    l = words();
    l.turned = std::numbers::pi / 2;
    l.align = HAlign::centre;
    l.valign = VAlign::top;
    std::string label = panel_.color_bar->label;
    if (!bar_.front().common().empty()) label += "  (" + bar_.front().common() + ")";
    sheet_.text({bar.right() + 2.2 * style_.gap + widest_bar_, bar.centre().y}, label, l);
}

void PanelDrawing::draw_insets() {
    for (std::size_t i = 0; i < panel_.insets.size(); ++i) {
        const Inset& inset = panel_.insets[i];
        const Box outer = inset_outer_[i];
        sheet_.rectangle(outer);
        sheet_.fill(kWhite);
        PanelDrawing inner(inset.panel.front(), style_, sheet_, inset.width * plot_.w, inset.height * plot_.h, true,
                           what_ + ", inset");
        if (!inner.place(without(outer, inner.margins()))) inner.place(without(outer, inner.margins()));
        if (inset.source) {
            const Box from = shown_enlarged(*inset.source);
            const Pen thin{kMuted, 0.75 * style_.frame, {}, Cap::butt};
            sheet_.rectangle(from);
            sheet_.stroke(thin);
            for (const auto& [start, end] : connectors(from, inner.plot_)) {
                sheet_.move_to(start);
                sheet_.line_to(end);
                sheet_.stroke(thin);
            }
        }
        inner.draw();
    }
}

void PanelDrawing::legend_sample(const Series& s, Vec2 left, double width) {
    const Pen pen = curve_pen(s, style_);
    if (s.line && s.value.empty()) {
        sheet_.move_to(left);
        sheet_.line_to(left + Vec2{width, 0});
        sheet_.stroke(pen);
    }
    if (s.every_point || s.some_markers)
        marker(look(s.look).marker, left + Vec2{width / 2, 0}, style_.marker, pen.color, s.look % 2 == 1);
}

void PanelDrawing::draw_legend() {
    if (!legend_box_) return;
    const double row = 1.35 * style_.letters, sample = kSample * style_.letters;
    Lettering l = words();
    l.valign = VAlign::middle;
    int k = 0;
    const auto next = [&] {
        const int column = k % legend_columns_, line = k / legend_columns_;
        const Vec2 at{legend_box_->x + column * (legend_entry_ + 2 * style_.gap), legend_box_->y + (line + 0.5) * row};
        ++k;
        return at;
    };
    for (const Series& s : panel_.series) {
        if (s.label.empty()) continue;
        const Vec2 p = next();
        legend_sample(s, p, sample);
        sheet_.text(p + Vec2{sample + style_.gap, 0}, s.label, l);
    }
    for (const Band& b : panel_.bands) {
        if (b.label.empty()) continue;
        const Vec2 p = next();
        sheet_.rectangle({p.x, p.y - 0.3 * style_.letters, sample, 0.6 * style_.letters});
        sheet_.fill(pale(look(b.look).color, 0.72));
        sheet_.text(p + Vec2{sample + style_.gap, 0}, b.label, l);
    }
}

}  // namespace beamcam::render::figure
