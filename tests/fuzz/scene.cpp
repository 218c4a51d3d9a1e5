// The scene reader: every text is a scene or is refused in words; a scene written out is read back as the same.
#include "scenes/scene/scene.hpp"

#include "scenes/format/reader.hpp"
#include "tests/fuzz/support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace beamcam;
    const scenes::Reading reading = scenes::read_scene({"fuzz.json", std::string(fuzz::text_of(data, size)), true});
    bool refused = false;
    for (const Message& message : reading.messages) {
        fuzz::claim(!message.text.empty(), "a message says something");
        refused = refused || message.fatal;
    }
    fuzz::claim(reading.scene.has_value() != refused, "a scene, or a reason why it is none");
    fuzz::claim(reading.messages.empty() || !reading.report().empty(), "the report tells the messages");
    if (!reading.scene) return 0;
    const std::string written = to_json(*reading.scene);
    const scenes::Reading again = scenes::read_scene({"written.json", written, true});
    if (!again.scene) std::fprintf(stderr, "%s\n", again.report().c_str());
    fuzz::claim(again.scene.has_value(), "what was written can be read");
    fuzz::claim(to_json(*again.scene) == written, "and is the same scene");
    return 0;
}
