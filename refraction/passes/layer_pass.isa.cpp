// Front ends of the refracted and the planar reflection pass (refraction/passes/layer_pass.h).
#include "refraction/passes/layer_pass.h"

#include "raster/front_end.h"
#include "refraction/passes/vertex_programs.h"

namespace shoal::inline SHOAL_ISA_NS {

void refracted_front_end(const LayerPassIn& in, const BinsOut& out, std::size_t work_item) {
  run_work_item(in.geometry, RefractedProgram(in.pass, in.view.view), in.pass.pass, out.bins, work_item);
}

void reflected_front_end(const LayerPassIn& in, const BinsOut& out, std::size_t work_item) {
  run_work_item(in.geometry, ReflectedProgram(in.pass, in.view.view), in.pass.pass, out.bins, work_item);
}

void blended_front_end(const BlendedPassIn& in, const BinsOut& out, std::size_t work_item) {
  const PassSettings settings = blended_settings(in);
  const auto run = [&](const auto& program) {
    run_work_item(in.geometry, program, settings, in.meshlets.data(), out.bins, work_item);
  };
  if (in.pass == nullptr)
    run(DirectProgram{in.view.view, in.view.frustum});
  else if (in.pass->kind == WaterPassKind::kReflected)
    run(ReflectedProgram(*in.pass, in.view.view));
  else
    run(RefractedProgram(*in.pass, in.view.view));
}

}  // namespace shoal::inline SHOAL_ISA_NS
