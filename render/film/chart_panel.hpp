// A panel that is one chart. Its past is accumulated column by column.
#pragma once

#include <utility>
#include <vector>

#include "render/film/panel.hpp"
#include "render/plot/chart.hpp"

namespace beamcam::render {

inline figure::PlotStyle chart_style(const FilmContext& context) {
    return figure::film_style(*context.palette, context.unit, context.tick);
}

// Copies the columns of the past up to `until`; `shown`: the first column that is not copied yet.
inline void copy_past(Canvas& kept, const Chart& chart, const Image& past, double until, double& shown) {
    const Box at = chart.past_box();
    until = std::max(until, shown);
    kept.image_part(past, static_cast<int>(at.x), static_cast<int>(at.y), {shown - at.x, 0, until - shown, at.h});
    shown = until;
}

class ChartPanel : public FilmPanel {
    struct Shown final : State {
        double until = 0;  // first column of the picture without past
    };

  public:
    ChartPanel(const FilmContext& context, ChartContent content, const Box& box)
        : context_(context),
          chart_(std::move(content), box, plot_area(box, context.unit, context.tick), chart_style(context),
                 *context.fonts) {
        past_ = chart_.past(*context.fonts);
    }
    void draw_background(Canvas& canvas) const override { chart_.draw_background(canvas); }
    Box accumulated_box() const override { return chart_.windowed() ? Box{} : chart_.past_box(); }
    std::unique_ptr<State> make_state() const override { return std::make_unique<Shown>(); }
    void accumulate(Canvas& kept, const Image&, int frame, bool restart, State* state) const override {
        if (chart_.windowed()) return;
        double& shown = static_cast<Shown*>(state)->until;
        if (restart) shown = chart_.past_box().x;
        copy_past(kept, chart_, past_, chart_.past_column(context_.at(0, frame)), shown);
    }
    void draw(Canvas& canvas, int frame, Style, State*) const override {
        chart_.draw_moving(canvas, context_.at(0, frame), readings(frame));
    }

  protected:
    virtual std::vector<double> readings(int frame) const = 0;
    const FilmContext& context_;

  private:
    Chart chart_;
    Image past_;
};

}  // namespace beamcam::render
