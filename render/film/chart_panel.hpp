// A panel that is one chart.
#pragma once

#include <utility>
#include <vector>

#include "render/film/panel.hpp"
#include "render/plot/chart.hpp"

namespace beamcam::render {

inline figure::PlotStyle chart_style(const FilmContext& context) {
    return figure::film_style(context.look.palette, context.look.unit, context.look.letters.heading,
                              context.look.letters.words);
}

class ChartPanel : public FilmPanel {
  public:
    ChartPanel(const FilmContext& context, ChartContent content, const Box& box)
        : context_(context),
          chart_(std::move(content), box, plot_area(box, context.look.unit, context.look.letters.words),
                 chart_style(context), *context.fonts) {}
    void draw_background(Canvas& canvas) const override { chart_.draw_background(canvas); }
    void draw(Canvas& canvas, int frame, Style, BodyPicture&) const override {
        chart_.draw_moving(canvas, context_.clock.at(frame), readings(frame), peaks(frame));
    }

  protected:
    virtual std::vector<double> readings(int frame) const = 0;
    virtual std::vector<Vec2> peaks(int) const { return {}; }
    const FilmContext& context_;

  private:
    Chart chart_;
};

}  // namespace beamcam::render
