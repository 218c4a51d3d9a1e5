// `--set`: each line is one override of the empty scene; all apply or are refused in words.
#include "scenes/format/overrides.hpp"
#include "scenes/format/reader.hpp"
#include "tests/fuzz/support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace beamcam;
    std::vector<std::string> overrides;
    std::string_view rest = fuzz::text_of(data, size);
    while (!rest.empty() && overrides.size() < 8) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        overrides.emplace_back(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    const scenes::Reading reading = scenes::read_scene({"fuzz.json", "{}", true}, overrides);
    bool refused = false;
    for (const Message& message : reading.messages) {
        fuzz::claim(!message.text.empty(), "a message says something");
        fuzz::claim(message.place.source <= overrides.size(), "and points at an override");
        refused = refused || message.fatal;
    }
    fuzz::claim(reading.scene.has_value() != refused, "a scene, or a reason why it is none");
    fuzz::claim(reading.messages.empty() || !reading.report().empty(), "the report tells the messages");
    return 0;
}
