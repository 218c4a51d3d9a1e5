// Boxes that together contain a path: they tell which tiles of a picture its stroke or its fill changes. Follows the
// path of a Painter, call by call.
#pragma once

#include <vector>

#include "render/draw/geometry.hpp"

namespace beamcam::render {

class PathBoxes {
  public:
    void move_to(Vec2 p);
    void line_to(Vec2 p);
    void close();
    void arc(Vec2 centre, double radius, double from, double to);  // angles counter-clockwise, Y up [rad]
    void circle(Vec2 centre, double radius);
    void rectangle(const Box& box);
    void add(const Box& box) { boxes_.push_back(box); }  // that contains what was added to the path by other means
    void clear();

    const std::vector<Box>& boxes() const { return boxes_; }
    Box around() const;  // the box around all of them

  private:
    void add_line(Vec2 from, Vec2 to);
    void add_arc(Vec2 centre, double radius, double from, double to);

    std::vector<Box> boxes_;
    Vec2 start_, at_;  // of the open part of the path
    bool open_ = false;
};

}  // namespace beamcam::render
