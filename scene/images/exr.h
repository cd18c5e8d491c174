// Checks OpenEXR files before the library reads them, because its reader trusts their headers.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "scene/images/images.h"

namespace shoal {

// Checks the header: every attribute lies inside the file and has the size of its type, there is one flat part, its
// size and tiles are within the limits, and the file has room for its table of chunks. (The library allocates the
// length that an attribute gives, up to 2 GiB, before it reads.) Pixels are not checked.
// Throws Error ("NAME: what is wrong; what was expected").
// Source: OpenEXR file layout (openexr.com, "Predefined Attributes" and "Component One" to "Five").
void check_exr_header(std::span<const std::uint8_t> file, const std::string& name, const ImageLimits& limits);

}  // namespace shoal
