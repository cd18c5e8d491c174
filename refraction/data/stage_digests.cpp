#include "refraction/data/stage_digests.h"

#include <string_view>

namespace shoal {

struct StageDigests::Stage {
  std::string name;
  Digest digest;
};

StageDigests::StageDigests(const Targets& targets, const TargetNeeds& needs, const FrameGrids& grids,
                           const LayerRegions& layer_regions)
    : targets_(targets), needs_(needs), grids_(grids), layer_regions_(layer_regions) {}
StageDigests::~StageDigests() = default;

Digest& StageDigests::digest_of(const char* stage) {
  for (auto& s : stages_)
    if (s->name == stage) return s->digest;
  stages_.push_back(std::make_unique<Stage>());
  stages_.back()->name = stage;
  return stages_.back()->digest;
}

namespace {

// Rows of pixels; with a region, only the pixels of its cells.
template <class T>
void add_rows(Digest& digest, const FrameGrid& grid, const AlignedArray<T>& buffer,
              const std::vector<std::int32_t>* region) {
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

void StageDigests::add(const char* stage) {
  if (std::string_view(stage) == "blended") return add_blended();
  visit_planes(targets_, needs_, [&](const TargetInfo& info, const auto& plane) {
    if (!info.exists || info.stage == nullptr || std::string_view(info.stage) != stage) return;
    if (info.of_layers)
      add_rows(digest_of(stage), grids_.layers.grid, plane,
               info.regions == 0   ? &layer_regions_.drawn
               : info.regions == 3 ? &layer_regions_.lit
                                   : &layer_regions_.behind[info.regions - 1]);
    else
      add_rows(digest_of(stage), grids_.frame, plane, nullptr);
  });
}

void StageDigests::add_shadows(const SunShadows& shadows) {
  for (const SunMap& map : shadows.maps)
    for (const ShadowMap& level : map.levels) add_rows(digest_of("shadow"), level.grid, level.depth, nullptr);
}

void StageDigests::add_blended() {
  // Empty blocks transmit everything.
  for (const BlendLayer* layer : {&targets_.blended_direct, &targets_.blended_refracted, &targets_.blended_reflected}) {
    if (layer->filled.size() == 0) continue;
    for (const auto* plane : {&layer->red, &layer->green, &layer->blue, &layer->transmittance}) {
      AlignedArray<float> whole(plane->size());
      for (std::size_t i = 0; i < whole.size(); ++i)
        whole[i] = layer->filled[i / kBlockPixels] != 0 ? (*plane)[i] : (plane == &layer->transmittance ? 1.0f : 0.0f);
      add_rows(digest_of("blended"), grids_.frame, whole, nullptr);
    }
  }
}

void StageDigests::add_picture() { digest_of("final").add(targets_.srgb8.data(), targets_.srgb8.size()); }

std::vector<std::pair<std::string, std::string>> StageDigests::list() const {
  std::vector<std::pair<std::string, std::string>> out;
  for (const auto& s : stages_) out.emplace_back(s->name, s->digest.hex());
  return out;
}

}  // namespace shoal
