// The reader of baselines: entries or a message.
#include "scenes/regression/baselines.hpp"

#include "scenes/commands/commands.hpp"
#include "scenes/format/reader.hpp"
#include "tests/fuzz/support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace beamcam;
    const fuzz::MemoryFile file(fuzz::text_of(data, size));
    try {
        const scenes::Baselines read = scenes::read_baselines(file.path());
        fuzz::claim(!read.entries.empty(), "baselines guard something");
        for (const scenes::Baseline& entry : read.entries)
            fuzz::claim(!entry.name.empty() && entry.name.find('/') == std::string::npos, "names lead nowhere else");
    } catch (const scenes::SceneError& error) {
        fuzz::claim(error.what()[0] != 0, "a refusal says why");
    } catch (const output::IoError&) {
    }
    return 0;
}
