#include "render/film/mechanism_legend.hpp"

#include <algorithm>

#include "render/film/mechanism_marks.hpp"
#include "render/film/mechanism_view.hpp"
#include "render/plot/ticks.hpp"

namespace beamcam::render {
namespace {

constexpr double kNameLine = 34;  // distance of names [design px]

}  // namespace

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
double MechanismLegend::gap() const { return std::min(4 * at_.unit, 0.1 * std::min(at_.box.w, at_.box.h)); }
bool MechanismLegend::has_label() const { return !entries().empty() && has_names(at_.box, at_.unit); }
bool MechanismLegend::has_bar() const {
    return at_.box.w >= 300 * at_.unit && at_.box.h >= 220 * at_.unit && at_.labelled() &&
           at_.context.setup->view.style != Style::solid;
}

void MechanismLegend::place(OccupancyGrid room) {
    Image scratch(1, 1);
    Canvas canvas(scratch, *at_.context.fonts);
    if (has_label()) place_names(canvas, room);
    if (!has_bar()) return;
    const double wide = std::max(scale_length(at_) * at_.look.camera.scale,
                                 canvas.measure(quantity(scale_length(at_), "m"), {.size = at_.context.tick}).w);
    bar_ = room.choose(places_along(at_.box.inset(gap()), {wide + 2 * at_.unit, 30 * at_.unit}, Corner::bottom_right));
}

// In the first form that fits into the panel clear of moving parts, else in the one that is covered least. A list that
// would hide the mechanism is left out, names that are too long are cut.
void MechanismLegend::place_names(Canvas& canvas, OccupancyGrid& room) {
    constexpr Form kForms[] = {{1, 1}, {1, 0.8}, {2, 1}, {2, 0.8}, {3, 0.8}, {4, 0.8}};
    constexpr double kFree = 0.01, kMost = 0.3;  // covered shares
    const Box area = at_.box.inset(gap());
    const int count = static_cast<int>(entries().size());
    double least = count > 1 ? kMost : 1;
    for (const Form& form : kForms) {
        Vec2 size = size_of(canvas, form);
        if (form.columns == 1 && form.size < 1) size.x = std::min(size.x, area.w);
        if (form.columns > count || size.x > area.w || size.y > area.h) continue;
        const Box place = room.choose(places_along(area, size, Corner::top_left));
        const double covered = room.covered(place);
        if (covered > least || (label_ && covered == least)) continue;
        label_ = place, form_ = form, least = covered;
        if (covered < kFree) break;
    }
    if (label_) room.cover(label_->inset(-gap()), 1);
}

// The widest name of all motions, so that the labels of several panels have the same place.
double MechanismLegend::widest_name(Canvas& canvas, double size) const {
    double widest = 0;
    for (const auto* labels : {&at_.context.labels, &at_.context.data_labels})
        for (const std::string& each : *labels) widest = std::max(widest, canvas.measure(each, label_style(size)).w);
    return widest;
}

Vec2 MechanismLegend::size_of(Canvas& canvas, const Form& form) const {
    const double between = form.columns > 1 ? 20 * at_.unit : 0;
    const double column = 16 * at_.unit + sample() + widest_name(canvas, form.size) + between;
    const int rows = (static_cast<int>(entries().size()) + form.columns - 1) / form.columns;
    return {form.columns * column, kNameLine * form.size * at_.unit * rows};
}

std::vector<Box> MechanismLegend::boxes() const {
    std::vector<Box> out;
    if (label_) out.push_back(*label_);
    if (bar_) out.push_back(*bar_);
    return out;
}

void MechanismLegend::draw(Canvas& canvas, const MechanismView& at) const {
    scale_bar(canvas, at);
    names(canvas);
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

TextStyle MechanismLegend::label_style(double size) const {
    return {.size = std::max(size * std::max(24 * at_.unit, at_.context.heading()), kReadable),
            .color = at_.palette.ink,
            .weight = Weight::semibold,
            .halo = at_.palette.paper};
}

void MechanismLegend::names(Canvas& canvas) const {
    if (!label_) return;
    const std::vector<Entry> all = entries();
    const std::size_t columns = static_cast<std::size_t>(form_.columns), rows = (all.size() + columns - 1) / columns;
    const double wide = label_->w / form_.columns, line = kNameLine * form_.size * at_.unit;
    TextStyle style = label_style(form_.size);
    style.max_width = wide - sample() - 14 * at_.unit;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double x = label_->x + 2 * at_.unit + wide * static_cast<double>(i / rows),
                     y = label_->y + 24 * form_.size * at_.unit + line * static_cast<double>(i % rows);
        canvas.move_to({x, y - 8 * at_.unit});
        canvas.line_to({x + sample(), y - 8 * at_.unit});
        canvas.stroke({all[i].color, all[i].width * at_.unit, dashes(all[i].dash, at_.unit), Cap::butt});
        canvas.text({x + sample() + 12 * at_.unit, y}, all[i].text, style);
    }
}

}  // namespace beamcam::render
