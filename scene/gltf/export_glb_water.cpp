#include "scene/gltf/export_glb_water.h"

#include <nlohmann/json.hpp>

#include "water/surface_keys.h"

namespace shoal {
namespace {

using json = nlohmann::ordered_json;

// The exact value of a float.
json exact(float value) { return static_cast<double>(value); }

json surface_json(const SurfaceSettings& surface) {
  json out = {{"type", surface_kind_name(surface.kind)}};
  if (surface.kind == SurfaceKind::kSum) {
    out = {{"parts", json::array()}};
    for (const SurfaceSettings& part : surface.parts) out["parts"].push_back(surface_json(part));
    if (surface.slope) out["slope"] = exact(*surface.slope);
    return out;
  }
  // Only keys that differ from the defaults of the surface's kind are written.
  const SurfaceSettings plain;
  for (const SurfaceNumber& key : surface_numbers()) {
    const std::optional<double> value = key.get(surface);
    if (value && value != key.get(plain)) out[key.name] = *value;
  }
  for (const SurfaceChoice& key : surface_choices()) {
    if (key.get(surface) != key.get(plain)) out[key.name] = key.values[key.get(surface)];
  }
  for (const RippleDrop& drop : surface.drops)
    out["drops"].push_back({exact(drop.x_m), exact(drop.z_m), exact(drop.time_s)});
  return out;
}

}  // namespace

json water_json(const WaterSpec& water) {
  json out;
  if (water.has_size) out["size"] = {exact(water.size_x), exact(water.size_z)};
  if (water.has_depth) out["depth"] = exact(water.depth);
  out["ior"] = exact(water.ior);
  out["absorption"] = {exact(water.absorption.x), exact(water.absorption.y), exact(water.absorption.z)};
  out["surface"] = surface_json(water.surface);
  out["geometry"] = water.surface.geometry == WaterGeometry::kDisplaced ? "displaced" : "normals";
  return out;
}

}  // namespace shoal
