// The program: arguments in, exit code out.
#include <stdio_ext.h>

#include <cstdio>
#include <cstdlib>
#include <initializer_list>

#include "scenes/commands/cli.hpp"

int main(int argc, char** argv) {
    // Pictures must not depend on these, nor standard output on what libraries tell of themselves.
    for (const char* name : {"FREETYPE_PROPERTIES", "FC_DEBUG"}) unsetenv(name);
    __fpurge(stdout);  // what they told before main: pixman of PIXMAN_DISABLE
    return beamcam::scenes::command_line(argc, argv);
}
