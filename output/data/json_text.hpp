// Values as JSON text; for the files that write records.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace beamcam::output {

using Json = nlohmann::ordered_json;

// Messages may quote a user's bytes, which need not be UTF-8; they become U+FFFD.
inline std::string text_of(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

}  // namespace beamcam::output
