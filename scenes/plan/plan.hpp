// The plan of a run: what the outputs of a scene need, found by walking backwards from them:
// files → pictures → poses and channels → times → a simulation, of which model, until when.
//
// A plan is a value, computed in microseconds without any file; run.hpp carries it out. Work that no output needs is
// not in it; there are no switches that turn a stage off.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "output/files/target.hpp"
#include "output/files/work.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/figures/studies.hpp"
#include "scenes/motions/progress.hpp"
#include "scenes/scene/files.hpp"
#include "scenes/scene/scene.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

// Results of earlier runs. up_to_date.hpp finds them, so that `plan` reads no files.
struct ExistingWork {
    std::map<std::size_t, std::string> finished;   // outputs whose files are up to date, and the files
    std::map<std::size_t, std::set<long>> frames;  // of sequences: numbers of the up-to-date frames
    double until = 0;                              // end of a run for all outputs, up-to-date ones included [s]
};

// A motion that outputs need.
struct PlannedMotion {
    sim::Problem problem;
    std::string key;             // motion_key(problem)
    sim::Request request = {};   // for data files of the scene's motion; of other motions only the end
    std::string label = {};      // of a compared motion
    bool ends_at_event = false;  // it may end later than the request, at events that have to be found first
    bool horizon = false;        // the reproducible horizon is needed, by further runs

    void simulate_until(double t) { request.end_time = std::max(t, request.end_time); }
};

// The parts of the request for a motion that a picture shows.
// Of Request::poses; the survey is for the choice of scales, the path for that of the tip.
constexpr std::size_t kFramePoses = 0, kSurveyPoses = 1, kPathPoses = 2;
// Of Request::tables: channels of the panels; with a cam t, contact_x, contact_s, contact_force.
constexpr std::size_t kChartTable = 0, kTraceTable = 1;

// An output with pictures of the mechanism, as this run makes it.
struct Pictures : PictureOutput {
    std::size_t output = 0;      // index into the scene's outputs
    bool collisions = false;     // a strip shows one collision at a time
    bool times_known = true;     // false: they depend on events that have to be found first
    double end_time = 0;         // last time that it needs; an upper bound while times_known is false [s]
    long first_frame = 0;        // number of the first frame
    std::set<long> existing;     // numbers of the up-to-date frames
    std::vector<int> draw;       // frames to draw, ascending, empty while unknown; camera and scales depend on all
    std::optional<int> poster;   // of a video: the frame that is also written to poster_file, as in `draw`
    std::string poster_file;     // empty: none
    std::vector<double> speeds;  // playback speed at each frame; empty in real time
    std::vector<render::Callout> callouts;
    std::vector<render::CameraMove> moves;
    std::vector<std::string> unreached_events;  // events outside the film: "impact 3"
    std::string omitted_panels;                 // panels that do not fit: "phase, energy"
    std::vector<sim::Channel> chart_channels;
    std::vector<Study> shown;  // the scene's motion, or those of a comparison

    bool makes_poster() const { return poster.has_value(); }
    bool ends_at_event() const { return kind != Kind::still && span.to_event.has_value(); }
};
struct FigureFile {
    std::size_t output = 0;
    std::string file, figure;
    // False: it begins or ends at events; studies and maker cover the whole scene until the events are found.
    bool times_known = true;
    bool ends_at_event = false;
    std::vector<Study> studies = {};  // the motions that it needs
    FigureMaker make = {};            // draws the figure from their results
};

// The inputs of a data file, and its target.
struct DataSource {
    const sim::Problem& problem;
    const sim::Request& request;
    const sim::Result& run;
    const output::Work& work;        // until now
    const output::Target* file;      // null: standard output
    const output::SweepData* sweep;  // null unless the plan needs it
    Progress& progress;
};
// A file with numbers of the scene's motion or sweep.
struct DataFile {
    std::size_t output = 0;
    std::string file, type;  // type: name in the plan, "trajectory"
    // Writes the file; returns a description for the user: "1501 rows".
    std::function<std::string(const DataSource& from)> write;
    std::string part = {};                  // of a sweep: "2/3"; empty: all of it
    std::string content = {};               // for the plan: "1501 rows"
    std::optional<std::size_t> table = {};  // index into Request::tables; its rows are saved if the solver fails
    bool holds_events = false;              // those that were found are saved if the solver fails
    bool reports_work = false;              // written last, because it contains the work of all outputs
};

struct Plan {
    std::optional<PlannedMotion> simulation;  // of the scene's motion
    // Upper bound of the first run, which finds the events of pictures and figures without known times.
    std::optional<double> events_until;
    bool all_events = false;            // false: the first run may end at the last event that outputs name
    std::vector<PlannedMotion> others;  // of motions that pictures and figures compare with the scene's or each other
    std::string sweep;                  // the first file that needs the points of the scene's sweep; empty: none
    std::vector<Pictures> pictures;
    std::vector<FigureFile> figures;
    std::vector<DataFile> data;
    std::vector<std::string> kept;  // files that are up to date: "t.csv", "4 frames of f-##.png"

    bool needs_gl() const;                                             // a lit view
    bool needs_encoder() const;                                        // a video
    const std::vector<double>& times(const Pictures& pictures) const;  // of its frames; empty while they are unknown
};

// `shard`: the part of the sweep that this run computes.
Plan plan(const Scene& scene, const Shard& shard = {}, const ExistingWork& existing = {});

// The requests for the scene's motion: for data files, then those of the pictures and figures that show it.
std::vector<sim::Request> requests_of(const Plan& plan);

// The reason for Pictures::omitted_panels.
std::string why_panels_are_omitted(const Size& size);

// Parameters and colour scales that do not fit into the picture: "R = 100 mm; colour scales"; empty if all fit. Loads
// fonts. Throws render::FontError.
std::string omitted_text(const Pictures& p, const Scene& scene);
// The reason for omitted_text.
std::string why_text_is_omitted(const Size& size);
// "fall.mp4 omits 🙂: no font has these characters", of title, captions (also those outside the film)
// and names; empty if there are none.
std::string characters_without_font(const PictureOutput& p, const Scene& scene);

// True for a film of one motion that shows its collisions in slow motion.
bool is_slow_motion(const Pictures& p);

// Sets the times of pictures and figures that depend on events. `find` simulates a problem until its events are found,
// once for the scene's own motion, if necessary, and once for each compared motion. An output with an event that does
// not occur is passed to `reject` and removed from the plan; without `reject` render::PictureError is thrown.
using FindEvents = std::function<sim::Result(const sim::Problem& problem, const sim::Request& request)>;
using RejectOutput = std::function<void(std::size_t output, const std::string& why)>;
void resolve_event_times(Plan& plan, const Scene& scene, const FindEvents& find, const RejectOutput& reject = {});

// The plan for people and for programs: motions, files and what is kept, one line each.
std::string to_text(const Plan& plan, const Scene& scene);
std::string to_json(const Plan& plan, const Scene& scene);

}  // namespace beamcam::scenes
