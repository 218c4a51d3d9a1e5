#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/film/film.hpp"
#include "tests/render/drawing.hpp"
#include "tests/render/films.hpp"
#include "tests/render/synthetic.hpp"

namespace beamcam::render {
namespace {

// Arrows are proportional to the force, in the mechanism and in the close-up.
TEST(ForceArrows, AreInProportionToTheForce) {
    for (const PanelKind kind : {PanelKind::mechanism, PanelKind::close_up}) {
        FilmSetup setup = test::flat_film({.duration = 0.1}, 1280, 1280);
        setup.impacts.clear();
        for (auto& column : setup.trace.values) column.clear();
        // The same pose with three forces: the first sets the scale, the arrows of the others are compared.
        sim::Pose pose = test::synthetic_pose(setup.problem, {}, 1.99);
        pose.nearest->touching = true, pose.nearest->gap = -1e-5, pose.nearest->friction = 0;
        setup.poses.clear();
        for (const double force : {200.0, 180.0, 90.0}) {
            pose.nearest->force = force;
            setup.poses.push_back(pose);
            pose.t += 0.01;
        }
        setup.layout = leaf({.kind = kind});
        setup.view.show = Show::clean;  // F is beyond the tip
        const Color contact = palette(setup.view.theme).contact;
        Film film(std::move(setup));
        const Box box = film.geometry(1).layout.first(kind)->box;
        // Length along which the arrow's colour is found.
        const auto length = [&](int frame) {
            const Image image = drawn(film, frame);
            const FrameGeometry g = film.geometry(frame);
            const bool close = kind == PanelKind::close_up;
            const Vec2 along = close ? Vec2{0, 1} : g.beam.contact->normal;
            const double u = g.layout.unit;
            const Vec2 foot = close ? Vec2{plot_area(box, u, g.layout.letters.words).centre().x, 0}
                                    : g.camera.to_pixels(g.beam.contact->on_disc);
            double top = -1e9, bottom = 1e9;
            for (int y = int(box.y + 46 * u); y < int(box.bottom()); ++y)
                for (int x = int(box.x); x < int(box.right()); ++x) {
                    const Vec2 off{x - foot.x, foot.y - y};
                    if (std::abs(cross(along, off)) > 10 * u) continue;
                    const std::uint32_t p = pixel_at(image, x, y);
                    if (difference(p, contact) < 0.02)
                        top = std::max(top, dot(along, off)), bottom = std::min(bottom, dot(along, off));
                }
            return top - bottom - (close ? 0 : 5) * u;  // the dot reaches below the arrow's foot
        };
        EXPECT_GT(length(2), 40) << type_of(kind).name;
        // Antialiasing hides about two pixels of the tip.
        EXPECT_NEAR(length(1) / length(2), 2, 0.12) << type_of(kind).name;
    }
}

}  // namespace
}  // namespace beamcam::render
