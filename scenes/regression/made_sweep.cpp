#include "scenes/regression/made_sweep.hpp"

#include <cerrno>
#include <cstdlib>

#include "output/files/errors.hpp"
#include "scenes/regression/sweep_record.hpp"
#include "sim/sweep/attractor.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

// Far above the rounding of any processor, far below what a motion that settles shows.
constexpr double kLittle = 1e-12;
constexpr int kTwins = 3;  // a point that is another one in every third run is found with 70 %

fs::path own_folder() {
    std::error_code error;
    std::string name = (fs::temp_directory_path(error) / "beamcam-sweep-XXXXXX").string();
    if (error) throw output::write_error("the folder for temporary files, TMPDIR", error.value());
    if (!mkdtemp(name.data())) throw output::write_error(name, errno);
    return name;
}

// Two of these keys may be swept, the third is not.
Scene displaced(Scene scene, int times) {
    const double factor = 1 + times * kLittle;
    scene.problem.gravity *= factor;
    if (scene.problem.cam) scene.problem.cam->speed *= factor, scene.problem.cam->eccentricity *= factor;
    return scene;
}

}  // namespace

MadeSweep::MadeSweep(const Scene& scene, int threads, Progress& progress)
    : folder_(own_folder()), made_(std::make_unique<SweepRun>(scene, SweepPart(), folder_ / "points")) {
    made_->make(threads, progress);
}

MadeSweep::~MadeSweep() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

output::NamedTable MadeSweep::table() const {
    const fs::path file = folder_ / kSweepRecord;
    output::write_sweep(file, made_->data());
    return output::read_table(file);
}

std::vector<bool> MadeSweep::unsure(const Tolerance& tolerance, int threads, Progress& progress) const {
    const output::NamedTable own = table();
    std::vector<bool> unsure(points());
    for (std::uint64_t k = 0; k < unsure.size(); ++k)
        unsure[k] = made_->read(k).kind == static_cast<int>(sim::AttractorClass::unsettled);
    for (int twin = 1; twin <= kTwins; ++twin) {
        const MadeSweep other(displaced(made_->grid().scene(), twin), threads, progress);
        for (const std::size_t k : points_that_differ(own, other.table(), tolerance)) unsure[k] = true;
    }
    return unsure;
}

void MadeSweep::write(const output::Target& file, const std::vector<bool>& unsure) const {
    output::SweepData data = made_->data();
    data.rows = [&unsure, rows = data.rows](std::uint64_t k) { return unsure[k] ? 0 : rows(k); };
    data.read = [&unsure, read = data.read](std::uint64_t k) {
        if (!unsure[k]) return read(k);
        output::StoredPoint none;
        none.point = k;
        none.kind = static_cast<int>(sim::AttractorClass::unsettled);
        return none;
    };
    output::write_sweep(file, data);
}

}  // namespace beamcam::scenes
