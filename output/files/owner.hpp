// The mark by which a user's runs recognize the files that they made.
//
// A secret of 32 hexadecimal digits lies in $XDG_STATE_HOME/beamcam/owner (else ~/.local/state/beamcam/owner), and the
// first run creates it. A list of files that came with somebody's folder cannot contain the marks of this user.
#pragma once

#include <string>

namespace beamcam::output {

// The mark of a file with this name and SHA-256 that this user's run made. Empty if the secret can neither be read nor
// be created: then no file is recognized.
std::string owner_mark(const std::string& name, const std::string& sha256);

}  // namespace beamcam::output
