// One integration for several requests: each has the bits of the run that it would have been alone.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

// ---- every number of a result, as bits -----------------------------------------------------------

using Bits = std::vector<std::uint64_t>;

struct Collector {
    Bits bits;
    void operator()(double value) { bits.push_back(std::bit_cast<std::uint64_t>(value)); }
    void operator()(long value) { bits.push_back(static_cast<std::uint64_t>(value)); }
    void operator()(int value) { (*this)(static_cast<long>(value)); }
    void operator()(const Vec2& v) { (*this)(v.x), (*this)(v.y); }
    void operator()(const std::optional<double>& value) {
        (*this)(value.has_value() ? 1L : 0L), (*this)(value.value_or(0));
    }
    void operator()(const Impact& i) {
        (*this)(i.t_start), (*this)(i.t_end), (*this)(i.x), (*this)(i.cam_angle), (*this)(i.v_n_before);
        (*this)(i.v_t_before), (*this)(i.v_n_after), (*this)(i.v_t_after), (*this)(i.duration), (*this)(i.force_peak);
        (*this)(i.penetration_peak), (*this)(i.impulse_n), (*this)(i.impulse_t), (*this)(i.restitution);
        (*this)(i.energy_lost), (*this)(i.collision);
        for (const auto* state : {&i.at_touch, &i.at_release}) {
            if (!*state) continue;
            (*this)((*state)->theta), (*this)((*state)->theta_dot), (*this)((*state)->contact_s);
            for (double q : (*state)->q) (*this)(q);
        }
    }
    void operator()(const Collision& c) {
        (*this)(c.t_start), (*this)(c.t_end), (*this)(c.count), (*this)(c.x), (*this)(c.v_n_before);
        (*this)(c.v_n_after), (*this)(c.restitution), (*this)(c.force_peak), (*this)(c.energy_lost);
    }
    void operator()(const Pose& p) {
        (*this)(p.t), (*this)(p.theta), (*this)(p.theta_dot), (*this)(p.cam_angle);
        for (Vec2 r : p.centreline) (*this)(r);
        for (double m : p.moment) (*this)(m);
        if (p.nearest) (*this)(p.nearest->gap), (*this)(p.nearest->force), (*this)(p.nearest->x), (*this)(p.nearest->s);
    }
};

Bits bits_of(const Result& r) {
    Collector put;
    put(r.end_time), put(r.energy_residual_max), put(r.energy_scale), put(r.reproducible_until);
    put(r.counters.steps), put(r.counters.rejected), put(r.counters.rhs_evaluations);
    put(r.counters.gap_evaluations);
    for (const Table& table : r.tables)
        for (const auto& column : table.values)
            for (double value : column) put(value);
    for (const auto& poses : r.poses)
        for (const Pose& pose : poses) put(pose);
    for (const auto& path : r.points)
        for (Vec2 point : path) put(point);
    for (const Impact& i : r.impacts) put(i);
    for (const Collision& c : r.collisions) put(c);
    for (const ZeroCrossing& z : r.theta_zero) put(z.t), put(z.theta_dot);
    for (const Apex& a : r.apexes) put(a.t), put(a.theta);
    for (const Extremum& e : r.extrema) put(e.min), put(e.t_min), put(e.max), put(e.t_max);
    return put.bits;
}

void expect_equal(const Result& a, const Result& b) {
    EXPECT_EQ(a.end_time, b.end_time);
    EXPECT_EQ(a.counters.rhs_evaluations, b.counters.rhs_evaluations);
    EXPECT_EQ(a.counters.gap_evaluations, b.counters.gap_evaluations);
    EXPECT_EQ(a.impacts.size(), b.impacts.size());
    EXPECT_EQ(a.energy_residual_max, b.energy_residual_max);
    EXPECT_EQ(a.warnings, b.warnings);
    EXPECT_TRUE(bits_of(a) == bits_of(b));
}

// Asks for something of everything.
Request full_request(const Problem& problem, double end) {
    Request request;
    request.end_time = end;
    std::vector<double> times;
    for (int k = 0; k <= 14; ++k) times.push_back(end * k / 14);
    request.tables.push_back({times, all_channels(problem)});
    request.poses.push_back({times, 9});
    request.points.push_back({0.5 * problem.beam.length, times});
    for (const Channel c : all_channels(problem))
        if (c.kind == ChannelKind::contact_force || c.kind == ChannelKind::tip_deflection) request.extrema.push_back(c);
    return request;
}

struct NamedCase {
    const char* name;
    Problem problem;
    double end;
};

std::vector<NamedCase> cases() {
    std::vector<NamedCase> all;
    const auto add = [&](const char* name, double end, auto&& change) {
        Problem p;
        change(p);
        all.push_back({name, p, end});
    };
    add("Default", 0.3, [](Problem&) {});
    add("Rigid", 0.4, [](Problem& p) { p.beam.model = ModelKind::rigid; });
    add("Exact", 0.15, [](Problem& p) {
        p.beam.model = ModelKind::exact;
        p.beam.modes = 1;
        p.initial.angular_velocity = -3;
    });
    add("SecondOrder", 0.15, [](Problem& p) {
        p.beam.model = ModelKind::second_order;
        p.initial.angular_velocity = -3;
    });
    add("Paper", 0.285, [](Problem& p) { p.beam.model = ModelKind::paper; });
    add("NoCam", 0.2, [](Problem& p) { p.cam.reset(); });
    add("StickSlip", 0.3, [](Problem& p) { p.contact.friction = StickSlipFriction{0.3, 0.4, {}}; });
    // The peak of the force differs in its last digits if its search goes on from an earlier search of the contact.
    add("StickSlipTurned", 0.3, [](Problem& p) {
        p.contact.friction = StickSlipFriction{0.3, 0.4, {}};
        p.cam->phase = 2e-3;
    });
    add("Coulomb", 0.3, [](Problem& p) { p.contact.friction = CoulombFriction{}; });
    add("Newton", 0.7, [](Problem& p) { p.contact.model = ContactModel::restitution; });
    add("Plastic", 0.7, [](Problem& p) {
        p.contact.model = ContactModel::restitution;
        p.contact.restitution = 0;
    });
    add("Resting", 0.1, [](Problem& p) {
        p.initial.shape = InitialShape::resting;
        p.cam->speed = 5;
    });
    add("SpinUp", 0.25, [](Problem& p) {
        p.cam.reset();
        p.hub.drive = SpinUp{4, 0.2};
    });
    add("TorqueTable", 0.3, [](Problem& p) { p.hub.drive = TorqueTable{{0, 0.1, 0.25}, {0, 0.2, 0}}; });
    add("Exponential", 0.3, [](Problem& p) {
        p.solver.method = Method::automatic;
        p.beam.modes = 6;
        p.beam.damping_ratio = {0.01};
    });
    add("Rk8", 0.3, [](Problem& p) { p.solver.method = Method::rk8; });
    add("Adams", 0.3, [](Problem& p) {
        p.solver.method = Method::cvode_adams;
        p.solver.rtol = 1e-6;
    });
    add("Bdf", 0.3, [](Problem& p) {
        p.solver.method = Method::cvode_bdf;
        p.solver.rtol = 1e-6;
    });
    return all;
}

class Everything : public ::testing::TestWithParam<NamedCase> {};

TEST_P(Everything, OneRunForManyGivesEachTheBitsOfItsOwn) {
    const auto& [name, problem, end] = GetParam();
    if (problem.beam.model > ModelKind::paper) SKIP_UNDER_SANITIZERS();
    std::vector<Request> requests;
    for (double share : {0.3, 1.0, 0.0}) requests.push_back(full_request(problem, share * end));
    requests.push_back({});
    requests[3].end_time = 0.97 * end;
    // The instants of the second once more, some of them in two tables, with the same curve and poses in contact.
    Request again = full_request(problem, end);
    again.tables.push_back(again.tables.front());
    again.tables.back().times.resize(9);
    again.tables.back().curve = {{ChannelKind::theta, 0}, {ChannelKind::theta_dot, 0}};
    again.poses.front().contacts = 4;
    requests.insert(requests.end(), 2, again);
    Effort effort;
    const std::vector<Result> together = simulate(problem, requests, {}, &effort);
    EXPECT_EQ(effort.integrations, 1);
    for (std::size_t i = 0; i < requests.size(); ++i) {
        SCOPED_TRACE(::testing::Message() << "request " << i);
        expect_equal(together[i], simulate(problem, requests[i]));
    }
}

INSTANTIATE_TEST_SUITE_P(Of, Everything, ::testing::ValuesIn(cases()),
                         [](const auto& each) { return std::string(each.param.name); });

// Apexes and zero crossings are searched only on request, and nothing else depends on the search.
TEST(SharedRuns, OfApexesAndZerosLeaveEverythingElseAsItIs) {
    for (const Method method : {Method::automatic, Method::rk8}) {
        Problem problem;
        problem.solver.method = method;
        problem.cam.reset();
        problem.initial.angular_velocity = 2;  // it rises, turns back and falls past the horizontal
        const Request with = [&] {
            Request request = full_request(problem, 0.8);
            request.apexes = request.zero_crossings = true;
            return request;
        }();
        Request without = with;
        without.apexes = without.zero_crossings = false;
        const Result direct = simulate(problem, with);
        ASSERT_FALSE(direct.apexes.empty());
        ASSERT_FALSE(direct.theta_zero.empty());
        Result bare = direct;
        bare.apexes.clear(), bare.theta_zero.clear();
        expect_equal(simulate(problem, without), bare);
        const Request both[] = {without, with};
        const std::vector<Result> together = simulate(problem, both);
        expect_equal(together[0], bare);
        expect_equal(together[1], direct);
    }
}

// A run that ends at an event has the same results up to there as a longer one.
TEST(SharedRuns, OfAsManyEventsAsAreEnoughEndAtTheLastOfThem) {
    const Problem problem;
    Request request;
    request.end_time = 1.5;
    const Result whole = simulate(problem, request);
    ASSERT_GT(whole.collisions.size(), 1u);
    const std::pair<EventCounts, double> cases[] = {{{.touches = 3}, whole.impacts[2].t_start},
                                                    {{.releases = 2}, *whole.impacts[1].t_end},
                                                    {{.collisions = 2}, whole.collisions[1].t_start},
                                                    {{.touches = 1, .collisions = 2}, whole.collisions[1].t_start},
                                                    {{.touches = 100'000}, 1.5}};
    for (const auto& [enough, end] : cases) {
        SCOPED_TRACE(::testing::Message() << "until " << end);
        request.enough = enough;
        const Result found = simulate(problem, request);
        EXPECT_EQ(found.end_time, end);
        ASSERT_LE(found.impacts.size(), whole.impacts.size());
        for (std::size_t i = 0; i < found.impacts.size(); ++i)
            EXPECT_EQ(found.impacts[i].t_start, whole.impacts[i].t_start);
        if (end < 1.5) {
            EXPECT_LT(found.counters.steps, whole.counters.steps);
        }
    }
}

TEST(Prefix, HoldsInTheStepThatAnEventShortens) {
    // Just before a touch a shorter run must show the step that the longer run takes, which ends at the touch.
    const Problem problem;
    const Result longer = run(problem, 1.0);
    for (std::size_t i = 0; i < 2; ++i) {
        const double touch = longer.impacts.at(i).t_start;
        const std::vector<double> times{touch - 3e-4, touch - 2e-4, touch - 1e-4};
        Request request;
        request.tables.push_back({times, all_channels(problem)});
        const Result shorter = simulate(problem, request);
        request.end_time = touch + 0.01;
        const Result same = simulate(problem, request);
        for (std::size_t c = 0; c < shorter.tables[0].values.size(); ++c)
            for (std::size_t row = 0; row < times.size(); ++row)
                EXPECT_EQ(std::bit_cast<std::uint64_t>(shorter.tables[0].values[c][row]),
                          std::bit_cast<std::uint64_t>(same.tables[0].values[c][row]))
                    << name(shorter.tables[0].channels[c]) << " " << i;
    }
}

}  // namespace
}  // namespace beamcam::sim::testing
