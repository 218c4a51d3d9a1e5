// A right-hand side allocates nothing: every call of malloc is counted while it runs.
//
// glibc only, and not under sanitizers, which bring their own malloc.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <vector>

#include "sim/dynamics/initial.hpp"
#include "sim/dynamics/system.hpp"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {
thread_local bool counting = false;
thread_local long allocations = 0;
}  // namespace

extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) {
    if (counting) ++allocations;
    return __libc_malloc(size);
}

namespace beamcam::sim {
namespace {

long allocations_of_one_call(System& system, const std::vector<double>& y) {
    std::vector<double> dy(y.size());
    system.rhs(0.1, y.data(), dy.data());  // the first call may set up what stays
    allocations = 0;
    counting = true;
    system.rhs(0.1, y.data(), dy.data());
    counting = false;
    for (double d : dy) EXPECT_TRUE(std::isfinite(d));
    return allocations;
}

TEST(RightHandSide, TheCounterSeesAnAllocation) {
    allocations = 0;
    counting = true;
    void* volatile p = std::malloc(8);
    counting = false;
    std::free(p);
    EXPECT_GE(allocations, 1);
}

TEST(RightHandSide, AllocatesNothingInFlightAndInContact) {
    for (const ModelKind kind : {ModelKind::rigid, ModelKind::zeroth_order, ModelKind::first_order, ModelKind::paper,
                                 ModelKind::second_order, ModelKind::exact}) {
        for (const int modes : {2, 8, 20}) {
            if (kind == ModelKind::exact && modes == 20) continue;  // its rest takes seconds to find
            for (const ContactModel contact : {ContactModel::compliant, ContactModel::restitution}) {
                Problem problem;
                problem.beam.model = kind;
                problem.beam.modes = modes;
                problem.beam.damping_ratio = {0.01};
                problem.contact.model = contact;
                problem.contact.friction = CoulombFriction{};
                problem.initial.shape = InitialShape::resting;
                System system(problem);
                const InitialState state = initial_state(problem);
                for (const bool touching : {false, true}) {
                    Phase phase = state.phase;
                    phase.touching = touching;
                    phase.held = touching && contact == ContactModel::restitution;
                    system.set_phase(phase);
                    EXPECT_EQ(allocations_of_one_call(system, state.y), 0)
                        << name(kind) << ", " << modes << " modes, " << (touching ? "touching" : "in flight");
                }
            }
        }
    }
}

}  // namespace
}  // namespace beamcam::sim

#endif
