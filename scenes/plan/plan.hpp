// The plan of a run: what the outputs of a scene need, found by walking backwards from them:
// files → pictures → poses and channels → times → motions, of which model, until when.
//
// A plan is a value, made without integrating anything and without reading files; run.hpp carries it out. Work that no
// output needs is not in it; there are no switches that turn a stage off.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scenes/figures/figure_types.hpp"
#include "scenes/motions/motion_request.hpp"
#include "scenes/plan/resolve.hpp"
#include "scenes/scene/files.hpp"

namespace beamcam::scenes {

// Files of earlier runs that are up to date. up_to_date.hpp finds them, so that `plan` reads no files.
struct ExistingWork {
    std::set<std::size_t> finished;                // outputs whose files are all up to date
    std::map<std::size_t, std::set<long>> frames;  // of sequences: numbers of the up-to-date frames
};

// Indices into Request::poses: the survey serves the choice of scales, the path that of the tip.
constexpr std::size_t kFramePoses = 0, kSurveyPoses = 1, kPathPoses = 2;
// Indices into Request::tables: the channels of the panels; with a cam t, contact_x, contact_s, contact_force.
constexpr std::size_t kChartTable = 0, kTraceTable = 1;

// An output with pictures of the mechanism, as this run makes it.
struct PlannedPictures : PictureOutput {
    std::size_t output = 0;            // index into the scene's outputs
    double end_time = 0;               // last time that it needs [s]
    FilmTimes times;                   // its frames, charts, captions and movements of the camera
    std::vector<int> draw;             // frames to draw, ascending; camera and scales depend on all
    std::string poster_file;           // empty: none
    std::string omitted_panels;        // panels that do not fit: "phase, energy"
    std::vector<std::size_t> motions;  // indices into Plan::motions: the scene's motion, or those of a comparison

    long number_of(std::size_t drawn) const { return times.first + draw[drawn]; }  // in names of files
};
struct FigureFile {
    std::size_t output = 0;
    std::string file, figure;
    std::vector<std::size_t> motions;  // indices into Plan::motions, in the order of the figure's requests
};
// A file with numbers of the scene's motion or sweep.
struct DataFile {
    std::size_t output = 0;
    std::string file;
    std::string content = {};              // for the text of the plan: "1501 rows"
    std::vector<std::size_t> tables = {};  // indices into the tables of the request for the scene's motion
    std::size_t index = 0;                 // into its poses or states
};

struct Plan {
    // All requests for motions. Those with equal keys share one integration.
    std::vector<MotionRequest> motions;
    std::optional<std::size_t> run;  // the request for data files of the scene's motion
    std::string sweep;               // the first file that needs the points of the scene's sweep; empty: none
    Shard shard;                     // the part of the sweep
    std::vector<PlannedPictures> pictures;
    std::vector<FigureFile> figures;
    std::vector<DataFile> data;        // in the order of the types
    std::vector<std::string> kept;     // files that are up to date: "t.csv", "4 frames of f-##.png"
    std::vector<std::size_t> waiting;  // outputs of a dry run whose times depend on events; nothing above is theirs

    bool needs_gl() const;  // a lit view
};

// A plan, and what draws each of its figures from the results of their motions.
struct PlanWithFigures : Plan {
    std::vector<FigureMaker> makers;
};

PlanWithFigures plan(const ResolvedScene& scene, const ExistingWork& existing = {});

// The end of a run for all outputs of a scene [s].
double run_end(const Scene& scene);

// The reason for panels and texts that a picture cuts or omits.
std::string too_small(const Size& size);
// "fall.mp4 omits 🙂: no font has these characters", of title, captions (also those outside the film)
// and names; empty if there are none.
std::string characters_without_font(const PictureOutput& p, const Scene& scene);

// The plan for people and for programs: motions, files and what is kept, one line each.
std::string to_text(const Plan& plan, const Scene& scene);
std::string to_json(const Plan& plan, const Scene& scene);

}  // namespace beamcam::scenes
