#include "shading/material.h"

namespace shoal {

std::vector<DrawState> draw_states(const std::vector<Material>& materials) {
  std::vector<DrawState> states;
  states.reserve(materials.size());
  for (const Material& m : materials)
    states.push_back({m.double_sided, m.alpha_mode == AlphaMode::kMask, m.alpha_mode == AlphaMode::kBlend});
  return states;
}

}  // namespace shoal
