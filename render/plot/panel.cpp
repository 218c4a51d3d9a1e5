#include "render/plot/panel.hpp"

#include <algorithm>
#include <cmath>

#include "render/plot/cloud.hpp"
#include "render/plot/drawn_curve.hpp"

namespace beamcam::render::figure {

PanelDrawing::PanelDrawing(const Panel& panel, const PlotStyle& style, PageCanvas& sheet, double width, double height,
                           bool lowest, bool legend, const std::string& what)
    : panel_(panel),
      style_(style),
      sheet_(sheet),
      plot_(panel, style, what, lowest),
      names_(panel, style, sheet, lowest, legend) {
    place({0, 0, width, height});
}

void PanelDrawing::place(const Box& box) {
    plot_.place(sheet_, box);
    names_.fit(plot_, box.w, box.h);
}

// ---- data ----------------------------------------------------------------------------------------

void PanelDrawing::draw(const Box& bar_beside) const {
    sheet_.clip(plot_.box(), [&] { draw_backgrounds(); });
    draw_data();
    label_rules();
    label_marks();
    names_.draw(plot_, bar_beside);
}

std::array<Vec2, 2> PanelDrawing::ends(const Rule& r) const {
    if (r.vertical) return {Vec2{plot_.along_x(r.at), plot_.box().y}, {plot_.along_x(r.at), plot_.box().bottom()}};
    return {Vec2{plot_.box().x, plot_.along_y(r.at)}, {plot_.box().right(), plot_.along_y(r.at)}};
}

// Vertical rules closer than a gap would look like a thick one: they are one, which has the label.
std::vector<Rule> PanelDrawing::distinct_rules() const {
    std::vector<Rule> out;
    for (const Rule& r : panel_.rules) {
        const auto same = std::ranges::find_if(out, [&](const Rule& other) {
            return r.vertical && other.vertical &&
                   std::abs(plot_.along_x(r.at) - plot_.along_x(other.at)) < style_.gap &&
                   (r.label.empty() || other.label.empty());
        });
        if (same == out.end())
            out.push_back(r);
        else if (!r.label.empty())
            *same = r;
    }
    return out;
}

void PanelDrawing::draw_backgrounds() const {
    for (const Cells& cells : panel_.cells) draw_cells(cells, plot_, sheet_);
    plot_.draw_bands(sheet_);
    for (const Rule& r : distinct_rules())
        sheet_.line(ends(r)[0], ends(r)[1],
                    {rgb(0x888888), 0.75 * style_.frame, {3.3 * style_.frame, 3.3 * style_.frame}, Cap::butt});
}

void PanelDrawing::draw_data() const {
    std::vector<DrawnCurve> curves;
    for (const Series& s : panel_.series) curves.emplace_back(s, plot_, sheet_.grain());
    const bool any_line = std::ranges::any_of(panel_.series, &Series::line);
    const auto draw_markers = [&](bool beneath) {  // of points without a line, such as data, beneath the lines
        for (const DrawnCurve& curve : curves)
            if (beneath == (any_line && !curve.series().line)) curve.draw_markers(plot_.box(), style_, sheet_);
    };
    draw_markers(true);
    sheet_.clip(plot_.box(), [&] {
        for (const Cloud& cloud : panel_.clouds) draw_cloud(cloud, plot_, sheet_);
        for (const DrawnCurve& curve : curves) curve.draw(style_, sheet_);
    });
    plot_.draw_x_axis(sheet_);
    plot_.draw_y_axis(sheet_);
    plot_.draw_frame(sheet_);
    draw_markers(false);
    for (const Mark& m : panel_.marks) {
        const Vec2 p = plot_.at(m.x, m.y);
        if (!inside(plot_.box(), p, 1)) continue;
        draw_marker(sheet_, style_, look(m.look).marker, p, 1.1 * style_.marker, look(m.look).color, m.hollow);
    }
}

// ---- labels --------------------------------------------------------------------------------------

// A label is above its mark, or below it at the upper edge of the plot.
void PanelDrawing::label_marks() const {
    const Box within = plot_.box().inset(style_.tick);
    for (const Mark& m : panel_.marks) {
        const Vec2 p = plot_.at(m.x, m.y);
        if (m.label.empty() || !inside(plot_.box(), p, 1)) continue;
        TextStyle l = style_.tick_numbers();
        l.color = look(m.look).color, l.halo = kWhite;
        const Box size = sheet_.measure(m.label, l);
        const double off = style_.marker + style_.gap, half = size.w / 2;
        const bool below = p.y - off - size.h < within.y;
        l.align = HAlign::centre, l.valign = below ? VAlign::top : VAlign::bottom;
        const double x = std::clamp(p.x, within.x + half, std::max(within.x + half, within.right() - half));
        sheet_.text({x, p.y + (below ? off : -off)}, m.label, l);
    }
}

// The label of a vertical rule is at its upper end to its right, that of a horizontal one at its right end above it; at
// the edge of the plot it is on the other side. Where another label is there, it is below or to the left of that one.
void PanelDrawing::label_rules() const {
    const Box within = plot_.box().inset(style_.gap);
    const double off = 0.7 * style_.gap;
    std::vector<Box> labels;
    for (const Rule& r : panel_.rules) {
        const auto [from, to] = ends(r);
        if (r.label.empty() || !inside(plot_.box(), from, 1e-6)) continue;
        TextStyle l = style_.tick_numbers();
        l.color = kMuted, l.halo = kWhite;
        const Box size = sheet_.measure(r.label, l);
        Box at{within.right() - size.w, to.y - off - size.h, size.w, size.h};
        if (r.vertical) at.x = from.x + off, at.y = within.y;
        if (r.vertical && at.right() > within.right()) at.x = from.x - off - size.w;
        if (!r.vertical && at.y < within.y) at.y = to.y + off;
        while (std::ranges::any_of(labels, [&](const Box& other) { return at.overlaps(other); }))
            r.vertical ? at.y += at.h + off : at.x -= at.w + off;
        labels.push_back(at);
        sheet_.text({at.x, at.y - size.y}, r.label, l);
    }
}

}  // namespace beamcam::render::figure
