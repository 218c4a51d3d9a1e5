#include "render/film/clock_line.hpp"

#include <algorithm>

#include "render/film/strip_content.hpp"

namespace beamcam::render {
namespace {

constexpr double kSmaller = 0.7;                        // size of letters for which there is no room otherwise
constexpr double kAfterClock = 36, kBetweenPills = 14;  // [design px]
constexpr double kPadding = 1.7;                        // of a pill, in sizes of its letters

std::string peak_text(const FilmContext& context, double force) {
    return context.look.translate("largest $F$ so far") + "\u2009=\u2009" +
           reading(force, context.scales.force_unit, "N");
}

}  // namespace

// Without room in the smaller size, the forces of all motions are left out, then the last pills.
ClockLine::ClockLine(const FilmContext& context) : context_(context) {
    const FilmSetup& setup = *context.setup;
    const bool mechanism = context.places.first(PanelKind::mechanism) != nullptr;
    if (!context.places.clock) return;
    if (setup.view.labelled() && context.scales.exaggeration > 1 && mechanism)
        pills_.push_back({Pill::Kind::exaggeration,
                          context.look.translate("deflection ×{}", power_text(context.scales.exaggeration)),
                          context.look.palette.motion});
    if (setup.view.labelled() && !setup.speeds.empty())
        pills_.push_back(
            {Pill::Kind::speed, widest_speed_text(setup.speeds, context.look.lang), context.look.palette.contact});
    const bool in_chart =
        std::ranges::any_of(context.places.panels, [](const auto& slot) { return shows_peaks(slot.spec); });
    for (int m = 0; m < context.members() && mechanism && !in_chart && setup.view.labelled(); ++m)
        if (!context.motion(m).impacts.empty() && context.scales.largest_force > 0 &&
            context.motion(m).problem.contact.model == sim::ContactModel::compliant) {
            if (!peaks_) peaks_.emplace(context, Range{0, context.clock.span.high});
            pills_.push_back({Pill::Kind::peak, peak_text(context, 0.888 * context.scales.force_unit.factor),
                              context.members() > 1 ? context.member_color(m) : context.look.palette.contact, m});
        }
    steady_ = steady_speed(setup.speeds);
    Image scratch(1, 1);
    const Canvas canvas(scratch, *context.fonts);
    const auto fits = [&](double size) {
        size_ = size * context.look.letters.title, letters_ = std::max(size * context.look.letters.words, kReadable);
        return measure(canvas) <= context.places.clock->right();
    };
    if (fits(1) || fits(kSmaller)) return;
    std::erase_if(pills_, [](const Pill& pill) { return pill.kind == Pill::Kind::peak; });
    while (!pills_.empty() && measure(canvas) > context.places.clock->right()) {
        has_room_ = false;
        pills_.pop_back();
    }
}

bool ClockLine::states_exaggeration() const {
    return !pills_.empty() && pills_.front().kind == Pill::Kind::exaggeration;
}

double ClockLine::measure(const Canvas& canvas) {
    const double u = context_.look.unit, last = context_.clock.at(context_.frames() - 1);
    clock_width_ = canvas.measure(clock_text(context_.clock.format, last), clock_style()).w;
    double right = context_.places.clock->x + clock_width_;
    first_ = right + kAfterClock * u;
    for (double x = first_; Pill & pill : pills_) {
        pill.width = canvas.measure(pill.widest, pill_style(pill)).w + kPadding * letters_;
        right = x + pill.width;
        x = right + kBetweenPills * u;
    }
    return right;
}

TextStyle ClockLine::clock_style() const {
    return {.size = size_,
            .color = context_.look.palette.ink,
            .weight = Weight::semibold,
            .tabular = context_.frames() > 1};
}

// On an unknown background pills are opaque.
TextStyle ClockLine::pill_style(const Pill& pill) const {
    return {.size = letters_,
            .color = context_.setup->view.transparent ? context_.look.palette.paper
                                                      : readable(context_.look.palette, pill.color),
            .weight = Weight::medium,
            .align = HAlign::centre};
}

// Empty: the pill is not shown.
std::string ClockLine::words(const Pill& pill, int frame) const {
    switch (pill.kind) {
        case Pill::Kind::exaggeration:
            return pill.widest;
        case Pill::Kind::speed:
            return speed_text(context_.setup->speeds[static_cast<std::size_t>(frame)], steady_, context_.look.lang);
        case Pill::Kind::peak:
            break;
    }
    const double peak = peaks_->of(pill.member, {0, context_.clock.at(frame)}).y;
    return peak >= 0.0005 * context_.scales.force_unit.factor ? peak_text(context_, peak) : std::string();
}

void ClockLine::draw(Canvas& canvas, int frame) const {
    if (!context_.places.clock) return;
    const Box& b = *context_.places.clock;
    const double u = context_.look.unit;
    if (clock_width_ <= b.w)
        canvas.text({b.x, b.y + 24 * u + 0.35 * size_}, clock_text(context_.clock.format, context_.clock.at(frame)),
                    clock_style());
    double x = first_;
    for (const Pill& pill : pills_) {
        const std::string text = words(pill, frame);
        const Box box{x, b.y + 6 * u, pill.width, 36 * u};
        x = box.right() + kBetweenPills * u;
        if (text.empty()) continue;
        canvas.rounded(box, 18 * u);
        canvas.fill(context_.setup->view.transparent ? pill.color : pill.color.faded(0.14));
        canvas.text({box.x + box.w / 2, b.y + 24 * u + 0.35 * letters_}, text, pill_style(pill));
    }
}

}  // namespace beamcam::render
