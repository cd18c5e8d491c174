// The kernels of one instruction set that are the same for every method.
#include "refraction/methods/kernels.h"
#include "trace/sun_blocked.h"

namespace shoal::inline SHOAL_ISA_NS {

FrameKernels make_frame_kernels() {
  return {.shadow = make_shadow_kernels(),
          .sun_blocked = &sun_blocked,
          .outline_front_end = &outline_front_end,
          .direct_front_end = &direct_front_end,
          .draw_tile = &draw_tile,
          .draw_tile_behind = &draw_tile_behind,
          .find_edges = &find_edges,
          .direct_alpha_test = &direct_alpha_test,
          .refracted_alpha_test = &refracted_alpha_test,
          .reflected_alpha_test = &reflected_alpha_test,
          .draw_tile_over = &draw_tile_over,
          .draw_displaced_water = &draw_displaced_water,
          .count_water = &count_water,
          .refracted_front_end = &refracted_front_end,
          .reflected_front_end = &reflected_front_end,
          .blended_front_end = &blended_front_end,
          .find_interface = &find_interface,
          .reflected_hits = &reflected_hits,
          .layer_from_hits = &layer_from_hits,
          .blend_water = &blend_water,
          .trace_secondary_interfaces = &trace_secondary_interfaces,
          .shade_water = &shade_water,
          .blend_direct = &blend_direct,
          .shade = &shade};
}

}  // namespace shoal::inline SHOAL_ISA_NS
