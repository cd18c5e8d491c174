// Rays that a layer does not tell about, gathered from any blocks: looked up in the scene sixteen at a time.
#pragma once

#include "refraction/narrow/nearest_hit.h"

namespace shoal::inline SHOAL_ISA_NS {

// Those that still wait when it goes out of scope are looked up then.
class UnsureRays {
 public:
  // Ids found go to ids[slot].
  UnsureRays(const FrameData& frame, std::int32_t* ids) : f_(frame), ids_(ids) {}
  ~UnsureRays() { look_up(); }
  UnsureRays(const UnsureRays&) = delete;
  UnsureRays& operator=(const UnsureRays&) = delete;

  //   slot   of the block's first pixel in blocked buffers
  //   t, id  as nearest_hits has them
  void add(const Ray<WideF>& ray, const RayDifferential<WideF>& differential, WideF t, WideI id, std::size_t slot,
           WideM lanes) {
    if (none(lanes)) return;
    const Vec3<WideF>* vectors[kVectors] = {&ray.origin_world,          &ray.direction_world,
                                            &differential.origin_dx,    &differential.origin_dy,
                                            &differential.direction_dx, &differential.direction_dy};
    for (int v = 0; v < kVectors; ++v) {
      compress(vectors[v]->x, lanes).store(&value_[3 * v][count_]);
      compress(vectors[v]->y, lanes).store(&value_[3 * v + 1][count_]);
      compress(vectors[v]->z, lanes).store(&value_[3 * v + 2][count_]);
    }
    compress(t, lanes).store(&value_[kRows - 1][count_]);
    compress(id, lanes).store(&id_[count_]);
    for (std::uint32_t left = to_bits(lanes); left != 0; left &= left - 1)
      slot_[count_++] = slot + static_cast<std::size_t>(__builtin_ctz(left));
    if (count_ < 16) return;
    const int rest = count_ - 16;
    count_ = 16;
    look_up();
    WideI::load(&id_[16]).store(&id_[0]);
    for (auto& row : value_) WideF::load(&row[16]).store(&row[0]);
    for (int i = 0; i < rest; ++i) slot_[i] = slot_[16 + i];
    count_ = rest;
  }

 private:
  // Those that wait, at most sixteen.
  void look_up() {
    if (count_ == 0) return;
    const auto vector = [&](int v) SHOAL_LAMBDA {
      return Vec3<WideF>{WideF::load(value_[3 * v]), WideF::load(value_[3 * v + 1]), WideF::load(value_[3 * v + 2])};
    };
    const WideI id = nearest_hits(f_, {vector(0), vector(1)}, {vector(2), vector(3), vector(4), vector(5)},
                                  WideF::load(value_[kRows - 1]), WideI::load(id_), lane_index() < WideI(count_));
    for (int i = 0; i < count_; ++i) ids_[slot_[i]] = extract(id, i);
    count_ = 0;
  }

  static constexpr int kVectors = 6, kRows = 3 * kVectors + 1;
  const FrameData& f_;
  std::int32_t* ids_;
  int count_ = 0;
  std::size_t slot_[32] = {};
  alignas(64) std::int32_t id_[32] = {};
  alignas(64) float value_[kRows][32] = {};
};

}  // namespace shoal::inline SHOAL_ISA_NS
