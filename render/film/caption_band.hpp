// The texts of events, one at a time, in a band below the panels.
#pragma once

#include "render/film/panel.hpp"
#include "render/film/parameter_line.hpp"
#include "render/plot/user_text.hpp"

namespace beamcam::render {

class CaptionBand {
  public:
    explicit CaptionBand(const FilmContext& context);
    void draw(Canvas& canvas, int frame) const;
    bool cuts_texts() const;

  private:
    const FilmContext& context_;
    std::vector<std::vector<FittedText>> texts_;  // lines of the callouts
};

}  // namespace beamcam::render
