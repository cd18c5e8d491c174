// refraction/: the functions of the broad and the narrow phase.
#include <string>
#include <vector>

#include "bench/harness.h"
#include "bench/kernels.h"
#include "bench/scenes.h"
#include "bench/stages.h"
#include "refraction/passes/water_region.h"

namespace shoal::bench {

namespace {

constexpr std::size_t kPoints = 1024;

// The eye of pool's camera above its water, and points in it.
struct Water {
  Stages stages{pool_scene(kPoolSizes[0].triangles), kWidth, kHeight, 1};
  std::vector<WaterOptics> optics;
  std::vector<float> points, ends;  // edges go from a point to its end: some centimetres, as in a mesh
  std::vector<float> far_m, across_m;

  Water() {
    const WaterBody& body = pool_scene(kPoolSizes[0].triangles).waters.front();
    const PlacedWater flat{&body, nullptr, 0};
    std::int32_t eye_in_water = -1;
    place_water({{&flat, 1},
                 stages.view(),
                 find_method("two-phase", isa()).kernels.map,
                 Reflections::kPlanar,
                 Reflections::kPlanar,
                 false},
                {optics, eye_in_water});
    Random random;
    points.resize(3 * kPoints), ends.resize(3 * kPoints);
    for (std::size_t i = 0; i < kPoints; ++i) {
      const Vec3f p = body.origin + body.axis_x * random.between(-3, 3) + body.axis_z * random.between(-3, 3) -
                      body.normal * random.between(0.01f, 2);
      const Vec3f q = p + Vec3f{random.between(-0.05f, 0.05f), 0, random.between(-0.05f, 0.05f)};
      points[i] = p.x, points[kPoints + i] = p.y, points[2 * kPoints + i] = p.z;
      ends[i] = q.x, ends[kPoints + i] = q.y, ends[2 * kPoints + i] = q.z;
      far_m.push_back(random.between(0.01f, 2));
      across_m.push_back(random.between(0, 15));
    }
  }
  const BroadPhase& exact() const { return optics.front().exact; }
  const BroadPhase& map() const { return optics.front().map; }
};

// Runs `kernel`(Water&, out), which does kPoints points.
template <class Kernel>
void points(benchmark::State& state, Kernel kernel) {
  Water water;
  std::vector<float> out(3 * kPoints);
  for (auto _ : state) {
    kernel(water, out.data());
    benchmark::ClobberMemory();
  }
  count_items(state, "point", kPoints);
  count_items(state, "16lanes", kPoints / 16.0);
}

void exact_rays(benchmark::State& state) {
  Water water;
  float out[16];
  const std::size_t region = water.stages.grid().region_count() / 2;
  for (auto _ : state) {
    refraction_kernels(isa()).exact_ray(water.exact(), water.stages.view(), water.stages.grid(), region, out);
    benchmark::DoNotOptimize(out);
  }
  count_items(state, "pix", kRegionSize * kRegionSize);
  count_items(state, "block", kRegionSize * kRegionSize / 16.0);
}

// The ways to solve the flat path that docs/solvers.md compares.
struct Solver {
  const char* name;
  PathWay way;
  int steps;  // or points a side of the table
};
constexpr Solver kSolvers[] = {
    {"fixed_point_1", PathWay::kFixedPoint, 1},
    {"fixed_point_2", PathWay::kFixedPoint, 2},
    {"fixed_point_4", PathWay::kFixedPoint, 4},
    {"fixed_point_8", PathWay::kFixedPoint, 8},
    {"fixed_point_16", PathWay::kFixedPoint, 16},
    {"newton_1", PathWay::kNewton, 1},
    {"newton_2", PathWay::kNewton, 2},
    {"newton_3", PathWay::kNewton, 3},
    {"newton_4", PathWay::kNewton, 4},
    {"halley_1", PathWay::kHalley, 1},
    {"halley_2", PathWay::kHalley, 2},
    {"halley_3", PathWay::kHalley, 3},
    {"quartic", PathWay::kQuartic, 0},
    {"table_65", PathWay::kTable, 65},
    {"table_129", PathWay::kTable, 129},
    {"table_257", PathWay::kTable, 257},
};

void solve_paths(benchmark::State& state, const Solver& solver) {
  PathTable table;
  points(state, [&](Water& w, float* out) {
    if (solver.way == PathWay::kTable && table.size == 0)
      table = make_path_table(w.map().path, static_cast<std::size_t>(solver.steps));
    refraction_kernels(isa()).solve(w.map(), solver.way, solver.steps, table, w.far_m.data(), w.across_m.data(),
                                    kPoints, out);
  });
}

// All pixels of the frame against the direct visibility buffer.
void confirm(benchmark::State& state, std::uint64_t triangles, bool by_neighbours) {
  Stages stages(pool_scene(triangles), kWidth, kHeight, 1);
  stages.front_end();
  stages.tiles();
  std::int32_t out[16];
  for (auto _ : state) {
    const VisibleIn in{stages.scene().shading, stages.view(), stages.direct()};
    stages.for_each_region(
        [&](std::size_t region) { refraction_kernels(isa()).confirm(in, by_neighbours, region, out); });
    benchmark::DoNotOptimize(out);
  }
  count_items(state, "pix", double{kWidth} * kHeight);
}

}  // namespace

void register_benchmarks() {
  const RefractionKernels& kernels = refraction_kernels(isa());
  add("path_solver/pool/1024", [&](auto& state) {
    points(state, [&](Water& w, float* out) {
      kernels.virtual_distance(w.map(), w.far_m.data(), w.across_m.data(), kPoints, out);
    });
  });
  for (const Solver& solver : kSolvers)
    add(std::string("path_solvers/") + solver.name + "/1024", [&](auto& state) { solve_paths(state, solver); });
  add("virtual_position/pool/1024", [&](auto& state) {
    points(state, [&](Water& w, float* out) { kernels.virtual_position(w.map(), w.points.data(), kPoints, out); });
  });
  add("edge_deviation/pool/1024", [&](auto& state) {
    points(state, [&](Water& w, float* out) {
      kernels.edge_deviation(w.map(), w.stages.view(), w.points.data(), w.ends.data(), kPoints, out);
    });
  });
  add("exact_ray/pool/64x64", exact_rays);
  for (const SizedScene& size : kPoolSizes) {
    for (const bool by_neighbours : {false, true})
      add(std::string(by_neighbours ? "confirm_by_neighbours" : "confirm_own") + "/pool/" + size.size,
          [=](auto& state) { confirm(state, size.triangles, by_neighbours); })
          ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace shoal::bench
