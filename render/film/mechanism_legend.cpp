#include "render/film/mechanism_legend.hpp"

#include <algorithm>

#include "render/film/mechanism_view.hpp"
#include "render/plot/ticks.hpp"

namespace beamcam::render {

std::vector<MechanismLegend::Entry> MechanismLegend::entries() const {
    std::vector<Entry> out;
    for (int m = 0; m < at_.context.members() && at_.context.members() > 1; ++m)
        if (at_.ghosts || m == at_.member)
            out.push_back({at_.context.member_color(m), at_.context.labels[static_cast<std::size_t>(m)], 6,
                           FilmContext::dash_of(static_cast<std::size_t>(m))});
    for (std::size_t k = 0; k < at_.context.data_labels.size() && at_.member == 0; ++k)
        if (at_.context.setup->data[k].find({sim::ChannelKind::theta, 0}))
            out.push_back({at_.context.data_color(k), at_.context.data_labels[k], 3, {9, 5}});
    return out;
}

// Length of the line before a name; short in a narrow panel [px].
double MechanismLegend::sample() const { return (at_.box.w < 160 * at_.unit ? 12 : 30) * at_.unit; }
bool MechanismLegend::has_label() const { return !entries().empty() && has_names(at_.box, at_.unit); }
bool MechanismLegend::has_bar() const {
    return at_.box.w >= 300 * at_.unit && at_.box.h >= 220 * at_.unit && at_.labelled() &&
           at_.context.setup->view.style != Style::solid;
}

void MechanismLegend::place(OccupancyGrid room) {
    Image scratch(1, 1);
    Canvas canvas(scratch, *at_.context.fonts);
    const double gap = std::min(4 * at_.unit, 0.1 * std::min(at_.box.w, at_.box.h));
    const auto choose = [&](Vec2 size, Corner first) {
        const Box place = room.choose(places_along(at_.box.inset(gap), size, first));
        room.cover(place.inset(-gap), 1);
        return place;
    };
    if (has_label()) {
        double widest = 0;  // of all motions, so that the labels of several panels have the same place
        for (const auto* labels : {&at_.context.labels, &at_.context.data_labels})
            for (const std::string& each : *labels) widest = std::max(widest, canvas.measure(each, label_style()).w);
        const auto lines = static_cast<double>(entries().size());
        label_ = choose({std::min(16 * at_.unit + sample() + widest, at_.box.w - 2 * gap), 34 * at_.unit * lines},
                        Corner::top_left);
    }
    if (!has_bar()) return;
    const double wide = std::max(scale_length(at_) * at_.look.camera.scale,
                                 canvas.measure(quantity(scale_length(at_), "m"), {.size = at_.context.tick}).w);
    bar_ = choose({wide + 2 * at_.unit, 30 * at_.unit}, Corner::bottom_right);
}

std::vector<Box> MechanismLegend::boxes() const {
    std::vector<Box> out;
    if (label_) out.push_back(*label_);
    if (bar_) out.push_back(*bar_);
    return out;
}

void MechanismLegend::draw(Canvas& canvas, const MechanismView& at) const {
    scale_bar(canvas, at);
    label(canvas);
}

// A round length near a seventh of the view [m].
double MechanismLegend::scale_length(const MechanismView& at) const {
    return round_down_125(0.17 * at.box.w / at.look.camera.scale);
}

void MechanismLegend::scale_bar(Canvas& canvas, const MechanismView& at) const {
    if (!bar_) return;
    const double w = scale_length(at) * at.look.camera.scale;
    double middle = bar_->x + bar_->w / 2;
    if (at.moved) middle = std::clamp(middle, at.box.x + w / 2 + 4 * at.unit, at.box.right() - w / 2 - 4 * at.unit);
    const double y = bar_->bottom() - 4 * at_.unit;
    const double x = middle - w / 2;
    canvas.move_to({x, y - 5 * at_.unit});
    canvas.line_to({x, y});
    canvas.line_to({x + w, y});
    canvas.line_to({x + w, y - 5 * at_.unit});
    canvas.stroke({at_.palette.muted, 1.6 * at_.unit, {}, Cap::butt});
    canvas.text(
        {middle, y - 9 * at_.unit}, quantity(scale_length(at), "m"),
        {.size = at_.context.tick, .color = at_.palette.muted, .align = HAlign::centre, .halo = at_.palette.paper});
}

TextStyle MechanismLegend::label_style() const {
    return {.size = std::max(24 * at_.unit, at_.context.heading()),
            .color = at_.palette.ink,
            .weight = Weight::semibold,
            .halo = at_.palette.paper};
}

void MechanismLegend::label(Canvas& canvas) const {
    if (!label_) return;
    double y = label_->y + 24 * at_.unit;
    TextStyle style = label_style();
    style.max_width = label_->w - sample() - 14 * at_.unit;
    for (const Entry& entry : entries()) {
        const double x = label_->x + 2 * at_.unit;
        canvas.move_to({x, y - 8 * at_.unit});
        canvas.line_to({x + sample(), y - 8 * at_.unit});
        canvas.stroke({entry.color, entry.width * at_.unit, dashes(entry.dash, at_.unit), Cap::butt});
        canvas.text({x + sample() + 12 * at_.unit, y}, entry.text, style);
        y += 34 * at_.unit;
    }
}

}  // namespace beamcam::render
