// The kinds of panels: each is a row here, and a file that makes it.
#include <algorithm>

#include "render/film/panel.hpp"

namespace beamcam::render {

std::unique_ptr<FilmPanel> make_mechanism_panel(const FilmContext& context, const PanelSlot& slot);
std::unique_ptr<FilmPanel> make_strip_panel(const FilmContext& context, const PanelSlot& slot);
std::unique_ptr<FilmPanel> make_phase_panel(const FilmContext& context, const PanelSlot& slot);
std::unique_ptr<FilmPanel> make_energy_panel(const FilmContext& context, const PanelSlot& slot);
std::unique_ptr<FilmPanel> make_close_up_panel(const FilmContext& context, const PanelSlot& slot);
std::unique_ptr<FilmPanel> make_traces_panel(const FilmContext& context, const PanelSlot& slot);

const std::vector<PanelType>& panel_types() {
    using enum sim::ChannelKind;
    static const std::vector<PanelType> types{
        {.kind = PanelKind::mechanism, .name = "mechanism", .smallest = {16, 16}, .make = make_mechanism_panel},
        // Hub speed against hub angle.
        {.kind = PanelKind::phase,
         .name = "phase",
         .smallest = {240, 170},
         .make = make_phase_panel,
         .channels = {theta, theta_dot},
         .draws_curve = true},
        // The terms of the energy balance as stacked bands against time.
        {.kind = PanelKind::energy,
         .name = "energy",
         .smallest = {300, 150},
         .make = make_energy_panel,
         .channels = {energy_kinetic, energy_potential, energy_elastic, energy_contact, loss_structural, loss_contact,
                      loss_friction, work_cam, work_drive},
         .takes_window = true},
        // The contact in micrometres.
        {.kind = PanelKind::close_up,
         .name = "close-up",
         .smallest = {240, 170},
         .make = make_close_up_panel,
         .needs_cam = true},
        // Where the contact has been on disc and beam.
        {.kind = PanelKind::traces,
         .name = "traces",
         .smallest = {240, 170},
         .make = make_traces_panel,
         .needs_cam = true},
        // Channels against time.
        {.kind = PanelKind::strip,
         .name = "strip",
         .smallest = {300, 150},
         .make = make_strip_panel,
         .takes_channels = true,
         .takes_window = true,
         .takes_collisions = true}};
    return types;
}

const PanelType& type_of(PanelKind kind) { return *std::ranges::find(panel_types(), kind, &PanelType::kind); }

}  // namespace beamcam::render
