#include "render/plot/lang.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace beamcam::render {
namespace {

constexpr std::string_view kHole = "{}";  // in a phrase: any text without a separator
constexpr std::string_view kSeparators[] = {" · ", ": ", ", "};

// The same number of holes in both, in the same order, or with numbers: {0}, {1}. The first phrase that is the whole
// text counts.
struct Phrase {
    std::string_view english, chinese;
};
constexpr Phrase kPhrases[] = {
    // films
    {"contact force, trace (√ scale)", "接触力（轨迹，√ 标度）"},
    {"Contact close-up", "接触点放大"},
    {"Contact", "接触"},
    {"smoothed over {}", "按 {} 平滑"},
    {"bending moment (√ scale)", "弯矩（√ 标度）"},
    {"undeflected", "未变形"},
    {"falls under gravity", "在重力作用下下落"},
    {"touches {} from the hub", "触点距轮毂 {}"},
    {"at {}", "速度 {}"},
    {"largest force {}", "最大接触力 {}"},
    {"in collision {}", "在第 {} 次碰撞"},
    {"infinitely many more impacts in {}", "再冲击无穷多次，历时 {}"},
    {"{} more impacts in {}", "再冲击 {} 次，历时 {}"},
    {"{} after the touch", "接触后 {}"},
    {"stays in contact", "保持接触"},
    {"after {}", "此前 {}"},
    {"lifts off after {} and {}", "历时 {}、{}后分离"},
    {"lifts off after {}", "历时 {} 后分离"},
    {"energy {} at the touch", "能量：接触时 {}"},
    {"{} from the cam", "来自凸轮 {}"},
    {"{} from the drive", "来自驱动 {}"},
    {"{} from the fall", "来自下落 {}"},
    {"{} rebound", "反弹 {}"},
    {"{} vibration", "振动 {}"},
    {"{} lost", "耗散 {}"},
    {"{} to the cam", "传给凸轮 {}"},
    {"{} to the drive", "传给驱动 {}"},
    {"infinitely many impacts", "无穷多次冲击"},
    {"{} impacts", "{} 次冲击"},
    {"{} impact", "{} 次冲击"},
    {"stays in contact from {} on", "自 {} 起保持接触"},
    {"heights in {}", "高度单位 {}"},
    {"{} against widths", "{}（相对水平方向）"},
    {"paler: $θ$ not reproducible", "浅色：$θ$ 不能重现"},
    {"paler: $θ$ not reproducible after {}", "浅色：{} 之后 $θ$ 不能重现"},
    {"paler: $θ$ not reproducible {}", "浅色：{} $θ$ 不能重现"},
    {"bends beyond {}", "挠曲超出 {}"},
    {"inextensible elastica", "不可伸长弹性线"},
    {"second-order", "二阶模型"},
    {"first-order", "一阶模型"},
    {"zeroth-order", "零阶模型"},
    {"exact", "精确模型"},
    {"paper", "论文模型"},
    {"rigid beam", "刚性梁"},
    {"rigid", "刚性"},
    {"steel", "钢"},
    {"aluminium", "铝"},
    {"titanium", "钛"},
    {"brass", "黄铜"},
    {"pmma", "有机玻璃"},
    {"pom", "聚甲醛"},
    {"rubber", "橡胶"},
    {"frictionless", "无摩擦"},
    {"stick–slip", "黏滑"},
    {"impulses", "冲量碰撞"},
    {"elastic", "弹性"},
    {"no gravity", "无重力"},
    {"face offset {}", "接触面偏置 {}"},
    {"torque by table", "转矩按表"},
    {"hub by table", "转角按表"},
    {"torque {}", "转矩 {}"},
    {"hub held", "轮毂固定"},
    {"hub at {}", "轮毂转速 {}"},
    {"hub to {} in {}", "轮毂加速至 {}，历时 {}"},
    {"{} modes", "{} 阶模态"},
    {"{} mode", "{} 阶模态"},
    {"deflection ×{}", "挠度 ×{}"},
    {"{} speed", "{} 倍速"},
    {"frozen", "定格"},
    {"Collision {}", "碰撞 {}"},
    {"turns", "圈"},
    {"sticks", "粘着"},
    {"slides", "滑动"},
    {"penetration", "压入"},
    {"potential", "势能"},
    {"kinetic", "动能"},
    {"bending", "弯曲能"},
    {"contact", "接触能"},
    {"Energy", "能量"},
    {"lost", "耗散"},
    {"peak", "峰值"},
    {"no contact", "无接触"},
    {"impulses only", "仅有冲量"},
    {"beam", "梁"},
    {"cam", "凸轮"},
    {"gap", "间隙"},
    // the page
    {"The mechanism", "机构"},
    {"Instant", "时刻"},
    {"Play", "播放"},
    {"Pause", "暂停"},
    {"Space", "空格键"},
    {"Speed", "速度"},
    {"Up and Down", "上下方向键"},
    {"deflection", "挠度"},
    // axes
    {"approach speed", "接近速度"},
    {"averaged over $t$ / s", "平均时间 $t$ / s"},
    {"cam phase / turn", "凸轮相位 / 转"},
    {"restitution", "恢复系数"},
    {"next collision", "下一次碰撞"},
    {"no loss", "无损失"},
    {"every {}", "每隔 {}"},
    {"displacement", "位移"},
    {"velocity", "速度"},
    {"acceleration", "加速度"},
    {"jerk", "跃度"},
    {"hub speed", "轮毂角速度"},
    {"error of {} / rad", "{} 的误差 / rad"},
    {"horizontal distance $x$ from $O$ / m", "距 $O$ 的水平距离 $x$ / m"},
    {"impacts", "冲击次数"},
    {"impacts per period, or per turn of the cam", "每周期（或每转）碰撞次数"},
    {"largest exponent / s^{−1}", "最大 Lyapunov 指数 / s^{−1}"},
    {"mean of {}", "平均 {}"},
    {"phase of the cam", "凸轮相位"},
    {"run time / ms", "计算时间 / ms"},
    {"turns of the cam", "凸轮转数"},
    {"{}, impact $k$", "{}，第 $k$ 次冲击"},
    {"{}, impact $k$ + 1", "{}，第 $k$ + 1 次冲击"},
    // legends, marks and titles of panels
    {"bending and contact", "弯曲与接触能"},
    {"coinciding", "重合"},
    {"completed", "补全各项"},
    {"corrected", "沿杆"},
    {"error, against $N$ = {}", "误差（相对 $N$ = {}）"},
    {"external work", "外功"},
    {"first collision", "首次碰撞"},
    {"flexible", "柔性"},
    {"located", "事件定位"},
    {"No samples to draw; motions: {}", "没有可绘制的点；运动：{}"},
    {"on the beam", "梁上"},
    {"on the cam", "凸轮上"},
    {"printed", "原文公式"},
    {"reference", "参考解"},
    {"rigid, factor 2", "刚性，2 倍"},
    {"simulation", "仿真"},
    {"stable", "稳定"},
    {"sum − work", "总和 − 外功"},
    {"sweep", "扫描"},
    {"target", "目标"},
    {"unknown", "未知"},
    {"unstable", "不稳定"},
    // channels
    {"Time", "时间"},
    {"Hub angle", "转角"},
    {"Hub speed", "角速度"},
    {"Angle of a straight lever", "直杆转角"},
    {"Lift error", "升程误差"},
    {"straight lever", "直杆"},
    {"Tip deflection", "末端挠度"},
    {"Rate of the tip", "末端挠度变化率"},
    {"Contact force", "接触力"},
    {"Friction", "摩擦力"},
    {"Gap", "间隙"},
    {"Contact point on the beam", "梁上接触点"},
    {"Contact point on the disc", "圆盘上接触点"},
    {"Cam angle", "凸轮转角"},
    {"Modal coordinate", "模态坐标"},
    {"Rate of a modal coordinate", "模态坐标变化率"},
    {"Kinetic energy", "动能"},
    {"Potential energy", "势能"},
    {"Bending energy", "弯曲能"},
    {"Energy in the contact", "接触能"},
    {"Lost in the beam", "结构耗散"},
    {"Lost in the hub", "轮毂耗散"},
    {"Energy in the hub's spring", "轮毂弹簧能"},
    {"Lost in the contact", "接触耗散"},
    {"Lost to friction", "摩擦耗散"},
    {"Work of the cam", "凸轮做功"},
    {"Work of the drive", "驱动做功"},
    {"Bending moment at the root", "根部弯矩"},
    {"Largest bending stress", "最大弯曲应力"},
    {"Place of the largest bending stress", "最大弯曲应力位置"},
    {"Force of the pivot", "铰支力"},
    {"Direction of the pivot's force", "铰支力方向"},
    {"Acceleration of the tip", "梁端加速度"},
    {"Power of the drive", "驱动功率"},
    {"Energy residual", "能量残差"},
    {"Separation", "分离量"},
    {"Separation, printed form", "分离量（印刷式）"},
    // motions of sweeps
    {"aperiodic", "非周期"},
    {"carried down", "递减延续"},
    {"carried up", "递增延续"},
    {"chaotic", "混沌"},
    {"following", "跟随"},
    {"over-the-top", "翻越"},
    {"period {}", "周期 {}"},
    {"period {} and more", "周期 {} 及以上"},
    {"{0} turn{1}, {2:g} impact{3}", "{0} 圈，碰撞 {2:g} 次"},
    {"periodic", "周期"},
    {"random starts", "随机初值"},
    {"rest", "静止"},
    {"same start", "相同初值"},
    {"unsettled", "未定"},
};

// The texts in the holes if the phrase is the whole text.
std::optional<std::vector<std::string_view>> match(std::string_view phrase, std::string_view text) {
    std::vector<std::string_view> found;
    for (std::size_t hole = 0; (hole = phrase.find(kHole)) != std::string_view::npos;) {
        const std::string_view before = phrase.substr(0, hole);
        if (!text.starts_with(before)) return std::nullopt;
        text.remove_prefix(before.size());
        phrase.remove_prefix(hole + kHole.size());
        const std::string_view after = phrase.substr(0, phrase.find(kHole));
        const std::size_t end = after.empty() ? text.size() : text.find(after);
        if (end == 0 || end == std::string_view::npos) return std::nullopt;
        found.push_back(text.substr(0, end));
        for (const std::string_view separator : kSeparators)
            if (found.back().find(separator) != std::string_view::npos) return std::nullopt;
        text.remove_prefix(end);
    }
    return text == phrase ? std::optional(found) : std::nullopt;
}

std::string in_chinese(std::string_view text) {
    for (const auto& [english, chinese] : kPhrases) {
        const auto found = match(english, text);
        if (!found) continue;
        std::string out(chinese);
        std::size_t at = 0;
        for (const std::string_view each : *found) {
            const std::string in_hole = in_chinese(each);
            at = out.find(kHole, at);
            out.replace(at, kHole.size(), in_hole);
            at += in_hole.size();
        }
        return out;
    }
    for (const std::string_view separator : kSeparators)
        if (const std::size_t at = text.find(separator); at != std::string_view::npos)
            return in_chinese(text.substr(0, at)) + std::string(separator) +
                   in_chinese(text.substr(at + separator.size()));
    return std::string(text);
}

}  // namespace

std::string_view translated(Lang lang, std::string_view english) {
    if (lang == Lang::en) return english;
    const auto found = std::ranges::find(kPhrases, english, &Phrase::english);
    return found == std::end(kPhrases) ? english : found->chinese;
}

std::string in(Lang lang, std::string text) { return lang == Lang::en ? std::move(text) : in_chinese(text); }

}  // namespace beamcam::render
