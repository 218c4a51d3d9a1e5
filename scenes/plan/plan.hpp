// What a scene's outputs need, found by walking backwards from them:
// files → pictures → poses and channels → instants → a simulation, of which model, until when.
//
// Pure: a Plan is a value, made in microseconds, that run.hpp carries out. What nobody needs is not
// in it; there are no switches that turn a stage off.
#pragma once

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
#include "scenes/figures/recipes.hpp"
#include "scenes/figures/studies.hpp"
#include "scenes/format/tree.hpp"
#include "scenes/motions/progress.hpp"
#include "scenes/scene/scene.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

// A part of the work, to share it between machines.
struct Selection {
    std::optional<std::pair<long, long>> frames;  // numbers of the frames of films and sequences, half open
    int shard = 1, shards = 1;                    // 1 <= shard <= shards
};

// What is there already. Found by looking at files (survey.hpp), so that a plan stays pure.
struct ExistingWork {
    std::set<std::size_t> finished;                // outputs whose files were made from the same inputs
    std::map<std::size_t, std::set<long>> frames;  // of sequences: numbers of the frames that are finished
    std::optional<double> kept_until;              // how far a kept trajectory of this motion goes [s]
    bool keeps = false;                            // trajectories are kept at all
    std::map<std::string, double> variants_kept;   // the same of other motions, by Studies::key
    double until = 0;                              // where the run of all outputs would end, finished ones too [s]
};

// What a stage took in earlier runs (history.hpp).
struct Cost {
    double seconds = 0;
    double amount = 0;  // steps of a motion, bytes of a file
};

// One run of the mechanics serves every output.
struct Simulation {
    sim::Request request;
    std::string until_because;  // the output that looks furthest: "fall.mp4"
    // Where outputs end at events that are yet to be found, and may look further: "impact 3, for f.pdf".
    std::vector<std::string> until_events = {};
    // Pictures that end before the run: each tells of impacts and energy as if the run ended with it.
    std::vector<double> ends;  // [s], distinct
    bool horizon = false;      // somebody asks until when it is reproducible: further runs
    bool from_cache = false;   // a kept trajectory goes far enough
    bool keep = false;         // for later runs
    std::optional<Cost> cost;

    void simulate_until(double t, const std::string& file);
};

// Other physics than the scene's, that figures compare it with: what serves all that look at it.
struct Variant {
    sim::Problem problem;
    Simulation simulation;
};

// Another motion in the same picture: a run of its own, with the poses, the chart and the trace of that picture.
struct ComparedMotion {
    std::string label;
    sim::Problem problem;
    sim::Request request;  // poses: frames, survey; tables: chart and, with a cam, trace; what is added stands behind
    std::optional<Cost> cost;
};

// A film, a sequence or a still: the same pictures, put away differently.
struct Pictures {
    enum class Kind { video, frames, still, page, model };
    Kind kind = Kind::video;
    std::size_t output = 0;  // index into the scene's outputs
    std::string file;
    Picture picture;
    FrameSpan span;           // of video and frames
    Instant at;               // of a still
    Encoding encoding;        // of video
    bool collisions = false;  // a strip of a film shows them one by one
    bool times_known =
        true;               // false: the instants of frames or of the charts' rows are not known before the events are
    double end_time = 0;    // nothing is looked at beyond it; if it ends at an event, at most, until settled [s]
    long first_frame = 0;   // number of the first frame; the others follow
    Selection selection;    // which of them are asked for
    std::set<long> there;   // numbers of those that are finished
    std::vector<int> draw;  // which are drawn, ascending; camera and scales are those of all
    std::string part;       // of a film: "30:60 of 0:90"; empty: the whole
    // Index into Simulation::ends; absent: the run ends with it, or it compares motions.
    std::optional<std::size_t> until;
    std::optional<int> poster;  // of a video: the frame that is also put into poster_file, as in `draw`
    std::string poster_file;    // empty: none
    Subtitles subtitles = Subtitles::none;
    std::string subtitles_file;  // empty: none
    bool chapters = false;
    std::vector<double> speeds;  // of time at each frame; empty in real time
    std::vector<render::Callout> callouts;
    std::vector<render::CameraMove> moves;
    std::vector<std::string> unreached_events;  // events of a film that it does not reach: "impact 3"
    std::string omitted_panels;                 // names of the wanted panels that do not fit: "phase, energy"
    std::vector<sim::Channel> chart_channels;
    std::vector<ComparedMotion> compared;  // all that the picture shows, if it compares; else empty
    // Of the one simulation, unless the picture compares motions:
    std::size_t poses = 0;             // index into Request::poses, whose times are the frames' instants
    std::size_t survey = 0;            // the same of what scales are chosen by
    std::size_t chart = 0;             // index into Request::tables: what the panels show
    std::optional<std::size_t> trace;  // t, contact_x, contact_s, contact_force; absent without a cam
    std::optional<Cost> cost;

    bool makes_poster() const;  // it is among those that are drawn
    bool ends_at_event() const { return kind != Kind::still && span.to_event.has_value(); }
};
struct FigureFile {
    std::size_t output = 0;
    std::string file, figure;
    // False: it begins or ends at events; studies and maker are of the whole scene until these are known.
    bool times_known = true;
    std::optional<Instant> ends_at = {};  // the event
    std::vector<Study> studies = {};      // what it looks at, as if it were alone
    FigureMaker make = {};                // from their results
    std::optional<Cost> cost = {};
};

// What a data file is written from, and where.
struct DataSource {
    const sim::Problem& problem;
    const sim::Request& request;  // of the scene's motion
    const sim::Result& run;
    const output::Work& work;        // so far
    const output::Target* file;      // null: standard output
    const output::SweepData* sweep;  // null unless the plan asks for it
    Progress& progress;
};
// A file that holds numbers of the scene's motion, or of its sweep.
struct DataFile {
    std::size_t output = 0;
    std::string file, stage;  // stage: what the plan calls it, "table"
    // Writes it, and returns what to say of it: "1501 rows".
    std::function<std::string(const DataSource& from)> write;
    std::string part = {};                  // of a sweep: "2/3"; empty: the whole
    std::string content = {};               // for the plan in words: "1501 rows of 29 channels"
    Node details = object_node();           // for the plan as JSON
    std::size_t numbers = 0;                // how many it holds; 0: so few that writing them takes no time
    std::optional<std::size_t> table = {};  // index into Request::tables; its rows are kept if the solver fails
    bool reports_work = false;              // it is written after all others
    std::optional<Cost> cost = {};
};

struct Skipped {
    std::string what, why;
};

struct Plan {
    std::optional<Simulation> simulation;
    // Until when, at most, a first run has to find events, because pictures and figures that are not settled look at
    // them.
    std::optional<double> events_until;
    bool all_events = false;  // some look at all until then; else the run may end once it has the events that they name
    std::vector<Variant> variants;
    std::string sweep;              // the first file that shows the points of the scene's sweep; empty: none
    bool sweep_end_states = false;  // and a film shows how motions go on from their ends, which no NetCDF file has
    std::vector<Pictures> pictures;
    std::vector<FigureFile> figures;
    std::vector<DataFile> data;
    std::vector<Skipped> skipped;

    bool needs_gl() const;                                      // a lit view
    bool needs_encoder() const;                                 // a video
    std::optional<Cost> cost() const;                           // of all stages with a known cost; amount: bytes
    std::size_t frames() const;                                 // drawn altogether
    std::vector<double> times(const Pictures& pictures) const;  // of its frames; empty before it is settled
};

Plan plan(const Scene& scene, const Selection& selection = {}, const ExistingWork& existing = {});

// What is asked of the scene's motion: first the run itself, then where pictures end before, then what figures look at,
// in their order. None without a simulation.
std::vector<sim::Request> requests_of(const Plan& plan);

// Notes which of its pictures end before the run.
void assign_ends(Plan& plan);

// Why a picture leaves out Pictures::omitted_panels.
std::string why_panels_are_omitted(const Size& size);

// The parameters, and the colour scales, for which the picture has no room: "R = 100 mm; colour scales"; empty: none.
// Loads fonts. Throws render::FontError.
std::string omitted_text(const Pictures& p, const Scene& scene);
// Why.
std::string why_text_is_omitted(const Size& size);
// Puts what pictures do not write among what the plan skips; nothing where fonts are missing.
void add_omitted_text(Plan& plan, const Scene& scene);

// A film of one motion so slow, or so slow around impacts, that collisions are what it shows.
bool is_slow_motion(const Pictures& p);

// Gives the pictures and figures that wait for impacts their instants. `find` runs a problem for its impacts, and its
// apexes where the request has them; it is called once for the scene's own motion, if a picture needs that, and for
// each compared one. What shows an instant that does not exist is handed to `refuse`, by its output, and leaves the
// plan; without `refuse` that is thrown. Throws what `find` throws and render::PictureError.
using FindEvents = std::function<sim::Result(const sim::Problem& problem, const sim::Request& request)>;
using RejectOutput = std::function<void(std::size_t output, const std::string& why)>;
void resolve_event_times(Plan& plan, const Scene& scene, const FindEvents& find, const RejectOutput& refuse = {});

// Words of the plan: "lit", "video".
const char* view_name(const render::View& view);
const char* kind_name(Pictures::Kind kind);
std::string encoding_words(const Encoding& encoding);  // "H.264, crf 18, veryfast"

// For people, and for programs.
std::string to_text(const Plan& plan, const Scene& scene);
std::string to_json(const Plan& plan, const Scene& scene);

}  // namespace beamcam::scenes
