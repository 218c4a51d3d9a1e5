// The accuracy of a problem's results: error against run time of every method, and the error budget of time
// integration, number of shapes, beam model and contact parameters, each with its run time. MODEL.md §16.
//
// Errors are the largest differences of `compared_angle` (channels.hpp) [rad] at equally spaced instants until `until`.
// Run times are wall-clock times on one core.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

struct AccuracyRequest {
    double end_time = 0;     // [s], > 0
    double target = 1e-4;    // largest error of the recommended settings [rad], > 0
    int repeats = 5;         // of each timing, >= 1
    double longest_run = 2;  // slower simulations are left out [s]
    // Of the work–precision diagram.
    std::vector<double> rtols = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12};
    std::vector<Method> methods = {Method::automatic, Method::rk8, Method::cvode_adams, Method::cvode_bdf};
    std::vector<int> modes = {1, 2, 3, 4, 6, 8, 12, 16, 20};  // and the number of the problem itself
    // In descending order of accuracy.
    std::vector<ModelKind> models = {ModelKind::exact, ModelKind::second_order, ModelKind::first_order,
                                     ModelKind::paper, ModelKind::zeroth_order, ModelKind::rigid};
};

struct Timing {                            // [s]
    double median = 0, low = 0, high = 0;  // of all repeats
    int repeats = 0;
};

// A row of any of the tables. Without an `error` the run was rejected or left out for the reason in `note`.
struct AccuracyRow {
    std::optional<double> error;  // [rad], largest until `Accuracy::until`
    double trusted_until = 0;     // until here the error is within the target [s]
    Timing time;
    long steps = 0, rhs_evaluations = 0;
    long impacts = 0;
    std::optional<double> touch_error;  // largest error of an impact's t_start [s]; absent if their number differs
    std::string note;
};
struct WorkRow : AccuracyRow {
    Method method = Method::automatic;
    double rtol = 0;
};
struct ModesRow : AccuracyRow {  // error against the row of `Accuracy::most_modes`
    int modes = 0;
};
struct ModelRow : AccuracyRow {  // error against `Accuracy::best_model`
    ModelKind model = ModelKind::rigid;
};
struct ContactRow : AccuracyRow {  // sensitivity to a parameter of the contact law
    std::string change;            // "stiffness +1 %"
};

struct Recommendation {
    double rtol = 0;
    int modes = 0;
    double until = 0;    // [s]
    double seconds = 0;  // run time to there
    double error = 0;    // measured with both, at most the target [rad]
    std::string text;
};

struct Accuracy {
    bool of_tip = false;         // the hub angle is prescribed: errors are those of tip deflection over length
    double end_time = 0;         // requested [s]
    double until = 0;            // end of reproducibility; all errors refer to [0, until] [s]
    Method reference_method = Method::rk8;
    double reference_error = 0;  // estimated error of the reference [rad]
    double target = 0;
    int most_modes = 0;                       // number of shapes of the reference for `modes`
    double models_until = 0;                  // the models are compared over [0, models_until] [s]
    ModelKind best_model = ModelKind::exact;  // reference for `models`
    std::vector<WorkRow> work;
    std::vector<ModesRow> modes;
    std::vector<ModelRow> models;
    std::vector<ContactRow> contact;
    std::optional<Recommendation> recommendation;
};

// `progress` receives the completed fraction, 0…1; if it returns false, Interrupted is thrown. Throws the exceptions of
// `simulate` for the problem's own settings.
Accuracy assess(const Problem& problem, const AccuracyRequest& request,
                const std::function<bool(double share)>& progress = {});

}  // namespace beamcam::sim
