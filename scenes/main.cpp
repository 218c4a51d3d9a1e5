// The program: arguments in, exit code out.
#include <stdio_ext.h>

#include <cstdio>
#include <cstdlib>
#include <initializer_list>

#include "scenes/commands/cli.hpp"

int main(int argc, char** argv) {
    // Pictures must not depend on these variables.
    for (const char* name : {"FREETYPE_PROPERTIES", "FC_DEBUG"}) unsetenv(name);
    __fpurge(stdout);  // pixman prints a message before main if PIXMAN_DISABLE is set
    return beamcam::scenes::command_line(argc, argv);
}
