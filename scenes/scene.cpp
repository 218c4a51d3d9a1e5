namespace beamcam::scenes {}
