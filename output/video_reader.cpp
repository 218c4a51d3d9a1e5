#include "output/video_reader.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>
#include <vector>

#include "output/video_library.hpp"
#include "output/video_reader_module.hpp"

namespace beamcam::output {

namespace {

const BeamcamVideoReaderModule& reader_module() {
    using Door = const BeamcamVideoReaderModule* (*)();
    const BeamcamVideoReaderModule* module =
        reinterpret_cast<Door>(video_library_symbol("beamcam_video_reader_module"))();
    if (module->version != kBeamcamVideoReaderVersion)
        throw MissingCodec("the module beamcam_video.so belongs to another version of beamcam; install beamcam again");
    return *module;
}

}  // namespace

struct VideoReader::Impl {
    std::filesystem::path file;
    const BeamcamVideoReaderModule& module = reader_module();
    BeamcamVideoReader* reader = nullptr;
    VideoFacts facts;
    long read = 0;

    explicit Impl(const std::filesystem::path& name) : file(name) {
        BeamcamVideoFacts raw = {};
        BeamcamVideoError error = {};
        check(module.open(file.c_str(), &reader, &raw, &error), error);
        facts = {raw.width, raw.height, static_cast<long>(raw.frames), raw.seconds, raw.codec, raw.container, {}};
        for (const char* const* entry = raw.metadata; *entry != nullptr; entry += 2)
            facts.metadata[entry[0]] = entry[1];
        if (facts.width <= kLargestSide && facts.height <= kLargestSide) return;
        module.close(reader);
        throw IoError("cannot read " + file.string() + ": " + std::to_string(facts.width) + "x" +
                      std::to_string(facts.height) + " pixels are more than the " + std::to_string(kLargestSide) + "x" +
                      std::to_string(kLargestSide) + " that beamcam handles");
    }
    ~Impl() { module.close(reader); }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    void check(BeamcamVideoStatus status, const BeamcamVideoError& error) const {
        switch (status) {
            case beamcam_video_ok:
                return;
            case beamcam_video_missing_codec:
                throw MissingCodec("cannot read " + file.string() + ": " + error.text);
            case beamcam_video_write_failed:
            case beamcam_video_read_failed:
            case beamcam_video_differs:
            case beamcam_video_failed:
                break;
        }
        if (error.error_number == ENOMEM) throw std::bad_alloc();
        throw IoError("cannot read " + file.string() + ": " + error.text);
    }
};

VideoReader::VideoReader(const std::filesystem::path& file) : impl_(std::make_unique<Impl>(file)) {}
VideoReader::~VideoReader() = default;

const VideoFacts& VideoReader::facts() const { return impl_->facts; }

bool VideoReader::next(Raster& picture) {
    picture.resize(impl_->facts.width, impl_->facts.height);
    int got = 0;
    BeamcamVideoError error = {};
    impl_->check(impl_->module.next(impl_->reader, picture.rgba.data(), &got, &error), error);
    if (got != 0) {
        ++impl_->read;
        return true;
    }
    if (impl_->read < impl_->facts.frames)
        throw IoError("cannot read " + impl_->file.string() + ": the film ends after " + std::to_string(impl_->read) +
                      " of its " + std::to_string(impl_->facts.frames) + " frames; make or copy it again");
    return false;
}

VideoAbilities video_abilities() {
    const BeamcamVideoReaderModule& module = reader_module();
    VideoAbilities found{module.versions(), {}};
    const std::pair<const char*, std::vector<const char*>> wanted[] = {
        {"H.264 (libx264)", {"libx264"}},
        {"VP9 (libvpx)", {"libvpx-vp9"}},
        {"AV1 (libsvtav1, libaom)", {"libsvtav1", "libaom-av1"}},
        {"ProRes", {"prores_ks"}},
        {"FFV1", {"ffv1"}},
        {"GIF", {"gif"}},
        {"APNG", {"apng"}}};
    for (const auto& [name, any] : wanted)
        found.encoders[name] =
            std::any_of(any.begin(), any.end(), [&](const char* encoder) { return module.has_encoder(encoder) != 0; });
    return found;
}

}  // namespace beamcam::output
