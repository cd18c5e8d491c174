#include "refraction/stage_digests.h"

#include <string_view>

namespace shoal {

struct StageDigests::Stage {
  std::string name;
  Digest digest;
};

StageDigests::StageDigests() = default;
StageDigests::~StageDigests() = default;

Digest& StageDigests::stage(const char* name) {
  for (auto& s : stages_)
    if (s->name == name) return s->digest;
  stages_.push_back(std::make_unique<Stage>());
  stages_.back()->name = name;
  return stages_.back()->digest;
}

namespace {

// Rows of pixels; with a region, only the pixels of its cells.
template <class T>
void add_rows(Digest& digest, const FrameGrid& grid, const AlignedArray<T>& buffer,
              const std::vector<std::uint8_t>* region) {
  std::vector<T> row;
  for (int y = 0; y < grid.height_px; ++y) {
    row.clear();
    for (int x = 0; x < grid.width_px; ++x) {
      const std::size_t cell = static_cast<std::size_t>(y / kRegionSize) * static_cast<std::size_t>(grid.regions_x) +
                               static_cast<std::size_t>(x / kRegionSize);
      if (region != nullptr && (*region)[cell] == 0) {
        x |= kRegionSize - 1;
        continue;
      }
      row.push_back(buffer[grid.slot(x, y)]);
    }
    digest.add(row.data(), row.size() * sizeof(T));
  }
}

}  // namespace

void StageDigests::shadow(const FrameData& f) {
  for (const SunMap& map : f.shadows.maps)
    for (const ShadowMap& level : map.levels) add_rows(stage("shadow"), level.grid, level.depth, nullptr);
}

void StageDigests::direct(const FrameData& f) {
  add_rows(stage("visibility.direct"), f.grid, f.direct.id, nullptr);
  add_rows(stage("depth.direct"), f.grid, f.direct.depth, nullptr);
}

void StageDigests::refracted(const FrameData& f) {
  add_rows(stage("visibility.refracted"), f.layers.grid, f.refracted.id, &f.layer_regions);
  add_rows(stage("depth.refracted"), f.layers.grid, f.refracted.depth, &f.layer_regions);
}

void StageDigests::reflected(const FrameData& f) {
  add_rows(stage("visibility.reflected"), f.layers.grid, f.mirrored.id, &f.layer_regions);
  add_rows(stage("depth.reflected"), f.layers.grid, f.mirrored.depth, &f.layer_regions);
}

void StageDigests::blended(const FrameData& f) {
  if (!f.blended.any()) return;
  // Empty blocks are those that let everything through.
  for (const BlendLayer* layer : {&f.blended.direct, &f.blended.refracted, &f.blended.mirrored}) {
    if (layer->filled.size() == 0) continue;
    for (const auto* plane : {&layer->red, &layer->green, &layer->blue, &layer->keep}) {
      AlignedArray<float> whole(plane->size());
      for (std::size_t i = 0; i < whole.size(); ++i)
        whole[i] = layer->filled[i / kBlockPixels] != 0 ? (*plane)[i] : (plane == &layer->keep ? 1.0f : 0.0f);
      add_rows(stage("blended"), f.grid, whole, nullptr);
    }
  }
}

void StageDigests::shaded(const FrameData& f) {
  for (const AlignedArray<float>& plane : f.gbuffer.plane) add_rows(stage("gbuffer"), f.grid, plane, nullptr);
  const HitPoints& h = f.hit_points;
  for (const auto* plane : {&h.kind, &h.id}) add_rows(stage("hit"), f.grid, *plane, nullptr);
  for (const auto* plane : {&h.x_world, &h.y_world, &h.z_world}) add_rows(stage("hit"), f.grid, *plane, nullptr);
}

void StageDigests::picture(const FrameData& f) {
  for (const auto* plane : {&f.lit.red, &f.lit.green, &f.lit.blue, &f.lit.alpha})
    add_rows(stage("lit"), f.grid, *plane, nullptr);
  stage("final").add(f.srgb8.data(), f.srgb8.size());
}

std::vector<std::pair<std::string, std::string>> StageDigests::list() const {
  std::vector<std::pair<std::string, std::string>> out;
  for (const auto& s : stages_) out.emplace_back(s->name, s->digest.hex());
  return out;
}

}  // namespace shoal
