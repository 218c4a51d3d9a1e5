#include "render/film/mechanism_legend.hpp"

#include <algorithm>
#include <array>

#include "render/film/mechanism_marks.hpp"
#include "render/film/mechanism_view.hpp"
#include "render/plot/ticks.hpp"
#include "render/plot/user_text.hpp"

namespace beamcam::render {
namespace {

constexpr double kNameLine = 30, kBesideLine = 12, kBetweenNames = 34;  // line before a name, and gaps [design px]
constexpr double kSmallNames = 0.75;                                    // the second size of the letters

TextStyle name_style(const MechanismView& at, double size) {
    return {.size = size, .color = at.palette.ink, .weight = Weight::semibold, .halo = at.palette.paper};
}

}  // namespace

MechanismLegend::MechanismLegend(const MechanismView& at) : at_(at) {
    const FilmContext& context = at.context;
    has_bar_ = at.labelled();
    for (const PanelSlot& slot : context.places.panels)  // the last one has it
        if (slot.spec.kind == PanelKind::mechanism && !at.whole) has_bar_ = at.labelled() && slot.box == at.box;
    if (!at.names) return;
    for (int m = 0; m < context.members() && context.members() > 1; ++m)
        if (at.ghosts || m == at.member)
            entries_.push_back({context.member_color(m), context.motion(m).label, 6,
                                FilmContext::dash_of(static_cast<std::size_t>(m))});
    for (const FilmData& data : context.setup->data)
        if (at.member == 0 && data.find({sim::ChannelKind::theta, 0}))
            entries_.push_back(
                {context.data_color(std::size_t(&data - context.setup->data.data())), data.label, 3, {9, 5}});
    Image scratch(1, 1);
    fit_names(Canvas(scratch, *context.fonts));
}

// Mechanisms beside each other have letters of one size, that of the longest name.
void MechanismLegend::fit_names(const Canvas& canvas) {
    const FilmContext& context = at_.context;
    size_ = context.look.letters.heading;
    const auto width = [&](const std::string& name) {
        return canvas.measure(text_markup(name), name_style(at_, size_)).w;
    };
    double longest = 0, all = 0;
    for (int m = 0; m < context.members() && !at_.ghosts; ++m)
        longest = std::max(longest, width(context.motion(m).label));
    for (const Entry& entry : entries_) all += std::max(longest, width(entry.name));
    const auto count = static_cast<double>(entries_.size());
    const double room = at_.box.w - (count * (kNameLine + kBesideLine) + (count - 1) * kBetweenNames) * at_.unit;
    const double smaller = std::max(kSmallNames * size_, kReadable);
    if (all > room) all *= smaller / size_, size_ = smaller;
    for (Entry& entry : entries_) {
        const double most = all > room ? room / count : width(entry.name) + 1;
        const FittedText name = fitted_text(canvas, entry.name, name_style(at_, size_), size_, most);
        entry.name = name.markup, cuts_names_ = cuts_names_ || name.cut;
    }
}

void MechanismLegend::draw(Canvas& canvas, const MechanismView& at) const {
    if (at_.context.setup->view.style != Style::solid) scale_bar(canvas, at);
    names(canvas);
}

// Its length is round, near a seventh of the view, but hardly shorter than its text.
void MechanismLegend::scale_bar(Canvas& canvas, const MechanismView& at, const Projection* view) const {
    if (!has_bar_) return;
    TextStyle style{.size = at_.context.look.letters.words,
                    .color = at_.palette.muted,
                    .align = HAlign::centre,
                    .halo = at_.palette.paper};
    const double scale = at.look.camera.scale, u = at_.unit;
    double length = round_down_125(0.17 * at.box.w / scale);  // [m]
    while (canvas.measure(quantity(length, "m"), style).w > 1.1 * length * scale) length = round_up_125(1.01 * length);
    const std::string text = quantity(length, "m");
    const double w = length * scale, words = canvas.measure(text, style).w;
    const double middle = at_.box.right() - 5 * u - std::max(w, words) / 2;
    const double floor = at.px({0, 0}).y + floor_depth(at.problem(), at.look.camera, at.look.unit);
    const double x = middle - w / 2, y = view ? floor : at_.box.bottom() - 8 * u;
    const auto on = [&](double across, double down) { return at.seen({across, down}, view); };
    std::array line{on(x, y - 5 * u), on(x, y), on(x + w, y), on(x + w, y - 5 * u)};
    Bounds all;
    for (const Vec2 p : line) all.add(p);
    const Box room = view ? at.box.inset(at.fade() + 5 * u) : at_.box;
    const Vec2 back{std::min(0.0, room.right() - all.x1), std::min(0.0, room.bottom() - all.y1)};
    for (Vec2& p : line) p += back;
    canvas.polyline(line);
    canvas.stroke({at_.palette.muted, 1.6 * u, {}, Cap::butt});
    canvas.text(on(middle, y) + back - Vec2{0, (view ? 15 : 9) * u}, text, style);
}

void MechanismLegend::name_contacts(Canvas& canvas) const {
    if (at_.member > 0 || !at_.labelled()) return;
    const double u = at_.unit;
    const Vec2 left{at_.box.x + 2 * u, at_.box.bottom() - 8 * u};
    for (const double k : {0, 1})
        canvas.line(left + Vec2{k * 15 * u, -8 * u}, left + Vec2{(k + 1) * 15 * u, -8 * u},
                    {k > 0 ? at_.palette.contact : at_.palette.ink, 6 * u, {}, Cap::butt});
    canvas.text(left + Vec2{kNameLine * u + kBesideLine * u, 0}, at_.context.look.translate("contact so far"),
                {.size = at_.context.look.letters.words, .color = at_.palette.muted, .halo = at_.palette.paper});
}

void MechanismLegend::names(Canvas& canvas) const {
    const double u = at_.unit, y = at_.box.y + 24 * u;
    double x = at_.box.x + 2 * u;
    for (const Entry& entry : entries_) {
        canvas.line({x, y - 8 * u}, {x + kNameLine * u, y - 8 * u},
                    {entry.color, entry.width * u, dashes(entry.dash, u), Cap::butt});
        x += (kNameLine + kBesideLine) * u;
        x += canvas.text({x, y}, entry.name, name_style(at_, size_)).w + kBetweenNames * u;
    }
}

}  // namespace beamcam::render
