// Output "sweep": the samples of all points of the scene's sweep, as NetCDF-4, CSV or NPZ.

#include <iostream>

#include "output/data/sweep_data.hpp"
#include "output/files/standard_output.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/value_formats.hpp"
#include "scenes/plan/planner.hpp"
#include "scenes/scene/files.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {

void SweepOutput::visit(SceneVisitor& v) {
    visit_file(v, file, {".nc", ".csv", ".npz"}, "-sweep.nc");
    v.check([this](ObjectReader& r) {
        if (!r.context().scene.sweep && !r.diagnostics().any())
            r.reject_object("type", ": the scene has no key \"sweep\"; add it, or remove this output");
    });
}

void SweepOutput::plan(Planner& planner, std::size_t output) const {
    DataFile data{output, file, "sweep", {}};
    if (const Shard& shard = planner.selection().shard; !shard.whole()) {
        if (!file.ends_with(".nc"))
            return planner.skip(file, "parts of a sweep must be .nc files, which `beamcam collect` joins");
        data.file = shard_file(file, shard);
        data.part = shard.text();
    }
    for (const SweptKey& over : planner.scene().sweep->over)
        data.content += (data.content.empty() ? "over " : " and ") + over.key;
    data.write = [](const DataSource& from) {
        if (from.file) {
            output::write_sweep(*from.file, *from.sweep);
        } else {
            output::write_sweep_csv(std::cout, *from.sweep);
            output::flush_data();
        }
        return counted(from.sweep->rows_in_all(), "row");
    };
    planner.require_sweep(data.file);
    planner.add(std::move(data));
}

}  // namespace beamcam::scenes
