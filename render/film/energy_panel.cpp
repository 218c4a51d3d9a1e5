// The terms of the energy balance as stacked bands.
#include <algorithm>
#include <cmath>

#include "render/film/chart_panel.hpp"
#include "render/film/strip_content.hpp"

namespace beamcam::render {
namespace {

using sim::ChannelKind;

constexpr double kVisible = 0.01;  // of the largest term

// All terms of the balance, stacked: their sum is the initial energy plus the work done by cam and drive, so where V ≥
// 0 the outline of the stack is the supplied energy. Where V < 0 its band is below zero, and the others are stacked on
// zero.
class EnergyPanel final : public ChartPanel {
  public:
    EnergyPanel(const FilmContext& context, const PanelSlot& slot)
        : ChartPanel(context, content(context, slot), slot.box),
          box_(slot.box),
          member_(std::min(slot.spec.member, context.members() - 1)) {}

    void draw_background(Canvas& canvas) const override {
        ChartPanel::draw_background(canvas);
        legend(canvas);
    }
    void draw(Canvas& canvas, int frame, Style style, BodyPicture& bodies) const override {
        ChartPanel::draw(canvas, frame, style, bodies);
        draw_member(canvas);
    }

  private:
    struct Part {
        std::string label;
        std::string symbol;  // where the label has no room
        std::vector<ChannelKind> channels;
        Color color;
    };
    static std::vector<Part> parts(const FilmContext& context) {
        const Palette& p = context.look.palette;
        using K = ChannelKind;
        const auto part = [&](const char* label, std::string symbol, std::vector<K> channels) {
            const Color color = *energy_color(p, channels.front());
            return Part{context.look.translate(label), std::move(symbol), std::move(channels), color};
        };
        return {part("potential", "$V$", {K::energy_potential}),
                part("kinetic", "$T$", {K::energy_kinetic}),
                part("bending", "$U$", {K::energy_elastic}),
                part("spring", "$U$_{h}", {K::energy_spring}),
                part("contact", "$U$_{c}", {K::energy_contact}),
                part("lost", "$D$", {K::loss_structural, K::loss_hub, K::loss_contact, K::loss_friction})};
    }

    static ChartContent content(const FilmContext& context, const PanelSlot& slot) {
        const PanelSpec& spec = slot.spec;
        const int member = std::min(spec.member, context.members() - 1);
        ChartContent c = blank_content(context, spec, member);
        if (is_wide(context, slot.box))
            c.words = context.look.translate("Energy") + " ";  // otherwise only the symbol and the legend fit
        const sim::Table& table = context.motion(member).chart;
        const auto* t = column(table, {ChannelKind::t, 0});
        std::vector<double> base(t ? t->size() : 0, 0.0);
        Extent shown;
        for (const Part& part : parts(context)) {
            figure::Band band{.low = base, .high = base, .color = part.color, .faint = part.color.faded(0.28)};
            if (t) band.x = *t;
            for (ChannelKind kind : part.channels) {
                const auto* v = column(table, {kind, 0});
                if (!v || v->empty()) continue;
                // Without a cam the channels of contact are empty. A preloaded spring would hide the rest.
                const double least = kind == ChannelKind::energy_spring ? std::ranges::min(*v) : 0;
                for (std::size_t i = 0; i < base.size(); ++i)
                    if (const double value = (*v)[i] - least; kind == ChannelKind::energy_potential && value < 0)
                        band.low[i] = value;
                    else if (value > 0)
                        band.high[i] += value;
            }
            base = band.high;
            shown.add(band.low), shown.add(band.high);
            c.panel.bands.push_back(std::move(band));
        }
        const auto& [any, low, high] = shown;
        c.set_values({1.02 * low, high > low ? 1.02 * high : 1}, "$E$", "J");
        return c;
    }

    static bool is_wide(const FilmContext& context, const Box& box) { return box.w > 600 * context.look.unit; }

    // The legend beside the heading, in symbols if there is no room for words, of the terms that are visible.
    void legend(Canvas& canvas) const {
        const double u = context_.look.unit;
        const Box plot = plot_area(box_, u, context_.look.letters.words);
        std::vector<Part> shown = parts(context_);
        double most = 0;
        for (const Part& part : shown) most = std::max(most, largest(part));
        std::erase_if(shown, [&](const Part& part) { return largest(part) <= kVisible * most; });
        const double first =
            plot.x +
            canvas
                .measure((is_wide(context_, box_) ? context_.look.translate("Energy") + " E / mJ" : "E / mJ"),
                         {.size = context_.look.letters.heading, .weight = Weight::semibold})
                .w +
            20 * u;
        const TextStyle style{.size = context_.look.letters.words, .color = context_.look.palette.muted};
        const double side = 0.8 * style.size, beside = 1.15 * style.size, gap = 0.7 * style.size;
        std::string Part::*text = &Part::label;
        const auto width = [&](const Part& part) { return beside + canvas.measure(part.*text, style).w + gap; };
        double end = first;
        for (const Part& part : shown) end += width(part);
        if (end - gap > box_.right()) text = &Part::symbol;
        double x = first;
        for (const Part& part : shown) {
            const double w = width(part);
            if (x + w - gap > box_.right() + 1) break;
            canvas.rounded({x, box_.y + 26.5 * u - side, side, side}, 3 * u);
            canvas.fill(part.color);
            canvas.text({x + beside, box_.y + 26 * u}, part.*text, style);
            x += w;
        }
    }
    double largest(const Part& part) const {
        double most = 0;
        for (const ChannelKind kind : part.channels)
            if (const auto* v = column(context_.motion(member_).chart, {kind, 0}))
                for (const double value : *v) most = std::max(most, std::abs(value));
        return most;
    }
    // The motion's label, over the bands.
    void draw_member(Canvas& canvas) const {
        if (context_.members() == 1) return;
        const double u = context_.look.unit;
        const Box plot = plot_area(box_, u, context_.look.letters.words);
        canvas.boxed_text({plot.x + 10 * u, plot.y + 24 * u}, context_.labels[static_cast<std::size_t>(member_)],
                          {.size = context_.look.letters.words,
                           .color = context_.look.palette.ink,
                           .weight = Weight::semibold,
                           .max_width = plot.w - 20 * u,
                           .halo = context_.look.palette.paper});
    }
    std::vector<double> readings(int) const override { return {}; }
    Box box_;
    int member_;
};

}  // namespace

PanelType energy_panel() {
    using enum ChannelKind;
    return {.kind = PanelKind::energy,
            .name = "energy",
            .smallest = {300, 150},
            .make = make_panel<EnergyPanel>,
            .channels = {energy_kinetic, energy_potential, energy_elastic, energy_spring, energy_contact,
                         loss_structural, loss_hub, loss_contact, loss_friction},
            .takes_window = true};
}

}  // namespace beamcam::render
