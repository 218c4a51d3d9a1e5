#include "scenes/outputs/plan_motions.hpp"

#include <fmt/format.h>

#include <utility>

namespace beamcam::scenes {
namespace {

// The poses of a request go to disk as they are found.
StoredPoses store_poses(sim::Request& request, const PictureRequests& of) {
    sim::PoseRequest &all = request.poses[of.poses], &some = request.poses[of.survey];
    StoredPoses stored{std::make_shared<PoseSpool>(all), std::make_shared<PoseSpool>(some)};
    all.take = [to = stored.frames](std::size_t row, const sim::Pose& pose) { to->put(row, pose); };
    some.take = [to = stored.survey](std::size_t row, const sim::Pose& pose) { to->put(row, pose); };
    return stored;
}

}  // namespace

Results PlanResults::of_figure(std::size_t figure) const {
    Results all;
    for (const sim::Result& result : figures[figure]) all.studies.push_back(&result);
    return all;
}

void PlanMotions::request_all() {
    if (plan_.simulation) {
        std::vector<sim::Request> requests = requests_of(plan_);
        for (const Pictures& p : plan_.pictures)
            results_.poses.push_back(p.compared.empty() ? store_poses(requests.front(), p.of_scene) : StoredPoses{});
        own_ = motions_.request(plan_.simulation->problem, std::move(requests));
    }
    request_others();
}

void PlanMotions::request_others() {
    for (const FigureFile& f : plan_.figures)
        for (const Study& study : f.studies)
            if (!study.of_scene)
                others_.push_back(motions_.request(study.problem, {study.request}, f.file, study.may_fail));
    for (const Pictures& p : plan_.pictures) {
        std::vector<StoredPoses>& stored = results_.compared_poses.emplace_back();
        for (const ComparedMotion& each : p.compared) {
            sim::Request request = each.request;
            stored.push_back(store_poses(request, each.of_picture));
            others_.push_back(
                motions_.request(each.problem, {std::move(request)}, fmt::format("{}, {}", p.file, each.label)));
        }
    }
}

PlanResults PlanMotions::take_results() {
    return take_results(own_ ? motions_.take_results(*own_) : std::vector<sim::Result>());
}

PlanResults PlanMotions::take_results(std::vector<sim::Result> own) {
    auto next = own.begin();
    auto other = others_.begin();
    const auto take_other = [&] { return std::move(motions_.take_results(*other++).front()); };
    if (plan_.simulation) {
        results_.run = std::move(*next++);
        for (std::size_t i = 0; i < plan_.simulation->ends.size(); ++i) results_.ends.push_back(std::move(*next++));
    }
    for (const FigureFile& f : plan_.figures) {
        std::vector<sim::Result>& all = results_.figures.emplace_back();
        for (const Study& study : f.studies) all.push_back(study.of_scene ? std::move(*next++) : take_other());
    }
    for (const Pictures& p : plan_.pictures) {
        std::vector<sim::Result>& all = results_.compared.emplace_back();
        for (std::size_t i = 0; i < p.compared.size(); ++i) all.push_back(take_other());
    }
    return std::move(results_);
}

const sim::Result* PlanMotions::partial_results() const {
    return own_ && !motions_.partial_results(*own_).empty() ? &motions_.partial_results(*own_).front() : nullptr;
}

}  // namespace beamcam::scenes
