// The Pango side of Fonts, for the two files that talk to Pango.
#pragma once

#include <fontconfig/fontconfig.h>
#include <pango/pangocairo.h>

#include <string>
#include <unordered_map>
#include <utility>

#include "render/draw/fonts.hpp"

namespace beamcam::render {

// Texts as they were laid out, the latest few hundred.
class Words {
  public:
    Words() = default;
    Words(const Words&) = delete;
    Words& operator=(const Words&) = delete;
    ~Words() { forget(); }
    // Owned by this; valid until the next call.
    template <typename Make>
    PangoLayout* get(const std::string& key, Make make) {
        if (const auto known = latest_.find(key); known != latest_.end()) return known->second;
        if (latest_.size() >= kMost) {
            drop(before_);
            before_ = std::exchange(latest_, {});
        }
        if (auto known = before_.extract(key)) return latest_.insert(std::move(known)).position->second;
        return latest_.emplace(key, make()).first->second;
    }
    void forget() { drop(latest_), drop(before_); }

  private:
    static constexpr std::size_t kMost = 256;
    using Known = std::unordered_map<std::string, PangoLayout*>;
    static void drop(Known& words) {
        for (const auto& [key, layout] : words) g_object_unref(layout);
        words.clear();
    }
    Known latest_, before_;
};

struct Fonts::Handles {
    std::string key;  // the files' paths
    FcConfig* config = nullptr;
    PangoFontMap* map = nullptr;
    PangoContext* context = nullptr;
    PangoLayout* layout = nullptr;  // reused for every text of a figure
    mutable Words words;            // of pictures

    Handles() = default;
    Handles(const Handles&) = delete;
    Handles& operator=(const Handles&) = delete;
    ~Handles();
};

}  // namespace beamcam::render
