namespace beamcam::output {}
