// What the numbers of a problem are worth: error against run time of every method, and the error budget — time
// integration, number of shapes, model of the beam, contact — each with its run time. MODEL.md, "Accuracy".
//
// Errors are of `compared_angle` (channels.hpp) [rad], the largest over equally spaced instants until `until`. Times
// are of one core, wall clock.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::sim {

struct AccuracyRequest {
    double end_time = 0;            // [s], > 0
    double target = 1e-4;           // the error that the recommendation is for [rad], > 0
    int repeats = 5;                // of each timing, >= 1
    double longest_run = 2;         // a single simulation that takes longer is left out [s]
    std::vector<double> rtols;      // of the work–precision diagram; empty: 1e-3 … 1e-12
    std::vector<Method> methods;    // empty: all
    std::vector<int> modes;         // empty: a ladder up to 20
    std::vector<ModelKind> models;  // from the highest down; empty: all
};

struct Timing {                            // [s]
    double median = 0, low = 0, high = 0;  // of all repeats
    int repeats = 0;
};

// A row of any of the tables. `error` is nothing where the run was refused or left out: `note` says why.
struct AccuracyRow {
    std::optional<double> error;  // [rad], largest until `Accuracy::until`
    double trusted_until = 0;     // first instant at which the error exceeds the target, else `until` [s]
    Timing time;
    long steps = 0, rhs_evaluations = 0;
    long impacts = 0;
    std::optional<double> touch_error;  // largest shift of an impact's t_start [s]; nothing where their number differs
    std::string note;
};
struct WorkRow : AccuracyRow {
    Method method = Method::automatic;
    double rtol = 0;
};
struct ModesRow : AccuracyRow {  // error against the row of `Accuracy::most_modes`
    int modes = 0;
};
struct ModelRow : AccuracyRow {  // error against `exact`, or the highest model that was affordable
    ModelKind model = ModelKind::rigid;
};
struct ContactRow : AccuracyRow {  // how far the angle moves when a number of the contact law is off
    std::string change;            // "stiffness +1 %"
};

struct Recommendation {
    double rtol = 0;
    int modes = 0;
    double until = 0;    // [s]
    double seconds = 0;  // run time to there
    double error = 0;    // estimated [rad]
    std::string text;
};

struct Accuracy {
    bool of_tip = false;         // the hub's angle is prescribed: errors are of the tip's deflection over the length
    double end_time = 0;         // asked [s]
    double until = 0;            // the motion is reproducible until here; every error is taken over [0, until] [s]
    double reference_error = 0;  // of the reference itself, estimated [rad]
    double target = 0;
    int most_modes = 0;                       // shapes that the others are compared with: the most that were affordable
    double models_until = 0;                  // the models are compared over [0, models_until] [s]
    ModelKind best_model = ModelKind::exact;  // that the others are compared with
    std::vector<WorkRow> work;
    std::vector<ModesRow> modes;
    std::vector<ModelRow> models;
    std::vector<ContactRow> contact;
    std::optional<Recommendation> recommendation;
};

// `progress` is told what is being run and the share done, 0…1; returning false ends with Interrupted.
// Throws what `simulate` throws of the problem's own settings.
Accuracy assess(const Problem& problem, const AccuracyRequest& request,
                const std::function<bool(const std::string& what, double share)>& progress = {});

}  // namespace beamcam::sim
