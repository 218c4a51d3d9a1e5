// The model is taken apart as glTF's standard says, and compared with the motion.
#include "render/film/model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "render/mechanism/exaggeration.hpp"
#include "tests/scenes/outputs/filmed.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

render::FilmSetup moving_until(double end, double rate) {
    render::FilmSetup setup = testing::filmed_until(end, rate);
    setup.view.exaggeration = 100;
    setup.title = "a \"b\" $\\omega$";
    return setup;
}

struct Parts {
    nlohmann::json json;
    std::string binary;

    explicit Parts(const std::string& file) {
        const auto word = [&](std::size_t at) {
            std::uint32_t value = 0;
            std::memcpy(&value, file.data() + at, 4);
            return value;
        };
        EXPECT_EQ(file.substr(0, 4), "glTF");
        EXPECT_EQ(word(4), 2U);
        EXPECT_EQ(word(8), file.size());
        EXPECT_EQ(word(12) % 4, 0U);
        json = nlohmann::json::parse(file.substr(20, word(12)));
        const std::size_t second = 20 + word(12);
        EXPECT_EQ(file.substr(second + 4, 4), std::string("BIN\0", 4));
        binary = file.substr(second + 8);
        EXPECT_EQ(word(second), binary.size());
    }
    std::vector<float> floats(std::size_t accessor) const {
        const auto& a = json["accessors"][accessor];
        const auto& view = json["bufferViews"][a["bufferView"].get<std::size_t>()];
        std::vector<float> out(view["byteLength"].get<std::size_t>() / 4);
        std::memcpy(out.data(), binary.data() + view["byteOffset"].get<std::size_t>(), 4 * out.size());
        return out;
    }
    std::vector<float> track(const std::string& node, const std::string& path, bool keys = false) const {
        const auto& animation = json["animations"][0];
        for (const auto& channel : animation["channels"])
            if (json["nodes"][channel["target"]["node"].get<std::size_t>()]["name"] == node &&
                channel["target"]["path"] == path)
                return floats(animation["samplers"][channel["sampler"].get<std::size_t>()][keys ? "input" : "output"]);
        ADD_FAILURE() << node << " has no track of its " << path;
        return {};
    }
};

TEST(Model, ItsJointsAreWhereTheFilmDrawsTheBeam) {
    const render::FilmSetup setup = moving_until(0.5, 60);
    const Parts model(render::glb_model(setup));
    const double factor = model.json["asset"]["extras"]["deflection"];
    EXPECT_EQ(model.json["asset"]["extras"]["title"], "a \"b\" ω");
    for (const std::size_t joint : {std::size_t{0}, std::size_t{12}, std::size_t{24}}) {
        const auto places = model.track("beam " + std::to_string(joint), "translation"),
                   turns = model.track("beam " + std::to_string(joint), "rotation");
        ASSERT_EQ(places.size(), 3 * setup.poses.size());
        for (std::size_t k = 0; k < setup.poses.size(); ++k) {
            const render::DrawnBeam beam =
                render::drawn_beam(setup.problem, setup.poses[k], factor, beam_depth(setup.problem.beam));
            const std::size_t at = joint * (beam.line.size() - 1) / 24;
            EXPECT_NEAR(places[3 * k], beam.line[at].x, 1e-6);
            EXPECT_NEAR(places[3 * k + 1], beam.line[at].y, 1e-6);
            const double half = std::atan2(turns[4 * k + 2], turns[4 * k + 3]);  // left is the tangent turned by 90°
            EXPECT_NEAR(-std::sin(2 * half), beam.left[at].x, 1e-5);
            EXPECT_NEAR(std::cos(2 * half), beam.left[at].y, 1e-5);
        }
    }
}

TEST(Model, HubAndCamTurnAsInTheMotionAndNeverTheLongWayRound) {
    render::FilmSetup setup = moving_until(0.5, 60);
    setup.problem.cam->speed = 50;
    for (sim::Pose& pose : setup.poses) pose.cam_angle = -50 * pose.t;
    const Parts model(render::glb_model(setup));
    const auto keys = model.track("cam", "rotation", true), turns = model.track("cam", "rotation");
    for (std::size_t k = 0; k < keys.size(); ++k) {
        EXPECT_NEAR(turns[4 * k + 2], std::sin(-25 * keys[k]), 1e-5);
        EXPECT_NEAR(turns[4 * k + 3], std::cos(-25 * keys[k]), 1e-5);
        if (k > 0) {
            EXPECT_LT(50 * (keys[k] - keys[k - 1]), 3.1);
        }
    }
    const auto hub = model.track("hub", "rotation");
    EXPECT_NEAR(2 * std::atan2(hub[2], hub[3]), setup.poses[0].theta, 1e-6);
}

TEST(Model, HasTheSameBytesAndNoCamWithoutOne) {
    render::FilmSetup setup = moving_until(0.1, 30);
    EXPECT_EQ(render::glb_model(setup), render::glb_model(setup));
    setup.problem.cam.reset();
    for (sim::Pose& pose : setup.poses) pose.nearest.reset();
    const Parts model(render::glb_model(setup));
    for (const auto& node : model.json["nodes"]) EXPECT_NE(node["name"], "cam");
}

}  // namespace
}  // namespace beamcam::scenes
