// What is recorded of a trajectory while it is integrated: samples, poses, impacts, crossings,
// extrema, the energy ledger. Each looks at accepted segments only and through its own System, so
// recording never changes a bit of the motion.
#pragma once

#include <vector>

#include "sim/integrator.hpp"
#include "sim/simulate.hpp"
#include "sim/system.hpp"

namespace beamcam::sim {

// A stretch of the trajectory in one phase: `segment` restricted to [from, to].
struct Stretch {
    const Segment* segment;
    double from, to;
    bool last;  // its end point belongs to it (end of the run)
};

// Channel values at one instant; remembers what it already worked out for that instant.
class Eye {
  public:
    explicit Eye(const Problem& problem);
    void set_phase(const Phase& phase) { system_.set_phase(phase); }
    void set_start_energy(double total) { start_total_ = total; }
    void look(double t, const double* y);
    double value(Channel channel);
    Pose pose(int stations);
    System& system() { return system_; }
    const System::Books& books();
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

class Recorder {
  public:
    Recorder(const Problem& problem, const Request& request, Result& result);

    void begin(const Phase& phase, const std::vector<double>& y);
    void phase(const Phase& phase);
    void stretch(const Stretch& s);
    void touch(double t, const double* y, const ContactState& contact);
    void release(double t, const double* y, const ContactState& contact);
    void end(double t, const double* y);
    double largest_elastic() const { return largest_elastic_; }  // bending energy [J]

  private:
    struct Cursor {
        std::vector<std::size_t> order;  // indices of the times, ascending
        std::size_t next = 0;
    };
    void sample(const Stretch& s);
    void turning_points(const Stretch& s);
    void contact_peaks(const Stretch& s);
    void extrema(const Stretch& s);
    void ledger();
    void settle(const double* y);
    template <class F>
    void sweep(const std::vector<double>& times, Cursor& cursor, const Stretch& s, F&& visit);
    int pieces(const Stretch& s);

    const Problem& problem_;
    const Request& request_;
    Result& result_;
    Eye eye_;
    std::vector<double> y_;
    std::vector<Cursor> table_cursors_, pose_cursors_, point_cursors_;
    double start_total_ = 0, largest_elastic_ = 0;
    bool impact_open_ = false;
    double books_at_touch_lost_ = 0, impulse_n_at_touch_ = 0, impulse_t_at_touch_ = 0;
};

}  // namespace beamcam::sim
