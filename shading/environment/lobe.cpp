// The share of a uniform environment that a GGX lobe reflects.
#include <algorithm>
#include <cmath>

#include "core/thread_pool.h"
#include "shading/environment/build.h"

namespace shoal::environment_parts {
namespace {

// Smith's Lambda. Source: Heitz 2014, eq. 72.
double lambda(double alpha2, double cosine) {
  const double c2 = cosine * cosine;
  return (std::sqrt(1 + alpha2 * (1 - c2) / c2) - 1) / 2;
}

}  // namespace

LobeShare lobe_share(double roughness, double cosine) {
  const double alpha = roughness * roughness, alpha2 = alpha * alpha;
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  // The view in the stretched space, a frame round it, and where the projected disc is cut.
  const double length = std::sqrt(alpha2 * sine * sine + cosine * cosine);
  const double view_x = alpha * sine / length, view_z = cosine / length;
  const double cut = 0.5 * (1 + view_z);
  const double masking = 1 + lambda(alpha2, cosine);
  LobeShare sum{0, 0};
  // Fibonacci's lattice on the disc.
  constexpr std::uint64_t kPoints = 987, kStep = 610;
  for (std::uint64_t i = 0; i < kPoints; ++i) {
    const double u = (static_cast<double>(i) + 0.5) / static_cast<double>(kPoints);
    const CirclePoint at = circle_point(2 * (i * kStep % kPoints) + 1, 2 * kPoints);
    const double r = std::sqrt(u);
    const double t1 = r * at.cosine, across = std::sqrt(std::max(0.0, 1 - t1 * t1));
    const double t2 = (1 - cut) * across + cut * r * at.sine;
    const double up = std::sqrt(std::max(0.0, 1 - t1 * t1 - t2 * t2));
    // The stretched normal: t1 along y, t2 along the tangent that leans to +z, up along the view.
    const double hx = alpha * (-t2 * view_z + up * view_x), hy = alpha * t1;
    const double hz = std::max(0.0, t2 * view_x + up * view_z);
    const double inverse = 1 / std::sqrt(hx * hx + hy * hy + hz * hz);
    const double v_dot_h = (hx * sine + hz * cosine) * inverse;
    const double light = 2 * v_dot_h * hz * inverse - cosine;
    if (!(light > 0) || !(v_dot_h > 0)) continue;
    const double weight = masking / (masking + lambda(alpha2, light));
    const double off = 1 - std::min(v_dot_h, 1.0), off2 = off * off;
    sum.white += weight;
    sum.grazing += weight * off2 * off2 * off;
  }
  return {sum.white / static_cast<double>(kPoints), sum.grazing / static_cast<double>(kPoints)};
}

std::vector<std::uint32_t> lobe_table(ThreadPool& pool) {
  std::vector<std::uint32_t> table(static_cast<std::size_t>(kLobeTableSize) * kLobeTableSize);
  pool.for_each(kLobeTableSize, [&](std::size_t row, int) {
    constexpr double kLast = kLobeTableSize - 1;
    for (std::size_t x = 0; x < kLobeTableSize; ++x) {
      const double root = std::max(static_cast<double>(x), 0.03125) / kLast;  // at 0 the lobe is its limit
      const LobeShare share = lobe_share(static_cast<double>(row) / kLast, root * root);
      const auto code = [](double v) { return static_cast<std::uint32_t>(std::clamp(v, 0.0, 1.0) * 65535 + 0.5); };
      table[row * kLobeTableSize + x] = code(share.white) | code(share.grazing) << 16;
    }
  });
  return table;
}

}  // namespace shoal::environment_parts
