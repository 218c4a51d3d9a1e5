// Image is all in its header.
#include "render/image.hpp"
