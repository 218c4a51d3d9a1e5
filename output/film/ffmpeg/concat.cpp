// Joins films without encoding them again.
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "output/film/ffmpeg/library.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace beamcam::output::ffmpeg {
namespace {

struct Segment {
    InputFile file;
    const AVStream* stream = nullptr;
    std::optional<FrameRange> range;  // if the segment states it

    explicit Segment(const std::filesystem::path& name) : file(name), range(frame_range(file)) {
        const AVFormatContext& format = file.format();
        if (format.nb_streams != 1 || format.streams[0]->codecpar->codec_type != AVMEDIA_TYPE_VIDEO)
            throw Mismatch(this->name() +
                           " is not a film of beamcam: it must contain one video stream and nothing else");
        stream = format.streams[0];
        if (file.tag("beamcam-rate-mode") == "variable")
            throw Mismatch(
                this->name() +
                " has a variable frame rate; parts made with --shard have a constant rate and can be joined");
        if (stream->avg_frame_rate.num <= 0 || stream->avg_frame_rate.den <= 0)
            throw Mismatch(this->name() + " does not state its frame rate; films of beamcam do");
    }
    std::string name() const { return file.file().string(); }
    std::string tag(const char* key) const { return file.tag(key); }
};

std::string size_of(const AVCodecParameters& p) { return std::to_string(p.width) + "x" + std::to_string(p.height); }

// A scene without the file names of its outputs, which do not affect the pictures.
std::string without_files(const std::string& scene) {
    const std::string key = "\"file\": \"";
    std::string kept;
    std::size_t from = 0;
    for (std::size_t at = scene.find(key); at != std::string::npos; at = scene.find(key, from)) {
        kept.append(scene, from, at - from);
        std::size_t end = at + key.size();
        while (end < scene.size() && scene[end] != '"') end += scene[end] == '\\' ? 2 : 1;
        from = std::min(end, scene.size());
    }
    return kept.append(scene, from);
}

// Why `b` cannot follow `a`; empty: it can.
std::string mismatch(const Segment& a, const Segment& b) {
    const AVCodecParameters &p = *a.stream->codecpar, &q = *b.stream->codecpar;
    if (p.codec_id != q.codec_id)
        return std::string("codecs ") + avcodec_get_name(p.codec_id) + " and " + avcodec_get_name(q.codec_id);
    if (p.width != q.width || p.height != q.height) return "sizes " + size_of(p) + " and " + size_of(q);
    if (av_cmp_q(a.stream->avg_frame_rate, b.stream->avg_frame_rate) != 0 ||
        av_cmp_q(a.stream->time_base, b.stream->time_base) != 0)
        return "frame rates";
    // VP9 has none: a null pointer of length 0.
    if (!std::equal(p.extradata, p.extradata + p.extradata_size, q.extradata, q.extradata + q.extradata_size))
        return "settings of the encoder";
    if (without_files(a.tag("beamcam-scene")) != without_files(b.tag("beamcam-scene"))) return "scenes";
    if (a.tag("beamcam-version") != b.tag("beamcam-version")) return "versions of beamcam";
    return {};
}

void check_order(const std::vector<Segment>& segments) {
    for (std::size_t i = 1; i < segments.size(); ++i) {
        const Segment &a = segments[i - 1], &b = segments[i];
        if (const std::string what = mismatch(a, b); !what.empty())
            throw Mismatch(a.name() + " and " + b.name() + " have different " + what + " and cannot be joined");
        if (a.range && b.range &&
            (a.range->end != b.range->first || a.range->begin_of_all != b.range->begin_of_all ||
             a.range->end_of_all != b.range->end_of_all))
            throw Mismatch(a.name() + " contains the frames " + a.tag("beamcam-frames") + ", " + b.name() + " " +
                           b.tag("beamcam-frames") + ": name the segments in order, without gaps");
    }
}

class Joiner {
  public:
    Joiner(const std::vector<Segment>& segments, const std::filesystem::path& file, const std::filesystem::path& named,
           const std::string& container)
        : file_(file, named, container) {
        const Segment &first = segments.front(), &last = segments.back();
        AVStream& stream = file_.stream();
        const int code = avcodec_parameters_copy(stream.codecpar, first.stream->codecpar);
        if (code < 0) fail("setting up the film", code);
        stream.time_base = first.stream->time_base;
        stream.avg_frame_rate = first.stream->avg_frame_rate;
        stream.sample_aspect_ratio = first.stream->sample_aspect_ratio;
        copy_tags(first, last);
        // As in all MP4 files of beamcam: index first, own keys. Other containers ignore these flags.
        file_.write_header({{"movflags", "+faststart+use_metadata_tags"}});
    }

    // Appends the packets of one segment. Its first picture has the time 0.
    void add(const Segment& segment) {
        const AVRational frame = av_inv_q(segment.stream->avg_frame_rate), base = segment.stream->time_base;
        const std::int64_t shift = av_rescale_q(frames_, frame, base), before = frames_;
        std::int64_t earliest = AV_NOPTS_VALUE;
        for (;;) {
            const int code = av_read_frame(&segment.file.format(), packet_.get());
            if (code == AVERROR_EOF) break;
            if (code < 0) segment.file.refuse(kDamaged, code);
            if ((packet_->flags & AV_PKT_FLAG_CORRUPT) != 0) segment.file.refuse(kDamaged);
            const bool has_order = packet_->dts != AV_NOPTS_VALUE;
            if (!is_instant(packet_->pts) || (has_order && !is_instant(packet_->dts)))
                segment.file.refuse("it contains a picture without a valid time stamp");
            // The first packet is a key frame and is displayed first.
            if (earliest == AV_NOPTS_VALUE) earliest = packet_->pts;
            packet_->pts += shift - earliest;
            if (has_order) packet_->dts += shift - earliest;
            packet_->stream_index = 0;
            packet_->pos = -1;
            av_packet_rescale_ts(packet_.get(), base, file_.stream().time_base);
            file_.write(*packet_);
            ++frames_;
        }
        const long declared = declared_frames(segment.file, *segment.stream),
                   read = static_cast<long>(frames_ - before);
        if (read == 0 || (declared > 0 && read != declared))
            segment.file.refuse("it contains " + std::to_string(read) + " of its " + std::to_string(declared) +
                                " frames; make or copy it again");
    }

    std::int64_t end() {
        file_.end();
        return frames_;
    }

  private:
    // So small that the sum of three does not overflow. Excludes AV_NOPTS_VALUE, the smallest number.
    static bool is_instant(std::int64_t stamp) {
        constexpr std::int64_t kFar = std::int64_t(1) << 60;
        return stamp > -kFar && stamp < kFar;
    }

    void copy_tags(const Segment& first, const Segment& last) {
        for (const AVDictionaryEntry* entry = nullptr;
             (entry = av_dict_get(first.file.format().metadata, "", entry, AV_DICT_IGNORE_SUFFIX)) != nullptr;) {
            const std::string key = entry->key;
            if (key == "title" || key == "comment" || (key.starts_with("beamcam-") && key != "beamcam-frames"))
                file_.set_tag(key, entry->value);
        }
        if (!first.range || !last.range) return;
        const FrameRange all{first.range->first, last.range->end, first.range->begin_of_all, first.range->end_of_all};
        if (all.first == all.begin_of_all && all.end == all.end_of_all) return;  // the whole film
        file_.set_tag("beamcam-frames", std::to_string(all.first) + ":" + std::to_string(all.end) + " of " +
                                            std::to_string(all.begin_of_all) + ":" + std::to_string(all.end_of_all));
    }

    OutputFile file_;
    Owned<AVPacket> packet_ = owned(av_packet_alloc());
    std::int64_t frames_ = 0;
};

}  // namespace

std::int64_t concatenate(const std::vector<std::filesystem::path>& names, const std::filesystem::path& file,
                         const std::filesystem::path& named, const std::string& container) {
    std::vector<Segment> segments;
    segments.reserve(names.size());
    for (const std::filesystem::path& name : names) segments.emplace_back(name);
    check_order(segments);
    Joiner film(segments, file, named, container);
    for (const Segment& segment : segments) film.add(segment);
    return film.end();
}

}  // namespace beamcam::output::ffmpeg
