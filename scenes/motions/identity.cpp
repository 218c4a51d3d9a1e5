#include "scenes/motions/identity.hpp"

#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <set>
#include <string_view>
#include <type_traits>
#include <variant>

#include "output/files/sha256.hpp"
#include "scenes/figures/recipes.hpp"
#include "scenes/motions/fingerprint.hpp"
#include "scenes/scene/version.hpp"

namespace beamcam::scenes {
namespace {

// The note that the linker leaves in every program and library: a digest of its content.
int add_build_id(dl_phdr_info* info, std::size_t, void* out) {
    if (std::string_view(info->dlpi_name).find("linux-vdso") != std::string_view::npos) return 0;  // the kernel's
    for (int i = 0; i < info->dlpi_phnum; ++i) {
        const ElfW(Phdr)& part = info->dlpi_phdr[i];
        if (part.p_type != PT_NOTE) continue;
        // NOLINTNEXTLINE(performance-no-int-to-ptr): the loader tells addresses as numbers
        const char* at = reinterpret_cast<const char*>(info->dlpi_addr + part.p_vaddr);
        const char* end = at + part.p_memsz;
        while (at + sizeof(ElfW(Nhdr)) <= end) {
            ElfW(Nhdr) note;
            std::memcpy(&note, at, sizeof note);
            const char* name = at + sizeof note;
            const char* content = name + (note.n_namesz + 3) / 4 * 4;
            if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == 4 && std::memcmp(name, "GNU", 4) == 0)
                static_cast<std::set<std::string>*>(out)->insert(std::string(content, note.n_descsz));
            at = content + (note.n_descsz + 3) / 4 * 4;
        }
    }
    return 0;
}

// The problem with all that leads to the same motion written alike.
sim::Problem canonical(sim::Problem p) {
    p.beam.basis = resolved_basis(p);
    p.contact.offset = contact_offset(p);
    p.beam.depth = 1;  // else only drawn
    p.contact.stiffness = contact_stiffness(p);
    if (p.cam) {
        p.cam->youngs_modulus.reset();  // of the stiffness alone
        p.cam->poisson_ratio = 0;
    }
    return p;
}

}  // namespace

const std::string& program_identity() {
    static const std::string identity = [] {
        std::set<std::string> build_ids;
        dl_iterate_phdr(add_build_id, &build_ids);
        output::Sha256 builds;
        for (const std::string& each : build_ids) builds.update(each);
        if (build_ids.empty()) builds.update(output::sha256_of_file("/proc/self/exe"));
        return fmt::format("beamcam {} {} {}", kVersion, builds.hex(), processor_path());
    }();
    return identity;
}

std::string motion_key(const sim::Problem& problem) {
    Scene scene;
    scene.problem = canonical(problem);
    scene.end_time = 0;
    return output::sha256("motion\n" + program_identity() + "\n" + to_json(scene));
}

std::string inputs_key(const Scene& scene, std::size_t output, double until, const std::string& part) {
    const Output& wanted = scene.outputs.at(output);
    Scene alone = scene;
    alone.outputs = {wanted};
    const auto* figure = std::get_if<FigureOutput>(&wanted);
    const Recipe* recipe = figure ? recipe_named(figure->figure) : nullptr;
    const bool sweep_film = std::holds_alternative<SweepFilmOutput>(wanted);
    const bool of_sweep = sweep_film || std::holds_alternative<SweepOutput>(wanted) || (recipe && recipe->of_sweep);
    if (of_sweep)
        write_out_tables(*alone.sweep);
    else
        alone.sweep.reset();
    if (is_data(wanted)) alone.title.clear();
    if (!is_picture(wanted) && !sweep_film) alone.units = {};
    const Extent extent = std::visit([](const auto& o) { return o.extent(); }, wanted);
    if (extent != Extent::scene || of_sweep) alone.end_time = extent == Extent::run ? until : 0;
    std::string other = part;
    const bool shows_data = is_picture(wanted) || std::holds_alternative<FigureOutput>(wanted) ||
                            std::holds_alternative<SummaryOutput>(wanted);
    if (!shows_data) alone.data.clear();
    for (const Measurement& each : alone.data) other += "\n" + each.digest;
    std::visit(
        [&other](const auto& o) {
            if constexpr (std::is_base_of_v<Picture, std::decay_t<decltype(o)>>) other += o.logo_digest;
        },
        wanted);
    if (figure) {  // what the scene does not say
        const char* epoch = figure->file.ends_with(".png") ? nullptr : std::getenv("SOURCE_DATE_EPOCH");
        other += fmt::format("\n{}", epoch ? epoch : "");
    }
    return output::sha256(fmt::format("inputs\n{}\n{}\n{}", program_identity(), other, to_json(alone)));
}

}  // namespace beamcam::scenes
