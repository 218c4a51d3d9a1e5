#include "sim/observe/observe.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "sim/observe/extrema.hpp"
#include "sim/observe/warnings.hpp"

namespace beamcam::sim {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
// Poses are taken within the first steps of a contact: a collision is over by then, a lasting contact moves slowly.
constexpr int kContactSteps = 4;

}  // namespace

Eye::Eye(const System& system) : system_(system), y_(static_cast<std::size_t>(system_.size)) {}

void Eye::look(double t, const double* y) {
    t_ = t;
    std::copy_n(y, y_.size(), y_.begin());
    books_known_ = contact_known_ = acceleration_known_ = false;
    system_.place(t, y_.data());
}

const ContactState& Eye::contact() {
    if (!contact_known_) {
        contact_ = system_.contact(t_, y_.data(), !system_.phase().touching);
        contact_known_ = true;
    }
    return contact_;
}

const System::Books& Eye::books() {
    if (!books_known_) {
        books_ = system_.books(t_, y_.data());
        books_known_ = true;
    }
    return books_;
}

void Eye::contact_is(const ContactState& contact) {
    contact_ = contact;
    contact_known_ = true;
}

void Eye::gap_is(double gap) {
    books_ = system_.books(t_, y_.data(), gap);
    books_known_ = true;
}

double Eye::value(Channel channel) {
    const int n = system_.coordinates();
    const Model& model = system_.model();
    const bool cam = system_.has_cam();
    switch (channel.kind) {
        case ChannelKind::t:
            return t_;
        case ChannelKind::theta:
            return model.hub_angle();
        case ChannelKind::theta_dot:
            return model.hub_rate();
        case ChannelKind::tip_deflection:
        case ChannelKind::tip_rate: {
            // Across the tangent at the root, which is the hub's direction (S6).
            BeamPoint tip, root;
            model.point(model.length(), tip);
            model.point(0, root);
            const Vec2 along = unit(model.hub_angle()), across = perp(along), span = tip.r - root.r;
            if (channel.kind == ChannelKind::tip_deflection) return dot(span, across);
            return dot(tip.v - root.v, across) - model.hub_rate() * dot(span, along);
        }
        case ChannelKind::contact_force:
            return cam ? contact().force : kNan;
        case ChannelKind::friction_force:
            return cam ? contact().friction : kNan;
        case ChannelKind::gap:
            return cam ? contact().gap : kNan;
        case ChannelKind::contact_x:
            return cam ? contact().x : kNan;
        case ChannelKind::contact_s: {
            if (!cam) return kNan;
            const double turn = std::atan2(contact().normal.y, contact().normal.x) - system_.cam(t_).angle;
            const double full = 2 * std::numbers::pi;
            return system_.problem().cam->radius * (turn - full * std::floor(turn / full));
        }
        case ChannelKind::cam_angle:
            return cam ? system_.cam(t_).angle : kNan;
        case ChannelKind::q:
            return channel.index < n ? y_[static_cast<std::size_t>(channel.index)] : kNan;
        case ChannelKind::energy_kinetic:
            return books().energies.kinetic;
        case ChannelKind::energy_potential:
            return books().energies.gravity;
        case ChannelKind::energy_elastic:
            return books().energies.elastic;
        case ChannelKind::energy_contact:
            return cam ? books().contact : kNan;
        case ChannelKind::loss_structural:
            return books().loss_structural;
        case ChannelKind::loss_contact:
            return cam ? books().loss_contact : kNan;
        case ChannelKind::loss_friction:
            return cam ? books().loss_friction : kNan;
        case ChannelKind::work_cam:
            return cam ? books().work_cam : kNan;
        case ChannelKind::work_drive:
            return books().work_drive;
        case ChannelKind::energy_residual:
            return books().total() - start_total_;
        case ChannelKind::separation:
        case ChannelKind::separation_paper: {
            if (!cam) return kNan;
            const ContactState c = contact();
            if (!acceleration_known_) {
                double acc[kMaxSize];
                system_.acceleration(t_, y_.data(), acc);
                hub_acceleration_ = 0;
                for (int i = 0; i < n; ++i) hub_acceleration_ += model.hub_row()[i] * acc[i];
                acceleration_known_ = true;
                system_.place(t_, y_.data());
            }
            // The paper's eq. (6) and the same with the sign that N ≥ 0 gives: J θ̈ = N x − ½mgL cos θ (S41).
            BeamPoint p, root;
            model.point(c.x, p);
            model.point(0, root);
            const Vec2 along = unit(model.hub_angle()), span = p.r - root.r;
            const double deflection = dot(span, perp(along)), arm = std::hypot(c.x, deflection);
            const double pull =
                3 * c.x * system_.problem().gravity * std::cos(model.hub_angle()) / (2 * model.length());
            return hub_acceleration_ * arm + (channel.kind == ChannelKind::separation ? pull : -pull);
        }
    }
    return kNan;
}

Pose Eye::pose(int stations) {
    const Model& model = system_.model();
    Pose pose;
    pose.t = t_;
    pose.theta = model.hub_angle();
    pose.theta_dot = model.hub_rate();
    pose.centreline.reserve(static_cast<std::size_t>(stations));
    pose.moment.reserve(static_cast<std::size_t>(stations));
    for (int i = 0; i < stations; ++i) {
        const double x = model.length() * i / (stations - 1);
        BeamPoint p;
        model.point(x, p);
        pose.centreline.push_back(p.r);
        pose.moment.push_back(model.bending_moment(x));
    }
    if (!system_.has_cam()) return pose;
    const Cam& cam = *system_.problem().cam;
    const CamPose at = system_.cam(t_);
    const ContactState& c = contact();
    pose.cam_centre = cam.centre;
    pose.disc_centre = at.disc;
    pose.cam_angle = at.angle;
    Nearest nearest;
    nearest.x = c.x;
    nearest.s = value({ChannelKind::contact_s});
    nearest.point = at.disc + cam.radius * c.normal;
    nearest.normal = c.normal;
    nearest.gap = c.gap;
    nearest.force = c.force;
    nearest.friction = c.friction;
    nearest.touching = system_.phase().touching;
    pose.nearest = nearest;
    return pose;
}

// ---- recorder --------------------------------------------------------------------------------

Recorder::Recorder(const System& system, const Request& request, double end)
    : problem_(system.problem()),
      request_(request),
      eye_(system),
      finder_(std::make_unique<ExtremaFinder>(system, request.extrema)),
      y_(static_cast<std::size_t>(eye_.system().size)),
      end_(end) {
    const auto ordered = [](const std::vector<double>& times) {
        Cursor cursor;
        cursor.order.resize(times.size());
        std::iota(cursor.order.begin(), cursor.order.end(), std::size_t{0});
        std::stable_sort(cursor.order.begin(), cursor.order.end(),
                         [&](std::size_t a, std::size_t b) { return times[a] < times[b]; });
        return cursor;
    };
    for (const TableRequest& table : request.tables) {
        table_cursors_.push_back(ordered(table.times));
        Table out;
        out.channels = table.channels;
        out.values.assign(table.channels.size(), std::vector<double>(table.times.size(), kNan));
        result_.tables.push_back(std::move(out));
        refined_.push_back({{}, {}, std::vector<std::vector<double>>(table.channels.size())});
    }
    for (const PoseRequest& poses : request.poses) {
        pose_cursors_.push_back(ordered(poses.times));
        contact_poses_.push_back(0);
        result_.poses.emplace_back(poses.take ? 0 : poses.times.size());
    }
    for (const PointRequest& points : request.points) {
        point_cursors_.push_back(ordered(points.times));
        result_.points.emplace_back(points.times.size());
    }
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    result_.extrema.assign(request.extrema.size(), {kInfinity, 0, -kInfinity, 0});
}

Recorder::Recorder(Recorder&&) noexcept = default;
Recorder::~Recorder() = default;

void Recorder::begin(const Phase& first_phase, const std::vector<double>& y) {
    phase(first_phase);
    eye_.look(0, y.data());
    start_total_ = eye_.books().total();
    eye_.set_start_energy(start_total_);
    const double lever = problem_.hub.radius + 0.5 * problem_.beam.length;
    result_.energy_scale = std::fabs(problem_.beam.line_density() * problem_.beam.length * problem_.gravity * lever);
    finder_->begin(start_total_, y.data(), result_.extrema);
    note_balance();
}

void Recorder::phase(const Phase& phase) {
    eye_.set_phase(phase);
    finder_->set_phase(phase);
}

template <class F>
void Recorder::sweep(const std::vector<double>& times, Cursor& cursor, const Stretch& s, F&& visit) {
    while (cursor.next < cursor.order.size()) {
        const std::size_t row = cursor.order[cursor.next];
        const double t = times[row];
        if (s.ends_before(t)) return;
        look(s, t);
        visit(row);
        ++cursor.next;
    }
}

void Recorder::look(const Stretch& s, double t) {
    s.segment->value(std::max(t, s.from), y_.data());
    eye_.look(t, y_.data());
    eye_.system().search_again();
}

// Charts and traces ask for the same instants: each is looked at once for all of them.
void Recorder::sample_tables(const Stretch& s) {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    const auto next = [&](std::size_t i) {
        const Cursor& cursor = table_cursors_[i];
        return cursor.next < cursor.order.size() ? request_.tables[i].times[cursor.order[cursor.next]] : kNone;
    };
    for (;;) {
        double t = kNone;
        for (std::size_t i = 0; i < request_.tables.size(); ++i) t = std::min(t, next(i));
        if (t == kNone || s.ends_before(t)) return;
        look(s, t);
        for (std::size_t i = 0; i < request_.tables.size(); ++i) {
            const std::vector<Channel>& channels = request_.tables[i].channels;
            for (; next(i) == t; ++table_cursors_[i].next)
                for (std::size_t c = 0; c < channels.size(); ++c)
                    result_.tables[i].values[c][table_cursors_[i].order[table_cursors_[i].next]] =
                        eye_.value(channels[c]);
        }
    }
}

// Between the times of the tables and the ends of the stretch, where the motion may jump: both ends are rows.
void Recorder::refine_curves(const Stretch& s, const std::vector<std::size_t>& before) {
    for (std::size_t i = 0; i < request_.tables.size(); ++i) {
        const TableRequest& table = request_.tables[i];
        if (!table.curve || table.times.empty()) continue;
        const Cursor& cursor = table_cursors_[i];
        const double first = table.times[cursor.order.front()], last = table.times[cursor.order.back()];
        const double from = std::max(s.from, first), to = std::min(s.to, last);
        if (!(to > from)) continue;
        Refined& refined = refined_[i];
        const auto at = [&](double t) {
            look(s, t);
            return Vec2{eye_.value(table.curve->first), eye_.value(table.curve->second)};
        };
        const auto keep = [&](double t) {
            look(s, t);
            refined.times.push_back(t);
            for (std::size_t c = 0; c < table.channels.size(); ++c)
                refined.values[c].push_back(eye_.value(table.channels[c]));
        };
        keep(from);
        double reached = from;
        for (std::size_t k = before[i]; k <= cursor.next; ++k) {
            const double t = k < cursor.next ? std::clamp(table.times[cursor.order[k]], from, to) : to;
            if (!(t > reached)) continue;
            refined.refiner.refine(reached, t, at, keep);
            reached = t;
        }
        keep(to);
    }
}

// The rows of the times and those between them, in the order of time.
void Recorder::merge_refined() {
    for (std::size_t i = 0; i < refined_.size(); ++i) {
        const Refined& refined = refined_[i];
        if (refined.times.empty()) continue;
        std::vector<double> times = request_.tables[i].times;
        times.insert(times.end(), refined.times.begin(), refined.times.end());
        std::vector<std::size_t> order(times.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::stable_sort(order, {}, [&](std::size_t row) { return times[row]; });
        Table& table = result_.tables[i];
        for (std::size_t c = 0; c < table.values.size(); ++c) {
            std::vector<double> all = table.values[c];
            all.insert(all.end(), refined.values[c].begin(), refined.values[c].end());
            for (std::size_t row = 0; row < order.size(); ++row) times[row] = all[order[row]];
            table.values[c] = times;
        }
    }
}

void Recorder::sample(const Stretch& s) {
    std::vector<std::size_t> before;
    for (const Cursor& cursor : table_cursors_) before.push_back(cursor.next);
    sample_tables(s);
    refine_curves(s, before);
    for (std::size_t i = 0; i < request_.poses.size(); ++i) {
        const PoseRequest& poses = request_.poses[i];
        sweep(poses.times, pose_cursors_[i], s, [&](std::size_t row) {
            if (poses.take)
                poses.take(row, eye_.pose(poses.stations));
            else
                result_.poses[i][row] = eye_.pose(poses.stations);
        });
    }
    for (std::size_t i = 0; i < request_.points.size(); ++i) {
        const PointRequest& points = request_.points[i];
        sweep(points.times, point_cursors_[i], s, [&](std::size_t row) {
            BeamPoint p;
            eye_.system().model().point(points.x, p);
            result_.points[i][row] = p.r;
        });
    }
}

// In the middle of the whole step, which is the same wherever the run ends.
void Recorder::contact_poses(const Stretch& s) {
    if (!impact_open_ || contact_steps_ == kContactSteps) return;
    const std::array instants{contact_steps_ == 0 ? s.from : kNan, 0.5 * (s.segment->t0 + s.segment->t1)};
    ++contact_steps_;
    for (std::size_t i = 0; i < request_.poses.size(); ++i) {
        const PoseRequest& poses = request_.poses[i];
        if (poses.times.empty()) continue;
        const double from = poses.times[pose_cursors_[i].order.front()],
                     to = poses.times[pose_cursors_[i].order.back()];
        for (const double t : instants) {
            if (!(t >= std::max(s.from, from) && t <= std::min(s.to, to)) || contact_poses_[i] == poses.contacts)
                continue;
            look(s, t);
            if (poses.take)
                poses.take(poses.times.size() + contact_poses_[i], eye_.pose(poses.stations));
            else
                result_.poses[i].push_back(eye_.pose(poses.stations));
            ++contact_poses_[i];
        }
    }
    eye_.system().search_again();
}

void Recorder::contact_peaks(const Stretch& s) {
    if (!impact_open_) return;
    Impact& impact = result_.impacts.back();
    finder_->contact_peaks(s, impact.force_peak, impact.penetration_peak);
}

void Recorder::note_balance() {
    const System::Books& books = eye_.books();
    largest_elastic_ = std::max(largest_elastic_, books.energies.elastic);
    result_.energy_scale = std::max({result_.energy_scale, books.energies.kinetic, books.energies.elastic});
    result_.energy_residual_max = std::max(result_.energy_residual_max, std::fabs(books.total() - start_total_));
}

// The energy balance where a step ends and, in contact, where only the dense output knows the force, inside it.
void Recorder::ledger(const Stretch& s) {
    const TouchSamples* samples = s.segment->touch();
    for (const double share : {1.0 / 3, 2.0 / 3, 1.0}) {
        if (share < 1 && (!impact_open_ || samples)) continue;
        const double t = share < 1 ? s.from + share * (s.to - s.from) : s.to;
        s.segment->value(t, y_.data());
        eye_.look(t, y_.data());
        if (samples && t == s.segment->t1) eye_.gap_is(samples->gap[TouchSamples::kCount - 1]);
        note_balance();
    }
}

void Recorder::stretch(const Stretch& s, Notes* made) {
    if (!(s.to > s.from) && !s.last) return;
    const std::size_t apexes = result_.apexes.size(), zeros = result_.theta_zero.size();
    // Each observer starts its search of the contact afresh, so that none sees what another looked at:
    // the last bits of a foot point depend on where its iteration began.
    sample(s);
    contact_poses(s);
    if (s.to > s.from) {
        if (request_.turning_points) finder_->turning_points(s, result_.apexes, result_.theta_zero);
        contact_peaks(s);
        finder_->step(s, result_.extrema);
    }
    eye_.system().search_again();
    ledger(s);
    if (!made) return;
    made->turning_points = request_.turning_points;
    made->apexes.assign(result_.apexes.begin() + static_cast<std::ptrdiff_t>(apexes), result_.apexes.end());
    made->theta_zero.assign(result_.theta_zero.begin() + static_cast<std::ptrdiff_t>(zeros), result_.theta_zero.end());
    if (impact_open_) {
        made->force_peak = result_.impacts.back().force_peak;
        made->penetration_peak = result_.impacts.back().penetration_peak;
    }
    made->energy_scale = result_.energy_scale;
    made->energy_residual_max = result_.energy_residual_max;
    made->largest_elastic = largest_elastic_;
}

void Recorder::stretch(const Stretch& s, const Notes& known) {
    if (!(s.to > s.from)) return;
    sample(s);
    contact_poses(s);
    eye_.system().search_again();
    finder_->step(s, result_.extrema);
    if (request_.turning_points && known.turning_points) {
        result_.apexes.insert(result_.apexes.end(), known.apexes.begin(), known.apexes.end());
        result_.theta_zero.insert(result_.theta_zero.end(), known.theta_zero.begin(), known.theta_zero.end());
    } else if (request_.turning_points) {
        finder_->turning_points(s, result_.apexes, result_.theta_zero);
    }
    if (impact_open_) {
        result_.impacts.back().force_peak = known.force_peak;
        result_.impacts.back().penetration_peak = known.penetration_peak;
    }
    result_.energy_scale = known.energy_scale;
    result_.energy_residual_max = known.energy_residual_max;
    largest_elastic_ = known.largest_elastic;
}

void Recorder::touch(double t, const double* y, const ContactState& c) {
    const double* ledger = y + eye_.system().controlled;
    impact_open_ = true;
    contact_steps_ = 0;
    books_at_touch_lost_ = ledger[kNormalWork] + ledger[kFrictionWork];
    impulse_n_at_touch_ = ledger[kImpulseN];
    impulse_t_at_touch_ = ledger[kImpulseT];
    Impact impact;
    impact.t_start = t;
    impact.x = c.x;
    impact.cam_angle = eye_.system().cam(t).angle;
    impact.v_n_before = c.gap_rate;
    impact.v_t_before = c.slip;
    impact.penetration_peak = std::max(0.0, -c.gap);
    if (problem_.contact.model == ContactModel::compliant) impact.force_peak = c.force;
    std::vector<Collision>& collisions = result_.collisions;
    const bool joins = !collisions.empty() && t - collisions.back().t_end.value_or(t) < problem_.contact.collision_gap;
    if (!joins) {
        Collision collision;
        collision.t_start = t;
        collision.x = c.x;
        collision.v_n_before = c.gap_rate;
        collisions.push_back(collision);
    }
    Collision& collision = collisions.back();
    ++collision.count;
    collision.t_end.reset();
    collision.v_n_after.reset();
    collision.restitution.reset();
    impact.collision = static_cast<int>(collisions.size()) - 1;
    result_.impacts.push_back(impact);
}

void Recorder::release(double t, const double* y, const ContactState& c) {
    Impact& impact = result_.impacts.back();
    impact.t_end = t;
    impact.duration = t - impact.t_start;
    impact.v_n_after = c.gap_rate;
    impact.v_t_after = c.slip;
    if (impact.v_n_before < 0) impact.restitution = -c.gap_rate / impact.v_n_before;
    settle(y);
    impact_open_ = false;
    Collision& collision = result_.collisions.back();
    collision.t_end = t;
    collision.v_n_after = c.gap_rate;
    if (collision.v_n_before < 0) collision.restitution = -c.gap_rate / collision.v_n_before;
}

// Impulses and losses of the open impact up to the state y.
void Recorder::settle(const double* y) {
    Impact& impact = result_.impacts.back();
    Collision& collision = result_.collisions.back();
    const double* ledger = y + eye_.system().controlled;
    impact.impulse_n = ledger[kImpulseN] - impulse_n_at_touch_;
    impact.impulse_t = ledger[kImpulseT] - impulse_t_at_touch_;
    impact.energy_lost = ledger[kNormalWork] + ledger[kFrictionWork] - books_at_touch_lost_;
    if (impact.force_peak) collision.force_peak = std::max(collision.force_peak.value_or(0), *impact.force_peak);
    collision.energy_lost += impact.energy_lost;
}

void Recorder::finish(double t, const double* y, const Tally& tally) {
    merge_refined();
    if (impact_open_) {
        eye_.look(t, y);
        settle(y);
        result_.impacts.back().energy_lost -= eye_.books().contact;  // what is stored is not lost
        result_.collisions.back().energy_lost -= eye_.books().contact;
    }
    finder_->finish(result_.extrema);
    // Channels that are undefined all along have no extrema.
    for (Extremum& e : result_.extrema)
        if (e.min > e.max) e = {kNan, kNan, kNan, kNan};
    result_.end_time = t;
    result_.counters = tally.counters;
    const Method method = problem_.solver.method;
    for (const auto& [by, steps] : {std::pair{method == Method::automatic ? Method::exponential : method,
                                              tally.counters.steps - tally.fallbacks.steps},
                                    std::pair{tally.fallbacks.method, tally.fallbacks.steps}})
        if (steps > 0) result_.steps_by_method.emplace_back(by, steps);
    result_.beyond_model = bends_beyond(problem_, largest_elastic_);
    Tally all = tally;
    all.fallbacks.searches = finder_->incomplete();
    result_.warnings = warnings(problem_, result_, all, largest_elastic_);
}

// ---- audience --------------------------------------------------------------------------------

double end_of(const Request& request) {
    double end = request.end_time;
    const auto extend = [&](const std::vector<double>& times) {
        for (double t : times) end = std::max(end, t);
    };
    for (const TableRequest& table : request.tables) extend(table.times);
    for (const PoseRequest& poses : request.poses) extend(poses.times);
    for (const PointRequest& points : request.points) extend(points.times);
    return end;
}

Audience::Audience(const System& system, std::span<const Request> requests) : done_(requests.size(), 0) {
    recorders_.reserve(requests.size());
    for (const Request& request : requests) {
        recorders_.emplace_back(system, request, end_of(request));
        end_ = std::max(end_, recorders_.back().end());
    }
}

void Audience::begin(const Phase& phase, const std::vector<double>& y) {
    y_.resize(y.size());
    for (Recorder& r : recorders_) r.begin(phase, y);
}

void Audience::finish(Recorder& recorder, double t, const double* y, const TallySource& tally) {
    recorder.finish(t, y, tally());
    done_[static_cast<std::size_t>(&recorder - recorders_.data())] = 1;
}

const Notes* Audience::stretch(const Segment& segment, double from, double to, bool event, const TallySource& tally,
                               const Notes* known) {
    for (Recorder& r : recorders_) {
        if (!listens(r)) continue;
        const bool ends = r.end() < to || (r.end() == to && !event);
        if (ends) {
            r.stretch({&segment, from, r.end(), true});
            segment.value(r.end(), y_.data());
            finish(r, r.end(), y_.data(), tally);
        } else if (known) {
            r.stretch({&segment, from, to, false}, *known);
        } else {
            r.stretch({&segment, from, to, false}, &notes_);
            known = &notes_;
        }
    }
    return known;
}

void Audience::touch(double t, const double* y, const ContactState& contact) {
    for (Recorder& r : recorders_)
        if (listens(r)) r.touch(t, y, contact);
}

void Audience::release(double t, const double* y, const ContactState& contact) {
    for (Recorder& r : recorders_)
        if (listens(r)) r.release(t, y, contact);
}

namespace {

// The end of a run that falls on an instant without a segment of its own.
struct PointSegment final : Segment {
    PointSegment(double t, const std::vector<double>& state) : y(state) { t0 = t1 = t; }
    void value(double, double* out) const override { std::copy(y.begin(), y.end(), out); }
    const std::vector<double>& y;
};

}  // namespace

void Audience::resume(double t, const std::vector<double>& y, const Phase& phase, const TallySource& tally) {
    for (Recorder& r : recorders_) {
        if (!listens(r)) continue;
        r.phase(phase);
        if (r.end() > t) continue;
        const PointSegment point(t, y);
        r.stretch({&point, t, t, true});
        finish(r, t, y.data(), tally);
    }
}

void Audience::give_up(double t, const std::vector<double>& y, const TallySource& tally) {
    for (Recorder& r : recorders_)
        if (listens(r)) finish(r, t, y.data(), tally);
}

std::vector<Result> Audience::results() {
    std::vector<Result> all;
    for (Recorder& r : recorders_) all.push_back(std::move(r.result()));
    return all;
}

}  // namespace beamcam::sim
