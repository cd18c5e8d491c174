// The properties of a material that the rasterizer reads.
#pragma once

namespace shoal {

struct DrawState {
  bool double_sided = false;  // back faces are drawn
  bool alpha_tested = false;  // the pass's alpha test decides which covered pixels are kept
  bool blended = false;       // left out of passes with PassSettings::skip_blended
};

}  // namespace shoal
