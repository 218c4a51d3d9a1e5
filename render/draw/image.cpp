// Image is all in its header.
#include "render/draw/image.hpp"
