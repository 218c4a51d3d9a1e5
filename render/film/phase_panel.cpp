// The phase portrait: hub speed against hub angle, with the path so far and the current point.
#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "render/film/chart_panel.hpp"
#include "render/plot/channel_label.hpp"

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

class PhasePanel final : public FilmPanel {
  public:
    PhasePanel(const FilmContext& context, const PanelSlot& slot)
        : context_(context), box_(slot.box), style_(chart_style(context)), plot_(axes_, style_, "phase") {
        Bounds all;
        for (int m = 0; m < context.members(); ++m) {
            const sim::Table& table = context.motion(m).chart;
            const auto *x = column(table, {ChannelKind::theta, 0}), *y = column(table, {ChannelKind::theta_dot, 0});
            for (std::size_t i = 0; x && y && i < x->size(); ++i) {
                all.add({(*x)[i], (*y)[i]});
            }
            for (int k = 0; k < context.frames(); ++k) {
                const sim::Pose p = context.pose(m, k);
                all.add({p.theta, p.theta_dot});
            }
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
                          words = heading(ChannelKind::theta_dot, context_.setup->view.lang) + name;
        const TextStyle heading{.size = context_.look.letters.heading, .weight = Weight::semibold};
        const Box& plot = plot_.box();
        draw_heading(canvas, context_, {plot.x, box_.y, plot.w, plot.h},
                     first_that_fits(canvas, {words, name}, heading, plot.w));
        plot_.draw_y_axis(canvas);
        plot_.draw_x_axis(canvas);
        for (std::size_t m = 0; m < paths_.size(); ++m) {
            canvas.polyline(paths_[m].points);
            canvas.stroke({context_.look.palette.tint(color(m), 0.22), 1.0 * u});
        }
    }

    void draw(Canvas& canvas, int frame, Style, State*) const override {
        for (std::size_t m = 0; m < paths_.size(); ++m) {
            const auto& [times, points] = paths_[m];
            const auto past = std::ranges::upper_bound(times, context_.clock.at(frame)) - times.begin();
            canvas.polyline(std::span(points).first(static_cast<std::size_t>(past)));
            canvas.stroke({color(m), 1.3 * context_.look.unit});
        }
        for (std::size_t m = 0; m < paths_.size(); ++m) {
            const sim::Pose& pose = context_.pose(static_cast<int>(m), frame);
            canvas.circle(to_pixels(pose.theta, pose.theta_dot), 6 * context_.look.unit);
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
        const sim::Table& table = context_.motion(member).chart;
        const auto *t = column(table, {ChannelKind::t, 0}), *x = column(table, {ChannelKind::theta, 0}),
                   *y = column(table, {ChannelKind::theta_dot, 0});
        if (!t || !x || !y) return {};
        std::vector<Vec2> points;
        for (std::size_t i = 0; i < t->size(); ++i) points.push_back(to_pixels((*x)[i], (*y)[i]));
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
