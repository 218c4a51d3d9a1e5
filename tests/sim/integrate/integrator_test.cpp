#include "sim/integrate/integrator.hpp"

#include <cmath>
#include <vector>

#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

// Two nonlinear equations whose solutions are known, and an integral that error control must not see.
struct Known : Ode {
    Known() {
        size = 3;
        controlled = 2;
    }
    void rhs(double t, const double* y, double* dy) override {
        dy[0] = -y[0] * y[0] * std::sin(t);  // 1/(2 − cos t)
        dy[1] = y[1] * std::cos(t);          // e^{sin t}
        dy[2] = std::log(y[1]);              // 1 − cos t
    }
    static std::vector<double> exact(double t) {
        return {1 / (2 - std::cos(t)), std::exp(std::sin(t)), 1 - std::cos(t)};
    }
};

double error_at(const Segment& s, double t) {
    double y[3], worst = 0;
    s.value(t, y);
    const std::vector<double> exact = Known::exact(t);
    for (std::size_t i = 0; i < 3; ++i) worst = std::max(worst, std::fabs(y[i] - exact[i]));
    return worst;
}

// A single step of the given length from t = 0.
double step_error(double h, double where) {
    Known ode;
    const auto integrator = make_rk8(ode, 1e-3, 1e-3);
    integrator->start(0, Known::exact(0).data());
    integrator->step();
    return error_at(integrator->shorten(h), where * h);
}

TEST(Rk8, ConvergesWithOrderEight) {
    const double order = std::log2(step_error(0.5, 1) / step_error(0.25, 1));
    EXPECT_GT(order, 8.6);  // one step: one more than the order
}

TEST(Rk8, ContinuousExtensionConvergesWithOrderSeven) {
    for (double where : {0.3, 0.5, 0.8}) {
        const double order = std::log2(step_error(0.25, where) / step_error(0.125, where));
        EXPECT_NEAR(order, 8, 0.4) << where;  // of one step, too
    }
}

TEST(Rk8, SegmentsJoinAndStartWhereTheyWereTold) {
    Known ode;
    const auto integrator = make_rk8(ode, 1e-10, 1e-12);
    integrator->start(0, Known::exact(0).data());
    double end[3] = {1, 1, 0}, begin[3];
    double t = 0;
    for (int i = 0; i < 20; ++i) {
        const Segment& s = integrator->step();
        EXPECT_EQ(s.t0, t);
        s.value(s.t0, begin);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(begin[k], end[k], 1e-15 * (1 + std::fabs(end[k])));
        s.value(s.t1, end);
        t = s.t1;
    }
}

TEST(Rk8, StopsAtAnInstantAndGoesOn) {
    Known ode;
    const auto integrator = make_rk8(ode, 1e-9, 1e-12);
    integrator->start(0, Known::exact(0).data());
    integrator->stop_at(0.37);
    double t = 0;
    while (t < 0.37) t = integrator->step().t1;
    EXPECT_EQ(t, 0.37);
    integrator->stop_at(INFINITY);
    EXPECT_GT(integrator->step().t1, 0.37);
}

TEST(Rk8, ShortenedStepIsAFullStepOfThatLength) {
    Known ode;
    const auto integrator = make_rk8(ode, 1e-8, 1e-11);
    integrator->start(0, Known::exact(0).data());
    const double h = integrator->step().t1;
    const Segment& s = integrator->shorten(0.5 * h);
    EXPECT_EQ(s.t1, 0.5 * h);
    EXPECT_LT(error_at(s, 0.5 * h), 1e-12);
    EXPECT_EQ(integrator->step().t0, 0.5 * h);
}

TEST(Rk8, SaysWhenItCannotGoOn) {
    struct Blowup : Ode {
        Blowup() { size = controlled = 1; }
        void rhs(double, const double* y, double* dy) override { dy[0] = y[0] * y[0]; }
    } ode;
    const auto integrator = make_rk8(ode, 1e-8, 1e-11);
    const double one = 1;
    integrator->start(0, &one);
    EXPECT_THROW(for (int i = 0; i < 100000; ++i) integrator->step(), StepFailure);
}

double error_over(Integrator& integrator, double end, double* worst_inside = nullptr) {
    integrator.start(0, Known::exact(0).data());
    for (int i = 0; i < 1000000; ++i) {
        const Segment& s = integrator.step();
        const double to = std::min(end, s.t1);
        if (worst_inside)
            for (double share : {0.25, 0.5, 0.75})
                *worst_inside = std::max(*worst_inside, error_at(s, s.t0 + share * (to - s.t0)));
        if (s.t1 >= end) return error_at(s, end);
    }
    return INFINITY;
}

TEST(Integrators, AllReachTheSameClosedForm) {
    for (double rtol : {1e-6, 1e-9, 1e-12}) {
        Known ode;
        const double allowed = 300 * rtol;
        double inside = 0;
        EXPECT_LT(error_over(*make_rk8(ode, rtol, rtol), 10, &inside), allowed) << rtol;
        EXPECT_LT(inside, allowed) << rtol;
        for (const Method method : {Method::cvode_adams, Method::cvode_bdf}) {
            inside = 0;
            EXPECT_LT(error_over(*make_sundials(method, ode, rtol, rtol), 10, &inside), 10 * allowed)
                << name(method) << " " << rtol;
            EXPECT_LT(inside, 10 * allowed) << name(method) << " " << rtol;
        }
    }
}

TEST(Integrators, UncontrolledComponentsNeverChangeAStep) {
    struct Plain : Known {
        explicit Plain(bool ledger) { size = ledger ? 3 : 2; }
        void rhs(double t, const double* y, double* dy) override {
            double all[3];
            Known::rhs(t, y, all);
            std::copy_n(all, size, dy);
            if (size == 3) dy[2] = 1e9 * std::sin(1e3 * t);  // fast, but not under error control
        }
    } with(true), without(false);
    for (int kind = 0; kind < 3; ++kind) {
        const auto make = [&](Ode& ode) {
            return kind == 0 ? make_rk8(ode, 1e-8, 1e-10)
                             : make_sundials(kind == 1 ? Method::cvode_adams : Method::cvode_bdf, ode, 1e-8, 1e-10);
        };
        const auto a = make(with), b = make(without);
        a->start(0, Known::exact(0).data());
        b->start(0, Known::exact(0).data());
        for (int i = 0; i < 100; ++i) {
            const double ta = a->step().t1, tb = b->step().t1;
            if (kind == 0)
                ASSERT_EQ(ta, tb) << i;
            else
                ASSERT_NEAR(ta, tb, 1e-6 * tb) << i;  // the norm over more components rounds otherwise
        }
    }
}

TEST(Integrators, CountWhatTheyDo) {
    Known ode;
    const auto integrator = make_rk8(ode, 1e-8, 1e-10);
    integrator->start(0, Known::exact(0).data());
    for (int i = 0; i < 10; ++i) integrator->step();
    EXPECT_EQ(integrator->counters.steps, 10);
    EXPECT_GE(integrator->counters.rhs_evaluations, 120);
}

}  // namespace
}  // namespace beamcam::sim::testing
