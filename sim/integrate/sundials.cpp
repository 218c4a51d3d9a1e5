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
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>

#include "sim/integrate/constants.hpp"
#include "sim/integrate/integrator.hpp"

#if SUNDIALS_VERSION_MAJOR >= 7
#define BEAMCAM_NO_COMM SUN_COMM_NULL
#else
#define BEAMCAM_NO_COMM nullptr
#endif

namespace beamcam::sim {
namespace {

constexpr int kMaxOrder = 12;  // of Adams; BDF uses 5
constexpr const char* kBelowRounding = "the tolerance asks for more digits than numbers have";
constexpr const char* kGaveUp = "the integrator gave up";

// One of the suite's solvers, and its own names for its flags (from malloc).
struct Suite {
    const char* name;
    char* (*flag_name)(long int);

    std::string flag(int value) const {
        const std::unique_ptr<char, decltype(&std::free)> text(flag_name(value), &std::free);
        return fmt::format("{}: {}", name, text ? text.get() : std::to_string(value).c_str());
    }
    void check(int value, const char* call) const {
        if (value < 0) throw StepFailure(fmt::format("{} of the integrator failed ({})", call, flag(value)));
    }
    StepFailure failure(int value, const char* reason) const {
        return StepFailure(fmt::format("{} ({})", reason, flag(value)));
    }
};
constexpr Suite kCvode{"CVODE", CVodeGetReturnFlagName}, kArkode{"ARKODE", ARKStepGetReturnFlagName};

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

// y_i = Σ_k row(k)_i sᵏ
template <class Row>
void horner(double s, std::size_t order, std::size_t n, Row&& row, double* y) {
    for (std::size_t i = 0; i < n; ++i) {
        double v = row(order)[i];
        for (std::size_t k = order; k-- > 0;) v = v * s + row(k)[i];
        y[i] = v;
    }
}

// Adds the growth of a solver's count, which restarts at zero with the solver.
void grow(long& total, long now, long& last) {
    total += now >= last ? now - last : now;
    last = now;
}

SUNContext make_context() {
    SUNContext context = nullptr;
    if (SUNContext_Create(BEAMCAM_NO_COMM, &context) != 0) throw StepFailure("the integrator could not be set up");
#if SUNDIALS_VERSION_MAJOR >= 7
    SUNContext_ClearErrHandlers(context);  // failures are returned as flags and reported by the caller
#endif
    return context;
}

// Common to CVODE and ARKODE: vectors, start and end of a step.
class SundialsSolver : public Integrator, protected Segment {
  public:
    SundialsSolver(const SundialsSolver&) = delete;
    SundialsSolver& operator=(const SundialsSolver&) = delete;

    void start(double t, const double* y) final {
        std::copy_n(y, n_, N_VGetArrayPointer(y_));
        std::copy_n(y, n_, end_.begin());
        t1 = t;
        collect();
        if (memory_)
            restart(t);
        else
            set_up(t);
        first_step(limited(call_.first_step(t1, end_, N_VGetArrayPointer(work_), stop_)));
    }

    const Segment& shorten(double at) final {
        // The polynomial is as accurate as the step; no history is kept to repeat it.
        value(at, end_.data());
        t1 = at;
        return *this;
    }

  protected:
    SundialsSolver(Ode& ode, double rtol, double atol)
        : call_{ode, rtol, atol}, n_(static_cast<std::size_t>(ode.size)), context_(make_context()), end_(n_, 0) {
        y_ = N_VNew_Serial(static_cast<sunindextype>(n_), context_);
        work_ = N_VNew_Serial(static_cast<sunindextype>(n_), context_);
    }
    ~SundialsSolver() override {
        N_VDestroy(y_);
        N_VDestroy(work_);
        SUNContext_Free(&context_);
    }

    bool stops() const { return std::isfinite(stop_) && stop_ > t0; }
    double target() const { return stops() ? stop_ : t0 + kFarTime; }
    void reached(double t) {
        t1 = t;
        std::copy_n(N_VGetArrayPointer(y_), n_, end_.begin());
    }
    // Adds the solver's counts to `counters`.
    virtual void collect() = 0;
    virtual void set_up(double t) = 0;
    virtual void restart(double t) = 0;
    virtual void first_step(double h) = 0;

    Callbacks call_;
    std::size_t n_;
    SUNContext context_;
    void* memory_ = nullptr;
    N_Vector y_ = nullptr, work_ = nullptr;
    std::vector<double> end_;
    IntegratorCounters last_;
};

class Cvode final : public SundialsSolver {
  public:
    Cvode(Method method, Ode& ode, double rtol, double atol)
        : SundialsSolver(ode, rtol, atol), bdf_(method == Method::cvode_bdf) {
        for (auto& d : taylor_) d.assign(n_, 0);
    }
    ~Cvode() override {
        if (memory_) CVodeFree(&memory_);
        if (linear_) SUNLinSolFree(linear_);
        if (matrix_) SUNMatDestroy(matrix_);
        if (nonlinear_) SUNNonlinSolFree(nonlinear_);
    }

    const Segment& step() override {
        t0 = t1;
        if (stops()) kCvode.check(CVodeSetStopTime(memory_, stop_), "the stop time");
        double t = t0;
        const int flag = CVode(memory_, target(), y_, &t, CV_ONE_STEP);
        if (flag < 0) throw kCvode.failure(flag, reason(flag));
        reached(t);
        int order = 1;
        kCvode.check(CVodeGetLastOrder(memory_, &order), "the order");
        order_ = std::min(order, kMaxOrder);
        base_ = t1;
        double factorial = 1;
        for (int k = 0; k <= order_; ++k) {
            if (k > 0) factorial *= k;
            kCvode.check(CVodeGetDky(memory_, t1, k, work_), "dense output");
            const double* d = N_VGetArrayPointer(work_);
            for (std::size_t i = 0; i < n_; ++i) taylor_[static_cast<std::size_t>(k)][i] = d[i] / factorial;
        }
        collect();
        return *this;
    }

    void value(double t, double* y) const override {
        horner(t - base_, static_cast<std::size_t>(order_), n_, [&](std::size_t k) { return taylor_[k].data(); }, y);
    }

    SegmentKind numbers(std::vector<double>& out) const override {
        out.push_back(base_);
        for (int k = 0; k <= order_; ++k) {
            const std::vector<double>& row = taylor_[static_cast<std::size_t>(k)];
            out.insert(out.end(), row.begin(), row.end());
        }
        return SegmentKind::taylor;
    }

  private:
    static const char* reason(int flag) {
        switch (flag) {
            case CV_TOO_MUCH_ACC:
                return kBelowRounding;
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
                return kGaveUp;
        }
    }

    void collect() override {
        if (!memory_) return;
        long steps = 0, rhs = 0, rejected = 0, jacobians = 0, linear_rhs = 0;
        CVodeGetNumSteps(memory_, &steps);
        CVodeGetNumRhsEvals(memory_, &rhs);
        CVodeGetNumErrTestFails(memory_, &rejected);
        if (bdf_) {
            CVodeGetNumJacEvals(memory_, &jacobians);
            CVodeGetNumLinRhsEvals(memory_, &linear_rhs);
        }
        rhs += linear_rhs;
        grow(counters.steps, steps, last_.steps);
        grow(counters.rhs, rhs, last_.rhs);
        grow(counters.rejected, rejected, last_.rejected);
        grow(counters.jacobians, jacobians, last_.jacobians);
    }

    void restart(double t) override { kCvode.check(CVodeReInit(memory_, t, y_), "a restart"); }
    void first_step(double h) override { kCvode.check(CVodeSetInitStep(memory_, h), "the first step"); }

    void set_up(double t) override {
        memory_ = CVodeCreate(bdf_ ? CV_BDF : CV_ADAMS, context_);
        if (!memory_) throw StepFailure("the integrator could not be set up");
        kCvode.check(CVodeInit(memory_, &Callbacks::rhs, t, y_), "the start");
        kCvode.check(CVodeSetUserData(memory_, &call_), "the start");
        kCvode.check(CVodeWFtolerances(memory_, &Callbacks::weights), "the tolerances");
        kCvode.check(CVodeSetMaxNumSteps(memory_, 1000000), "the start");
#if SUNDIALS_VERSION_MAJOR < 7
        // Failures are returned as flags and reported by the caller.
        kCvode.check(CVodeSetErrHandlerFn(memory_, [](int, const char*, const char*, char*, void*){}, nullptr),
                     "the start");
#endif
        if (bdf_) {
            matrix_ = SUNDenseMatrix(static_cast<sunindextype>(n_), static_cast<sunindextype>(n_), context_);
            linear_ = SUNLinSol_Dense(y_, matrix_, context_);
            kCvode.check(CVodeSetLinearSolver(memory_, linear_, matrix_), "the linear solver");
        } else {
            nonlinear_ = SUNNonlinSol_FixedPoint(y_, 0, context_);
            kCvode.check(CVodeSetNonlinearSolver(memory_, nonlinear_), "the nonlinear solver");
        }
    }

    bool bdf_;
    SUNMatrix matrix_ = nullptr;
    SUNLinearSolver linear_ = nullptr;
    SUNNonlinearSolver nonlinear_ = nullptr;
    std::array<std::vector<double>, kMaxOrder + 1> taylor_;
    int order_ = 0;
    double base_ = 0;
};

// A stored polynomial of CVODE: the instant of expansion, and the coefficients from the constant on.
class StoredTaylor final : public StoredSegment {
  public:
    explicit StoredTaylor(int size) : n_(static_cast<std::size_t>(size)) {}
    void load(double begin, double end, std::span<const double> numbers) override {
        if (numbers.size() < 1 + n_ || (numbers.size() - 1) % n_ != 0)
            throw std::invalid_argument("a segment of the trajectory has the wrong length");
        t0 = begin;
        t1 = end;
        base_ = numbers.front();
        rows_ = numbers.subspan(1);
    }
    void value(double t, double* y) const override {
        horner(t - base_, rows_.size() / n_ - 1, n_, [&](std::size_t k) { return rows_.data() + k * n_; }, y);
    }

  private:
    std::size_t n_;
    double base_ = 0;
    std::span<const double> rows_;
};

class Arkode final : public SundialsSolver {
  public:
    Arkode(Ode& ode, double rtol, double atol) : SundialsSolver(ode, rtol, atol) {}
    ~Arkode() override {
        if (memory_) ARKStepFree(&memory_);
    }

    const Segment& step() override {
        t0 = t1;
        if (stops()) kArkode.check(ARKStepSetStopTime(memory_, stop_), "the stop time");
        double t = t0;
        const int flag = ARKStepEvolve(memory_, target(), y_, &t, ARK_ONE_STEP);
        if (flag < 0) throw kArkode.failure(flag, reason(flag));
        reached(t);
        collect();
        return *this;
    }

    void value(double t, double* y) const override {
        if (t == t1) {
            std::copy(end_.begin(), end_.end(), y);
            return;
        }
        kArkode.check(ARKStepGetDky(memory_, t, 0, work_), "dense output");
        std::copy_n(N_VGetArrayPointer(work_), n_, y);
    }

  private:
    static const char* reason(int flag) {
        switch (flag) {
            case ARK_TOO_MUCH_ACC:
                return kBelowRounding;
            case ARK_ERR_FAILURE:
                return step_failure_reason(true);
            case ARK_RHSFUNC_FAIL:
            case ARK_FIRST_RHSFUNC_ERR:
            case ARK_REPTD_RHSFUNC_ERR:
            case ARK_UNREC_RHSFUNC_ERR:
                return step_failure_reason(false);
            default:
                return kGaveUp;
        }
    }

    void collect() override {
        if (!memory_) return;
        long steps = 0, rhs = 0, implicit = 0, rejected = 0;
        ARKStepGetNumSteps(memory_, &steps);
        ARKStepGetNumRhsEvals(memory_, &rhs, &implicit);
        ARKStepGetNumErrTestFails(memory_, &rejected);
        grow(counters.steps, steps, last_.steps);
        grow(counters.rhs, rhs, last_.rhs);
        grow(counters.rejected, rejected, last_.rejected);
    }

    void restart(double t) override { kArkode.check(ARKStepReset(memory_, t, y_), "a restart"); }
    void first_step(double h) override { kArkode.check(ARKStepSetInitStep(memory_, h), "the first step"); }

    void set_up(double t) override {
        memory_ = ARKStepCreate(&Callbacks::rhs, nullptr, t, y_, context_);
        if (!memory_) throw StepFailure("the integrator could not be set up");
        kArkode.check(ARKStepSetUserData(memory_, &call_), "the start");
        kArkode.check(ARKStepWFtolerances(memory_, &Callbacks::weights), "the tolerances");
        kArkode.check(ARKStepSetTableNum(memory_, ARKODE_DIRK_NONE, ARKODE_FEHLBERG_13_7_8), "the method");
        kArkode.check(ARKStepSetInterpolantDegree(memory_, 5), "dense output");
        kArkode.check(ARKStepSetMaxNumSteps(memory_, 1000000), "the start");
#if SUNDIALS_VERSION_MAJOR < 7
        kArkode.check(ARKStepSetErrHandlerFn(memory_, [](int, const char*, const char*, char*, void*){}, nullptr),
                      "the start");
#endif
    }
};

}  // namespace

std::unique_ptr<StoredSegment> make_stored_taylor(int size) { return std::make_unique<StoredTaylor>(size); }

std::unique_ptr<Integrator> make_sundials(Method method, Ode& ode, double rtol, double atol) {
    if (method == Method::arkode_erk) return std::make_unique<Arkode>(ode, rtol, atol);
    return std::make_unique<Cvode>(method, ode, rtol, atol);
}

}  // namespace beamcam::sim
