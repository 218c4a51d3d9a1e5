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
        if (shows_peaks(spec_) && context.setup->view.labelled()) peaks_.emplace(context);
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
        for (int m = 0; peaks_ && m < context_.members(); ++m) out.push_back(peaks_->of(m, context_.clock.at(frame)));
        return out;
    }
    PanelSpec spec_;
    std::optional<Peaks> peaks_;
};

// ---- a strip that shows one collision after the other --------------------------------------------

// The channels during one collision, from shortly before its first touch at t₀. The chart stays until the next
// collision begins; before the first one a film shows nothing. All collisions share the axis of values.
// Collisions of compared motions that follow each other within three times their duration are one.
class CollisionPanel final : public FilmPanel {
  public:
    CollisionPanel(const FilmContext& context, const PanelSlot& slot) : context_(context), spec_(slot.spec) {
        std::vector<std::pair<sim::Impact, std::size_t>> impacts;  // and their motions
        for (int m = 0; m < context.members(); ++m)
            for (const sim::Impact& i : context.motion(m).impacts) impacts.emplace_back(i, std::size_t(m));
        std::ranges::stable_sort(impacts, {}, [](const auto& each) { return each.first.t_start; });
        std::vector<int> last(static_cast<std::size_t>(context.members()), -1);  // collision of each motion
        for (const auto& [i, m] : impacts) {
            if (i.t_start > context.clock.span.high) break;
            const double end = std::min(i.t_end.value_or(context.clock.span.high), context.clock.span.high);
            if (context.frames() > 1 && end < context.clock.at(0)) continue;  // before the film
            const bool begins = std::exchange(last[m], i.collision) != i.collision;
            if (spans_.empty() || (begins && (last.size() == 1 || i.t_start > spans_.back().until())))
                spans_.push_back({{i.t_start, end}, end, i.collision});
            Collision& now = spans_.back();
            now.span.high = std::max(now.span.high, end);
            now.shown = end - i.t_start > kLasting ? i.t_start + kShown : now.span.high;
        }
        if (shows_peaks(spec_) && context.setup->view.labelled()) peaks_.emplace(context);
        content_ = strip_content(context, spec_);
        content_.panel.events.clear();
        content_.past_only = context.frames() > 1;  // the picture of a touch shows the force that follows
        curves_ = std::exchange(content_.panel.series, {});
        const Box plot = plot_area(slot.box, context.look.unit, context.look.letters.words);
        for (int k = 0; k < context.frames(); ++k)
            if (const std::size_t which = shown(context.clock.at(k)); !charts_.contains(which))
                charts_.try_emplace(which, content_of(which), slot.box, plot, chart_style(context), *context.fonts);
    }

    void draw_background(Canvas&) const override {}

    void draw(Canvas& canvas, int frame, Style, BodyPicture&) const override {
        const double now = context_.clock.at(frame);
        const std::size_t which = shown(now);
        const Chart& chart = charts_.at(which);
        if (content_.past_only && now - start(which) < chart.time().low) return;
        chart.draw_background(canvas);
        std::vector<double> readings;
        std::vector<Vec2> peaks;
        for (const Channel channel : spec_.channels)
            for (int m = 0; m < context_.members(); ++m) readings.push_back(reading(context_, m, frame, channel));
        for (int m = 0; peaks_ && m < context_.members(); ++m) {
            const Vec2 peak = peaks_->of(m, now) - Vec2{start(which), 0};
            peaks.push_back(peak.x < 0 ? Vec2{kNan, kNan} : peak);  // of an earlier collision
        }
        chart.draw_moving(canvas, now - start(which), readings, peaks);
    }

  private:
    // Of a contact that lasts, only the beginning counts as a collision [s].
    static constexpr double kLasting = 1, kShown = 0.1;
    struct Collision {
        Range span;
        double shown = 0;  // end of its time axis
        int number = 1;
        double until() const { return span.high + 3 * (span.high - span.low); }
    };

    // The collision that began last.
    std::size_t shown(double t) const {
        std::size_t which = 0;
        while (which + 1 < spans_.size() && spans_[which + 1].span.low <= t) ++which;
        return which;
    }
    double start(std::size_t which) const { return spans_.empty() ? 0 : spans_[which].span.low; }

    ChartContent content_of(std::size_t which) const {
        ChartContent c = content_;
        Range time{0, 0.01};
        if (!spans_.empty()) {
            const Range& span = spans_[which].span;
            const double length = spans_[which].shown - span.low, m = std::clamp(0.15 * length, 1.5e-5, 0.01);
            time = {-m, length + m};
            // If that is over before the film begins, or before the instant of a still, the contact after it is shown.
            const double first = context_.clock.at(0), shown_until = span.low + length + m;
            if (context_.frames() == 1 && first > shown_until && first <= span.high)
                time = {first - kShown - span.low, first - span.low};
            else if (context_.clock.span.low > shown_until && span.high > context_.clock.span.low)
                time = {context_.clock.span.low - span.low, std::min(span.high, context_.clock.span.high) - span.low};
            if (context_.members() == 1) c.words = context_.look.translate("Collision {}", spans_[which].number) + ", ";
        }
        const Prefix prefix = time.high < 1 ? prefix_for(time.high) : Prefix{"", 1};
        c.set_time(time, prefix.factor, fmt::format("($t$ − $t$_{{0}}) / {}s", prefix.symbol));
        const double t0 = start(which);
        for (figure::Span& span : c.panel.spans) span.from -= t0, span.to -= t0;
        for (figure::Series curve : curves_) {
            const std::vector<double> t = std::exchange(curve.x, {}), v = std::exchange(curve.y, {});
            const auto begin = std::ranges::lower_bound(t, t0 + time.low) - t.begin(),
                       end = std::ranges::upper_bound(t, t0 + time.high) - t.begin();
            for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
                curve.add(t[i] - t0, v[i]);
            c.panel.series.push_back(std::move(curve));
        }
        return c;
    }

    const FilmContext& context_;
    PanelSpec spec_;
    std::optional<Peaks> peaks_;
    std::vector<Collision> spans_;
    ChartContent content_;
    std::vector<figure::Series> curves_;
    std::map<std::size_t, Chart> charts_;  // of the collisions that frames show
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
