#include "render/draw/label.hpp"

#include <algorithm>
#include <utility>

namespace beamcam::render {
namespace {

// All relative to the size of the letters.
constexpr double kRaisedMore = 0.06, kLoweredMore = 0.07;  // offsets of scripts, additional if a base has both
constexpr double kBehindItalic = 0.08;                     // space between an italic letter and its superscript

class LabelSetter {
  public:
    using Measure = std::function<RunExtent(const SetRun& run)>;
    LabelSetter(double size, const LetterRules& rules, const Measure& measure)
        : size_(size), rules_(rules), measure_(measure) {
        label_.ascent = rules.cap_height * size;
    }

    SetLabel set(const std::vector<Run>& runs) {
        for (std::size_t i = 0; i < runs.size(); ++i) add(runs, i);
        return std::move(label_);
    }

  private:
    // Scripts of one base start at the same position.
    void add(const std::vector<Run>& runs, std::size_t i) {
        const Run& run = runs[i];
        SetRun set{.run = run, .size = run.script ? smaller(rules_.script_size) : size_};
        const bool both = run.script != 0 && has_both_scripts(runs, i);
        if (run.script > 0) set.y = -(rules_.raised + (both ? kRaisedMore : 0)) * size_;
        if (run.script < 0) set.y = (rules_.lowered + (both ? kLoweredMore : 0)) * size_;
        double& end = run.script > 0 ? above_end_ : run.script < 0 ? below_end_ : label_.width;
        set.x = end;
        if (base_is_italic_ && !run.symbol) {
            if (run.script == 0 && runs[i - 1].script == 0) set.x += rules_.behind_italic * size_;
            if (run.script > 0 && above_end_ == base_end_) set.x += kBehindItalic * size_;
        }
        const RunExtent extent = measure_(set);
        set.advance = extent.advance, set.top = extent.top;
        end = set.x + set.advance;
        add_ink(extent.ink, {set.x, set.y});
        label_.width = std::max(label_.width, end);
        if (run.script == 0) {
            above_end_ = below_end_ = base_end_ = end;
            base_is_italic_ = run.symbol;
        }
        label_.smallest_letter = std::min(label_.smallest_letter, set.size);
        label_.ascent = std::max(label_.ascent, -set.y + (run.script ? rules_.cap_height * set.size : 0));
        if (run.dots) label_.ascent = std::max(label_.ascent, 0.98 * size_), label_.ink.add({set.x, -0.98 * size_});
        if (run.script < 0) label_.descent = std::max(label_.descent, set.y + 0.12 * set.size);
        label_.runs.push_back(std::move(set));
    }
    static bool has_both_scripts(const std::vector<Run>& runs, std::size_t i) {
        const auto is_other = [&](std::size_t k) { return runs[k].script == -runs[i].script; };
        for (std::size_t k = i; k-- > 0 && runs[k].script != 0;)
            if (is_other(k)) return true;
        for (std::size_t k = i + 1; k < runs.size() && runs[k].script != 0; ++k)
            if (is_other(k)) return true;
        return false;
    }

    void add_ink(const Box& box, Vec2 at) {
        if (box.h > 0) label_.ink.add(at + Vec2{box.x, box.y}), label_.ink.add(at + Vec2{box.right(), box.bottom()});
    }
    double smaller(double share) const { return std::max(rules_.smallest, share * size_); }

    double size_;
    const LetterRules& rules_;
    const Measure& measure_;
    SetLabel label_;
    double base_end_ = 0, above_end_ = 0, below_end_ = 0;  // ends of the last base and its scripts
    bool base_is_italic_ = false;
};

}  // namespace

SetLabel set_label(const std::vector<Run>& runs, double size, const LetterRules& rules,
                   const std::function<RunExtent(const SetRun& run)>& extent) {
    return LabelSetter(size, rules, extent).set(runs);
}

}  // namespace beamcam::render
