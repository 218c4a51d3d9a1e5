#include "tests/render/synthetic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace beamcam::test {
namespace {

using sim::Vec2;
using std::numbers::pi;

// The hinged–free shape is close to a parabola less its rigid part; unit tip value.
double shape(double s) { return (s * s - 0.75 * s) / 0.25 * 0.8 + 0.2 * std::sin(2 * pi * s); }

// End of the bounces of a falling body: flights of duration T, 0.6 T, 0.36 T, …
struct Flight {
    double start, length, height;
};
Flight flight_at(double t) {
    double start = -0.3, length = 0.6, height = 0.46;
    while (t >= start + length && length > 0.02) start += length, length *= 0.72, height *= 0.5;
    return {start, length, length > 0.02 ? height : 0};
}

struct Contact {
    double theta, x;
};
Contact resting(const sim::Problem& problem, Vec2 disc) {
    const double d = norm(disc),
                 r = problem.cam->radius + problem.contact.offset.value_or(beam_depth(problem.beam) / 2);
    return {std::atan2(disc.y, disc.x) + std::asin(r / d), std::sqrt(d * d - r * r)};
}

}  // namespace

sim::Pose synthetic_pose(const sim::Problem& problem, const Synthetic& how, double t) {
    sim::Pose pose;
    const double l = problem.beam.length;
    pose.t = t;
    const Flight flight = flight_at(t);
    const double phase = (t - flight.start) / flight.length;
    const double lift = std::max(0.0, 4 * flight.height * phase * (1 - phase));
    const double since = t < 0.3 ? 0 : t - 0.3,
                 a = how.amplitude * l * std::exp(-0.8 * since) * std::sin(2 * pi * 6.5 * since);
    double rest = 0;
    if (problem.cam) {
        pose.cam_centre = problem.cam->centre;
        pose.cam_angle = problem.cam->phase - problem.cam->speed * t;
        pose.disc_centre = pose.cam_centre + sim::unit(pose.cam_angle) * problem.cam->eccentricity;
        pose.disc_radius = problem.cam->radius;
        rest = resting(problem, pose.disc_centre).theta;
    }
    const double straight = rest + lift;
    constexpr int n = 97;
    const auto bend = [&](double turn) {
        pose.centreline.clear();
        for (int i = 0; i < n; ++i) {
            const double s = double(i) / (n - 1);
            const Vec2 u = sim::unit(straight + turn);
            pose.centreline.push_back(u * (s * l) + sim::perp(u) * (a * shape(s)));
        }
    };
    bend(0);
    if (problem.cam) {
        const double reach = problem.cam->radius + problem.contact.offset.value_or(beam_depth(problem.beam) / 2);
        sim::Nearest nearest;
        // Rotated until the gap is that of the straight rod, by secant steps.
        double turn = 0;
        for (int pass = 0; pass < 12; ++pass) {
            bend(turn);
            double best = std::numeric_limits<double>::infinity();
            for (int i = 0; i + 1 < n; ++i) {
                const Vec2 p = pose.centreline[std::size_t(i)], q = pose.centreline[std::size_t(i) + 1] - p;
                const double s = std::clamp(dot(pose.disc_centre - p, q) / dot(q, q), 0.0, 1.0);
                const Vec2 foot = p + q * s;
                const double d = norm(foot - pose.disc_centre);
                if (d < best)
                    best = d, nearest.x = (i + s) / (n - 1) * l, nearest.normal = (foot - pose.disc_centre) * (1 / d);
            }
            nearest.gap = best - reach;
            const double wanted =
                norm(pose.disc_centre) * std::sin(straight - std::atan2(pose.disc_centre.y, pose.disc_centre.x)) -
                reach;
            if (lift > 0.3) break;
            turn += (wanted - nearest.gap) / std::max(nearest.x, 0.05 * l);
        }
        nearest.point = pose.disc_centre + nearest.normal * problem.cam->radius;
        nearest.touching = lift < 0.004;
        if (nearest.touching) nearest.force = 6 + 240 * flight.height * (1 - lift / 0.004) * std::abs(std::sin(90 * t));
        const double s = std::atan2(nearest.normal.y, nearest.normal.x) - pose.cam_angle;
        nearest.s = problem.cam->radius * (s - 2 * pi * std::floor(s / (2 * pi)));
        pose.nearest = nearest;
        bend(turn);
    }
    const Vec2 first = pose.centreline[1] - pose.centreline[0];
    pose.theta = std::atan2(first.y, first.x);
    for (int i = 0; i < n; ++i) {
        const double s = double(i) / (n - 1);
        const double hold = pose.nearest && pose.nearest->force > 0
                                ? -0.1 * pose.nearest->force * std::max(0.0, s < 0.23 ? s : 0.3 * (1 - s))
                                : 0;
        pose.moment.push_back(problem.beam.bending_stiffness() / (l * l) * a * 9 * std::pow(std::sin(pi * s), 2) +
                              hold);
    }
    return pose;
}

render::FilmSetup synthetic_film(const Synthetic& how) {
    render::FilmSetup film;
    sim::Problem& p = film.problem;
    p.beam.length *= how.size, p.beam.depth = beam_depth(p.beam) * how.size;
    p.beam.area *= how.size * how.size, p.beam.second_moment *= std::pow(how.size, 4);
    p.cam->centre = p.cam->centre * how.size, p.cam->radius *= how.size, p.cam->eccentricity *= how.size;
    p.cam->speed = how.speed;
    if (!how.cam) p.cam.reset();
    if (how.half_depth) p.contact.offset.reset();
    film.title = "Flexible beam on a rotating eccentric cam";
    film.warning = "energy ledger closed to 3·10⁻¹⁰";
    const int frames = int(std::lround(how.duration * how.fps));
    for (int k = 0; k < frames; ++k) film.poses.push_back(synthetic_pose(p, how, k / how.fps));

    using K = sim::ChannelKind;
    film.chart.channels = {{K::t, 0}, {K::theta, 0}, {K::contact_force, 0}};
    film.trace.channels = {{K::t, 0}, {K::contact_x, 0}, {K::contact_s, 0}, {K::contact_force, 0}};
    film.chart.values.resize(3);
    film.trace.values.resize(4);
    bool touching = false;
    for (int i = 0; i <= 1000 * how.duration; ++i) {
        const double t = i / 1000.0;
        const sim::Pose q = synthetic_pose(p, how, t);
        film.chart.values[0].push_back(t);
        film.chart.values[1].push_back(q.theta);
        film.chart.values[2].push_back(q.nearest ? q.nearest->force : std::numeric_limits<double>::quiet_NaN());
        if (!q.nearest) continue;
        film.trace.values[0].push_back(t);
        film.trace.values[1].push_back(q.nearest->x);
        film.trace.values[2].push_back(q.nearest->s);
        film.trace.values[3].push_back(q.nearest->force);
        if (q.nearest->touching && !touching) {
            sim::Impact impact;
            impact.t_start = t, impact.t_end = t + 0.001, impact.x = q.nearest->x, impact.cam_angle = q.cam_angle;
            impact.force_peak = 20 + 500 * flight_at(t).height;
            film.impacts.push_back(impact);
        }
        touching = q.nearest->touching;
    }
    return film;
}

render::FilmSetup flat_film(const Synthetic& how, int width, int height) {
    render::FilmSetup film = synthetic_film(how);
    film.width = width, film.height = height;
    film.view.style = render::Style::flat;
    return film;
}

render::FilmSetup led_rod(double from, double rate, double duration) {
    render::FilmSetup film = flat_film({.duration = duration}, 1280, 720);
    for (sim::Pose& pose : film.poses) {
        pose.theta = from + rate * pose.t;
        const double last = double(pose.centreline.size() - 1);
        for (std::size_t i = 0; i < pose.centreline.size(); ++i)
            pose.centreline[i] = sim::unit(pose.theta) * (film.problem.beam.length * double(i) / last);
        pose.nearest.reset();
    }
    return film;
}

}  // namespace beamcam::test
