// The letters of texts, for the files that use Pango: their fonts, their layouts, and the places of the runs of a
// markup.
#pragma once

#include <fontconfig/fontconfig.h>
#include <pango/pangocairo.h>

#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "render/draw/fonts.hpp"
#include "render/draw/label.hpp"
#include "render/draw/text_style.hpp"

namespace beamcam::render {

// A few hundred text layouts: most texts of a frame also are in the previous one.
class LayoutCache {
  public:
    LayoutCache() = default;
    LayoutCache(const LayoutCache&) = delete;
    LayoutCache& operator=(const LayoutCache&) = delete;
    ~LayoutCache() { clear(); }
    // The layout is owned by the cache and valid until the next call.
    template <typename Make>
    PangoLayout* get(const std::string& key, Make make) {
        if (const auto known = layouts_.find(key); known != layouts_.end()) return known->second;
        if (layouts_.size() >= kMostLayouts) clear();
        return layouts_.emplace(key, make()).first->second;
    }
    void clear() {
        for (const auto& [key, layout] : layouts_) g_object_unref(layout);
        layouts_.clear();
    }

  private:
    static constexpr std::size_t kMostLayouts = 512;
    std::unordered_map<std::string, PangoLayout*> layouts_;
};

struct Fonts::Handles {
    std::string key;  // the files' paths
    FcConfig* config = nullptr;
    PangoFontMap* map = nullptr;
    PangoContext* context = nullptr;
    mutable LayoutCache layouts;

    Handles() = default;
    Handles(const Handles&) = delete;
    Handles& operator=(const Handles&) = delete;
    ~Handles();
};

// The font of a run of letters; `family` depends only on typefaces and slant.
struct LetterFace {
    const char* family;
    double size = 16;
    Weight weight = Weight::regular;
    bool italic = false, tabular = false;
    double max_width = 0;  // > 0: truncated with an ellipsis
    std::string key(std::string_view text) const;
};
LetterFace face_of(const SetRun& run, const TextStyle& style, Typefaces typefaces);

// The layout of a run, without characters that no font of pictures has; owned by `fonts` and valid until the next call.
// Throws FontError for a character that no font of pages has.
PangoLayout* layout_of(const Fonts& fonts, const LetterFace& face, const std::string& text);
inline PangoLayout* layout_of(const Fonts& fonts, const SetRun& run, const TextStyle& style) {
    return layout_of(fonts, face_of(run, style, fonts.typefaces()), run.run.text);
}
double baseline_of(PangoLayout* layout);  // from its top

// The places of the runs of a markup.
SetLabel set_text(const Fonts& fonts, std::string_view markup, const TextStyle& style);

}  // namespace beamcam::render
