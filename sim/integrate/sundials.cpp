// CVODE behind the one-step view of integrator.hpp: Adams with fixed-point iteration, BDF with Newton and a dense
// differenced Jacobian (a few to eighty unknowns: differencing costs as much as a few steps, and dozens of steps use
// it). A segment is the Nordsieck polynomial of the step. The only file that includes SUNDIALS.
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

#include "sim/integrate/integrator.hpp"

namespace beamcam::sim {
namespace {

constexpr double kIgnoredWeight = 1e-30;  // in SUNDIALS, of components without error control
constexpr int kMostFailures = 30;         // of the iteration: the first step of a beam at rest is far too long
constexpr double kFarTime = 1e3;          // [s] a target beyond any step, in the direction of time

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

// Why a step failed, by CVODE's flag.
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

// Right-hand side and error norm.
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
    void operator()(void* memory) const { CVodeFree(&memory); }
};

class Cvode final : public Integrator, private Segment {
  public:
    Cvode(Method method, Ode& ode, double rtol, double atol)
        : bdf_(method == Method::cvode_bdf),
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
    Cvode(const Cvode&) = delete;
    Cvode& operator=(const Cvode&) = delete;

    void start(double t, const double* y) override {
        std::copy_n(y, n_, N_VGetArrayPointer(y_.get()));
        std::copy_n(y, n_, end_.begin());
        t1 = t;
        if (memory_) {
            count();
            check(CVodeReInit(memory_.get(), t, y_.get()), "a restart");
        } else {
            create(t);
        }
        const double h = call_.first_step(t1, end_, N_VGetArrayPointer(work_.get()), stop_);
        check(CVodeSetInitStep(memory_.get(), limited(h)), "the first step");
    }

    const Segment& step() override {
        t0 = t1;
        const bool stops = std::isfinite(stop_) && stop_ > t0;
        if (stops) check(CVodeSetStopTime(memory_.get(), stop_), "the stop time");
        double t = t0;
        const int flag = CVode(memory_.get(), stops ? stop_ : t0 + kFarTime, y_.get(), &t, CV_ONE_STEP);
        if (flag < 0) throw StepFailure(fmt::format("{} ({})", reason_of(flag), text_of(flag)));
        t1 = t;
        std::copy_n(N_VGetArrayPointer(y_.get()), n_, end_.begin());
        keep_polynomial();
        count();
        return *this;
    }

    const Segment& shorten(double at) override {
        // The polynomial is as accurate as the step; no history is kept to repeat it.
        value(at, end_.data());
        t1 = at;
        return *this;
    }

    void value(double t, double* y) const override { evaluate_taylor(polynomial_, n_, t, y); }

  private:
    void create(double t) {
        memory_.reset(CVodeCreate(bdf_ ? CV_BDF : CV_ADAMS, context_));
        if (!memory_) throw StepFailure("the integrator could not be set up");
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
        check(CVodeSetUserData(memory_.get(), &call_), "the start");
        check(CVodeWFtolerances(memory_.get(), &Callbacks::weights), "the tolerances");
        check(CVodeSetMaxNumSteps(memory_.get(), 1000000), "the start");
        check(CVodeSetMaxConvFails(memory_.get(), kMostFailures), "the start");
        if (std::isfinite(call_.ode.longest_step))
            check(CVodeSetMaxStep(memory_.get(), call_.ode.longest_step), "the longest step");
    }

    void keep_polynomial() {
        int order = 1;
        check(CVodeGetLastOrder(memory_.get(), &order), "the order");
        polynomial_.assign(1, t1);
        double factorial = 1;
        for (int k = 0; k <= order; ++k) {
            if (k > 0) factorial *= k;
            check(CVodeGetDky(memory_.get(), t1, k, work_.get()), "dense output");
            const double* d = N_VGetArrayPointer(work_.get());
            for (std::size_t i = 0; i < n_; ++i) polynomial_.push_back(d[i] / factorial);
        }
    }

    static std::string text_of(int flag) {
        const std::unique_ptr<char, decltype(&std::free)> text(CVodeGetReturnFlagName(flag), &std::free);
        return fmt::format("CVODE: {}", text ? text.get() : std::to_string(flag).c_str());
    }
    static void check(int flag, const char* call) {
        if (flag < 0) throw StepFailure(fmt::format("{} of the integrator failed ({})", call, text_of(flag)));
    }

    void count() {
        Counters now;
        CVodeGetNumSteps(memory_.get(), &now.steps);
        CVodeGetNumErrTestFails(memory_.get(), &now.rejected);
        CVodeGetNumRhsEvals(memory_.get(), &now.rhs_evaluations);
        if (bdf_) {
            long linear = 0;
            CVodeGetNumLinRhsEvals(memory_.get(), &linear);
            now.rhs_evaluations += linear;
        }
        // CVODE's counts restart at zero with it.
        for (const auto each : {&Counters::steps, &Counters::rejected, &Counters::rhs_evaluations})
            counters.*each += now.*each >= last_.*each ? now.*each - last_.*each : now.*each;
        last_ = now;
    }

    bool bdf_;
    Callbacks call_;
    std::size_t n_;
    sundials::Context context_;
    Vector y_, work_;
    Owned<SUNMatrix, SUNMatDestroy> matrix_;
    Owned<SUNLinearSolver, SUNLinSolFree> linear_;
    Owned<SUNNonlinearSolver, SUNNonlinSolFree> nonlinear_;
    std::unique_ptr<void, FreeMemory> memory_;  // uses all of these
    std::vector<double> end_, polynomial_;
    Counters last_;
};

}  // namespace

std::unique_ptr<Integrator> make_sundials(Method method, Ode& ode, double rtol, double atol) {
    return std::make_unique<Cvode>(method, ode, rtol, atol);
}

}  // namespace beamcam::sim
