#include "render/plot/channel_label.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace beamcam::render {
namespace {

using sim::ChannelKind;

struct LabelRow {
    ChannelKind kind;
    ChannelLabel label;
};
constexpr LabelRow kLabels[] = {
    {ChannelKind::t, {"Time", "时间", "t"}},
    {ChannelKind::theta, {"Hub angle", "转角", "θ"}},
    {ChannelKind::theta_dot, {"Hub speed", "角速度", "θ", "", true}},
    {ChannelKind::tip_deflection, {"Tip deflection", "末端挠度", "v"}},
    {ChannelKind::tip_rate, {"Rate of the tip", "末端挠度变化率", "v", "", true}},
    {ChannelKind::contact_force, {"Contact force", "接触力", "F"}},
    {ChannelKind::friction_force, {"Friction", "摩擦力", "F", "t"}},
    {ChannelKind::gap, {"Gap", "间隙", "g"}},
    {ChannelKind::contact_x, {"Contact point on the beam", "梁上接触点", "x", "c"}},
    {ChannelKind::contact_s, {"Contact point on the disc", "圆盘上接触点", "s", "c"}},
    {ChannelKind::cam_angle, {"Cam angle", "凸轮转角", "ψ"}},
    {ChannelKind::q, {"Modal coordinate", "模态坐标", "q"}},
    {ChannelKind::energy_kinetic, {"Kinetic energy", "动能", "T"}},
    {ChannelKind::energy_potential, {"Potential energy", "势能", "V"}},
    {ChannelKind::energy_elastic, {"Bending energy", "弯曲能", "U"}},
    {ChannelKind::energy_contact, {"Energy in the contact", "接触能", "U", "c"}},
    {ChannelKind::loss_structural, {"Lost in the beam", "结构耗散", "D", "s"}},
    {ChannelKind::loss_contact, {"Lost in the contact", "接触耗散", "D", "c"}},
    {ChannelKind::loss_friction, {"Lost to friction", "摩擦耗散", "D", "f"}},
    {ChannelKind::work_cam, {"Work of the cam", "凸轮做功", "W", "c"}},
    {ChannelKind::work_drive, {"Work of the drive", "驱动做功", "W", "d"}},
    {ChannelKind::energy_residual, {"Energy residual", "能量残差", "ΔE"}},
    {ChannelKind::separation, {"Separation", "分离量", "a", "n"}},
    {ChannelKind::separation_paper, {"Separation, printed form", "分离量（印刷式）", "a", "p"}},
};

static_assert(std::ranges::equal(kLabels, sim::kChannels, {}, &LabelRow::kind, &sim::ChannelRow::kind),
              "each channel needs a label, in the order of its row");

}  // namespace

std::string ChannelLabel::heading(Lang lang) const {
    return lang == Lang::zh ? std::string(chinese) + " " : std::string(words) + " ";
}

std::string ChannelLabel::below(sim::Channel channel) const {
    return channel.kind == ChannelKind::q ? std::to_string(channel.index) : subscript;
}

const ChannelLabel& label_of(ChannelKind kind) { return kLabels[static_cast<std::size_t>(kind)].label; }

std::string print_symbol(sim::Channel channel) {
    const ChannelLabel& label = label_of(channel.kind);
    const std::string below = label.below(channel);
    const std::string symbol = label.rate ? fmt::format("\\dot{{{}}}", label.symbol) : label.symbol;
    if (below.empty()) return fmt::format("${}$", symbol);
    return channel.kind == ChannelKind::q ? fmt::format("${}_{{{}}}$", symbol, below)
                                          : fmt::format("${}_{{\\r{{{}}}}}$", symbol, below);
}

}  // namespace beamcam::render
