// The reader of baselines: entries or words; an edit of nothing leaves every byte but "renderers" readable.
#include "scenes/commands/commands.hpp"
#include "scenes/format/reader.hpp"
#include "scenes/regression/baseline_edit.hpp"
#include "tests/fuzz/support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace beamcam;
    const fuzz::MemoryFile file(fuzz::text_of(data, size));
    try {
        const scenes::Baselines read = scenes::read_baselines(file.path());
        fuzz::claim(!read.entries.empty(), "baselines guard something");
        scenes::Baselines wanted = read;
        wanted.renderers["0123456789ab"] = {{"cairo", "1"}};
        for (scenes::Baseline& entry : wanted.entries)
            if (entry.problem.empty()) {
                entry.accepted = {{"0123456789ab", {std::string(64, 'a')}}};
                entry.reproducible_until = 0.25;
            }
        const fuzz::MemoryFile again(edited(read, wanted));
        const scenes::Baselines changed = scenes::read_baselines(again.path());
        fuzz::claim(changed.entries.size() == read.entries.size(), "an edit keeps the entries");
        for (const scenes::Baseline& entry : changed.entries)
            fuzz::claim(!entry.problem.empty() || (entry.accepted.size() == 1 && entry.reproducible_until == 0.25),
                        "and says what it was told");
    } catch (const scenes::SceneError& error) {
        fuzz::claim(error.what()[0] != 0, "a refusal says why");
    } catch (const scenes::UnreadableFile&) {
    }
    return 0;
}
