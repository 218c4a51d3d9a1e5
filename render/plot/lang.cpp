#include "render/plot/lang.hpp"

#include <string_view>

namespace beamcam::render {
namespace {

// Longer phrases come before those that they contain.
constexpr std::pair<std::string_view, std::string_view> kChinese[] = {
    {"contact force, trace (√ scale)", "接触力（轨迹，√ 标度）"},
    {"Contact trace on disc and beam", "圆盘与梁上的接触轨迹"},
    {"Contact trace", "接触轨迹"},
    {"Contact close-up", "接触点放大"},
    {"age of the trace", "轨迹时间"},
    {"bending moment", "弯矩"},
    {" against widths", "（相对水平方向）"},
    {"heights in ", "高度单位 "},
    {"energy closes to ", "能量误差 "},
    {"paler: θ not reproducible", "浅色：θ 不能重现"},
    {"bends beyond ", "挠曲超出 "},
    {"inextensible elastica", "不可伸长弹性线"},
    {"second-order", "二阶模型"},
    {"first-order", "一阶模型"},
    {"zeroth-order", "零阶模型"},
    {"exact", "精确模型"},
    {"paper", "论文模型"},
    {"rigid beam", "刚性梁"},
    {"rigid", "刚性"},
    {"frictionless", "无摩擦"},
    {"stick–slip", "黏滑"},
    {"impulses", "冲量碰撞"},
    {"elastic", "弹性"},
    {"no gravity", "无重力"},
    {"face offset ", "接触面偏置 "},
    {"torque by table", "转矩按表"},
    {"hub by table", "转角按表"},
    {"torque ", "转矩 "},
    {"hub held", "轮毂固定"},
    {"hub at ", "轮毂转速 "},
    {"hub to ", "轮毂加速至 "},
    {" modes", " 阶模态"},
    {" mode", " 阶模态"},
    {"deflection ×", "挠度 ×"},
    {" speed", " 倍速"},
    {"frozen", "定格"},
    {"Collision ", "碰撞 "},
    {"collision ", "碰撞 "},
    {"impact ", "冲击 "},
    {" of ", "/"},
    {"penetration", "压入"},
    {"friction ", "摩擦 "},
    {"friction", "摩擦"},
    {"potential", "势能"},
    {"kinetic", "动能"},
    {"bending", "弯曲能"},
    {"Contact", "接触"},
    {"contact", "接触能"},
    {"Energy ", "能量 "},
    {"lost", "耗散"},
    {"force", "力"},
    {"peak", "峰值"},
    {"no contact", "无接触"},
    {"impulses only", "仅有冲量"},
    {"beam", "梁"},
    {"cam", "凸轮"},
    {"root", "根部"},
    {"tip", "端部"},
    {"gap", "间隙"},
};

}  // namespace

std::string in(Lang lang, std::string text) {
    if (lang == Lang::en) return text;
    for (const auto& [english, chinese] : kChinese)
        for (std::size_t at = 0; (at = text.find(english, at)) != std::string::npos; at += chinese.size())
            text.replace(at, english.size(), chinese);
    return text;
}

}  // namespace beamcam::render
