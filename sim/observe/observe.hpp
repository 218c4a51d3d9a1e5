// What is recorded of a trajectory while it is integrated: samples, poses, impacts, crossings,
// extrema, the energy ledger. Each looks at accepted segments only and through its own System, so
// recording never changes a bit of the motion.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "sim/dynamics/system.hpp"
#include "sim/integrate/integrator.hpp"
#include "sim/observe/refine.hpp"
#include "sim/observe/request.hpp"
#include "sim/observe/result.hpp"

namespace beamcam::sim {

// A stretch of the trajectory in one phase: `segment` restricted to [from, to].
struct Stretch {
    const Segment* segment;
    double from, to;
    bool last;  // its end point belongs to it (end of the run)
    bool ends_before(double t) const { return last ? t > to : t >= to; }
};

// Channel values at one instant; remembers what it already worked out for that instant.
class Eye {
  public:
    explicit Eye(const System& system);
    void set_phase(const Phase& phase) { system_.set_phase(phase); }
    void set_start_energy(double total) { start_total_ = total; }
    void look(double t, const double* y);
    double value(Channel channel);
    Pose pose(int stations);
    System& system() { return system_; }
    const System::Books& books();
    // Spare a look at the contact where it is known.
    void gap_is(double gap);
    void contact_is(const ContactState& contact);
    const ContactState& contact();

  private:
    System system_;
    double t_ = 0, start_total_ = 0;
    std::vector<double> y_;
    bool books_known_ = false, contact_known_ = false, acceleration_known_ = false;
    System::Books books_;
    ContactState contact_;
    double hub_acceleration_ = 0;
};

// What a stretch adds to every result, whatever was asked for. Found once, told to every recorder.
struct Notes {
    bool turning_points = false;  // whether the next two were looked for
    std::vector<Apex> apexes;
    std::vector<ZeroCrossing> theta_zero;
    // So far: of the impact still open, of the energy ledger, and the largest bending energy [J].
    decltype(Impact::force_peak) force_peak{};
    double penetration_peak = 0, energy_scale = 0, energy_residual_max = 0, largest_elastic = 0;
};

// What an integration did in another way than asked for, or could not resolve.
struct Fallbacks {
    long steps = 0;        // by `method` instead of the exponential collocation
    long handed_over = 0;  // contacts that the collocation could not solve
    long grips = 0;        // steps in which a bristle's grip stayed though it breaks and catches at one instant
    long strikes = 0;      // taken as plastic because the step's error swallows the rebound
    long coarse = 0;       // steps whose vibration is faster than the looks for a touch resolve
    long left_behind = 0;  // resting starts on a turning cam without a motion along it
    long searches = 0;     // for an extremum that ended before they were sure
    double gap = 0;        // largest distance from zero of the gap at an event, taken out of it from there on [m]
    Method method = Method::rk8;
};

// What an integration has counted so far.
struct Tally {
    Counters counters;
    long floored = 0;   // touches slower than the approach floor
    long chatters = 0;  // ends of chatter in sustained contact
    Fallbacks fallbacks;
};

class ExtremaFinder;

// Records for one request, until its own end.
class Recorder {
  public:
    Recorder(const System& system, const Request& request, double end);
    Recorder(Recorder&&) noexcept;
    ~Recorder();

    void begin(const Phase& phase, const std::vector<double>& y);
    void phase(const Phase& phase);
    void stretch(const Stretch& s, Notes* made = nullptr);
    void stretch(const Stretch& s, const Notes& known);  // not the last one
    void touch(double t, const double* y, const ContactState& contact);
    void release(double t, const double* y, const ContactState& contact);
    void finish(double t, const double* y, const Tally& tally);

    double end() const { return end_; }
    Result& result() { return result_; }

  private:
    struct Cursor {
        std::vector<std::size_t> order;  // indices of the times, ascending
        std::size_t next = 0;
    };
    void look(const Stretch& s, double t);
    void sample_tables(const Stretch& s);
    void refine_curves(const Stretch& s, const std::vector<std::size_t>& before);
    void merge_refined();
    void sample(const Stretch& s);
    void contact_peaks(const Stretch& s);
    void contact_poses(const Stretch& s);
    void ledger(const Stretch& s);
    void note_balance();
    void settle(const double* y);
    template <class F>
    void sweep(const std::vector<double>& times, Cursor& cursor, const Stretch& s, F&& visit);

    Problem problem_;
    const Request& request_;
    Result result_;
    Eye eye_;
    std::unique_ptr<ExtremaFinder> finder_;
    std::vector<double> y_;
    std::vector<Cursor> table_cursors_, pose_cursors_, point_cursors_;
    struct Refined {  // rows between the times of a table with a curve
        CurveRefiner refiner;
        std::vector<double> times;
        std::vector<std::vector<double>> values;  // by channel
    };
    std::vector<Refined> refined_;            // of each table
    std::vector<std::size_t> contact_poses_;  // of each pose request: how many there are
    int contact_steps_ = 0;                   // of the open impact, looked into for poses
    double end_ = 0, start_total_ = 0, largest_elastic_ = 0;
    bool impact_open_ = false;
    double books_at_touch_lost_ = 0, impulse_n_at_touch_ = 0, impulse_t_at_touch_ = 0;
};

// The recorders of one integration. Each hears of it what it would hear if it were alone and the run
// ended with it: its result does not depend on the others.
class Audience {
  public:
    // The tally where the integration stands. Asked for after a stretch was looked at.
    using TallySource = std::function<Tally()>;

    Audience(const System& system, std::span<const Request> requests);
    double end() const { return end_; }  // the furthest that anybody looks [s]

    void begin(const Phase& phase, const std::vector<double>& y);
    // From `from` to `to`, where an event follows or not. `known` are the notes of an earlier run. Returns the
    // notes; null where nobody looks at the whole stretch.
    const Notes* stretch(const Segment& segment, double from, double to, bool event, const TallySource& tally,
                         const Notes* known = nullptr);
    void touch(double t, const double* y, const ContactState& contact);
    void release(double t, const double* y, const ContactState& contact);
    // After an event, and at the start: the motion goes on from here.
    void resume(double t, const std::vector<double>& y, const Phase& phase, const TallySource& tally);
    // Nothing follows.
    void give_up(double t, const std::vector<double>& y, const TallySource& tally);

    std::vector<Result> results();  // in the order of the requests; once

  private:
    bool listens(const Recorder& recorder) const {
        return !done_[static_cast<std::size_t>(&recorder - recorders_.data())];
    }
    void finish(Recorder& recorder, double t, const double* y, const TallySource& tally);

    std::vector<Recorder> recorders_;
    std::vector<char> done_;  // by recorder
    std::vector<double> y_;
    Notes notes_;
    double end_ = 0;
};

// The last instant that a request looks at [s].
double end_of(const Request& request);

}  // namespace beamcam::sim
