#include "sim/studies/accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/counted.hpp"
#include "sim/run/horizon.hpp"
#include "sim/run/simulate.hpp"
#include "sim/studies/trials.hpp"

namespace beamcam::sim {
namespace {

constexpr double kReferenceRtol = 1e-13;    // the tightest tolerance
constexpr double kCheckRtol = 1e-12;        // of the run that estimates the error of the reference
constexpr double kReferenceRuns = 50;       // time limit of the reference and of contact variants, in longest runs
constexpr double kIndependentRuns = 5;      // the same of a reference by another method than the scene's
constexpr double kModesRuns = 5;            // the same of each number of shapes
constexpr double kModelRuns = 10;           // the same of each model
constexpr double kShortestPart = 1.0 / 16;  // of the motion: least part over which models are compared
constexpr int kModelShapes = 20;            // least number of shapes in the comparison of models
constexpr int kPaperShapes = 6;             // the same of `paper`, which loses its positive inertia with more
constexpr double kAsFar = 0.98;             // of the longest time within the target: as good

class Assessment {
  public:
    Assessment(const Problem& problem, const AccuracyRequest& request, const Trials::Report& report)
        : problem_(problem), request_(request), trials_(problem, request.target, report) {
        out_.of_tip = trials_.of_tip();
        out_.end_time = request.end_time;
        out_.target = request.target;
    }

    Accuracy assess() {
        compute_reference();
        compare_methods();
        if (problem_.beam.model != ModelKind::rigid) {
            compare_modes();
            compare_models();
        }
        if (problem_.cam) compare_contacts();
        recommend();
        return std::move(out_);
    }

  private:
    Problem with(double rtol, Method method = Method::automatic) const {
        Problem variant = problem_;
        variant.solver.method = method;
        // The ratio of the tolerances is kept.
        variant.solver.atol = problem_.solver.atol * (rtol / problem_.solver.rtol);
        variant.solver.rtol = rtol;
        return variant;
    }

    // ---- the tables ------------------------------------------------------------------------------

    // All comparisons end where the scene's own settings no longer reproduce the motion. The reference up to there is
    // rk8 at the tightest tolerance, or the automatic method if that takes too long; its own error is estimated by a
    // tenfold tolerance.
    void compute_reference() {
        trials_.begin(0, 0.1);
        const TrialRun mine = simulate_reference(problem_, request_.end_time);
        const TrialRun truth = simulate_reference(with(kReferenceRtol), request_.end_time);
        double until = request_.end_time;
        for (std::size_t k = 0; k < truth.angle.size(); ++k) {
            if (std::fabs(mine.angle[k] - truth.angle[k]) <= kReproducible * std::max(1.0, std::fabs(truth.angle[k])))
                continue;
            until = request_.end_time * static_cast<double>(k > 1 ? k - 1 : 1) / kInstants;
            break;
        }
        out_.until = until;
        std::optional<TrialRun> independent = trials_.simulate_until(with(kReferenceRtol, Method::rk8), until,
                                                                     kIndependentRuns * request_.longest_run, true);
        if (!independent) out_.reference_method = Method::automatic;
        reference_ = independent ? std::move(*independent) : simulate_reference(with(kReferenceRtol), until);
        const TrialRun check = simulate_reference(with(kCheckRtol, out_.reference_method), until);
        for (std::size_t k = 0; k < check.angle.size(); ++k)
            out_.reference_error = std::max(out_.reference_error, std::fabs(check.angle[k] - reference_.angle[k]));
        // Rounding of the angle itself.
        double size = 1;
        for (const double angle : reference_.angle) size = std::max(size, std::fabs(angle));
        out_.reference_error = std::max(out_.reference_error, std::numeric_limits<double>::epsilon() * size);
    }

    TrialRun simulate_reference(const Problem& problem, double end) {
        const double limit = kReferenceRuns * request_.longest_run;
        if (auto run = trials_.simulate_until(problem, end, limit, true)) return std::move(*run);
        throw SolverError(
            fmt::format("the reference (rtol {:g}) of {:g} s of motion takes longer than {:g} s; give an earlier end "
                        "with --until, or more time with --longest",
                        problem.solver.rtol, end, limit),
            0, {});
    }

    void compare_methods() {
        const double all = static_cast<double>(request_.methods.size() * request_.rtols.size());
        for (const Method method : request_.methods)
            for (const double rtol : request_.rtols) {
                trials_.begin(0.1 + 0.5 * static_cast<double>(out_.work.size()) / all, 0.5 / all);
                WorkRow& row = out_.work.emplace_back();
                row.method = method;
                row.rtol = rtol;
                trials_.measure(row, with(rtol, method), reference_, out_.until, request_.longest_run,
                                request_.repeats);
                if (!row.note.starts_with(kLeftOut)) continue;
                row.note += ", as tighter tolerances would be";
                break;
            }
    }

    // Rows are in descending order of accuracy. Compares the variant of each with the first one that runs, which is
    // returned, and its run in `truth`; over [0, until], or if that is affordable only for a part, over the longest
    // one, at least `shortest`.
    template <class Row, class VariantOf>
    const Row* compare_with_first(std::vector<Row>& rows, const VariantOf& variant_of, double share, double runs,
                                  double shortest, double& until, TrialRun& truth) {
        const double limit = runs * request_.longest_run;
        const Row* first = nullptr;
        for (Row& row : rows) {
            const double more = 0.15 / static_cast<double>(rows.size());
            trials_.begin(share, more);
            share += more;
            const Problem variant = variant_of(row);
            bool affordable = first != nullptr;
            for (double part = 1; !first && !affordable && part >= shortest; part /= 2) {
                row.note.clear();
                if (auto run = trials_.try_until(variant, part * out_.until, limit, row.note)) {
                    truth = std::move(*run);
                    until = part * out_.until;
                    first = &row;
                }
                affordable = !row.note.starts_with(kLeftOut);
            }
            // Timings of the expensive models are not repeated.
            const int repeats = variant.beam.model >= ModelKind::second_order ? 1 : request_.repeats;
            if (first && row.note.empty()) trials_.measure(row, variant, truth, until, limit, repeats);
        }
        return first;
    }

    // At the scene's tolerance, whose error is far below the effect of one shape.
    void compare_modes() {
        std::vector<int> ladder = request_.modes;
        if (std::ranges::find(ladder, problem_.beam.modes) == ladder.end()) ladder.push_back(problem_.beam.modes);
        std::ranges::sort(ladder, std::greater<>());
        for (const int modes : ladder) out_.modes.emplace_back().modes = modes;
        const auto variant_of = [&](const ModesRow& row) {
            Problem variant = problem_;
            set_shapes(variant, variant.beam.model, variant.beam.basis, row.modes);
            return variant;
        };
        double until = 0;
        if (const ModesRow* first = compare_with_first(out_.modes, variant_of, 0.6, kModesRuns, 1, until, most_modes_))
            out_.most_modes = first->modes;
        std::ranges::reverse(out_.modes);
    }

    // All models with so many shapes that their different bases do not matter (`paper` with those that it bears),
    // against the most accurate one that the time allows; over a shorter motion if `exact` is affordable only for that.
    void compare_models() {
        for (const ModelKind model : request_.models) out_.models.emplace_back().model = model;
        const auto variant_of = [&](const ModelRow& row) {
            Problem variant = problem_;
            const int least = row.model == ModelKind::paper ? kPaperShapes : kModelShapes;
            set_shapes(variant, row.model, variant.beam.basis, std::max(problem_.beam.modes, least));
            if (row.model == ModelKind::exact || row.model == ModelKind::second_order)
                variant.solver.rtol = std::max(variant.solver.rtol, std::min(1e-8, 1e-3 * request_.target));
            return variant;
        };
        out_.models_until = out_.until;
        TrialRun best;
        if (const ModelRow* first =
                compare_with_first(out_.models, variant_of, 0.75, kModelRuns, kShortestPart, out_.models_until, best))
            out_.best_model = first->model;
        std::ranges::reverse(out_.models);
    }

    void compare_contacts() {
        const double limit = kReferenceRuns * request_.longest_run;
        const TrialRun truth = simulate_reference(problem_, out_.until);
        const auto add = [&](std::string change, const Problem& variant) {
            trials_.begin(0.92 + 0.015 * static_cast<double>(out_.contact.size()), 0.015);
            ContactRow& row = out_.contact.emplace_back();
            row.change = std::move(change);
            trials_.measure(row, variant, truth, out_.until, limit, 1);
        };
        Problem variant = problem_;
        if (problem_.contact.model == ContactModel::compliant) {
            variant.contact.stiffness_factor = 1.01;
            add("stiffness +1 %", variant);
            variant = problem_;
        }
        const double c = problem_.contact.restitution;
        variant.contact.restitution = c <= 0.99 ? c + 0.01 : c - 0.01;
        add(c <= 0.99 ? "restitution +0.01" : "restitution −0.01", variant);
        if (problem_.contact.model == ContactModel::compliant &&
            problem_.contact.approach_floor.policy == ApproachFloorPolicy::value) {
            variant = problem_;
            variant.contact.approach_floor.value *= 2;
            add("approach floor × 2", variant);
        }
    }

    // ---- the recommendation ----------------------------------------------------------------------

    // The smallest number of shapes that stays within the target for as long (within 2 %) as any number does, and the
    // loosest tolerance of `auto` whose error is at most half the target and with which these shapes do the same.
    void recommend() {
        Recommendation r;
        r.modes = problem_.beam.modes;
        r.until = out_.until;
        double farthest = out_.until;
        if (!out_.modes.empty()) {
            farthest = 0;
            const ModesRow* last = nullptr;
            for (const ModesRow& row : out_.modes)
                if (row.error) last = &row;
            for (const ModesRow& row : out_.modes)
                if (row.error && &row != last) farthest = std::max(farthest, row.trusted_until);
            for (const ModesRow& row : out_.modes) {
                if (!row.error || row.trusted_until < kAsFar * farthest) continue;
                r.modes = row.modes;
                r.until = std::min(r.until, row.trusted_until);
                break;
            }
        }
        trials_.begin(0.97, 0.03);
        for (const WorkRow& row : out_.work) {
            if (row.method != Method::automatic || !row.error || *row.error > request_.target / 2) continue;
            r.rtol = row.rtol;
            if (measure_combination(r)) break;
        }
        if (r.seconds == 0) return;
        const std::string shapes = problem_.beam.model == ModelKind::rigid ? "" : " and " + counted(r.modes, "mode");
        const std::string within = fmt::format("{} to {:g} rad", out_.of_tip ? "the tip's δ/L" : "θ", request_.target);
        if (r.until < out_.until && farthest < out_.until)
            r.text = fmt::format("no number of modes that was tried gives {} until {:.4g} s; ", within, out_.until);
        r.text += fmt::format("rtol {:.0e}{} give {} for the first {:.3g} s in {:.2g} ms", r.rtol, shapes, within,
                              r.until, 1e3 * r.seconds);
        out_.recommendation = std::move(r);
    }

    // Tolerance and shapes were tried one by one. False if both together fail, or leave the target earlier.
    bool measure_combination(Recommendation& r) {
        Problem chosen = with(r.rtol);
        set_shapes(chosen, chosen.beam.model, chosen.beam.basis, r.modes);
        const TrialRun& truth = out_.most_modes > 0 ? most_modes_ : reference_;
        const double limit = kReferenceRuns * request_.longest_run;
        AccuracyRow row;
        trials_.measure(row, chosen, truth, out_.until, limit, 1);
        if (!row.error || row.trusted_until < kAsFar * r.until || row.trusted_until <= 0) return false;
        const double until = std::min(r.until, row.trusted_until);
        const auto timing = trials_.time(chosen, until, limit, request_.repeats, limit * request_.repeats);
        if (!timing) return false;
        r.until = until;
        r.error = std::min(*row.error, request_.target);
        r.seconds = timing->median;
        return true;
    }

    const Problem& problem_;
    const AccuracyRequest& request_;
    Trials trials_;
    Accuracy out_;
    TrialRun reference_, most_modes_;  // the latter: with the number of modes `Accuracy::most_modes`
};

}  // namespace

Accuracy assess(const Problem& problem, const AccuracyRequest& request,
                const std::function<bool(double share)>& progress) {
    return Assessment(problem, request, progress).assess();
}

}  // namespace beamcam::sim
