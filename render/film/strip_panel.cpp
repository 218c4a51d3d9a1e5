// Channels against time: over the film or a moving window, or collision by collision.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "render/film/chart_panel.hpp"
#include "render/film/force_curve.hpp"
#include "render/film/strip_content.hpp"
#include "render/plot/ticks.hpp"

namespace beamcam::render {
namespace {

using sim::Channel;

class StripPanel final : public ChartPanel {
  public:
    StripPanel(const FilmContext& context, const PanelSlot& slot)
        : ChartPanel(context, strip_content(context, slot.spec), slot.box), spec_(slot.spec) {
        if (shows_peaks(spec_) && context.setup->view.labelled()) peaks_.emplace(context, context.clock.span);
    }

  private:
    std::vector<double> readings(int frame) const override {
        std::vector<double> out;
        for (const Channel channel : spec_.channels)
            for (int m = 0; m < context_.members(); ++m) out.push_back(reading(context_, m, frame, channel));
        for (const double measured : readings_of_data(context_, spec_, context_.clock.at(frame)))
            out.push_back(measured);
        return out;
    }
    std::vector<Vec2> peaks(int frame) const override {
        std::vector<Vec2> out;
        for (int m = 0; peaks_ && m < context_.members(); ++m)
            out.push_back(peaks_->of(m, {context_.clock.span.low, context_.clock.at(frame)}));
        return out;
    }
    PanelSpec spec_;
    std::optional<Peaks> peaks_;
};

// ---- a strip that shows one collision after the other --------------------------------------------

// The channels during the latest collision of each motion, from shortly before its first touch at t₀; before that of
// the first one its axes. All collisions share the axis of values.
class CollisionPanel final : public FilmPanel {
  public:
    CollisionPanel(const FilmContext& context, const PanelSlot& slot)
        : context_(context), spec_(slot.spec), whole_(context, over_film(slot)) {
        for (int m = 0; m < context.members(); ++m) collisions_.push_back(collisions_of(m));
        if (shows_peaks(spec_) && context.setup->view.labelled()) peaks_.emplace(context, context.clock.span);
        content_ = strip_content(context, spec_);
        content_.panel.events.clear();
        content_.past_only =
            context.frames() > 1 || context.members() > 1;  // the picture of a touch shows the force that follows
        curves_ = std::exchange(content_.panel.series, {});
        const Box plot = plot_area(slot.box, context.look.unit, context.look.letters.words);
        for (int k = 0; k < context.frames(); ++k)
            if (const Latest latest = latest_at(context.clock.at(k)); !charts_.contains(latest))
                charts_.try_emplace(latest, content_of(latest), slot.box, plot, chart_style(context), *context.fonts);
    }

    double begins() const override { return begins_with_touch(context_); }
    void draw_background(Canvas&) const override {}

    void draw(Canvas& canvas, int frame, Style style, BodyPicture& bodies) const override {
        const double now = context_.clock.at(frame);
        const Latest latest = latest_at(now);
        if (outlasts_window(latest, now)) {
            whole_.draw_background(canvas);
            return whole_.draw(canvas, frame, style, bodies);
        }
        const Chart& chart = charts_.at(latest);
        chart.draw_background(canvas);
        std::vector<double> times, readings;
        std::vector<Vec2> peaks;
        for (int m = 0; m < context_.members(); ++m) {
            const double touch = touch_of(latest, m);
            times.push_back(now - touch);
            if (peaks_) peaks.push_back(peaks_->of(m, {touch, now}) - Vec2{touch, 0});
        }
        for (const Channel channel : spec_.channels)
            for (int m = 0; m < context_.members(); ++m) readings.push_back(reading(context_, m, frame, channel));
        if (content_.past_only)
            chart.draw_rows(canvas, times, readings, peaks);
        else
            chart.draw_moving(canvas, times.front(), readings, peaks);
    }

  private:
    // Of a contact that lasts, only the beginning counts as a collision [s].
    static constexpr double kLasting = 1, kShown = 0.1;
    static PanelSlot over_film(PanelSlot slot) {
        slot.spec.by_collision = false;
        return slot;
    }
    struct Collision {
        Range span;
        double shown = 0;  // end of its time axis
        int number = 1;
    };
    using Latest = std::vector<std::size_t>;  // the collision of each motion that began last, or the first

    std::vector<Collision> collisions_of(int member) const {
        std::vector<Collision> out;
        for (const sim::Impact& i : context_.motion(member).impacts) {
            if (i.t_start > context_.clock.span.high) break;
            const double end = std::min(i.t_end.value_or(context_.clock.span.high), context_.clock.span.high);
            if (context_.frames() > 1 && end < context_.clock.at(0)) continue;  // before the film
            if (out.empty() || out.back().number != i.collision) out.push_back({{i.t_start, end}, end, i.collision});
            Collision& now = out.back();
            now.span.high = std::max(now.span.high, end);
            now.shown = end - i.t_start > kLasting ? i.t_start + kShown : now.span.high;
        }
        return out;
    }

    Latest latest_at(double t) const {
        Latest out;
        for (const std::vector<Collision>& all : collisions_) {
            const auto begun = std::ranges::count_if(all, [&](const Collision& each) { return each.span.low <= t; });
            out.push_back(static_cast<std::size_t>(std::max(begun, 1L)) - 1);
        }
        return out;
    }
    const Collision* collision(const Latest& latest, int m) const {
        const auto member = static_cast<std::size_t>(m);
        return collisions_[member].empty() ? nullptr : &collisions_[member][latest[member]];
    }
    // Every motion is in a contact that lasts, of which its chart does not show this instant.
    bool outlasts_window(const Latest& latest, double now) const {
        for (int m = 0; m < context_.members(); ++m)
            if (const Collision* own = collision(latest, m);
                !own || now > own->span.high || now <= own->span.low + time_of(*own).high)
                return false;
        return true;
    }
    double touch_of(const Latest& latest, int m) const {
        const Collision* own = collision(latest, m);
        return own ? own->span.low : 2 * context_.clock.span.high;  // after the film
    }

    // The time axis of a collision, from its first touch.
    Range time_of(const Collision& each) const {
        const double length = each.shown - each.span.low, m = std::clamp(0.15 * length, 1.5e-5, 0.01);
        return {-m, length + m};
    }

    ChartContent content_of(const Latest& latest) const {
        ChartContent c = content_;
        std::optional<Range> all;
        for (int m = 0; m < context_.members(); ++m)
            if (const Collision* own = collision(latest, m)) {
                const Range time = time_of(*own);
                all = all ? Range{std::min(all->low, time.low), std::max(all->high, time.high)} : time;
                c.words = context_.members() > 1 ? context_.look.translate("Last collisions") + ", "
                                                 : context_.look.translate("Collision {}", own->number) + ", ";
            }
        const Range time = all.value_or(Range{0, 0.01});
        const Prefix prefix = time.high < 1 ? prefix_for(time.high) : Prefix{"", 1};
        c.set_time(time, prefix.factor, fmt::format("($t$ − $t$_{{0}}) / {}s", prefix.symbol));
        for (figure::Span& span : c.panel.spans) span.from -= touch_of(latest, 0), span.to -= touch_of(latest, 0);
        for (std::size_t k = 0; k < curves_.size(); ++k) {
            figure::Series curve = curves_[k];
            const double t0 = touch_of(latest, static_cast<int>(k) % context_.members());
            const std::vector<double> t = std::exchange(curve.x, {}), v = std::exchange(curve.y, {});
            for (std::size_t i = 0; i < t.size(); ++i)
                if (t[i] >= t0 + time.low && t[i] <= t0 + time.high) curve.add(t[i] - t0, v[i]);
            c.panel.series.push_back(std::move(curve));
        }
        return c;
    }

    const FilmContext& context_;
    PanelSpec spec_;
    std::optional<Peaks> peaks_;
    std::vector<std::vector<Collision>> collisions_;  // of each motion
    ChartContent content_;
    std::vector<figure::Series> curves_;
    std::map<Latest, Chart> charts_;  // of the collisions that frames show
    StripPanel whole_;                // after the window of a contact that lasts
};

}  // namespace

PanelType strip_panel() {
    return {.kind = PanelKind::strip,
            .name = "strip",
            .smallest = {300, 150},
            .make = [](const FilmContext& context, const PanelSlot& slot) -> std::unique_ptr<FilmPanel> {
                if (slot.spec.by_collision && context.setup->problem.cam)
                    return std::make_unique<CollisionPanel>(context, slot);
                return std::make_unique<StripPanel>(context, slot);
            },
            .takes_channels = true,
            .takes_window = true,
            .takes_collisions = true};
}

}  // namespace beamcam::render
