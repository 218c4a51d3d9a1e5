#include "scenes/regression/computed_sweep.hpp"

#include <cerrno>
#include <cstdlib>

#include "output/files/errors.hpp"
#include "scenes/regression/sweep_record.hpp"
#include "sim/sweep/attractor.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

// Far above rounding errors, far below the differences between settled motions.
constexpr double kPerturbation = 1e-12;
constexpr int kRepetitions = 3;  // find a point that changes in every third run with a probability of 70 %

fs::path temporary_folder() {
    std::error_code error;
    std::string name = (fs::temp_directory_path(error) / "beamcam-sweep-XXXXXX").string();
    if (error) throw output::write_error("the directory for temporary files, TMPDIR", error.value());
    if (!mkdtemp(name.data())) throw output::write_error(name, errno);
    return name;
}

// At most two of these keys are swept; the third changes.
Scene perturbed(Scene scene, int times) {
    const double factor = 1 + times * kPerturbation;
    scene.problem.gravity *= factor;
    if (scene.problem.cam) scene.problem.cam->speed *= factor, scene.problem.cam->eccentricity *= factor;
    return scene;
}

}  // namespace

ComputedSweep::TemporaryFolder::TemporaryFolder() : path(temporary_folder()) {}
ComputedSweep::TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
}

ComputedSweep::ComputedSweep(const Scene& scene, int threads, Progress& progress)
    : run_(std::make_unique<SweepRun>(scene, SweepPart(), folder_.path / "points")) {
    run_->make(threads, progress);
}

output::NamedTable ComputedSweep::table() const {
    const fs::path file = folder_.path / kSweepRecord;
    output::write_sweep(file, run_->data());
    return output::read_table(file);
}

std::vector<bool> ComputedSweep::uncertain(const Tolerance& tolerance, int threads, Progress& progress) const {
    const output::NamedTable own = table();
    std::vector<bool> uncertain(points());
    for (std::uint64_t k = 0; k < uncertain.size(); ++k)
        uncertain[k] = run_->read(k).kind == static_cast<int>(sim::AttractorClass::unsettled);
    for (int repetition = 1; repetition <= kRepetitions; ++repetition) {
        const ComputedSweep other(perturbed(run_->grid().scene(), repetition), threads, progress);
        for (const std::size_t k : points_that_differ(own, other.table(), tolerance)) uncertain[k] = true;
    }
    return uncertain;
}

void ComputedSweep::write(const output::Target& file, const std::vector<bool>& uncertain) const {
    output::SweepData data = run_->data();
    data.rows = [&uncertain, rows = data.rows](std::uint64_t k) { return uncertain[k] ? 0 : rows(k); };
    data.read = [&uncertain, read = data.read](std::uint64_t k) {
        if (!uncertain[k]) return read(k);
        output::StoredPoint none;
        none.point = k;
        none.kind = static_cast<int>(sim::AttractorClass::unsettled);
        return none;
    };
    output::write_sweep(file, data);
}

}  // namespace beamcam::scenes
