#include "render/film/camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beamcam::render {
namespace {

constexpr double kMean = 1.0 / 3;  // duration over which positions are averaged [s of the film]

double eased(Ease ease, double x) {
    switch (ease) {
        case Ease::smooth:
            return x * x * (3 - 2 * x);
        case Ease::linear:
            return x;
        case Ease::in:
            return x * x;
        case Ease::out:
            return x * (2 - x);
    }
    return x;
}

// Hann window of `half` frames to either side, shorter at the ends of the film.
std::vector<Followed> averaged(const std::vector<Followed>& all, int half) {
    std::vector<Followed> out;
    const auto count = static_cast<int>(all.size());
    for (int k = 0; k < count; ++k) {
        Followed sum;
        double weights = 0;
        const int reach = std::min({half, k, count - 1 - k});  // symmetric, so that uniform motion is not delayed
        for (int i = -reach; i <= reach; ++i) {
            const double weight = 1 + std::cos(std::numbers::pi * i / (reach + 1));
            const Followed& one = all[static_cast<std::size_t>(k + i)];
            sum = {sum.tip + one.tip * weight, sum.contact + one.contact * weight, sum.cam + one.cam * weight};
            weights += weight;
        }
        out.push_back({sum.tip * (1 / weights), sum.contact * (1 / weights), sum.cam * (1 / weights)});
    }
    return out;
}

Vec2 place_of(const Shot& shot, const Followed& parts, Vec2 middle) {
    const Anchor& anchor = shot.follow;
    switch (anchor.kind) {
        case Anchor::Kind::all:
            return middle;
        case Anchor::Kind::tip:
            return parts.tip * (1 - 0.25 / std::max(1.0, shot.zoom));  // there would be nothing beyond it
        case Anchor::Kind::contact:
            return parts.contact;
        case Anchor::Kind::cam:
            return parts.cam;
        case Anchor::Kind::hub:
            return {0, 0};
        case Anchor::Kind::place:
            break;
    }
    return anchor.place;
}

// A shot evaluated at one frame.
struct Seen {
    double zoom, yaw, pitch;
    Vec2 middle;  // [m]
};

Seen between(const Seen& a, const Seen& b, double share) {
    const double zoom = a.zoom * std::pow(b.zoom / a.zoom, share);
    // The centre moves in proportion to the visible width; linearly if the width is constant.
    const double widths = 1 / b.zoom - 1 / a.zoom;
    const double way = std::abs(widths) * a.zoom < 1e-6 ? share : (1 / zoom - 1 / a.zoom) / widths;
    return {zoom, a.yaw + (b.yaw - a.yaw) * share, a.pitch + (b.pitch - a.pitch) * share,
            a.middle + (b.middle - a.middle) * way};
}

}  // namespace

std::vector<CameraFrame> camera_frames(const Shot& first, const std::vector<CameraMove>& moves, const Camera& whole,
                                       const Box& box, const std::vector<Followed>& followed, double fps) {
    const std::vector<Followed> mean = averaged(followed, static_cast<int>(kMean / 2 * fps));
    const Vec2 middle = whole.to_world(box.centre());
    std::vector<CameraFrame> out;
    for (std::size_t k = 0; k < mean.size(); ++k) {
        const auto seen = [&](const Shot& shot) -> Seen {
            return {shot.zoom, shot.yaw, shot.pitch, place_of(shot, mean[k], middle)};
        };
        const auto frame = static_cast<double>(k);
        Seen now = seen(first);
        double arrived = -std::numeric_limits<double>::infinity();
        for (const CameraMove& move : moves) {
            const double begins = std::max(move.arrives - move.lasts, arrived);
            if (frame <= begins && frame < move.arrives) break;
            arrived = move.arrives;
            const double share = frame >= move.arrives ? 1 : (frame - begins) / (move.arrives - begins);
            now = share < 1 ? between(now, seen(move.shot), eased(move.ease, share)) : seen(move.shot);
            if (share < 1) break;
        }
        Camera camera = whole;
        if (now.zoom != 1 || !(now.middle == middle)) {
            camera.scale *= now.zoom;
            camera.origin = box.centre() - Vec2{camera.scale * now.middle.x, -camera.scale * now.middle.y};
        }
        out.push_back({camera, now.zoom, now.yaw, now.pitch});
    }
    return out;
}

}  // namespace beamcam::render
