#include "scenes/outputs/plan_motions.hpp"

#include <fmt/format.h>

#include <utility>

namespace beamcam::scenes {
namespace {

// The poses of a request go to disk as they are found.
StoredPoses store_poses(sim::Request& request) {
    const auto store = [&](std::size_t which) {
        sim::PoseRequest& poses = request.poses[which];
        const auto to = std::make_shared<PoseSpool>(poses);
        poses.take = [to](std::size_t row, const sim::Pose& pose) { to->put(row, pose); };
        return to;
    };
    return {store(kFramePoses), store(kSurveyPoses), store(kPathPoses)};
}

}  // namespace

Results PlanResults::of_figure(std::size_t figure) const {
    Results all;
    for (const sim::Result& result : figures[figure]) all.studies.push_back(&result);
    return all;
}

void PlanMotions::request_all() {
    if (plan_.simulation) {
        std::vector<sim::Request> own = requests_of(plan_);
        auto next = own.begin() + 1;
        for (const Pictures& p : plan_.pictures) {
            std::vector<StoredPoses>& stored = results_.poses.emplace_back(p.shown.size());
            if (p.shown.front().of_scene) stored.front() = store_poses(*next++);
        }
        own_ = motions_.request(plan_.simulation->problem, std::move(own));
    }
    request_others();
}

void PlanMotions::request_others() {
    results_.poses.resize(plan_.pictures.size());
    for (std::size_t k = 0; k < plan_.pictures.size(); ++k) {
        const Pictures& p = plan_.pictures[k];
        results_.poses[k].resize(p.shown.size());
        for (std::size_t i = 0; i < p.shown.size(); ++i) {
            const Study& motion = p.shown[i];
            if (motion.of_scene) continue;
            sim::Request request = motion.request;
            results_.poses[k][i] = store_poses(request);
            others_.push_back(
                motions_.request(motion.problem, {std::move(request)}, fmt::format("{}, {}", p.file, motion.label)));
        }
    }
    for (const FigureFile& f : plan_.figures)
        for (const Study& study : f.studies)
            if (!study.of_scene)
                others_.push_back(motions_.request(study.problem, {study.request}, f.file));
}

PlanResults PlanMotions::take_results() {
    return take_results(own_ ? motions_.take_results(*own_) : std::vector<sim::Result>());
}

PlanResults PlanMotions::take_results(std::vector<sim::Result> own) {
    auto next = own.begin();
    auto other = others_.begin();
    if (plan_.simulation) results_.run = std::move(*next++);
    const auto taken = [&](const std::vector<Study>& studies) {
        std::vector<sim::Result> all;
        for (const Study& study : studies)
            all.push_back(std::move(study.of_scene ? *next++ : motions_.take_results(*other++).front()));
        return all;
    };
    for (const Pictures& p : plan_.pictures) results_.shown.push_back(taken(p.shown));
    for (const FigureFile& f : plan_.figures) results_.figures.push_back(taken(f.studies));
    return std::move(results_);
}

const sim::Result* PlanMotions::partial_results() const {
    return own_ && !motions_.partial_results(*own_).empty() ? &motions_.partial_results(*own_).front() : nullptr;
}

}  // namespace beamcam::scenes
