// Figures drawn from simulations of their motions.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scenes/figures/figure_types.hpp"
#include "scenes/format/reader.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes::testing {

inline render::figure::Figure simulated(const Scene& scene, const FigureOutput& how) {
    MotionRequests requests;
    const FigureMaker make = figure_type(how.figure)->prepare(scene, how, requests);
    std::vector<sim::Result> made;
    for (const MotionRequest& motion : requests.take()) made.push_back(sim::simulate(motion.problem, motion.request));
    MotionResults results;
    for (const sim::Result& result : made) results.motions.push_back(&result);
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

// A figure or a preset by its name.
inline render::figure::Figure figure_of(const Scene& s, const char* name, Lang lang = Lang::en) {
    const Node output = object_node({{"type", "figure"}, {"figure", name}, {"lang", lang == Lang::en ? "en" : "zh"}});
    Scene scene = s;
    std::vector<Message> messages;
    if (!read_only_output(output, "s.json", "", scene, messages)) throw std::runtime_error(messages.front().text);
    return simulated(scene, std::get<FigureOutput>(scene.outputs.front()));
}

}  // namespace beamcam::scenes::testing
