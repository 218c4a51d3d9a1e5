#include "render/film/clock_line.hpp"

#include <algorithm>
#include <string_view>

#include "render/film/mechanism_marks.hpp"

namespace beamcam::render {
namespace {

using Brevity = ClockLine::Brevity;

constexpr double kClock = 46, kLetters = 20;            // sizes [design px]
constexpr double kAfterClock = 36, kBetweenPills = 14;  // [design px]
constexpr double kPadding = 1.7;                        // of a pill, in sizes of its letters

// "defl. ×5" of "deflection ×5"; "×5" and "1/50" of "1/50 speed".
std::string short_form(std::string words, Brevity brevity) {
    const auto replace = [&](std::string_view from, std::string_view by) {
        if (const auto at = words.find(from); at != std::string::npos) words.replace(at, from.size(), by);
    };
    if (brevity == Brevity::abbreviated) replace("deflection ", "defl. ");
    if (brevity == Brevity::numbers)
        for (const std::string_view dispensable : {"deflection ", " speed", "挠度 ", " 倍速"}) replace(dispensable, "");
    return words;
}

}  // namespace

ClockLine::ClockLine(const FilmContext& context) : context_(context) {
    const FilmSetup& setup = *context.setup;
    if (setup.view.show.legend && context.factor > 1 && context.places.first(PanelKind::mechanism))
        pills_.push_back({context.translate("deflection ×" + power_text(context.factor)), context.palette->motion});
    if (setup.view.show.legend && !setup.speeds.empty())
        pills_.push_back({context.translate(widest_speed_text(setup.speeds)), context.palette->contact, 0, true});
    steady_ = steady_speed(setup.speeds);
    Image scratch(1, 1);
    Canvas canvas(scratch, *context.fonts);
    if (context.places.clock) choose_sizes(canvas);
}

// Smaller letters and a smaller clock rather than numbers without words.
void ClockLine::choose_sizes(Canvas& canvas) {
    struct Sizes {
        double clock, letters;
    };
    const double u = context_.unit;
    for (const Sizes& sizes : {Sizes{kClock, kLetters}, {kClock, 16}, {34, 18}, {28, 18}, {24, 18}}) {
        size_ = sizes.clock * u, letters_ = std::max(sizes.letters * u, kReadable);
        if (measure(canvas) <= context_.places.clock->right()) return;
    }
    brevity_ = Brevity::abbreviated;
    if (measure(canvas) <= context_.places.clock->right()) return;
    brevity_ = Brevity::numbers;
    size_ = kClock * u, letters_ = kLetters * u;
    measure(canvas);
}

double ClockLine::measure(Canvas& canvas) {
    const Box& b = *context_.places.clock;
    const double u = context_.unit, last = context_.at(context_.frames() - 1);
    clock_width_ = canvas.measure(clock_text(context_.time, last, last), clock_style()).w;
    first_ = b.x + (context_.setup->view.show.clock ? clock_width_ + kAfterClock * u : 0);
    double right = first_ - kBetweenPills * u;
    for (Pill& pill : pills_) {
        const std::string text = short_form(pill.widest, brevity_);
        pill.width = canvas.measure(text, pill_style(pill)).w + kPadding * letters_;
        right += kBetweenPills * u + pill.width + 0.2 * letters_;
    }
    return right;
}

TextStyle ClockLine::clock_style() const {
    return {.size = size_, .color = context_.palette->ink, .weight = Weight::semibold};
}

// On an unknown background pills are opaque.
TextStyle ClockLine::pill_style(const Pill& pill) const {
    return {
        .size = letters_,
        .color = context_.setup->view.transparent ? context_.palette->paper : readable(*context_.palette, pill.color),
        .weight = Weight::medium,
        .align = HAlign::centre};
}

std::string ClockLine::words(const Pill& pill, int frame) const {
    std::string all = pill.widest;
    if (pill.states_speed)
        all = context_.translate(speed_text(context_.setup->speeds[static_cast<std::size_t>(frame)], steady_));
    return short_form(std::move(all), brevity_);
}

void ClockLine::draw(Canvas& canvas, int frame) const {
    if (!context_.places.clock) return;
    const Box& b = *context_.places.clock;
    const double u = context_.unit, last = context_.at(context_.frames() - 1);
    if (clock_width_ > b.w) return;
    if (context_.setup->view.show.clock)
        canvas.text({b.x, b.y + 24 * u + 16 / kClock * size_}, clock_text(context_.time, context_.at(frame), last),
                    clock_style());
    double x = first_;
    for (const Pill& pill : pills_) {
        const std::string text = words(pill, frame);
        const TextStyle style = pill_style(pill);
        const Box box{x, b.y + 6 * u, std::max(pill.width, canvas.measure(text, style).w + kPadding * letters_),
                      36 * u};
        x = box.right() + kBetweenPills * u;
        if (text.empty() || box.right() > b.right()) continue;
        canvas.rounded(box, 18 * u);
        canvas.fill(context_.setup->view.transparent ? pill.color : pill.color.faded(0.14));
        canvas.text({box.x + box.w / 2, b.y + 24 * u + 0.35 * letters_}, text, style);
    }
}

}  // namespace beamcam::render
