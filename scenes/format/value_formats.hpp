// Values with a notation of their own. Each ValueFormat reads, writes and describes one.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/format/keys.hpp"

namespace beamcam::scenes {

ValueFormat file_format(std::string& file, std::initializer_list<const char*> endings);  // relative, of these endings
ValueFormat numbered_file_format(std::string& file);                                     // .png with '#' for the number
ValueFormat size_format(Size& size);
ValueFormat frame_rate_format(FrameRate& rate);
ValueFormat instant_format(Instant& at);
ValueFormat instant_format(std::optional<Instant>& at);
// The first or last instant of a film: a time or an event.
ValueFormat bound_format(double& time, std::optional<Instant>& event);
ValueFormat bound_format(std::optional<double>& time, std::optional<Instant>& event);
void set_bound(const Instant& at, std::optional<double>& time, std::optional<Instant>& event);
ValueFormat speed_format(Speed& speed);
ValueFormat anchor_format(render::Anchor& anchor);
ValueFormat anchor_format(std::optional<render::Anchor>& anchor);
ValueFormat background_format(render::View& view);
ValueFormat color_format(std::optional<std::uint32_t>& color);
ValueFormat show_format(render::Shown& show);
bool set_background(std::string_view text, render::View& view);  // false: not a background
std::optional<render::Shown> shown_preset(std::string_view name);
inline constexpr const char* kPresets[] = {"all", "talk", "paper", "clean"};
std::vector<std::string> channel_names(const std::vector<sim::Channel>& channels);
// Appends the channels that an array names; each must be among `allowed`.
void read_channels(ObjectReader& r, const Node& node, const std::string& key, const std::vector<sim::Channel>& allowed,
                   std::vector<sim::Channel>& out);
ValueFormat channels_format(std::vector<sim::Channel>& channels);
ValueFormat grouped_channels_format(std::vector<SeriesPanel>& panels);  // one panel for each unit
ValueFormat abscissa_format(std::string& against);  // "t", "turns", "phase", "frequency" or a channel

// One panel for each unit, in order of first occurrence.
std::vector<SeriesPanel> panels_by_unit(const std::vector<sim::Channel>& channels, const sim::Problem& problem);

std::optional<Size> parse_size(std::string_view text);             // "1280x720"
std::optional<FrameRate> parse_frame_rate(std::string_view text);  // "60", "29.97", "30000/1001"
std::optional<Instant> parse_instant(std::string_view text);       // "impact:2", "apex:1", "touch", "last"
bool names_event(std::string_view text);                           // true if it begins like an event
inline constexpr const char* kEventsCount =
    "events are counted from 1: impact:1, collision:2, apex:1, release:3, touch";

inline constexpr sim::Range kFromStart{0, sim::Range::kInfinity, false, false, "is negative; times begin at 0"};
inline constexpr sim::Range kSpeedRange{1e-6, 1000, false, false,
                                        "is outside 1e-06 … 1000; 1 is real time, 0.1 a tenth of it"};

}  // namespace beamcam::scenes
