// The places of captions in a picture of the mechanism. Each keeps its place while others appear and disappear: clear
// of the captions that are shown with it, of labels, and of what moves while it is shown, as far as there is room.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "render/film/caption_leader.hpp"
#include "render/film/mechanism_marks.hpp"

namespace beamcam::render {

inline constexpr double kCaptionLine = 29;  // distance between lines [design px]

struct Caption {
    std::vector<std::string> lines;
    std::vector<double> heights;  // of the lines [px]
    Box plate;
    double opacity = 1;
};

class CaptionPlaces {
  public:
    explicit CaptionPlaces(const MechanismScene& scene);

    Box plate_of(const Callout& callout) const;  // in this frame
    // A place that keeps clear of `moving`, as far as there is room [px].
    Box placed(const Callout& callout, const std::vector<Box>& moving) const;
    Caption caption_of(const Callout& callout, Vec2 at) const;
    bool is_visible(const Callout& callout) const;  // without space for all, a later caption replaces earlier ones
    // Where the leader line of a caption ends. None if the anchor is out of view; without a contact, none to a cam
    // [px].
    std::optional<Vec2> leader_foot(const Callout& callout) const;
    CaptionLeader leader_of(const Callout& callout, const Box& plate, Vec2 foot) const;
    const TextStyle& style() const { return style_; }

    static Anchor::Kind kind_of(const Callout& c) { return c.anchor ? c.anchor->kind : Anchor::Kind::contact; }
    static bool is_at_contact(const Callout& c) { return kind_of(c) == Anchor::Kind::contact; }
    // The order in which captions get their places: those of moving parts last, so that the others keep theirs.
    static bool comes_before(const Callout& one, const Callout& other);

  private:
    void keep_inside(Box& plate) const;
    const Box* hidden(const Box& plate) const;
    void place(Box& plate) const;
    void add_bodies(std::vector<Box>& taken) const;
    std::vector<Box> beam() const;
    bool crosses_cam(Vec2 from, Vec2 to) const;
    Box first_plate(const Callout& callout) const;
    Box plate_at_anchor(const Callout& callout) const;
    Box plate_at_contact(const Callout& callout) const;
    Vec2 foot_of(const Anchor& anchor) const;
    Vec2 contact_foot() const;
    double space_for_later(const Callout& callout) const;
    std::optional<Box> free_plate(const Callout& callout, const Box& first, const std::vector<Box>& taken,
                                  const std::vector<Box>& moving) const;

    const MechanismScene& s;
    const double u;
    const Box& box;
    TextStyle style_;
    std::vector<Box> labels_;                       // that captions must not hide [px]
    mutable std::map<const Callout*, Box> plates_;  // cached
};

}  // namespace beamcam::render
