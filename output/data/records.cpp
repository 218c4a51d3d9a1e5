#include "output/data/records.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "output/data/tables.hpp"
#include "output/files/atomic_file.hpp"
#include "output/json/tree.hpp"

namespace beamcam::output {

namespace {

// Calls visit(name, value) for every field, in the order of JSON and CSV.
template <typename Visit>
void for_each_field(const sim::Impact& i, Visit visit) {
    visit("t_start", i.t_start);
    visit("t_end", i.t_end);
    visit("x", i.x);
    visit("cam_angle", i.cam_angle);
    visit("v_n_before", i.v_n_before);
    visit("v_t_before", i.v_t_before);
    visit("v_n_after", i.v_n_after);
    visit("v_t_after", i.v_t_after);
    visit("duration", i.duration);
    visit("force_peak", i.force_peak);
    visit("penetration_peak", i.penetration_peak);
    visit("impulse_n", i.impulse_n);
    visit("impulse_t", i.impulse_t);
    visit("restitution", i.restitution);
    visit("energy_lost", i.energy_lost);
    visit("collision", i.collision);
    if (!i.at_touch) return;
    const auto state = [&](const std::optional<sim::TouchState>& at, const std::string& suffix) {
        const auto value = [&](double known) { return at ? std::optional(known) : std::nullopt; };
        const sim::TouchState& some = at ? *at : *i.at_touch;
        visit("theta" + suffix, value(some.theta));
        visit("theta_dot" + suffix, value(some.theta_dot));
        visit("contact_s" + suffix, value(some.contact_s));
        for (std::size_t k = 0; k < some.q.size(); ++k) visit("q" + std::to_string(k + 1) + suffix, value(some.q[k]));
    };
    state(i.at_touch, "");
    state(i.at_release, "_after");
}

template <typename Visit>
void for_each_field(const sim::Collision& c, Visit visit) {
    visit("t_start", c.t_start);
    visit("t_end", c.t_end);
    visit("count", c.count);
    visit("x", c.x);
    visit("v_n_before", c.v_n_before);
    visit("v_n_after", c.v_n_after);
    visit("restitution", c.restitution);
    visit("force_peak", c.force_peak);
    visit("energy_lost", c.energy_lost);
}

template <typename Record>
Node array_of(const std::vector<Record>& records) {
    return array_node(records, [](const Record& record) {
        Node object = object_node();
        for_each_field(record, [&object](const std::string& name, const auto& value) { add(object, name, value); });
        return object;
    });
}

Node units(const sim::Problem& problem, const std::vector<ChannelExtremum>& extrema) {
    Node map = object_node({{"t", "s"}});
    for (const auto& [channel, e] : extrema) add(map, sim::name(channel), sim::unit(channel, problem));
    return map;
}

Node extrema_node(const std::vector<ChannelExtremum>& extrema) {
    Node map = object_node();
    for (const auto& [channel, e] : extrema)
        add(map, sim::name(channel),
            object_node({{"min", e.min}, {"t_min", e.t_min}, {"max", e.max}, {"t_max", e.t_max}}));
    return map;
}

void add_reproducibility(const sim::Result& result, Node& out) {
    add(out, "reproducible_until", result.reproducible_until);
    add(out, "not_reproducible", array_node(result.not_reproducible, [](const sim::Interval& lost) {
            return array_node({lost.from, lost.to});
        }));
    if (result.reproducible_again_from) add(out, "reproducible_again_from", result.reproducible_again_from);
    add(out, "compared_with", result.compared_with);
    add(out, "reproducibility", result.reproducibility);
}

Node timing_node(const sim::Timing& time) {
    if (time.repeats == 0) return {};
    return object_node({{"median", time.median}, {"low", time.low}, {"high", time.high}, {"repeats", time.repeats}});
}

// `identity`: the object of the keys that identify a row.
template <class Row, class Identity>
Node accuracy_rows(const std::vector<Row>& rows, Identity identity) {
    return array_node(rows, [&](const Row& row) {
        Node out = identity(row);
        add(out, "error", row.error);
        if (!row.error) {
            add(out, "note", row.note);
            return out;
        }
        add(out, "trusted_until", row.trusted_until);
        add(out, "seconds", timing_node(row.time));
        add(out, "steps", row.steps);
        add(out, "rhs_evaluations", row.rhs_evaluations);
        add(out, "impacts", row.impacts);
        add(out, "touch_error", row.touch_error);
        return out;
    });
}

// The impacts alone.
ColumnTable impacts_table(const sim::Result& result) {
    ColumnTable table;
    for_each_field(result.impacts.empty() ? sim::Impact{} : result.impacts.front(),
                   [&table](const std::string& name, const auto&) { table.columns.push_back({name}); });
    for (const sim::Impact& impact : result.impacts) {
        auto column = table.columns.begin();
        for_each_field(impact, [&](const std::string&, const std::optional<double>& value) {
            if (column == table.columns.end()) throw std::logic_error("impacts have different fields");
            (column++)->values.push_back(value.value_or(std::numeric_limits<double>::quiet_NaN()));
        });
    }
    return table;
}

// The turn φ = −ψ of the cam at an instant, from 0 to 2π.
double turn_of(const sim::Problem& problem, double t) {
    return 2 * std::numbers::pi *
           sim::turn_fraction((problem.cam->speed * t - problem.cam->phase) / (2 * std::numbers::pi));
}

// The intervals without contact in the last turn of the cam, and where on the cam the largest force acts.
void add_turn(const sim::Problem& problem, const sim::Result& result, const std::vector<ChannelExtremum>& extrema,
              Node& out) {
    for (const ChannelExtremum& e : extrema)
        if (e.channel.kind == sim::ChannelKind::contact_force)
            add(out, "phi_of_largest_force", turn_of(problem, e.extremum.t_max));
    const double turn = cam_period(problem), end = result.end_time, begin = end - turn;
    if (problem.cam->speed == 0 || begin < 0) return;
    Node apart = array_node();
    const auto add_flight = [&](double from, double to) {
        if (from < to)
            apart.items.push_back(object_node(
                {{"from", from}, {"to", to}, {"phi_from", turn_of(problem, from)}, {"phi_to", turn_of(problem, to)}}));
    };
    double left = begin;  // since then the beam is apart
    for (const sim::Impact& impact : result.impacts) {
        const double until = impact.t_end.value_or(end);
        if (until < begin) continue;
        add_flight(left, impact.t_start);
        left = std::max(left, until);
    }
    add_flight(left, end);
    add(out, "apart_in_last_turn", std::move(apart));
}

// Differences are measured minus computed, in the channel's unit.
Node agreement_node(const Agreement& each, const char* unit) {
    Node out = object_node({{"label", each.label},
                            {"file", each.file},
                            {"channel", sim::name(each.channel)},
                            {"unit", unit},
                            {"rows", each.rows}});
    if (each.rows > 0) add(out, "rms", each.rms);
    return out;
}

}  // namespace

std::string impacts_json(const sim::Result& result) {
    Node out = object_node();
    add(out, "impacts", array_of(result.impacts));
    add(out, "collisions", array_of(result.collisions));
    return to_text(out);
}

void write_impacts(const FileTarget& file, const sim::Result& result) {
    const std::string ending = file.path.extension().string();
    if (ending == ".json") return write_file(file, impacts_json(result));
    if (ending == ".csv") return write_table(file, impacts_table(result));
    throw UnsupportedOption("cannot write " + file.path.string() + ": impacts end in .json or .csv");
}

std::string summary_json(const sim::Problem& problem, const sim::Result& result,
                         const std::vector<ChannelExtremum>& extrema, const std::vector<Agreement>& data) {
    Node steps = object_node();
    for (const auto& [method, count] : result.steps_by_method) add(steps, sim::name(method), count);
    Node zeros = array_node(result.theta_zero, [](const sim::ZeroCrossing& zero) {
        return object_node({{"t", zero.t}, {"theta_dot", zero.theta_dot}});
    });

    Node out = object_node({{"units", units(problem, extrema)},
                            {"model", sim::name(problem.beam.model)},
                            {"modes", problem.beam.model == sim::ModelKind::rigid ? 0 : problem.beam.modes},
                            {"end_time", result.end_time},
                            {"steps", result.counters.steps},
                            {"steps_by_method", std::move(steps)},
                            {"rhs_evaluations", result.counters.rhs_evaluations},
                            {"wall_seconds", result.wall_seconds},
                            {"events", object_node({{"theta_zero", std::move(zeros)}})},
                            {"extrema", extrema_node(extrema)},
                            {"energy_residual_max", result.energy_residual_max},
                            {"energy_scale", result.energy_scale},
                            {"impacts", result.impacts.size()},
                            {"collisions", result.collisions.size()}});
    if (problem.cam && problem.cam->profile) add_turn(problem, result, extrema, out);
    if (result.reproducible_until) add_reproducibility(result, out);
    if (!data.empty())
        add(out, "data",
            array_node(data, [&](const Agreement& each) { return agreement_node(each, unit(each.channel, problem)); }));
    add(out, "warnings", result.warnings);
    return to_text(out);
}

std::string modes_json(const std::vector<sim::Mode>& modes) {
    const auto point = [](const sim::Vec2& at) { return array_node({at.x, at.y}); };
    return to_text(object_node({{"modes", array_node(modes, [&](const sim::Mode& mode) {
                                     return object_node({{"omega", mode.omega},
                                                         {"hz", mode.omega / (2 * std::numbers::pi)},
                                                         {"shape", array_node(mode.shape, point)},
                                                         {"q", array_node({mode.q.begin(), mode.q.end()})}});
                                 })}}));
}

std::string cam_json(const sim::Lever::Summary& s, const std::optional<sim::BeamJump>& beam) {
    Node all = object_node({{"base_radius", s.base_radius},
                            {"rho_min", s.rho_min},
                            {"rho_min_phi", s.rho_min_phi},
                            {"rho_max", s.rho_max},
                            {"pressure_angle_max", s.pressure_angle_max},
                            {"jump_speed", s.jump ? Node(s.jump->speed) : Node()},
                            {"jump_phi", s.jump ? Node(s.jump->phi) : Node()}});
    if (beam) add(all, "beam_jump_speed", beam->leaves);
    return to_text(all);
}

std::string peak_json(const sim::PeakBudget& budget, const std::string& unit) {
    Node rows = array_node();
    for (const sim::PeakRow& row : budget.rows) {
        Node each = object_node({{"change", row.change}});
        if (row.peak) {
            add(each, "peak", *row.peak);
            add(each, "t", row.t);
            add(each, "relative", relative_change(budget, row));
        } else {
            add(each, "note", row.note);
        }
        rows.items.push_back(std::move(each));
    }
    return to_text(object_node({{"of", name(budget.channel)},
                                {"unit", unit},
                                {"end_time", budget.end_time},
                                {"peak", budget.peak},
                                {"t", budget.t},
                                {"rows", std::move(rows)},
                                {"recommendation", budget.recommendation}}));
}

std::string accuracy_json(const sim::Accuracy& a) {
    Node work = accuracy_rows(a.work, [](const auto& row) {
        return object_node({{"method", sim::name(row.method)}, {"rtol", row.rtol}});
    });
    Node modes = accuracy_rows(a.modes, [](const auto& row) { return object_node({{"modes", row.modes}}); });
    Node models = accuracy_rows(a.models, [](const auto& row) { return object_node({{"model", name(row.model)}}); });
    Node contact = accuracy_rows(a.contact, [](const auto& row) { return object_node({{"change", row.change}}); });
    Node recommendation;
    if (const auto& r = a.recommendation)
        recommendation = object_node({{"rtol", r->rtol},
                                      {"modes", r->modes},
                                      {"until", r->until},
                                      {"error", r->error},
                                      {"seconds", r->seconds},
                                      {"text", r->text}});
    return to_text(object_node(
        {{"of", a.of_tip ? "tip_deflection / length" : "theta"},
         {"units", object_node({{"error", "rad"}, {"seconds", "s"}, {"trusted_until", "s"}, {"touch_error", "s"}})},
         {"end_time", a.end_time},
         {"until", a.until},
         {"reference_method", sim::name(a.reference_method)},
         {"reference_error", a.reference_error},
         {"target", a.target},
         {"time_integration", std::move(work)},
         {"modes", object_node({{"against", a.most_modes}, {"rows", std::move(modes)}})},
         {"models",
          object_node({{"against", sim::name(a.best_model)}, {"until", a.models_until}, {"rows", std::move(models)}})},
         {"contact", std::move(contact)},
         {"recommendation", std::move(recommendation)}}));
}

}  // namespace beamcam::output
