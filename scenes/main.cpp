// The program: arguments in, exit code out.
#include "scenes/cli.hpp"

int main(int argc, char** argv) { return beamcam::scenes::command_line(argc, argv); }
