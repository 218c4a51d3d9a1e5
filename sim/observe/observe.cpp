#include "sim/observe/observe.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "sim/base/numerics.hpp"
#include "sim/integrate/collocation.hpp"
#include "sim/observe/warnings.hpp"

namespace beamcam::sim {
namespace {

constexpr int kMaxLooks = 24;       // looks at most, at a step that resolves the vibration
constexpr double kMostLooks = 1e5;  // and at one that spans many periods
// At such a step, for extremes: a faster vibration is met at all its phases, if not in every period.
constexpr int kExtremeLooks = 100;
constexpr std::size_t kMostPeaks = 4;
constexpr long kPatience = 200;     // peaks of one channel that may turn out to be no higher, …
constexpr double kNoHigher = 1e-9;  // … by this share
// The rise of a peak above its sample over that of the parabola: 1.09 for a vibration with 1.5 samples a radian.
constexpr double kSteeper = 1.1;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
// Poses are taken within the first steps of a contact: a collision is over by then, a lasting contact moves slowly.
constexpr int kContactSteps = 4;

// Calls offer(t, f(t)) at the maxima of f between samples values[i] = f(time(i)), i = 0…count, that could
// exceed `best`. A parabola rises above its highest sample by at most an eighth of the second difference;
// twice that is looked into. At the ends of a stretch, which bracket nothing, a look a little inside
// tells whether f rises there. Of a vibration's many peaks those are looked into whose parabolas rise highest; once
// `vain` of them were no higher than the best, only those that promise to be. Returns whether all that
// promise to exceed `best` were looked into.
template <class F, class Time, class Offer>
bool each_maximum(F&& f, Time&& time, const double* values, int count, const double& best, long& vain, Offer&& offer) {
    const auto look = [&](double a, double b) {
        const double before = best;
        const auto [t, value] = find_peak(f, a, b);
        offer(t, value);
        if (!(best > before + kNoHigher * std::fabs(before))) ++vain;
    };
    const auto promises = [&](double height) { return vain < kPatience || height > best; };
    const auto bend_at = [&](int i) {
        const int middle = std::clamp(i, 1, count - 1);
        return std::fabs(values[middle - 1] - 2 * values[middle] + values[middle + 1]);
    };
    const auto may_exceed = [&](int i) { return bend_at(i) > 0 && values[i] + 0.25 * bend_at(i) > best; };
    for (const int end : {0, count}) {
        const int other = end == 0 ? 1 : count - 1;
        if (!may_exceed(end) || !(values[end] >= values[other])) continue;
        if (!promises(values[end] + kSteeper * 0.125 * bend_at(end))) continue;
        const double inside = time(end) + 1e-3 * (time(other) - time(end));
        if (f(inside) > values[end]) look(std::min(time(end), time(other)), std::max(time(end), time(other)));
    }
    struct Peak {
        int i;
        double height;
    };
    std::vector<Peak> peaks;
    for (int i = 1; i < count; ++i) {
        if (!may_exceed(i) || values[i] < values[i - 1] || values[i] < values[i + 1]) continue;
        const double lean = values[i + 1] - values[i - 1];
        peaks.push_back({i, values[i] + kSteeper * lean * lean / (8 * bend_at(i))});
    }
    if (peaks.size() > kMostPeaks)
        std::nth_element(peaks.begin(), peaks.begin() + kMostPeaks, peaks.end(),
                         [](const Peak& a, const Peak& b) { return a.height > b.height; });
    bool complete = true;
    for (std::size_t k = 0; k < peaks.size(); ++k) {
        if (!may_exceed(peaks[k].i) || !promises(peaks[k].height)) continue;
        if (k < kMostPeaks)
            look(time(peaks[k].i - 1), time(peaks[k].i + 1));
        else if (peaks[k].height > best)
            complete = false;
    }
    return complete;
}

// The polynomial through the samples of a step (barycentric formula).
class Sampled {
  public:
    Sampled(const double* t, const double* f) : t_(t), f_(f) {
        const double span = t[kCount - 1] - t[0];
        for (int i = 0; i < kCount; ++i) {
            weight_[i] = 1;
            for (int j = 0; j < kCount; ++j)
                if (j != i) weight_[i] *= span / (t[i] - t[j]);
        }
    }
    double operator()(double at) const {
        double above = 0, below = 0;
        for (int i = 0; i < kCount; ++i) {
            if (at == t_[i]) return f_[i];
            const double w = weight_[i] / (at - t_[i]);
            above += w * f_[i];
            below += w;
        }
        return above / below;
    }

  private:
    static constexpr int kCount = TouchSamples::kCount;
    const double *t_, *f_;
    double weight_[kCount];
};

// `best`, or the largest value of sign·f within a step, from its samples at the ends and nodes, if that is larger.
double sampled_peak(const double* t, const double* f, double sign, double best) {
    constexpr int kCount = TouchSamples::kCount, kPieces = 4;  // of an interval between samples
    constexpr double kLebesgue = 2.9;  // how much farther from zero than its samples the polynomial may be
    const auto [low, high] = std::minmax_element(f, f + kCount);
    const double middle = sign * 0.5 * (*low + *high), half_range = 0.5 * (*high - *low);
    if (middle + kLebesgue * half_range <= best) return best;
    const Sampled curve(t, f);
    const auto at = [&](double instant) { return sign * curve(instant); };
    const auto time = [&](int i) {
        const int left = std::min(i / kPieces, kCount - 2);
        return t[left] + (t[left + 1] - t[left]) * (i - left * kPieces) / kPieces;
    };
    std::array<double, kPieces*(kCount - 1) + 1> values;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = at(time(static_cast<int>(i)));
    for (const double value : values) best = value > best ? value : best;  // of a step of rounding's size: NaN
    long vain = 0;
    each_maximum(at, time, values.data(), static_cast<int>(values.size()) - 1, best, vain,
                 [&](double, double value) { best = std::max(best, value); });
    return best;
}

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
    vain_.assign(2 * request.extrema.size(), 0);
}

void Recorder::begin(const Phase& phase, const std::vector<double>& y) {
    eye_.set_phase(phase);
    eye_.look(0, y.data());
    start_total_ = eye_.books().total();
    eye_.set_start_energy(start_total_);
    const double lever = problem_.hub.radius + 0.5 * problem_.beam.length;
    result_.energy_scale = std::fabs(problem_.beam.line_density() * problem_.beam.length * problem_.gravity * lever);
    ledger();
}

void Recorder::phase(const Phase& phase) { eye_.set_phase(phase); }

int Recorder::pieces(const Stretch& s) {
    // Steps of high order span a good part of the fastest period: look a few times a radian.
    const double radians = (s.to - s.from) * eye_.system().highest_frequency();
    const double most = s.segment->bounds() ? kMostLooks : kMaxLooks;
    return static_cast<int>(std::clamp(std::ceil(radians * 1.5), 2.0, most));
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

// For how many pieces from here on neither the hub's angle nor its rate can change sign: the frame is too far from that
// for the vibration, and needs a while to come near. Half of its rate is left to the inertia's own vibration.
int Recorder::quiet_pieces(const Turn& hub, const Stretch& s, double piece) {
    const MotionBounds* b = s.segment->bounds();
    if (!b) return 0;
    const double rate = 0.5 * std::fabs(hub.frame_rate) - b->ripple_rate, angle = std::fabs(hub.frame) - b->ripple;
    if (!(rate > 0 && angle > 0)) return 0;
    const double quiet = std::min(rate / b->spin_acceleration, angle / b->spin) / piece;
    return static_cast<int>(std::min(quiet, kMostLooks));
}

Recorder::Turn Recorder::turn(const Stretch& s, double t) {
    s.segment->value(t, y_.data());
    eye_.system().place(t, y_.data());
    const Model& model = eye_.system().model();
    return {model.hub_angle(), model.hub_rate(), y_[0], y_[static_cast<std::size_t>(eye_.system().coordinates())]};
}

void Recorder::turning_points(const Stretch& s) {
    if (!request_.turning_points) return;
    if (const MotionBounds* b = s.segment->bounds()) {
        const bool turns = b->rate_low <= 0 && b->rate_high >= 0, crosses = b->angle_low <= 0 && b->angle_high >= 0;
        if (!turns && !crosses) return;
    }
    const auto angle = [&](double t) { return turn(s, t).angle; };
    const auto rate = [&](double t) { return turn(s, t).rate; };
    const int count = pieces(s);
    const auto time = [&](int i) { return i == count ? s.to : s.from + (s.to - s.from) * i / count; };
    Turn before = turn(s, s.from);
    for (int i = 0; i < count;) {
        if (const int quiet = quiet_pieces(before, s, (s.to - s.from) / count)) {
            i = std::min(count, i + quiet);
            before = turn(s, time(i));
            continue;
        }
        const Turn after = turn(s, time(i + 1));
        if (before.rate > 0 && after.rate <= 0) {
            const double t = find_root(rate, time(i), time(i + 1), before.rate, after.rate);
            result_.apexes.push_back({t, angle(t)});
        }
        if ((before.angle > 0) != (after.angle > 0) && before.angle != 0) {
            const double t = find_root(angle, time(i), time(i + 1), before.angle, after.angle);
            result_.theta_zero.push_back({t, rate(t)});
        }
        before = after;
        ++i;
    }
}

void Recorder::contact_peaks(const Stretch& s) {
    if (!impact_open_) return;
    Impact& impact = result_.impacts.back();
    if (const TouchSamples* samples = s.segment->touch()) {
        impact.force_peak = sampled_peak(samples->t, samples->force, 1, impact.force_peak.value_or(0));
        impact.penetration_peak = sampled_peak(samples->t, samples->gap, -1, impact.penetration_peak);
        return;
    }
    const auto contact_at = [&](double t) -> const ContactState& {
        s.segment->value(t, y_.data());
        eye_.look(t, y_.data());
        return eye_.contact();
    };
    const auto force = [&](double t) { return contact_at(t).force; };
    const auto depth = [&](double t) { return -contact_at(t).gap; };
    const int count = std::max(4, pieces(s));
    const auto time = [&](int i) { return i >= count ? s.to : s.from + (s.to - s.from) * i / count; };
    std::vector<double> forces(static_cast<std::size_t>(count) + 1), depths(forces.size());
    for (int i = 0; i <= count; ++i) {
        const ContactState& c = contact_at(time(i));
        forces[static_cast<std::size_t>(i)] = c.force;
        depths[static_cast<std::size_t>(i)] = -c.gap;
    }
    const auto refine = [&](const auto& values, const auto& f, double& best) {
        for (int i = 0; i <= count; ++i) best = std::max(best, values[static_cast<std::size_t>(i)]);
        long vain = 0;
        each_maximum(f, time, values.data(), count, best, vain,
                     [&](double, double value) { best = std::max(best, value); });
    };
    double force_peak = impact.force_peak.value_or(0);
    refine(forces, force, force_peak);
    impact.force_peak = force_peak;
    refine(depths, depth, impact.penetration_peak);
}

void Recorder::extrema(const Stretch& s) {
    if (request_.extrema.empty()) return;
    const int count = std::min(pieces(s), kExtremeLooks);
    bool complete = count == pieces(s);
    const std::size_t channels = request_.extrema.size();
    std::vector<std::vector<double>> values(channels, std::vector<double>(static_cast<std::size_t>(count) + 1));
    const auto time = [&](int i) { return i == count ? s.to : s.from + (s.to - s.from) * i / count; };
    for (int i = 0; i <= count; ++i) {
        s.segment->value(time(i), y_.data());
        eye_.look(time(i), y_.data());
        for (std::size_t c = 0; c < channels; ++c)
            values[c][static_cast<std::size_t>(i)] = eye_.value(request_.extrema[c]);
    }
    for (std::size_t c = 0; c < channels; ++c) {
        Extremum& e = result_.extrema[c];
        const auto offer = [&](double t, double v) {
            if (v < e.min) {
                e.min = v;
                e.t_min = t;
            }
            if (v > e.max) {
                e.max = v;
                e.t_max = t;
            }
        };
        const auto at = [&](double t) {
            s.segment->value(t, y_.data());
            eye_.look(t, y_.data());
            return eye_.value(request_.extrema[c]);
        };
        for (int i = 0; i <= count; ++i) offer(time(i), values[c][static_cast<std::size_t>(i)]);
        if (request_.extrema[c].kind == ChannelKind::energy_residual)  // largest near the nodes of a collocation
            for (int k = 0; k < kNodes; ++k) {
                const double t = s.from + Collocation::get().c[k] * (s.to - s.from);
                offer(t, at(t));
            }
        complete = each_maximum(at, time, values[c].data(), count, e.max, vain_[2 * c], offer) && complete;
        for (double& value : values[c]) value = -value;
        double highest = -e.min;
        const auto offer_lowest = [&](double t, double value) {
            offer(t, -value);
            highest = -e.min;
        };
        complete = each_maximum([&](double t) { return -at(t); }, time, values[c].data(), count, highest,
                                vain_[2 * c + 1], offer_lowest) &&
                   complete;
    }
    if (!complete) ++thinned_;
}

void Recorder::ledger() {
    const System::Books& books = eye_.books();
    largest_elastic_ = std::max(largest_elastic_, books.energies.elastic);
    result_.energy_scale = std::max({result_.energy_scale, books.energies.kinetic, books.energies.elastic});
    result_.energy_residual_max = std::max(result_.energy_residual_max, std::fabs(books.total() - start_total_));
}

void Recorder::stretch(const Stretch& s, Notes* made) {
    if (!(s.to > s.from) && !s.last) return;
    const std::size_t apexes = result_.apexes.size(), zeros = result_.theta_zero.size();
    // Each observer starts its search of the contact afresh, so that none sees what another looked at:
    // the last bits of a foot point depend on where its iteration began.
    sample(s);
    contact_poses(s);
    if (s.to > s.from) {
        turning_points(s);
        eye_.system().search_again();
        contact_peaks(s);
        eye_.system().search_again();
        extrema(s);
    }
    eye_.system().search_again();
    // In contact also inside the step, where only the dense output knows the force, unless nodes do.
    for (const double share : {1.0 / 3, 2.0 / 3, 1.0}) {
        if (share < 1 && (!impact_open_ || s.segment->touch())) continue;
        const double t = share < 1 ? s.from + share * (s.to - s.from) : s.to;
        s.segment->value(t, y_.data());
        eye_.look(t, y_.data());
        if (const TouchSamples* samples = s.segment->touch())
            eye_.gap_is(t == s.segment->t1 ? samples->gap[TouchSamples::kCount - 1]
                                           : Sampled(samples->t, samples->gap)(t));
        ledger();
    }
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
    extrema(s);
    eye_.system().search_again();
    if (request_.turning_points && known.turning_points) {
        result_.apexes.insert(result_.apexes.end(), known.apexes.begin(), known.apexes.end());
        result_.theta_zero.insert(result_.theta_zero.end(), known.theta_zero.begin(), known.theta_zero.end());
    } else {
        turning_points(s);
        eye_.system().search_again();
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
    all.fallbacks.thinned = thinned_;
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
