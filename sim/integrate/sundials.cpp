// CVODE and ARKODE behind the one-step view of integrator.hpp: Adams with fixed-point iteration, BDF with Newton
// and a dense differenced Jacobian (a few to eighty unknowns: differencing costs as much as a few steps, and dozens of
// steps use it). The only file that includes SUNDIALS.
//
// A segment is CVODE's Nordsieck polynomial of the step, or ARKODE's interpolant of degree 5: with
// Fehlberg's 8(7) pair events are as accurate as that interpolant, not as the step.
#include <arkode/arkode_arkstep.h>
#include <cvode/cvode.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <sundials/sundials_context.hpp>
#include <type_traits>
#include <vector>

#include "sim/integrate/constants.hpp"
#include "sim/integrate/integrator.hpp"

namespace beamcam::sim {
namespace {

// The Taylor polynomial of CVODE's steps. `numbers`: the instant of expansion, and the coefficients from the constant
// on, n numbers each.
void evaluate_taylor(std::span<const double> numbers, std::size_t n, double t, double* y) {
    const double s = t - numbers.front();
    const std::span<const double> rows = numbers.subspan(1);
    for (std::size_t i = 0; i < n; ++i) {
        double v = rows[rows.size() - n + i];
        for (std::size_t k = rows.size() / n - 1; k-- > 0;) v = v * s + rows[k * n + i];
        y[i] = v;
    }
}

class StoredTaylor final : public StoredSegment {
  public:
    explicit StoredTaylor(int size) : n_(static_cast<std::size_t>(size)) {}
    void load(double begin, double end, std::span<const double> numbers) override {
        if (numbers.size() < 1 + n_ || (numbers.size() - 1) % n_ != 0)
            throw std::invalid_argument("a segment of the trajectory has the wrong length");
        t0 = begin;
        t1 = end;
        polynomial_ = numbers;
    }
    void value(double t, double* y) const override { evaluate_taylor(polynomial_, n_, t, y); }

  private:
    std::size_t n_;
    std::span<const double> polynomial_;
};

// One of the suite's solvers by those of its functions that both have.
struct SolverFunctions {
    const char* name;
    char* (*flag_name)(long int);  // from malloc
    int (*set_user_data)(void*, void*);
    int (*set_weights)(void*, int (*)(N_Vector, N_Vector, void*));
    int (*set_most_steps)(void*, long int);
    int (*restart)(void*, double, N_Vector);
    int (*set_first_step)(void*, double);
    int (*set_stop_time)(void*, double);
    int (*step)(void*, double, N_Vector, double*, int);
    int (*derivative)(void*, double, int, N_Vector);
    int (*count_steps)(void*, long int*);
    int (*count_rejected)(void*, long int*);
    void (*free)(void**);
};
constexpr SolverFunctions kCvode{"CVODE",           CVodeGetReturnFlagName, CVodeSetUserData,
                                 CVodeWFtolerances, CVodeSetMaxNumSteps,    CVodeReInit,
                                 CVodeSetInitStep,  CVodeSetStopTime,       CVode,
                                 CVodeGetDky,       CVodeGetNumSteps,       CVodeGetNumErrTestFails,
                                 CVodeFree},
    kArkode{
        "ARKODE",           ARKStepGetReturnFlagName,  ARKStepSetUserData, ARKStepWFtolerances, ARKStepSetMaxNumSteps,
        ARKStepReset,       ARKStepSetInitStep,        ARKStepSetStopTime, ARKStepEvolve,       ARKStepGetDky,
        ARKStepGetNumSteps, ARKStepGetNumErrTestFails, ARKStepFree};
// NOLINTBEGIN(misc-redundant-expression): equal now, but of two libraries
static_assert(CV_ONE_STEP == ARK_ONE_STEP && CV_TOO_MUCH_ACC == ARK_TOO_MUCH_ACC && CV_ERR_FAILURE == ARK_ERR_FAILURE &&
              CV_RHSFUNC_FAIL == ARK_RHSFUNC_FAIL && CV_FIRST_RHSFUNC_ERR == ARK_FIRST_RHSFUNC_ERR &&
              CV_REPTD_RHSFUNC_ERR == ARK_REPTD_RHSFUNC_ERR && CV_UNREC_RHSFUNC_ERR == ARK_UNREC_RHSFUNC_ERR);
// NOLINTEND(misc-redundant-expression)

// Why a step failed, by the flag of either solver.
const char* reason_of(int flag) {
    switch (flag) {
        case CV_TOO_MUCH_ACC:
            return "the tolerance asks for more digits than numbers have";
        case CV_ERR_FAILURE:
            return step_failure_reason(true);
        case CV_CONV_FAILURE:
            return "the iteration of an implicit step does not converge, however short the step";
        case CV_LSETUP_FAIL:
        case CV_LSOLVE_FAIL:
            return "the equations of an implicit step have no solution";
        case CV_RHSFUNC_FAIL:
        case CV_FIRST_RHSFUNC_ERR:
        case CV_REPTD_RHSFUNC_ERR:
        case CV_UNREC_RHSFUNC_ERR:
            return step_failure_reason(false);
        default:
            return "the integrator gave up";
    }
}

// Right-hand side and error norm of both solvers.
struct Callbacks {
    Ode& ode;
    double rtol, atol;

    static int rhs(double t, N_Vector y, N_Vector dy, void* self) noexcept {
        Ode& ode = static_cast<Callbacks*>(self)->ode;
        double* out = N_VGetArrayPointer(dy);
        ode.rhs(t, N_VGetArrayPointer(y), out);
        for (int i = 0; i < ode.size; ++i)
            if (!std::isfinite(out[i])) return 1;  // recoverable: try a smaller step
        return 0;
    }

    static int weights(N_Vector y, N_Vector w, void* self) noexcept {
        const auto& me = *static_cast<Callbacks*>(self);
        const double* value = N_VGetArrayPointer(y);
        double* weight = N_VGetArrayPointer(w);
        // The norm averages over all components; only the controlled ones must count.
        const double share = std::sqrt(static_cast<double>(me.ode.size) / me.ode.controlled);
        for (int i = 0; i < me.ode.size; ++i)
            weight[i] = i < me.ode.controlled ? share / (me.rtol * std::fabs(value[i]) + me.atol) : kIgnoredWeight;
        return 0;
    }

    // Moves the state by a hundredth of its tolerance-weighted size; the error test does the rest.
    double first_step(double t, const std::vector<double>& y, double* slope, double stop) const {
        ode.rhs(t, y.data(), slope);
        double size = 0, speed = 0;
        for (int i = 0; i < ode.controlled; ++i) {
            const double value = y[static_cast<std::size_t>(i)], scale = atol + rtol * std::fabs(value);
            size += value * value / (scale * scale);
            speed += slope[i] * slope[i] / (scale * scale);
        }
        const double h = size > 0 && speed > 0 ? 0.01 * std::sqrt(size / speed) : 1e-6;
        return std::isfinite(stop) && stop > t ? std::min(h, 0.5 * (stop - t)) : h;
    }
};

template <auto destroy>
struct Destroy {
    void operator()(auto* handle) const { destroy(handle); }
};
template <class Handle, auto destroy>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Destroy<destroy>>;
using Vector = Owned<N_Vector, N_VDestroy>;

struct FreeMemory {
    const SolverFunctions& solver;
    void operator()(void* memory) const { solver.free(&memory); }
};
using Memory = std::unique_ptr<void, FreeMemory>;

// What both solvers share; the derived class creates the solver's memory and evaluates within a step.
class SundialsIntegrator : public Integrator, protected Segment {
  public:
    SundialsIntegrator(const SundialsIntegrator&) = delete;
    SundialsIntegrator& operator=(const SundialsIntegrator&) = delete;

    void start(double t, const double* y) final {
        std::copy_n(y, n_, N_VGetArrayPointer(y_.get()));
        std::copy_n(y, n_, end_.begin());
        t1 = t;
        if (memory_) {
            count();
            check(solver_.restart(memory_.get(), t, y_.get()), "a restart");
        } else {
            create(t);
            check(solver_.set_user_data(memory_.get(), &call_), "the start");
            check(solver_.set_weights(memory_.get(), &Callbacks::weights), "the tolerances");
            check(solver_.set_most_steps(memory_.get(), 1000000), "the start");
        }
        const double h = call_.first_step(t1, end_, N_VGetArrayPointer(work_.get()), stop_);
        check(solver_.set_first_step(memory_.get(), limited(h)), "the first step");
    }

    const Segment& step() final {
        t0 = t1;
        const bool stops = std::isfinite(stop_) && stop_ > t0;
        if (stops) check(solver_.set_stop_time(memory_.get(), stop_), "the stop time");
        double t = t0;
        const int flag = solver_.step(memory_.get(), stops ? stop_ : t0 + kFarTime, y_.get(), &t, CV_ONE_STEP);
        if (flag < 0) throw StepFailure(fmt::format("{} ({})", reason_of(flag), text_of(flag)));
        t1 = t;
        std::copy_n(N_VGetArrayPointer(y_.get()), n_, end_.begin());
        stepped();
        count();
        return *this;
    }

    const Segment& shorten(double at) final {
        // The polynomial is as accurate as the step; no history is kept to repeat it.
        value(at, end_.data());
        t1 = at;
        return *this;
    }

  protected:
    SundialsIntegrator(const SolverFunctions& solver, Ode& ode, double rtol, double atol)
        : solver_(solver),
          call_{ode, rtol, atol},
          n_(static_cast<std::size_t>(ode.size)),
          y_(N_VNew_Serial(static_cast<sunindextype>(n_), context_)),
          work_(N_VNew_Serial(static_cast<sunindextype>(n_), context_)),
          end_(n_, 0) {
        if (!y_ || !work_) throw StepFailure("the integrator could not be set up");
#if SUNDIALS_VERSION_MAJOR >= 7
        SUNContext_ClearErrHandlers(context_);  // failures are returned as flags and reported by the caller
#endif
    }

    void check(int flag, const char* call) const {
        if (flag < 0) throw StepFailure(fmt::format("{} of the integrator failed ({})", call, text_of(flag)));
    }
    const double* derivative(double t, int k) const {
        check(solver_.derivative(memory_.get(), t, k, work_.get()), "dense output");
        return N_VGetArrayPointer(work_.get());
    }

    void own(void* memory) {
        if (!memory) throw StepFailure("the integrator could not be set up");
        memory_.reset(memory);
    }
    // Creates the solver's memory, with its method.
    virtual void create(double t) = 0;
    virtual void stepped() {}
    // Numbers of right-hand sides and Jacobians since the last (re)start.
    virtual IntegratorCounters evaluations() const = 0;

    const SolverFunctions& solver_;
    Callbacks call_;
    std::size_t n_;
    sundials::Context context_;
    Vector y_, work_;
    Owned<SUNMatrix, SUNMatDestroy> matrix_;  // of CVODE
    Owned<SUNLinearSolver, SUNLinSolFree> linear_;
    Owned<SUNNonlinearSolver, SUNNonlinSolFree> nonlinear_;
    Memory memory_{nullptr, FreeMemory{solver_}};  // uses all of these
    std::vector<double> end_;

  private:
    std::string text_of(int flag) const {
        const std::unique_ptr<char, decltype(&std::free)> text(solver_.flag_name(flag), &std::free);
        return fmt::format("{}: {}", solver_.name, text ? text.get() : std::to_string(flag).c_str());
    }
    void count() {
        IntegratorCounters now = evaluations();
        solver_.count_steps(memory_.get(), &now.steps);
        solver_.count_rejected(memory_.get(), &now.rejected);
        // A solver's counts restart at zero with the solver.
        for (const auto each : {&IntegratorCounters::steps, &IntegratorCounters::rhs, &IntegratorCounters::rejected,
                                &IntegratorCounters::jacobians})
            counters.*each += now.*each >= last_.*each ? now.*each - last_.*each : now.*each;
        last_ = now;
    }

    IntegratorCounters last_;
};

class Cvode final : public SundialsIntegrator {
  public:
    Cvode(Method method, Ode& ode, double rtol, double atol)
        : SundialsIntegrator(kCvode, ode, rtol, atol), bdf_(method == Method::cvode_bdf) {}

    void value(double t, double* y) const override { evaluate_taylor(polynomial_, n_, t, y); }

    SegmentKind numbers(std::vector<double>& out) const override {
        out.insert(out.end(), polynomial_.begin(), polynomial_.end());
        return SegmentKind::taylor;
    }

  private:
    void create(double t) override {
        own(CVodeCreate(bdf_ ? CV_BDF : CV_ADAMS, context_));
        check(CVodeInit(memory_.get(), &Callbacks::rhs, t, y_.get()), "the start");
#if SUNDIALS_VERSION_MAJOR < 7
        check(CVodeSetErrFile(memory_.get(), nullptr), "the start");  // as ClearErrHandlers
#endif
        if (bdf_) {
            matrix_.reset(SUNDenseMatrix(static_cast<sunindextype>(n_), static_cast<sunindextype>(n_), context_));
            linear_.reset(SUNLinSol_Dense(y_.get(), matrix_.get(), context_));
            check(CVodeSetLinearSolver(memory_.get(), linear_.get(), matrix_.get()), "the linear solver");
        } else {
            nonlinear_.reset(SUNNonlinSol_FixedPoint(y_.get(), 0, context_));
            check(CVodeSetNonlinearSolver(memory_.get(), nonlinear_.get()), "the nonlinear solver");
        }
    }

    void stepped() override {
        int order = 1;
        check(CVodeGetLastOrder(memory_.get(), &order), "the order");
        polynomial_.assign(1, t1);
        double factorial = 1;
        for (int k = 0; k <= order; ++k) {
            if (k > 0) factorial *= k;
            const double* d = derivative(t1, k);
            for (std::size_t i = 0; i < n_; ++i) polynomial_.push_back(d[i] / factorial);
        }
    }

    IntegratorCounters evaluations() const override {
        IntegratorCounters now;
        long linear = 0;
        CVodeGetNumRhsEvals(memory_.get(), &now.rhs);
        if (bdf_) {
            CVodeGetNumJacEvals(memory_.get(), &now.jacobians);
            CVodeGetNumLinRhsEvals(memory_.get(), &linear);
        }
        now.rhs += linear;
        return now;
    }

    bool bdf_;
    std::vector<double> polynomial_;
};

class Arkode final : public SundialsIntegrator {
  public:
    Arkode(Ode& ode, double rtol, double atol) : SundialsIntegrator(kArkode, ode, rtol, atol) {}

    void value(double t, double* y) const override { std::copy_n(t == t1 ? end_.data() : derivative(t, 0), n_, y); }

  private:
    void create(double t) override {
        own(ARKStepCreate(&Callbacks::rhs, nullptr, t, y_.get(), context_));
        check(ARKStepSetTableNum(memory_.get(), ARKODE_DIRK_NONE, ARKODE_FEHLBERG_13_7_8), "the method");
        check(ARKStepSetInterpolantDegree(memory_.get(), 5), "dense output");
#if SUNDIALS_VERSION_MAJOR < 7
        check(ARKStepSetErrFile(memory_.get(), nullptr), "the start");  // as ClearErrHandlers
#endif
    }

    IntegratorCounters evaluations() const override {
        IntegratorCounters now;
        long implicit = 0;
        ARKStepGetNumRhsEvals(memory_.get(), &now.rhs, &implicit);
        return now;
    }
};

}  // namespace

std::unique_ptr<Integrator> make_sundials(Method method, Ode& ode, double rtol, double atol) {
    if (method == Method::arkode_erk) return std::make_unique<Arkode>(ode, rtol, atol);
    return std::make_unique<Cvode>(method, ode, rtol, atol);
}

std::unique_ptr<StoredSegment> make_stored_taylor(int size) { return std::make_unique<StoredTaylor>(size); }

}  // namespace beamcam::sim
