// What OpenEXR's reader takes on trust, checked before it sees a file.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "scene/images/images.h"

namespace shoal {

// Walks the header: every attribute inside of the file and of its type's size, one flat part, a size and tiles within
// the limits, a table of chunks that the file has room for. The library takes the memory that an attribute's length
// asks for, up to 2 GiB, before it reads. Pixels are not looked at. Throws Error ("NAME: what is wrong; what was
// expected"). Source: OpenEXR file layout (openexr.com, "Predefined Attributes" and "Component One" to "Five").
void check_exr_header(std::span<const std::uint8_t> file, const std::string& name, const ImageLimits& limits);

}  // namespace shoal
