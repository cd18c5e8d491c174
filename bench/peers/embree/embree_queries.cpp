// Triangles come in kinds, one Embree geometry each, over the scene's own vertices: the geometry then decides which
// tests a filter makes, and most triangles need none. Primitive numbers keep the scene's order within a kind.
#include "bench/peers/embree/embree_queries.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "core/error.h"
#include "raster/front_end.h"

namespace shoal {

namespace {

// How rays see a triangle.
struct Kind {
  bool one_sided, alpha_tested, casts;
  bool operator==(const Kind&) const = default;
};

struct KindTriangles {
  Kind kind;
  std::vector<std::uint32_t> indices;  // three a triangle, into Geometry::vertices
  std::vector<std::int32_t> id;        // the scene's triangle of each
  RTCGeometry geometry = nullptr;
};

struct QueryContext {
  RTCIntersectContext rtc;  // first: Embree hands it back
  const RayPacket* rays;
};

[[noreturn]] void fail(RTCError error) {
  throw Error(error == RTC_ERROR_OUT_OF_MEMORY ? "the ray tracer is out of memory; expected a smaller scene"
                                               : "the ray tracer fails: Embree error " + std::to_string(error));
}

// Lanes that a filter is called for. A packet's rays carry their lane as id.
struct FilterLanes {
  std::uint32_t bits = 0;
  int place[16] = {};  // of the lane in Embree's arrays
};
FilterLanes lanes_of(const RTCFilterFunctionNArguments* args) {
  FilterLanes lanes;
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const unsigned lane = RTCRayN_id(args->ray, args->N, i) & 15u;
    lanes.bits |= 1u << lane;
    lanes.place[lane] = static_cast<int>(i);
  }
  return lanes;
}

void refuse(const RTCFilterFunctionNArguments* args, const FilterLanes& lanes, std::uint32_t bits) {
  for (int lane = 0; lane < 16; ++lane)
    if (((bits >> lane) & 1u) != 0) args->valid[lanes.place[lane]] = 0;
}

std::uint32_t seen_from_behind(const RTCFilterFunctionNArguments* args, const FilterLanes& lanes) {
  std::uint32_t behind = 0;
  for (int lane = 0; lane < 16; ++lane) {
    if (((lanes.bits >> lane) & 1u) == 0) continue;
    const unsigned i = static_cast<unsigned>(lanes.place[lane]);
    const float along = RTCRayN_dir_x(args->ray, args->N, i) * RTCHitN_Ng_x(args->hit, args->N, i) +
                        RTCRayN_dir_y(args->ray, args->N, i) * RTCHitN_Ng_y(args->hit, args->N, i) +
                        RTCRayN_dir_z(args->ray, args->N, i) * RTCHitN_Ng_z(args->hit, args->N, i);
    if (along > 0.0f) behind |= 1u << lane;
  }
  return behind;
}

std::uint32_t cut_out(const RTCFilterFunctionNArguments* args, const FilterLanes& lanes, std::uint32_t wanted) {
  const RayPacket& rays = *reinterpret_cast<const QueryContext*>(args->context)->rays;
  const KindTriangles& kind = *static_cast<const KindTriangles*>(args->geometryUserPtr);
  if (rays.alpha_test == nullptr || wanted == 0) return 0;
  std::int32_t id[16] = {};
  for (int lane = 0; lane < 16; ++lane)
    if (((wanted >> lane) & 1u) != 0)
      id[lane] = kind.id[RTCHitN_primID(args->hit, args->N, static_cast<unsigned>(lanes.place[lane]))];
  return wanted & ~rays.alpha_test(rays.context, rays, id, wanted);
}

void filter_first_hit(const RTCFilterFunctionNArguments* args) {
  const KindTriangles& kind = *static_cast<const KindTriangles*>(args->geometryUserPtr);
  const FilterLanes lanes = lanes_of(args);
  std::uint32_t refused = kind.kind.one_sided ? seen_from_behind(args, lanes) : 0;
  if (kind.kind.alpha_tested) refused |= cut_out(args, lanes, lanes.bits & ~refused);
  refuse(args, lanes, refused);
}

void filter_blocked(const RTCFilterFunctionNArguments* args) {
  const KindTriangles& kind = *static_cast<const KindTriangles*>(args->geometryUserPtr);
  const FilterLanes lanes = lanes_of(args);
  refuse(args, lanes, kind.kind.casts ? cut_out(args, lanes, lanes.bits) : lanes.bits);
}

}  // namespace

RayPacket make_packet(const float (&origin_world)[3][16], const float (&direction_world)[3][16],
                      const float (&t_far)[16]) {
  RayPacket p;
  std::copy_n(origin_world[0], 16, p.origin_x), std::copy_n(origin_world[1], 16, p.origin_y);
  std::copy_n(origin_world[2], 16, p.origin_z);
  std::copy_n(direction_world[0], 16, p.direction_x), std::copy_n(direction_world[1], 16, p.direction_y);
  std::copy_n(direction_world[2], 16, p.direction_z);
  std::fill_n(p.t_near, 16, 0.0f), std::copy_n(t_far, 16, p.t_far);
  return p;
}

struct EmbreeQueries::Impl {
  Impl(const RenderScene& scene, int threads, bool moves_)
      : device_(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())), moves(moves_) {
    if (device_ == nullptr) fail(rtcGetDeviceError(nullptr));
    sort(scene);
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST |
                                                        (moves ? RTC_SCENE_FLAG_DYNAMIC : RTC_SCENE_FLAG_NONE)));
    rtcSetSceneBuildQuality(scene_, moves ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM);
    for (KindTriangles& kind : kinds_) {
      attach(scene.geometry, kind, scene_, static_cast<unsigned>(&kind - kinds_.data()));
      if (kind.kind.one_sided || kind.kind.alpha_tested)
        rtcSetGeometryIntersectFilterFunction(kind.geometry, &filter_first_hit);
      if (!kind.kind.casts || kind.kind.alpha_tested)
        rtcSetGeometryOccludedFilterFunction(kind.geometry, &filter_blocked);
      if (moves) rtcSetGeometryBuildQuality(kind.geometry, RTC_BUILD_QUALITY_REFIT);
      rtcCommitGeometry(kind.geometry);
    }
    rtcCommitScene(scene_);
    check();
  }
  ~Impl() {
    for (KindTriangles& kind : kinds_) rtcReleaseGeometry(kind.geometry);
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void first_hits(RayPacket& rays, std::uint32_t lanes, bool coherent) const {
    RTCRayHit16 query;
    alignas(64) int valid[16];
    copy(rays, lanes, query.ray, valid);
    for (int i = 0; i < 16; ++i) query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    QueryContext context = context_of(rays, coherent);
    rtcIntersect16(valid, scene_, &context.rtc, &query);
    for (int i = 0; i < 16; ++i) {
      const unsigned kind = query.hit.geomID[i];
      rays.id[i] = valid[i] != 0 && kind != RTC_INVALID_GEOMETRY_ID ? kinds_[kind].id[query.hit.primID[i]] : kNoId;
    }
  }

  void first_hit_of_each(RayPacket& rays, std::uint32_t lanes) const {
    QueryContext context = context_of(rays, false);
    for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
      const int i = __builtin_ctz(left);
      RTCRayHit query;
      query.ray = {rays.origin_x[i],    rays.origin_y[i],    rays.origin_z[i],         rays.t_near[i],
                   rays.direction_x[i], rays.direction_y[i], rays.direction_z[i],      0.0f,
                   rays.t_far[i],       0xFFFFFFFFu,         static_cast<unsigned>(i), 0};
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(scene_, &context.rtc, &query);
      rays.id[i] = query.hit.geomID != RTC_INVALID_GEOMETRY_ID ? kinds_[query.hit.geomID].id[query.hit.primID] : kNoId;
    }
  }

  std::uint32_t blocked(const RayPacket& rays, std::uint32_t lanes) const {
    RTCRay16 query;
    alignas(64) int valid[16];
    copy(rays, lanes, query, valid);
    QueryContext context = context_of(rays, true);
    rtcOccluded16(valid, scene_, &context.rtc, &query);
    std::uint32_t hit = 0;
    // Embree marks them by a far end of minus infinity.
    for (int i = 0; i < 16; ++i)
      if (valid[i] != 0 && query.tfar[i] < 0.0f) hit |= 1u << i;
    return hit;
  }

  void refit() {
    for (KindTriangles& kind : kinds_) {
      rtcUpdateGeometryBuffer(kind.geometry, RTC_BUFFER_TYPE_VERTEX, 0);
      rtcCommitGeometry(kind.geometry);
    }
    rtcCommitScene(scene_);
    check();
  }

  static QueryContext context_of(const RayPacket& rays, bool coherent) {
    QueryContext context;
    rtcInitIntersectContext(&context.rtc);
    context.rtc.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    context.rays = &rays;
    return context;
  }

  static void copy(const RayPacket& rays, std::uint32_t lanes, RTCRay16& to, int* valid) {
    for (int i = 0; i < 16; ++i) {
      to.org_x[i] = rays.origin_x[i], to.org_y[i] = rays.origin_y[i], to.org_z[i] = rays.origin_z[i];
      to.dir_x[i] = rays.direction_x[i], to.dir_y[i] = rays.direction_y[i], to.dir_z[i] = rays.direction_z[i];
      to.tnear[i] = rays.t_near[i], to.tfar[i] = rays.t_far[i];
      to.time[i] = 0.0f;
      to.mask[i] = 0xFFFFFFFFu;
      to.id[i] = static_cast<unsigned>(i);
      to.flags[i] = 0;
      valid[i] = ((lanes >> i) & 1u) != 0 ? -1 : 0;
    }
  }

  void sort(const RenderScene& scene) {
    for (const Drawable& drawable : scene.geometry.drawables) {
      const Material& material = scene.materials.materials[drawable.material];
      if (!drawable.drawn) continue;
      if (material.alpha_mode == AlphaMode::kBlend) continue;
      KindTriangles& to = kind_of({!material.double_sided, material.alpha_mode == AlphaMode::kMask, !material.unlit});
      for (std::uint32_t k = 0; k < drawable.triangle_count; ++k) {
        const std::uint32_t id = drawable.first_triangle + k;
        const Geometry::TriangleRecord& record = scene.geometry.triangles[id];
        to.indices.insert(to.indices.end(), record.vertex, record.vertex + 3);
        to.id.push_back(static_cast<std::int32_t>(id));
      }
    }
  }

  KindTriangles& kind_of(Kind kind) {
    for (KindTriangles& k : kinds_)
      if (k.kind == kind) return k;
    kinds_.push_back({kind, {}, {}, nullptr});
    return kinds_.back();
  }

  void attach(const Geometry& geometry, KindTriangles& kind, RTCScene scene, unsigned as) {
    kind.geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(kind.geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, geometry.vertices.data(),
                               offsetof(VertexRecord, position_world), sizeof(VertexRecord), geometry.vertices.size());
    rtcSetSharedGeometryBuffer(kind.geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, kind.indices.data(), 0,
                               3 * sizeof(std::uint32_t), kind.id.size());
    rtcSetGeometryUserData(kind.geometry, &kind);
    rtcAttachGeometryByID(scene, kind.geometry, as);
    check();
  }

  void check() const {
    const RTCError error = rtcGetDeviceError(device_);
    if (error != RTC_ERROR_NONE) fail(error);
  }

  RTCDevice device_ = nullptr;
  bool moves;
  RTCScene scene_ = nullptr;
  std::vector<KindTriangles> kinds_;
};

EmbreeQueries::EmbreeQueries(const RenderScene& scene, int threads, bool moves)
    : impl_(std::make_unique<Impl>(scene, threads, moves)) {}
EmbreeQueries::~EmbreeQueries() = default;
void EmbreeQueries::first_hits(RayPacket& rays, std::uint32_t lanes, bool coherent) const {
  impl_->first_hits(rays, lanes, coherent);
}
void EmbreeQueries::first_hit_of_each(RayPacket& rays, std::uint32_t lanes) const {
  impl_->first_hit_of_each(rays, lanes);
}
std::uint32_t EmbreeQueries::blocked(const RayPacket& rays, std::uint32_t lanes) const {
  return impl_->blocked(rays, lanes);
}
void EmbreeQueries::refit() { impl_->refit(); }

}  // namespace shoal
