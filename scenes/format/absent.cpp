#include "scenes/format/absent.hpp"

#include <algorithm>
#include <cctype>

#include "output/json/tree.hpp"

namespace beamcam::scenes {
namespace {

enum class WordKind { not_modelled, key, other };

struct Absent {
    WordKind kind;
    const char* words;     // separated by blanks
    const char* sentence;  // follows "unknown …; "
};

// Words of `not_modelled` are one or more parts of a key: "spring" is found in "return_spring" and in "springRate". A
// word may begin with the object that has the key: "hub.damping". Other words are units, commands, options, endings of
// files, and values as "key=word".
constexpr Absent kAbsent[] = {
    {WordKind::key, "lift lift_table polynomial ellipse base_circle lobe",
     "\"profile\" of the cam describes any convex outline: by a motion law, by arcs or by points"},
    {WordKind::not_modelled, "cam.acceleration cam.drive cam.torque cam.inertia cam.mass",
     "the cam turns at constant speed: its own dynamics are not modelled"},
    {WordKind::not_modelled, "cams beams", "several cams or beams are not modelled; \"compare\" shows several motions"},
    {WordKind::not_modelled, "spring springs preload hub.stiffness joint_stiffness",
     "\"hub\": {\"spring\": {\"stiffness\", \"free_angle\", \"damping\"}} is a spring at the hub; springs at the beam "
     "are not "
     "modelled"},
    {WordKind::not_modelled, "damper dashpot bearing hub.damping hub.friction joint_damping",
     "hub.spring.damping damps the hub, beam.damping_ratio and beam.kelvin_voigt its vibrations; friction at the hub "
     "is not "
     "modelled"},
    {WordKind::not_modelled, "tip_mass point_mass mass masses payload",
     "a mass at the tip or at a point is not modelled; the beam's own mass follows from density and area"},
    {WordKind::not_modelled, "roller follower nose tip_radius",
     "a roller or a nose is not modelled: the beam itself touches the cam, contact.offset from its axis"},
    {WordKind::not_modelled, "taper tapered stepped sections tip_area tip_depth root_depth",
     "the beam is uniform: tapered and stepped beams are not modelled"},
    {WordKind::not_modelled, "shear shear_modulus timoshenko rotary_inertia axial extension",
     "shear, rotary inertia and extension of the beam are not modelled"},
    {WordKind::not_modelled, "torsion out_of_plane warping", "the motion is plane: torsion is not modelled"},
    {WordKind::not_modelled, "yield yield_stress plasticity plastic hardening",
     "all bodies are elastic: plasticity is not modelled"},
    {WordKind::not_modelled, "drag air_drag air fluid", "the resistance of the air is not modelled"},
    {WordKind::not_modelled, "lubrication lubricant oil wear temperature",
     "lubrication, wear and temperature are not modelled"},

    {WordKind::key, "beam.width beam.thickness beam.height beam.diameter beam.cross_section beam.c_max",
     "write \"section\": {\"type\": \"rectangle\", \"width\": \"25 mm\", \"height\": \"0.8 mm\"}; types are rectangle, "
     "circle, tube and custom"},
    {WordKind::key, "section.thickness section.depth section.b section.h",
     "the height lies in the plane of the motion, the width perpendicular to it; the wall of a tube is \"wall\""},
    {WordKind::key, "section.inner section.inner_diameter section.radius section.outer",
     "a circle has a \"diameter\", a tube an outer \"diameter\" and a \"wall\""},
    {WordKind::key, "anchor", "it was withdrawn: texts are in a band below the panels; remove the key"},
    {WordKind::key, "subtitles chapters", "it was withdrawn; \"events\" show texts in the film, ffmpeg adds subtitles"},
    {WordKind::key, "collision", "it was withdrawn; write \"from\": \"collision:3\", \"to\": \"liftoff:3\""},
    {WordKind::key, "layer", "it was withdrawn; \"show\" and \"layout\" choose what a film shows"},
    {WordKind::key, "trace tip_path swing shutter exposures view.strobe palette logo",
     "it was withdrawn; \"theme\" and \"background\" remain, and the figure \"strobe\" draws several instants"},
    {WordKind::key, "right right_label right_unit",
     "the second axis was withdrawn: channels of another unit have a panel of their own"},
    {WordKind::key, "horizon",
     "films and stills have it no longer; curves of a \"figure\" show it, beamcam simulate --horizon lists the "
     "intervals"},

    {WordKind::key, "wrap sign zero",
     "it was withdrawn: angles that begin again after a turn are joined; convert other columns before, and name the "
     "file that has the channel itself"},
    {WordKind::key, "friction.damping", "the dashpot of the bristle was withdrawn; remove the key"},
    {WordKind::key, "accepted reproducible_until renderers",
     "it was withdrawn: references are plain files, which beamcam test BASELINES --update writes; remove the key"},
    {WordKind::key, "expected", "it was withdrawn; beamcam diff compares pictures of other programs"},

    {WordKind::other, "type=model", "3-D models were withdrawn; a \"page\" plays the motion in a browser"},
    {WordKind::other, "type=shapes",
     "it was withdrawn; beamcam figure SCENE kymograph --data FILE.csv has the deflections"},
    {WordKind::other, "figure=impact-histograms", "it was withdrawn; impact-maps draws the same impacts"},
    {WordKind::other, "type=sweep-film", "it was withdrawn; write a \"sweep\", a \"figure\" and \"video\" outputs"},
    {WordKind::other, "codec=hevc codec=av1 codec=apng",
     "it was withdrawn; write h264, or vp9 or prores for a transparent film"},
    {WordKind::other, "method=exponential method=arkode-erk", "it was withdrawn; write auto or rk8"},
    {WordKind::other, "type=gif", "write a \"video\" whose \"file\" ends in .gif"},
    {WordKind::other, "type=apng", "write a \"video\" whose \"file\" ends in .webp or .gif"},

    {WordKind::other, "inch inches", "write in"},
    {WordKind::other, "metre metres meter meters", "write m"},
    {WordKind::other, "second seconds sec", "write s"},
    {WordKind::other, "degree degrees Grad grad gon", "write deg"},
    {WordKind::other, "radian radians", "write rad"},
    {WordKind::other, "hertz", "write Hz"},
    {WordKind::other, "newton newtons", "write N"},

    {WordKind::other, "accept", "it was withdrawn; write beamcam test BASELINES --update NAME"},
    {WordKind::other, "completion manual", "it was withdrawn; scenes/completion.bash completes, --help explains"},
    {WordKind::other, "cache", "it was withdrawn: motions are not stored between runs"},
    {WordKind::other, "concat", "it was withdrawn; write ffmpeg -f concat -i LIST.txt -c copy FILM.mp4"},
    {WordKind::other, "sheet", "it was withdrawn; write ffmpeg -i FILM.mp4 -vf fps=1,tile=4x3 -frames:v 1 SHEET.png"},
    {WordKind::other, "paper", "it was withdrawn; write beamcam run scenes/paper/*.json -o paper"},
    {WordKind::other, "stress", "it was withdrawn; tests/campaign of the source has the campaign"},
    {WordKind::other, "help", "write beamcam --help"},
    {WordKind::other, "version", "write beamcam --version"},

    {WordKind::other, "--no-cache", "it was withdrawn: motions are not stored between runs"},
    {WordKind::other, "--frames", "it was withdrawn; --from and --to choose a part of a film"},
    {WordKind::other, "--shard", "films are made in one piece; beamcam sweep --shard divides a sweep"},
    {WordKind::other, "--shapes",
     "it was withdrawn; beamcam figure SCENE kymograph --data FILE.csv has the deflections"},
    {WordKind::other, "--right", "it was withdrawn: channels of another unit have a panel of their own"},
    {WordKind::other, "--collision", "it was withdrawn; write --from collision:3 --to liftoff:3"},
    {WordKind::other, "--emit --parts",
     "it was withdrawn; scenes/SWEEPS.md has recipes for GNU parallel, Snakemake and Slurm"},
    {WordKind::other, "--film", "it was withdrawn; --diagram draws the sweep, beamcam render one of its motions"},
    {WordKind::other, "--add-digest --on-new-renderer", "it was withdrawn; --update writes the references"},
    {WordKind::other, "--annotate", "it was withdrawn; --report writes a page, --junit a file for CI services"},
    {WordKind::other, "--text", "it was withdrawn: texts are drawn as outlines"},

    {WordKind::other, ".pdf .svg", "figures and beamcam render --at T -o FILE are drawn as .pdf and .svg"},
};

std::string sentence(WordKind kind, auto&& matches) {
    for (const Absent& row : kAbsent)
        if (row.kind == kind && std::ranges::any_of(split(row.words, ' '), matches))
            return std::string("; ") + row.sentence;
    return {};
}

// "tipMass", "tip-mass" and "Tip mass" as "tip_mass".
std::string in_snake_case(std::string_view word) {
    std::string out;
    for (std::size_t i = 0; i < word.size(); ++i) {
        const auto c = static_cast<unsigned char>(word[i]);
        if (std::isupper(c) && i > 0 && std::islower(static_cast<unsigned char>(word[i - 1]))) out += '_';
        out += c == '-' || c == ' ' ? '_' : static_cast<char>(std::tolower(c));
    }
    return out;
}

bool contains(const std::string& all, const std::string& part) { return all.find(part) != std::string::npos; }

}  // namespace

std::string absent_key(std::string_view path) {
    constexpr std::size_t kLongest = 200;  // a longer path is no word that anybody expects
    if (path.size() > kLongest) return {};
    const std::string key = in_snake_case(path.substr(path.rfind('.') + 1)), whole = "." + in_snake_case(path);
    std::string found = sentence(WordKind::key, [&](const std::string& word) { return whole.ends_with("." + word); });
    if (!found.empty()) return found;
    return sentence(WordKind::not_modelled, [&](const std::string& word) {
        return contains(word, ".") ? whole.ends_with("." + word) : contains("_" + key + "_", "_" + word + "_");
    });
}

std::string absent(std::string_view word) {
    return sentence(WordKind::other, [&](const std::string& each) { return each == word; });
}

std::vector<NotModelled> not_modelled() {
    std::vector<NotModelled> all;
    for (const Absent& row : kAbsent)
        if (row.kind == WordKind::not_modelled) all.push_back({split(row.words, ' '), row.sentence});
    return all;
}

}  // namespace beamcam::scenes
