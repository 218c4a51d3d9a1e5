// A panel that is one chart: what has been is kept, column by column.
#pragma once

#include <utility>
#include <vector>

#include "render/film/panel.hpp"
#include "render/plot/chart.hpp"

namespace beamcam::render {

inline ChartStyle chart_style(const FilmFacts& facts) { return {*facts.palette, facts.unit, facts.tick}; }

// Shows what has been as far as this column; `shown`: the first column that does not show it yet.
inline void show_past(Canvas& kept, const Chart& chart, const Image& past, double until, double& shown) {
    const Box at = chart.past_box();
    until = std::max(until, shown);
    kept.image_part(past, static_cast<int>(at.x), static_cast<int>(at.y), {shown - at.x, 0, until - shown, at.h});
    shown = until;
}

class ChartPanel : public FilmPanel {
    struct Shown final : State {
        double until = 0;  // the picture's first column that shows no past
    };

  public:
    ChartPanel(const FilmFacts& facts, ChartContent content, const Box& box)
        : facts_(facts), chart_(std::move(content), box, plot_area(box, facts.unit, facts.tick), chart_style(facts)) {
        past_ = chart_.past(*facts.fonts);
    }
    void draw_ground(Canvas& canvas) const override { chart_.draw_ground(canvas); }
    Box growing() const override { return chart_.windowed() ? Box{} : chart_.past_box(); }
    std::unique_ptr<State> make_state() const override { return std::make_unique<Shown>(); }
    // What has been, column by column.
    void grow(Canvas& kept, const Image&, int frame, bool anew, State* state) const override {
        if (chart_.windowed()) return;
        double& shown = static_cast<Shown*>(state)->until;
        if (anew) shown = chart_.past_box().x;
        show_past(kept, chart_, past_, chart_.past_column(facts_.at(0, frame)), shown);
    }
    void draw(Canvas& canvas, int frame, Style, State*) const override {
        chart_.draw_moving(canvas, facts_.at(0, frame), readings(frame));
    }

  protected:
    virtual std::vector<double> readings(int frame) const = 0;
    const FilmFacts& facts_;

  private:
    Chart chart_;
    Image past_;
};

}  // namespace beamcam::render
