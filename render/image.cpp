namespace beamcam::render {}
