#include "render/draw/label.hpp"

#include <algorithm>
#include <utility>

namespace beamcam::render {
namespace {

// All relative to the size of the letters.
constexpr double kRaisedMore = 0.06, kLoweredMore = 0.07;  // offsets of scripts, additional if a base has both
constexpr double kBehindItalic = 0.08;                     // space between an italic letter and its superscript
constexpr double kFractionSize = 0.64;                     // size of numerator and denominator
constexpr double kMathAxis = 0.27;                         // height of a fraction's line
constexpr double kClearance = 0.09;                        // space around lines
constexpr double kRootSign = 0.55;                         // its width

class LabelSetter {
  public:
    using Measure = std::function<RunExtent(const SetRun& run)>;
    LabelSetter(double size, const LetterRules& rules, const Measure& measure)
        : size_(size), rules_(rules), measure_(measure) {
        label_.ascent = rules.cap_height * size;
    }

    SetLabel set(const std::vector<Run>& runs) {
        for (std::size_t i = 0; i < runs.size(); ++i) {
            if (runs[i].over.empty())
                add_text(runs, i);
            else if (runs[i].under.empty())
                add_root(runs[i]);
            else
                add_fraction(runs[i]);
        }
        return std::move(label_);
    }

  private:
    // Scripts of one base start at the same position.
    void add_text(const std::vector<Run>& runs, std::size_t i) {
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

    void add_fraction(const Run& run) {
        const double small = smaller(kFractionSize), gap = kClearance * size_, axis = -kMathAxis * size_;
        SetLabel above = set_label(run.over, small, rules_, measure_),
                 below = set_label(run.under, small, rules_, measure_);
        const double x = label_.width, wide = std::max(above.width, below.width) + 2 * gap;
        add_rule({{x + gap / 2, axis}, {x + wide - gap / 2, axis}});
        const Vec2 up{x + (wide - above.width) / 2, axis - gap - above.descent},
            down{x + (wide - below.width) / 2, axis + gap + below.ascent};
        append(std::move(above), up);
        append(std::move(below), down);
        end_base(x + wide);
    }

    void add_root(const Run& run) {
        const double gap = kClearance * size_, sign = kRootSign * size_;
        SetLabel inside = set_label(run.over, size_, rules_, measure_);
        const double x =
            label_.width + (label_.width > 0 ? gap : 0);  // the root sign starts low, where a subscript may end
        const double top = -inside.ascent - gap, end = x + sign + inside.width;
        add_rule({{x, -0.3 * size_},
                  {x + 0.3 * sign, -0.36 * size_},
                  {x + 0.6 * sign, inside.descent},
                  {x + sign, top},
                  {end, top}});
        append(std::move(inside), {x + sign, 0});
        label_.ascent = std::max(label_.ascent, gap - top);
        end_base(end + gap / 2);
    }

    void add_rule(std::vector<Vec2> rule) {
        for (const Vec2 p : rule) label_.ink.add(p, kRuleWidth * size_ / 2);
        label_.rules.push_back(std::move(rule));
    }
    void add_ink(const Box& box, Vec2 at) {
        if (box.h > 0) label_.ink.add(at + Vec2{box.x, box.y}), label_.ink.add(at + Vec2{box.right(), box.bottom()});
    }

    // Adds a part whose baseline starts at `at`.
    void append(SetLabel part, Vec2 at) {
        add_ink(part.ink.box(), at);
        for (SetRun& run : part.runs) {
            run.x += at.x, run.y += at.y;
            label_.runs.push_back(std::move(run));
        }
        for (std::vector<Vec2>& rule : part.rules) {
            for (Vec2& p : rule) p += at;
            add_rule(std::move(rule));
        }
        label_.smallest_letter = std::min(label_.smallest_letter, part.smallest_letter);
        label_.ascent = std::max(label_.ascent, part.ascent - at.y);
        label_.descent = std::max(label_.descent, part.descent + at.y);
    }
    void end_base(double x) {
        label_.width = base_end_ = above_end_ = below_end_ = x;
        base_is_italic_ = false;
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
