// The background that filtered waves reflect: every kernel of an instruction set calls this copy.
#include "scene/rough_mirror.h"

namespace shoal::inline SHOAL_ISA_NS {

template RoughMirror<WideF> mirror_roughly(const SkyView&, const WaterBody&, bool, Vec3<WideF>, const ExactRay<WideF>&);

}  // namespace shoal::inline SHOAL_ISA_NS
