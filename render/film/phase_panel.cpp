// The phase portrait: hub speed against hub angle, with the path so far and the current point.
#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "render/film/chart_panel.hpp"
#include "render/plot/channel_label.hpp"
#include "render/plot/ticks.hpp"
#include "sim/beam/drive.hpp"

namespace beamcam::render {
namespace {

using sim::ChannelKind;

struct TimedPath {
    std::vector<double> times;  // increasing [s]
    std::vector<Vec2> points;   // [px]; NaN breaks the path
};

// Without points nearer than `least` pixels to the previous one, except the last point.
TimedPath thinned(const std::vector<double>& times, const std::vector<Vec2>& points, double least) {
    TimedPath out;
    for (std::size_t i = 0; i < times.size(); ++i) {
        const bool near = !out.points.empty() && norm(points[i] - out.points.back()) < least;  // false beside NaN
        if (near && i + 1 < times.size()) continue;
        out.times.push_back(times[i]);
        out.points.push_back(points[i]);
    }
    return out;
}

// A period of the first natural vibration, where that is so fast that it would hide the path; else 0.
double smoothing_time(const Motion& motion) {
    constexpr double kSlow = 0.1;  // of the time of the chart
    const auto* t = column(motion.chart, {ChannelKind::t, 0});
    if (!t || t->empty() || sim::is_prescribed(motion.problem.hub.drive)) return 0;
    const double period = first_period(motion.problem);
    return period < kSlow * (t->back() - t->front()) ? period : 0;
}

struct Path {
    std::vector<double> theta, speed;  // in the rows of a chart [rad], [rad/s]
};

// The mean over this time around each row, or the part of it that the rows have, and its derivative.
Path mean_of(const std::vector<double>& t, const std::vector<double>& theta, double time) {
    std::vector<double> integral{0};
    for (std::size_t i = 1; i < t.size(); ++i)
        integral.push_back(integral.back() + (theta[i] + theta[i - 1]) / 2 * (t[i] - t[i - 1]));
    Path path;
    for (const double now : t) {
        const double from = std::max(now - time / 2, t.front()), to = std::min(now + time / 2, t.back());
        const auto rate = [&](const std::vector<double>& of) {
            return (value_at(t, of, to) - value_at(t, of, from)) / (to - from);
        };
        path.theta.push_back(rate(integral));
        path.speed.push_back(rate(theta));
    }
    return path;
}

// Smoothed twice, which leaves little of the higher vibrations.
Path path_of(const Motion& motion, double time) {
    const auto *t = column(motion.chart, {ChannelKind::t, 0}), *theta = column(motion.chart, {ChannelKind::theta, 0}),
               *speed = column(motion.chart, {ChannelKind::theta_dot, 0});
    if (!t || !theta || !speed) return {};
    if (time == 0) return {*theta, *speed};
    return mean_of(*t, mean_of(*t, *theta, time).theta, time);
}

class PhasePanel final : public FilmPanel {
  public:
    PhasePanel(const FilmContext& context, const PanelSlot& slot)
        : context_(context), box_(slot.box), style_(chart_style(context)), plot_(axes_, style_, "phase") {
        Bounds all;
        for (int m = 0; m < context.members(); ++m) {
            const double time = smoothing_time(context.motion(m));
            smoothing_ = std::max(smoothing_, time);
            const Path& path = smooth_.emplace_back(path_of(context.motion(m), time));
            for (std::size_t i = 0; i < path.theta.size(); ++i) all.add({path.theta[i], path.speed[i]});
        }
        axes_.x = axis(all.x0, all.x1, "$θ$", ChannelKind::theta, x_factor_);
        axes_.y = axis(all.y0, all.y1, "d$θ$/d$t$", ChannelKind::theta_dot, y_factor_);
        Image none(1, 1);
        plot_.place(Canvas(none, *context.fonts), plot_area(slot.box, context.look.unit, context.look.letters.words));
        for (int m = 0; m < context.members(); ++m) paths_.push_back(path(m));
    }

    void draw_background(Canvas& canvas) const override {
        const double u = context_.look.unit;
        const std::string name = plot_.y().name(),
                          words = heading(ChannelKind::theta_dot, context_.setup->view.lang) + name,
                          smoothing = smoothing_ > 0
                                          ? context_.look.translate("smoothed over {}", quantity(smoothing_, "s"))
                                          : std::string(),
                          end = smoothing.empty() ? smoothing : ", " + smoothing;
        const TextStyle heading{.size = context_.look.letters.heading, .weight = Weight::semibold};
        const Box& plot = plot_.box();
        draw_heading(canvas, context_, {plot.x, box_.y, plot.w, plot.h},
                     first_that_fits(canvas, {words + end, name + end, name}, heading, plot.w));
        plot_.draw_y_axis(canvas);
        plot_.draw_x_axis(canvas);
        for (std::size_t m = 0; m < paths_.size(); ++m) {
            canvas.polyline(paths_[m].points);
            canvas.stroke({context_.look.palette.tint(color(m), 0.22), 1.0 * u});
        }
    }

    void draw(Canvas& canvas, int frame, Style, BodyPicture&) const override {
        for (std::size_t m = 0; m < paths_.size(); ++m) {
            const auto& [times, points] = paths_[m];
            const auto past = std::ranges::upper_bound(times, context_.clock.at(frame)) - times.begin();
            canvas.polyline(std::span(points).first(static_cast<std::size_t>(past)));
            canvas.stroke({color(m), 1.3 * context_.look.unit});
        }
        for (std::size_t m = 0; m < paths_.size(); ++m) {
            const auto* t = column(context_.motion(static_cast<int>(m)).chart, {ChannelKind::t, 0});
            const auto& [theta, speed] = smooth_[m];
            if (!t || theta.empty()) continue;
            const double now = context_.clock.at(frame);
            canvas.circle(to_pixels(value_at(*t, theta, now), value_at(*t, speed, now)), 6 * context_.look.unit);
            canvas.fill_keeping_path(color(m));
            canvas.stroke({context_.look.palette.paper, 1.6 * context_.look.unit});
        }
    }

  private:
    Color color(std::size_t member) const { return series_color(context_.look.palette, member); }
    Axis axis(double low, double high, const std::string& symbol, ChannelKind kind, double factor) const {
        if (!(low <= high)) low = 0, high = 1 / factor;
        low *= factor, high *= factor;
        if (high - low < 1e-9) low -= 0.05, high += 0.05;
        const std::string unit = context_.shown_unit({kind, 0});
        return {.label = symbol + " / " + unit,
                .from = low,
                .to = high,
                .round_ends = true,
                .short_numbers = true,
                .grid = true};
    }
    Vec2 to_pixels(double theta, double speed) const { return plot_.at(x_factor_ * theta, y_factor_ * speed); }
    TimedPath path(int member) const {
        const auto* t = column(context_.motion(member).chart, {ChannelKind::t, 0});
        const auto& [theta, speed] = smooth_[static_cast<std::size_t>(member)];
        std::vector<Vec2> points;
        for (std::size_t i = 0; i < theta.size(); ++i) points.push_back(to_pixels(theta[i], speed[i]));
        if (points.empty()) return {};
        return thinned(*t, points, 0.7);
    }

    const FilmContext& context_;
    Box box_;
    // From SI to the units of the axes.
    double x_factor_ = context_.shown_factor({ChannelKind::theta, 0});
    double y_factor_ = context_.shown_factor({ChannelKind::theta_dot, 0});
    figure::PlotStyle style_;
    figure::Panel axes_;
    figure::Plot plot_;
    double smoothing_ = 0;  // the longest [s]
    std::vector<Path> smooth_;
    std::vector<TimedPath> paths_;
};

}  // namespace

PanelType phase_panel() {
    return {.kind = PanelKind::phase,
            .name = "phase",
            .smallest = {240, 170},
            .make = make_panel<PhasePanel>,
            .channels = {ChannelKind::theta, ChannelKind::theta_dot},
            .draws_curve = true};
}

}  // namespace beamcam::render
