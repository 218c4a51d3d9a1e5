// The parts of a series: its x axis, the simulations that it needs, its panels and its title.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "render/plot/figure.hpp"
#include "scenes/figures/motion_requests.hpp"
#include "scenes/figures/series_data.hpp"
#include "scenes/scene/scene.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

// The x axis: time, turns of the cam, phase of the cam, frequency or a channel.
class SeriesAbscissa {
  public:
    SeriesAbscissa(const SeriesKeys& keys, Lang lang);

    const std::optional<sim::Channel>& channel() const { return channel_; }  // absent: time, turns or frequency
    bool is_frequency() const { return against_ == "frequency"; }
    bool is_time() const { return against_ == "t" || is_turns(); }  // or turns, which grow with it

    // The abscissa of each row of a table whose last channel is drawn, in SI units or turns.
    std::vector<double> of(const sim::Table& table, const sim::Problem& problem) const;
    // The abscissa of each row of data; nothing if they do not hold it. The angle of the cam follows from its law.
    std::optional<std::vector<double>> of(const Measurement& data, const sim::Problem& problem) const;
    // The factor from seconds to the axis: 1, or the cam's turns per second.
    double per_second(const sim::Problem& problem) const;
    // The part of the abscissae of a curve that the axis shows, in SI units.
    std::pair<double, double> drawn(const sim::Problem& problem) const;
    // Turns angles of the cam into phases of a turn; a line is broken at each turn.
    void fold(render::figure::Series& curve) const;
    // Gives all panels one axis, with its label and unit.
    void share(render::figure::Figure& figure, const sim::Problem& problem, const render::Units& units) const;

  private:
    bool is_phase() const { return against_ == "phase"; }
    bool is_turns() const { return against_ == "turns"; }

    std::string against_;
    std::optional<double> low_, high_;
    std::string label_;
    AxisUnit unit_;
    Lang lang_;
    std::optional<sim::Channel> channel_;
};

// ---- the plan: motions, and a table for each curve of each panel -------------------------------------

struct SeriesMotion {
    std::string label;
    sim::Problem problem;
    std::size_t request = 0;
};

struct SeriesCurve {
    sim::Channel channel;
    std::size_t motion = 0, table = 0;  // the table: of the request of the motion
    std::optional<SeriesSum> sum = {};  // instead of the channel
};

struct PlannedPanel {
    std::size_t number = 0;            // among the panels of the keys
    std::vector<std::size_t> motions;  // that it shows
    std::vector<SeriesCurve> curves;   // of each channel, all these motions
};

struct SeriesPlan {
    SeriesKeys keys;
    Lang lang;
    double end = 0;  // [s]
    SeriesAbscissa abscissa;
    render::Units units = {};
    std::vector<SeriesMotion> motions = {};
    std::vector<PlannedPanel> panels = {};  // with `keys.apart` those of the first motion come first
    std::vector<Measured> measured = {};
    std::size_t measured_motion = 0;  // with which data are compared

    bool has_sums() const {
        return std::ranges::any_of(keys.panels, [](const SeriesPanel& panel) { return !panel.sums.empty(); });
    }
    const SeriesMotion& motion_with_data() const { return motions[measured_motion]; }
    // The rows of a curve, or its amplitudes by frequency; its values come last.
    sim::Table rows(const SeriesCurve& curve, const MotionResults& results) const;
    // The intervals in which curves are paler; a spectrum, which is of the whole interval, has none.
    std::vector<UnreliableInterval> unreliable(const sim::Result& result) const;
};

// Adds motions and panels to a plan.
void complete(SeriesPlan& plan, const Scene& scene, MotionRequests& requests);

// ---- the figure ---------------------------------------------------------------------------------------

// The look of each motion: one look for motions whose curves coincide in all panels.
std::vector<int> looks_of_motions(const SeriesPlan& plan, const MotionResults& results);

// A planned panel; with `keys.residuals` also a panel of the differences of the data.
std::vector<render::figure::Panel> series_panels(const SeriesPlan& plan, const PlannedPanel& planned,
                                                 const MotionResults& results, const std::vector<int>& looks);

// Vertical lines of the panel at instants, where x is time or grows with it. Throws PictureError for a note at an event
// that the motion does not have, or has outside of the interval.
std::vector<render::figure::Rule> series_rules(const SeriesPlan& plan, const PlannedPanel& panel,
                                               const MotionResults& results);

// Whether lines mark collisions because the impacts between these instants are too many to distinguish.
bool marks_collisions(const sim::Result& result, double from, double to);

// The sums or channels of a panel, and the title of a series with its x axis, as markup.
std::string panel_subject(const SeriesPanel& panel);
std::string series_title(const SeriesKeys& keys);

}  // namespace beamcam::scenes
