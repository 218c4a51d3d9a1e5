// Finds and loads the module that links FFmpeg (beamcam_video.so), once, when it is first wanted.
#pragma once

namespace beamcam::output {

// The function of that name in the module; it stays loaded. Throws MissingCodec with every place that was looked at.
void* video_library_symbol(const char* name);

}  // namespace beamcam::output
