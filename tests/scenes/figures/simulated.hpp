// Figures drawn from simulations of their motions.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scenes/figures/figure_types.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes::testing {

inline render::figure::Figure simulated(const Scene& scene, const FigureOutput& how) {
    Studies studies;
    const FigureMaker make = figure_type(how.figure)->prepare(scene, how, studies);
    std::vector<sim::Result> made;
    for (const Study& study : studies.take()) {
        try {
            made.push_back(sim::simulate(study.problem, study.request));
        } catch (const sim::SolverError& error) {
            if (!study.may_fail) throw;
            made.push_back(error.partials.at(0));
        }
    }
    Results results;
    for (const sim::Result& result : made) results.studies.push_back(&result);
    return make(results);
}

// The figure of the first output of a scene.
inline render::figure::Figure simulated(const std::string& text) {
    const Reading reading = read(text);
    if (!reading.scene) throw std::runtime_error(reading.report());
    return simulated(*reading.scene, std::get<FigureOutput>(reading.scene->outputs.front()));
}

inline Scene scene_from(const std::string& text) {
    Reading reading = read(text);
    EXPECT_TRUE(reading.scene) << reading.report();
    return *reading.scene;
}

inline FigureOutput in(Lang lang) {
    FigureOutput how;
    how.lang = lang;
    return how;
}

inline render::figure::Figure figure_of(const Scene& s, const char* name, Lang lang = Lang::en) {
    FigureOutput how = in(lang);
    how.figure = name;
    return simulated(s, how);
}

}  // namespace beamcam::scenes::testing
