#include "scenes/plan/inputs_key.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <variant>

#include "output/files/digest.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/motions/identity.hpp"

namespace beamcam::scenes {

std::string inputs_key(const Scene& scene, std::size_t output, double until, const std::string& part) {
    const Output& one = scene.outputs.at(output);
    const OutputInputs shown = inputs_of(one);
    const auto* figure = std::get_if<FigureOutput>(&one);
    const FigureType* type = figure ? figure_type(figure->figure) : nullptr;
    const bool of_sweep = shown.sweep || (type && type->of_sweep());
    Scene inputs = scene;
    inputs.outputs = {one};
    if (!shown.title) inputs.title.clear();
    if (!shown.units) inputs.units = {};
    if (!shown.data) inputs.data.clear();
    if (of_sweep)
        resolve_tables(*inputs.sweep);
    else
        inputs.sweep.reset();
    const Extent extent = std::visit([](const auto& o) { return o.extent(); }, one);
    if (extent != Extent::scene || of_sweep) inputs.end_time = extent == Extent::run ? until : 0;
    std::string other = part;
    for (const Measurement& each : inputs.data) other += "\n" + each.digest;
    if (const auto* picture = std::get_if<PictureOutput>(&one)) other += picture->logo_digest;
    if (figure) {  // not part of the scene
        const char* epoch = figure->file.ends_with(".png") ? nullptr : std::getenv("SOURCE_DATE_EPOCH");
        other += fmt::format("\n{}", epoch ? epoch : "");
    }
    return output::sha256(fmt::format("inputs\n{}\n{}\n{}", program_identity(), other, metadata_json(inputs)));
}

}  // namespace beamcam::scenes
