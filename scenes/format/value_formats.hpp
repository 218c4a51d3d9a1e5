// Values with a notation of their own. Each ValueFormat reads, writes and describes one.
#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "scenes/format/keys.hpp"

namespace beamcam::scenes {

// The format of `value`, which is a T or a std::optional<T>. `read` returns an optional T, or reports why there is
// none.
template <class Value, class Read, class Write>
ValueFormat format_of(Value& value, const char* type, std::string schema, Read read, Write write) {
    const auto write_present = [&value, write]() -> Node {
        if constexpr (requires { value.has_value(); })
            return value ? Node(write(*value)) : Node();
        else
            return write(value);
    };
    const auto read_into = [&value, read](ObjectReader& r, const Node& node, const std::string& key) {
        if (const auto given = read(r, node, key)) value = *given;
    };
    return {type, std::move(schema), read_into, write_present};
}

// The text of a string; empty: the node is none.
inline std::string word_in(const Node& node) { return node.kind == Node::Kind::string ? node.text : ""; }

// A relative path with one of these endings. `numbered`: with '#' for the number of a frame.
ValueFormat file_format(std::string& file, std::initializer_list<const char*> endings, bool numbered = false);
// The key "file" of an output; without it the name is that of the scene and `ending`.
void visit_file(SceneVisitor& v, std::string& file, std::initializer_list<const char*> endings, const char* ending,
                const char* meaning = "Name of the file", const char* note = "");
// The factor of the deflection; absent: "auto".
void visit_exaggeration(SceneVisitor& v, std::optional<double>& factor, const char* meaning);
// A number, or a text with a unit. Its dimension depends on other keys: nullopt if they have an error.
using DimensionOf = std::function<std::optional<sim::Dimension>(const ObjectReader& r)>;
ValueFormat quantity_format(double& value, DimensionOf dimension);
ValueFormat quantity_format(std::optional<double>& value, DimensionOf dimension);
ValueFormat quantities_format(std::vector<double>& values, DimensionOf dimension, int fewest = 0);
// The dimension of the values of a channel.
sim::Dimension dimension_of(const sim::Channel& channel, const sim::Problem& problem);
DimensionOf dimension_of_first(const std::vector<sim::Channel>& channels);
// The unit of an axis whose values have this dimension.
ValueFormat unit_format(AxisUnit& unit, DimensionOf dimension);
ValueFormat texts_format(std::vector<std::string>& texts);
ValueFormat size_format(Size& size);
ValueFormat frame_rate_format(FrameRate& rate);
ValueFormat instant_format(Instant& at);
ValueFormat instant_format(std::optional<Instant>& at);
// The first or last instant of a film or figure: a time or an event. `last`: whether it is named "last".
ValueFormat bound_format(double& time, std::optional<Instant>& event);
ValueFormat bound_format(std::optional<double>& time, std::optional<Instant>& event, bool* last = nullptr);
ValueFormat speed_format(Speed& speed);
ValueFormat anchor_format(render::Anchor& anchor);
ValueFormat anchor_format(std::optional<render::Anchor>& anchor);
ValueFormat background_format(render::View& view);
std::vector<std::string> channel_names(const std::vector<sim::Channel>& channels);
// Appends the channels that an array names; each must be among `allowed`.
void read_channels(ObjectReader& r, const Node& node, const std::string& key, const std::vector<sim::Channel>& allowed,
                   std::vector<sim::Channel>& out);
ValueFormat channels_format(std::vector<sim::Channel>& channels);
ValueFormat grouped_channels_format(std::vector<SeriesPanel>& panels);  // one panel for each unit
ValueFormat abscissa_format(std::string& against);  // "t", "turns", "phase", "frequency" or a channel

inline constexpr sim::Range kFromStart{0, sim::Range::kInfinity, false, false, "is negative; times begin at 0"};
inline constexpr sim::Range kSpeedRange{1e-6, 1000, false, false,
                                        "is outside 1e-06 … 1000; 1 is real time, 0.1 a tenth of it"};

}  // namespace beamcam::scenes
