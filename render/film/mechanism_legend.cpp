#include "render/film/mechanism_legend.hpp"

#include <algorithm>

#include "render/film/mechanism_marks.hpp"
#include "render/film/mechanism_view.hpp"
#include "render/plot/ticks.hpp"
#include "render/plot/user_text.hpp"

namespace beamcam::render {
namespace {

constexpr double kNameLine = 34;  // distance of names [design px]

}  // namespace

std::vector<MechanismLegend::Entry> MechanismLegend::entries() const {
    std::vector<Entry> out;
    for (int m = 0; m < at_.context.members() && at_.context.members() > 1; ++m)
        if (at_.ghosts || m == at_.member)
            out.push_back({at_.context.member_color(m), at_.context.motion(m).label, 6,
                           FilmContext::dash_of(static_cast<std::size_t>(m))});
    for (std::size_t k = 0; k < at_.context.data_labels.size() && at_.member == 0; ++k)
        if (at_.context.setup->data[k].find({sim::ChannelKind::theta, 0}))
            out.push_back({at_.context.data_color(k), at_.context.setup->data[k].label, 3, {9, 5}});
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
// would hide the mechanism is left out.
void MechanismLegend::place_names(Canvas& canvas, OccupancyGrid& room) {
    static constexpr Form kForms[] = {{1, 1},
                                      {1, 0.8},
                                      {1, 0.8, 2},
                                      {2, 1},
                                      {2, 0.8},
                                      {3, 0.8},
                                      {4, 0.8},
                                      {2, 0.8, 1, true},
                                      {3, 0.8, 1, true},
                                      {2, 0.8, 1, true, true},
                                      {1, 0.8, 1, false, true}};
    constexpr double kFree = 0.01, kApart = 0.1, kMost = 0.3;  // covered shares
    double least = entries().size() > 1 ? kMost : 1;
    for (const Form& form : kForms) {
        std::optional<Placed> here = placed(canvas, room, form);
        if (!here || here->covered > least || (form.apart && here->covered > kApart)) continue;
        if (form.cut && !blocks_.empty() && least <= kApart) continue;  // rather cover a little than cut a name
        if (!blocks_.empty() && here->covered == least) continue;
        blocks_ = std::move(here->blocks), form_ = form, least = here->covered;
        if (least < kFree) break;
    }
    for (const Block& block : blocks_) room.cover(block.box.inset(-gap()), 1);
}

std::optional<MechanismLegend::Placed> MechanismLegend::placed(Canvas& canvas, OccupancyGrid room,
                                                               const Form& form) const {
    const Box area = at_.box.inset(gap());
    const std::size_t count = entries().size(), rows = (count + form.columns - 1) / form.columns;
    if (form.columns > count || (form.lines > 1 && count > 1)) return std::nullopt;
    std::size_t lines = 1;
    double width = 16 * at_.unit + sample() + widest_name(canvas, form, lines);
    if (form.columns > 1 && !form.apart) width += 20 * at_.unit;
    if (form.cut) width = std::min(width, area.w / static_cast<double>(form.columns));
    const double beyond = static_cast<double>(lines - 1) * line_height(form.size);  // the first line
    const auto size_of = [&](std::size_t columns, std::size_t names) {
        return Vec2{static_cast<double>(columns) * width,
                    kNameLine * form.size * at_.unit * static_cast<double>(names) + beyond};
    };
    Placed out{{}, 0};
    const auto add = [&](Vec2 size) {
        const Box place = room.choose(places_along(area, size, Corner::top_left));
        for (const Block& other : out.blocks)  // columns that are apart hide no name of each other
            if (place.overlaps(other.box)) out.covered = 1;
        out.covered = std::max(out.covered, room.covered(place));
        room.cover(place.inset(-gap()), 1);
        return place;
    };
    const Vec2 whole = size_of(form.apart ? 1 : form.columns, rows);
    if (whole.x > area.w || whole.y > area.h) return std::nullopt;
    const Box all = form.apart ? Box{} : add(whole);
    for (std::size_t first = 0; first < count; first += rows) {
        const std::size_t names = std::min(rows, count - first);
        const std::size_t column = first / rows;
        const double before = width * static_cast<double>(column);
        out.blocks.push_back(
            {form.apart ? add(size_of(1, names)) : Box{all.x + before, all.y, width, all.h}, first, names});
    }
    return out;
}

double MechanismLegend::line_height(double size) const { return 1.2 * label_style(size).size; }

// Markup of the lines of a name, within this width [px].
std::vector<std::string> MechanismLegend::lines_of(Canvas& canvas, const std::string& name, const Form& form,
                                                   double width) const {
    TextStyle style = label_style(form.size);
    style.max_width = width;
    return wrapped_lines(canvas, name, style, form.lines);
}

// Of all motions, so that the labels of several panels have the same place. `lines`: the most.
double MechanismLegend::widest_name(Canvas& canvas, const Form& form, std::size_t& lines) const {
    const double width = form.lines > 1 ? at_.box.inset(gap()).w - 16 * at_.unit - sample() : 0;
    double widest = 0;
    const auto add = [&](const std::string& name) {
        const std::vector<std::string> all = lines_of(canvas, name, form, width);
        lines = std::max(lines, all.size());
        for (const std::string& line : all) widest = std::max(widest, canvas.measure(line, label_style(form.size)).w);
    };
    for (int m = 0; m < at_.context.members(); ++m) add(at_.context.motion(m).label);
    for (const FilmData& data : at_.context.setup->data) add(data.label);
    return widest;
}

std::vector<Box> MechanismLegend::boxes() const {
    std::vector<Box> out;
    for (const Block& block : blocks_) out.push_back(block.box);
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
    const std::vector<Entry> all = entries();
    const double line = kNameLine * form_.size * at_.unit;
    TextStyle style = label_style(form_.size);
    for (const Block& block : blocks_) {
        style.max_width = block.box.w - sample() - 14 * at_.unit;
        for (std::size_t i = 0; i < block.count; ++i) {
            const Entry& entry = all[block.first + i];
            const double x = block.box.x + 2 * at_.unit;
            double y = block.box.y + 24 * form_.size * at_.unit + line * static_cast<double>(i);
            canvas.move_to({x, y - 8 * at_.unit});
            canvas.line_to({x + sample(), y - 8 * at_.unit});
            canvas.stroke({entry.color, entry.width * at_.unit, dashes(entry.dash, at_.unit), Cap::butt});
            for (const std::string& text : lines_of(canvas, entry.name, form_, style.max_width)) {
                canvas.text({x + sample() + 12 * at_.unit, y}, text, style);
                y += line_height(form_.size);
            }
        }
    }
}

}  // namespace beamcam::render
