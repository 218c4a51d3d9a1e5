#include "render/plot/survival.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "render/draw/canvas.hpp"

namespace beamcam::render {
namespace {

constexpr int kWidth = 1800, kPlatesAcross = 3;
constexpr double kPageMargin = 48, kHeadHeight = 118, kFieldHeight = 400, kBetweenFields = 34;  // [px]
constexpr double kTitleHeight = 60, kFootHeight = 62;  // of a field: above and below its cells

Color color_of(sim::Outcome outcome) {
    switch (outcome) {
        case sim::Outcome::closed:
            return rgb(0x2f6db3);
        case sim::Outcome::open:
            return rgb(0x9cc3e6);
        case sim::Outcome::refused:
            return rgb(0xc9ccd1);
        case sim::Outcome::stopped:
            return rgb(0xe9a23b);
        case sim::Outcome::failed:
            return rgb(0xc62828);
    }
    return {};
}

const char* meaning(sim::Outcome outcome) {
    switch (outcome) {
        case sim::Outcome::closed:
            return "ended, ledger closed";
        case sim::Outcome::open:
            return "ended, open ledger told";
        case sim::Outcome::refused:
            return "refused in words";
        case sim::Outcome::stopped:
            return "stopped in words";
        case sim::Outcome::failed:
            return "failed";
    }
    return "";
}

constexpr sim::Outcome kOutcomes[] = {sim::Outcome::closed, sim::Outcome::open, sim::Outcome::refused,
                                      sim::Outcome::stopped, sim::Outcome::failed};

using OutcomesByCell = std::map<std::pair<std::size_t, std::size_t>, std::vector<sim::Outcome>>;

class Field {
  public:
    Field(Canvas& canvas, const sim::CaseGrid& plate, const OutcomesByCell& cells, const Box& box)
        : canvas_(canvas), plate_(plate), cells_(cells), box_(box) {
        for (const std::string& row : plate.rows) labels_ = std::max(labels_, canvas.measure(escape(row), small_).w);
        labels_ = std::min(labels_, 0.32 * box.w);
        inner_ = {box.x + labels_ + 12, box.y + kTitleHeight, box.w - labels_ - 12, box.h - kTitleHeight - kFootHeight};
    }
    void draw() {
        canvas_.text({box_.x, box_.y + 18}, escape(plate_.title),
                     {.size = 19, .color = ink_, .weight = Weight::semibold});
        canvas_.text({box_.x, box_.y + kTitleHeight - 12}, escape(plate_.row_title), note_);
        for (const auto& [at, outcomes] : cells_) cell(at.first, at.second, outcomes);
        row_labels();
        column_labels();
    }

  private:
    double width() const { return inner_.w / static_cast<double>(plate_.columns.size()); }
    double height() const { return inner_.h / static_cast<double>(plate_.rows.size()); }

    void cell(std::size_t row, std::size_t column, const std::vector<sim::Outcome>& outcomes) {
        const Box cell{inner_.x + static_cast<double>(column) * width() + 1,
                       inner_.y + static_cast<double>(row) * height() + 1, width() - 2, height() - 2};
        const double stripe = cell.w / static_cast<double>(outcomes.size());
        for (std::size_t i = 0; i < outcomes.size(); ++i) {
            const Box part{cell.x + static_cast<double>(i) * stripe, cell.y, stripe, cell.h};
            canvas_.rectangle(part);
            canvas_.fill(color_of(outcomes[i]));
            if (outcomes[i] != sim::Outcome::failed) continue;
            for (double way : {0.0, 1.0}) {
                canvas_.line({part.x, part.y + way * part.h}, {part.right(), part.y + (1 - way) * part.h},
                             {.color = rgb(0xffffff), .width = 1.5});
            }
        }
    }
    void row_labels() {
        // Every label that has room; at least a line of 17 px.
        const auto every = static_cast<std::size_t>(std::ceil(17 / height()));
        for (std::size_t i = 0; i < plate_.rows.size(); i += every)
            canvas_.text({inner_.x - 10, inner_.y + (static_cast<double>(i) + 0.5) * height() + 5},
                         escape(plate_.rows[i]), small_right());
    }
    void column_labels() {
        double widest = 0;
        for (const std::string& column : plate_.columns)
            widest = std::max(widest, canvas_.measure(escape(column), small_).w + 10);
        const auto every = static_cast<std::size_t>(std::ceil(widest / width()));
        for (std::size_t i = 0; i < plate_.columns.size(); i += every) {
            TextStyle style = small_;
            style.align = HAlign::centre;
            canvas_.text({inner_.x + (static_cast<double>(i) + 0.5) * width(), inner_.bottom() + 20},
                         escape(plate_.columns[i]), style);
        }
        TextStyle style = note_;
        style.align = HAlign::right;
        canvas_.text({inner_.right(), inner_.bottom() + 43}, escape(plate_.column_title), style);
    }
    TextStyle small_right() const {
        TextStyle style = small_;
        style.align = HAlign::right;
        style.max_width = labels_ + 1;
        return style;
    }

    Canvas& canvas_;
    const sim::CaseGrid& plate_;
    const OutcomesByCell& cells_;
    Box box_, inner_;
    double labels_ = 0;
    Color ink_ = rgb(0x1c2530);
    TextStyle small_{.size = 14, .color = rgb(0x3d4854)}, note_{.size = 15, .color = rgb(0x5b6672)};
};

void legend(Canvas& canvas, const std::vector<sim::StressResult>& results) {
    double x = kPageMargin;
    for (const sim::Outcome outcome : kOutcomes) {
        const auto count =
            std::count_if(results.begin(), results.end(), [&](const auto& r) { return r.outcome == outcome; });
        canvas.rectangle({x, 78, 20, 20});
        canvas.fill(color_of(outcome));
        if (outcome == sim::Outcome::failed)
            for (double way : {0.0, 1.0}) {
                canvas.line({x, 78 + way * 20}, {x + 20, 98 - way * 20}, {.color = rgb(0xffffff), .width = 1.5});
            }
        const Box text = canvas.text({x + 28, 94}, fmt::format("{}: {}", meaning(outcome), count),
                                     {.size = 17, .color = rgb(0x1c2530)});
        x = text.right() + 36;
    }
}

}  // namespace

Image survival_map(const sim::Campaign& campaign, const std::vector<sim::StressResult>& results) {
    std::vector<OutcomesByCell> cells(campaign.grids.size());
    for (std::size_t i = 0; i < campaign.cases.size(); ++i) {
        const sim::StressCase& one = campaign.cases[i];
        cells[one.grid][{one.row, one.column}].push_back(results[i].outcome);
    }
    const std::size_t lines = (campaign.grids.size() + kPlatesAcross - 1) / kPlatesAcross;
    const double line = kTitleHeight + kFieldHeight + kFootHeight + kBetweenFields;
    Image image(kWidth, static_cast<int>(kHeadHeight + static_cast<double>(lines) * line + kPageMargin / 2));
    const Fonts fonts;
    Canvas canvas(image, fonts);
    canvas.paint(rgb(0xffffff));
    canvas.text({kPageMargin, 48}, fmt::format("Survival at the extremes: {} cases", campaign.cases.size()),
                {.size = 28, .color = rgb(0x1c2530), .weight = Weight::semibold});
    legend(canvas, results);
    const double width = (kWidth - 2 * kPageMargin - (kPlatesAcross - 1) * kBetweenFields * 1.4) / kPlatesAcross;
    for (std::size_t i = 0; i < campaign.grids.size(); ++i) {
        // The last plate takes what is left of its line.
        const bool last = i + 1 == campaign.grids.size();
        const std::size_t column = i % kPlatesAcross, row = i / kPlatesAcross;
        const double x = kPageMargin + static_cast<double>(column) * (width + 1.4 * kBetweenFields);
        const Box box{x, kHeadHeight + static_cast<double>(row) * line + 10, last ? kWidth - kPageMargin - x : width,
                      kTitleHeight + kFieldHeight + kFootHeight};
        Field(canvas, campaign.grids[i], cells[i], box).draw();
    }
    return image;
}

}  // namespace beamcam::render
