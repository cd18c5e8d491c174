#include "compare/flip.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "compare/flip_color.h"
#include "compare/flip_kernels.h"
#include "core/error.h"
#include "shading/srgb.h"

namespace shoal {

namespace {

constexpr double kPiD = 3.14159265358979323846;
constexpr int kBandRows = 16, kTile = 64;  // of a task
constexpr double kMostStops = 100;         // 2 to that is a float

// --- Filters --------------------------------------------------------------------------------------------------------

// The taps of f at 0, 1, ... up to a radius.
template <class Function>
std::vector<double> half_taps(int radius, Function f) {
  std::vector<double> taps;
  for (int k = 0; k <= radius; ++k) taps.push_back(f(static_cast<double>(k)));
  return taps;
}
// Of one that falls from the middle on; taps that no float sum would notice are left out. (Not of a derivative: its
// positive and negative taps are balanced, however small they are.)
template <class Function>
std::vector<double> bell_taps(int radius, Function f) {
  std::vector<double> taps = half_taps(radius, f);
  while (taps.size() > 1 && taps.back() < 1e-7 * taps.front()) taps.pop_back();
  return taps;
}

// Of the whole filter, both halves.
double sum_of(const std::vector<double>& half) {
  double sum = half[0];
  for (std::size_t k = 1; k < half.size(); ++k) sum += 2 * half[k];
  return sum;
}

HalfFilter scaled(const std::vector<double>& half, double scale) {
  HalfFilter filter;
  for (const double t : half) filter.push_back(static_cast<float>(t * scale));
  return filter;
}

// Positive taps to a sum of 1, negative ones to -1 (section 4.2).
HalfFilter balanced(std::vector<double> half, bool antisymmetric) {
  double positive = 0, negative = 0;
  for (std::size_t k = 0; k < half.size(); ++k) {
    const double both = k == 0 || antisymmetric ? half[k] : 2 * half[k];
    (both > 0 ? positive : negative) += both;
  }
  for (double& t : half) {
    if (t != 0) t /= t > 0 ? positive : -negative;
  }
  return scaled(half, 1);
}

// One Gaussian of the contrast sensitivity functions, a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees (section 4.1.1).
struct Sensitivity {
  double a, b;
  double height() const { return a * std::sqrt(kPiD / b); }
};

FlipFilters make_filters(double pixels_per_degree) {
  constexpr Sensitivity kAchromatic{1, 0.0047}, kRedGreen{1, 0.0053}, kWide{34.1, 0.04}, kNarrow{13.5, 0.025};
  FlipFilters f;
  // Three standard deviations of the widest, for all.
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(kWide.b / (2 * kPiD * kPiD)) * pixels_per_degree));
  const auto gaussian = [&](const Sensitivity& s) {
    return bell_taps(radius, [&](double k) {
      const double degrees = k / pixels_per_degree;
      return std::exp(-kPiD * kPiD * degrees * degrees / s.b);
    });
  };
  const auto normalized = [](const std::vector<double>& half) { return scaled(half, 1 / sum_of(half)); };
  f.achromatic = normalized(gaussian(kAchromatic));
  f.red_green = normalized(gaussian(kRedGreen));
  // In two dimensions each Gaussian weighs its height times its taps' sum squared.
  const std::vector<double> wide = gaussian(kWide), narrow = gaussian(kNarrow);
  const double wide_share = kWide.height() * sum_of(wide) * sum_of(wide);
  const double narrow_share = kNarrow.height() * sum_of(narrow) * sum_of(narrow), total = wide_share + narrow_share;
  f.blue_yellow_wide = normalized(wide);
  f.blue_yellow_narrow = normalized(narrow);
  f.blue_yellow_wide_rows = scaled(wide, wide_share / total / sum_of(wide));
  f.blue_yellow_narrow_rows = scaled(narrow, narrow_share / total / sum_of(narrow));

  // Features are 0.082 degrees wide.
  const double deviation = 0.5 * 0.082 * pixels_per_degree;
  const int feature_radius = static_cast<int>(std::ceil(3 * deviation));
  const auto bell = [&](double k) { return std::exp(-k * k / (2 * deviation * deviation)); };
  f.smooth = normalized(bell_taps(feature_radius, bell));
  f.edge = balanced(half_taps(feature_radius, [&](double k) { return k * bell(k); }), true);
  f.point = balanced(
      half_taps(feature_radius, [&](double k) { return (k * k / (deviation * deviation) - 1) * bell(k); }), false);
  f.reach_px = std::max(radius, feature_radius);
  return f;
}

// --- One exposure ---------------------------------------------------------------------------------------------------

void require_pair(const LinearPicture& a, const LinearPicture& b, const FlipSettings& settings) {
  const auto whole = [](const LinearPicture& p) {
    return p.width_px > 0 && p.height_px > 0 &&
           p.rgb.size() == static_cast<std::size_t>(p.width_px) * static_cast<std::size_t>(p.height_px) * 3;
  };
  if (!whole(a) || !whole(b) || a.width_px != b.width_px || a.height_px != b.height_px) {
    throw UsageError("FLIP: pictures of different sizes; expected two of the same");
  }
  if (!(settings.pixels_per_degree >= 1.0f && settings.pixels_per_degree <= 10000.0f)) {
    throw UsageError("FLIP: pixels a degree out of range; expected 1 to 10000");
  }
}

// The buffers of a comparison, for as many exposures as there are.
class Comparison {
 public:
  Comparison(const LinearPicture& reference, const LinearPicture& test, const FlipSettings& settings, ThreadPool& pool)
      : picture_{&reference, &test},
        kernels_(flip_kernels(settings.isa)),
        filters_(make_filters(static_cast<double>(settings.pixels_per_degree))),
        pool_(pool) {
    for (FlipRows& rows : rows_) {
      rows.width_px = reference.width_px;
      rows.height_px = reference.height_px;
      rows.stride_px = (reference.width_px + 15) / 16 * 16;
      const std::size_t size = static_cast<std::size_t>(rows.stride_px) * static_cast<std::size_t>(rows.height_px);
      for (auto& plane : rows.plane) plane.resize(size);
    }
    const auto row = static_cast<std::size_t>(rows_[0].stride_px + 2 * filters_.reach_px + 32);
    scratch_.assign(static_cast<std::size_t>(pool.threads()), std::vector<float>(4 * row));
    error.assign(static_cast<std::size_t>(reference.width_px) * static_cast<std::size_t>(reference.height_px), 0.0f);
  }

  // Raises `error` to this exposure's.
  void add(const ToneCurve& tone) {
    const int width = rows_[0].width_px, height = rows_[0].height_px;
    const int bands = (height + kBandRows - 1) / kBandRows;
    pool_.for_each(static_cast<std::size_t>(bands) * 2, [&](std::size_t task, int thread) {
      const int band = static_cast<int>(task / 2);
      kernels_.filter_rows(filters_, tone, picture_[task % 2]->rgb.data(), band * kBandRows,
                           std::min((band + 1) * kBandRows, height), scratch_[static_cast<std::size_t>(thread)].data(),
                           rows_[task % 2]);
    });
    const int tiles_x = (width + kTile - 1) / kTile, tiles_y = (height + kTile - 1) / kTile;
    pool_.for_each(static_cast<std::size_t>(tiles_x) * static_cast<std::size_t>(tiles_y), [&](std::size_t task, int) {
      const int x = static_cast<int>(task) % tiles_x * kTile, y = static_cast<int>(task) / tiles_x * kTile;
      kernels_.combine(filters_, rows_[0], rows_[1], x, std::min(x + kTile, width), y, std::min(y + kTile, height),
                       error.data());
    });
  }

  std::vector<float> error;

 private:
  const LinearPicture* picture_[2];
  const FlipKernels& kernels_;
  FlipFilters filters_;
  ThreadPool& pool_;
  FlipRows rows_[2];
  std::vector<std::vector<float>> scratch_;  // one a thread
};

// --- Exposures ------------------------------------------------------------------------------------------------------

// The x that the tone curve maps to 0.85: the positive root.
double bright_input() {
  constexpr double kTarget = 0.85;
  const auto k = [](int i) { return static_cast<double>(kAces[i]); };
  const double a = k(0) - kTarget * k(3), b = k(1) - kTarget * k(4), c = k(2) - kTarget * k(5);
  const double s = std::sqrt(b * b - 4 * a * c);
  return std::max((-b + s) / (2 * a), (-b - s) / (2 * a));
}

}  // namespace

LinearPicture linear_from_srgb8(int width_px, int height_px, const std::uint8_t* rgb) {
  float linear[256];
  for (int code = 0; code < 256; ++code) linear[code] = static_cast<float>(srgb_to_linear(code / 255.0));
  LinearPicture picture{width_px, height_px, {}};
  picture.rgb.resize(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px) * 3);
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) picture.rgb[i] = linear[rgb[i]];
  return picture;
}

std::vector<float> ldr_flip(const LinearPicture& reference, const LinearPicture& test, const FlipSettings& settings,
                            ThreadPool& pool) {
  require_pair(reference, test, settings);
  Comparison comparison(reference, test, settings, pool);
  comparison.add(ToneCurve{});
  return std::move(comparison.error);
}

HdrFlip exposure_range(const LinearPicture& reference) {
  std::vector<float> luminance;
  for (std::size_t i = 0; i + 2 < reference.rgb.size(); i += 3) {
    float y = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const float v = reference.rgb[i + c];
      y += kWhiteXyzFromRgb.m[1][c] * (v > 0.0f ? std::min(v, 1e9f) : 0.0f);
    }
    if (y > 0.0f) luminance.push_back(y);
  }
  HdrFlip range;
  range.exposures = 1;
  if (luminance.empty()) return range;
  const auto middle = luminance.begin() + static_cast<std::ptrdiff_t>((luminance.size() - 1) / 2);
  std::nth_element(luminance.begin(), middle, luminance.end());
  const double median = static_cast<double>(*middle);
  const double most = static_cast<double>(*std::max_element(middle, luminance.end()));
  const double bright = bright_input();
  range.first_stops = static_cast<float>(std::log2(bright / most));
  range.last_stops = static_cast<float>(std::min(std::log2(bright / median), kMostStops));
  range.exposures = std::max(2, static_cast<int>(std::ceil(range.last_stops - range.first_stops)));
  return range;
}

HdrFlip hdr_flip(const LinearPicture& reference, const LinearPicture& test, const FlipSettings& settings,
                 ThreadPool& pool) {
  require_pair(reference, test, settings);
  HdrFlip flip = exposure_range(reference);
  Comparison comparison(reference, test, settings, pool);
  for (int i = 0; i < flip.exposures; ++i) {
    const double t = flip.exposures > 1 ? i / static_cast<double>(flip.exposures - 1) : 0.0;
    const double stops = static_cast<double>(flip.first_stops) * (1 - t) + static_cast<double>(flip.last_stops) * t;
    comparison.add(ToneCurve{true, static_cast<float>(std::exp2(stops))});
  }
  flip.error = std::move(comparison.error);
  return flip;
}

}  // namespace shoal
