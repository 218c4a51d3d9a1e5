// The Pango side of Fonts, for the files that talk to Pango.
#pragma once

#include <fontconfig/fontconfig.h>
#include <pango/pangocairo.h>

#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "render/draw/fonts.hpp"
#include "render/draw/text_style.hpp"

namespace beamcam::render {

// Texts as they were laid out, the latest few hundred: most texts of a frame are those of the frame before.
class LayoutCache {
  public:
    LayoutCache() = default;
    LayoutCache(const LayoutCache&) = delete;
    LayoutCache& operator=(const LayoutCache&) = delete;
    ~LayoutCache() { forget(); }
    // Owned by this; valid until the next call.
    template <typename Make>
    PangoLayout* get(const std::string& key, Make make) {
        if (const auto known = latest_.find(key); known != latest_.end()) return known->second;
        if (latest_.size() >= kMostLayouts) {
            drop(before_);
            before_ = std::exchange(latest_, {});
        }
        if (auto known = before_.extract(key)) return latest_.insert(std::move(known)).position->second;
        return latest_.emplace(key, make()).first->second;
    }
    void forget() { drop(latest_), drop(before_); }

  private:
    static constexpr std::size_t kMostLayouts = 256;
    using Known = std::unordered_map<std::string, PangoLayout*>;
    static void drop(Known& layouts) {
        for (const auto& [key, layout] : layouts) g_object_unref(layout);
        layouts.clear();
    }
    Known latest_, before_;
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

// The letters that a text is laid out in; `family` is the same for all of one size, weight and slant.
struct LetterFace {
    const char* family;
    double size = 16;
    Weight weight = Weight::regular;
    bool italic = false;
    bool tabular = false;  // digits of one width
    double max_width = 0;  // > 0: cut with an ellipsis there
    std::string key(std::string_view markup) const;
};
// The fonts own it; valid until the next call.
PangoLayout* laid_out(const Fonts& fonts, const LetterFace& face, const std::string& markup);

}  // namespace beamcam::render
