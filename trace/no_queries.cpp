// A build without libraries has no ray tracer.
#include "trace/ray_queries.h"

namespace shoal {

std::unique_ptr<RayQueries> make_ray_queries(const RenderScene&, int) { return nullptr; }

}  // namespace shoal
