// How the cases of the stress campaign are put together: the default system close to its first touch, and cases sorted
// into grids.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "sim/studies/stress.hpp"

namespace beamcam::sim {

inline constexpr double kUsualEnd = 0.06;       // [s] of a usual case: fall, strike, bounce
inline constexpr double kFirstBending = 816.9;  // [rad/s] of the free default beam

// The angle of a straight beam that touches the cam.
inline double touching_angle(const Problem& p) {
    const Vec2 disc = disc_centre(*p.cam, 0);
    return std::atan2(disc.y, disc.x) + std::asin(std::min(1.0, (p.cam->radius + contact_offset(p)) / norm(disc)));
}
inline void approach(Problem& p, double lead = 0.03, double speed = -2) {
    p.initial.angle = touching_angle(p) + lead;
    p.initial.angular_velocity = speed;
}
// The default system, with the beam 0.03 rad above the cam and approaching it.
inline Problem base() {
    Problem p;
    approach(p);
    return p;
}

class CampaignBuilder {
  public:
    void grid(std::string title, std::string rows, std::string columns) {
        campaign_.grids.push_back({std::move(title), std::move(rows), std::move(columns), {}, {}});
    }
    // Names the row and the column of the following cases, texts or numbers. They are in the order of their first use.
    template <class Row, class Column>
    void at(const Row& row, const Column& column) {
        CaseGrid& grid = campaign_.grids.back();
        row_ = index(grid.rows, text(row)), column_ = index(grid.columns, text(column));
    }
    void add(std::string variant, const Problem& problem, double end = kUsualEnd) {
        campaign_.cases.push_back({campaign_.grids.size() - 1, row_, column_, std::move(variant), problem, end});
    }
    void add_single(const char* row, const Problem& problem, double end = kUsualEnd) {
        at(row, name(problem.beam.model));
        add("", problem, end);
    }
    Campaign take() { return std::move(campaign_); }

  private:
    static std::string text(double number) { return fmt::format("{:g}", number); }
    static std::string text(std::string words) { return words; }
    static std::size_t index(std::vector<std::string>& names, const std::string& name) {
        const auto at = std::ranges::find(names, name);
        if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
        names.push_back(name);
        return names.size() - 1;
    }
    Campaign campaign_;
    std::size_t row_ = 0, column_ = 0;
};

void add_grids(CampaignBuilder& out);

}  // namespace beamcam::sim
