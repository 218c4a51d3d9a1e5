// The simulations that a series needs: its motions, and a table for each curve of each panel.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "scenes/figures/measured.hpp"
#include "scenes/figures/reproducible.hpp"
#include "scenes/figures/series_abscissa.hpp"
#include "scenes/figures/studies.hpp"

namespace beamcam::scenes {

struct SeriesMotion {
    std::string label;
    sim::Problem problem;
    std::size_t study = 0;
};

struct SeriesCurve {
    sim::Channel channel;
    std::size_t motion = 0, table = 0;  // the table: of the motion's study
    std::optional<SeriesSum> sum = {};  // instead of the channel
};

struct PlannedPanel {
    std::size_t number = 0;                // among the panels of the keys
    std::vector<std::size_t> motions;      // that it shows
    std::vector<SeriesCurve> left, right;  // by axis: of each channel, all these motions
};

struct SeriesPlan {
    SeriesKeys keys;
    Lang lang;
    double end = 0;  // [s]
    SeriesAbscissa abscissa;
    std::vector<SeriesMotion> motions = {};
    std::vector<PlannedPanel> panels = {};  // with `keys.apart` those of the first motion come first
    std::vector<Measured> measured = {};
    std::size_t measured_motion = 0;  // with which data are compared

    bool horizon = true;  // curves are paler where θ is not reproducible

    bool has_sums() const {
        return std::ranges::any_of(keys.panels, [](const SeriesPanel& panel) { return !panel.sums.empty(); });
    }
    const SeriesMotion& motion_with_data() const { return motions[measured_motion]; }
    // The rows of a curve, or its amplitudes by frequency; its values come last.
    sim::Table rows(const SeriesCurve& curve, const Results& results) const;
    // Where curves are lighter; nowhere in a spectrum, which is of the whole interval.
    std::vector<Lost> lost(const sim::Result& result) const;
};

// Adds motions and panels to a plan. `name`: of the figure, for messages.
void complete(SeriesPlan& plan, const Scene& scene, const char* name, Studies& studies);

}  // namespace beamcam::scenes
