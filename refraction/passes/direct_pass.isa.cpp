// Front ends of the direct pass (refraction/passes/direct_pass.h).
#include "refraction/passes/direct_pass.h"

#include "raster/front_end.h"
#include "refraction/passes/vertex_programs.h"

namespace shoal::inline SHOAL_ISA_NS {

void direct_front_end(const DirectPassIn& in, const BinsOut& out, std::size_t work_item) {
  const DirectProgram program{in.view.view, in.view.frustum};
  run_work_item(in.geometry, program, in.view.direct_pass, out.bins, work_item);
}

void outline_front_end(const OutlinePassIn& in, const BinsOut& out) {
  const DirectProgram program{in.view.view, in.view.frustum};
  for (std::size_t body = 0; body < in.outlines.body_count; ++body) {
    const std::uint32_t first = in.outlines.first_meshlet[body];
    // The rays of the pixels cross a displaced surface (passes/displaced_water.h); its outline is not drawn.
    const std::uint32_t end = is_displaced(in.water[body]) ? first : in.outlines.first_meshlet[body + 1];
    FrontEnd<DirectProgram>(in.outlines.geometry, program, in.view.direct_pass, out.bins.work_items[body])
        .run(first, end, kFirstWaterId + static_cast<std::int32_t>(body));
  }
}

}  // namespace shoal::inline SHOAL_ISA_NS
