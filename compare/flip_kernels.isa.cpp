// LDR-FLIP, sixteen pixels at a time. Section numbers: Andersson et al. 2020.
#include "compare/flip_kernels.h"

#include <cstring>

#include "compare/flip_color.h"
#include "core/math.h"
#include "core/vec_lanes.h"

namespace shoal::inline SHOAL_ISA_NS {
namespace {

SHOAL_INLINE Vec3<WideF> multiply(const Matrix3& m, Vec3<WideF> v) {
  return {(WideF(m.m[0][0]) * v.x + WideF(m.m[0][1]) * v.y) + WideF(m.m[0][2]) * v.z,
          (WideF(m.m[1][0]) * v.x + WideF(m.m[1][1]) * v.y) + WideF(m.m[1][2]) * v.z,
          (WideF(m.m[2][0]) * v.x + WideF(m.m[2][1]) * v.y) + WideF(m.m[2][2]) * v.z};
}

// Narkowicz's fit of the ACES curve; the factor 0.6 of exposure that it asks for is in the coefficients.
SHOAL_INLINE WideF aces(WideF x) {
  const WideF above = (WideF(kAces[0]) * x + WideF(kAces[1])) * x + WideF(kAces[2]);
  const WideF below = (WideF(kAces[3]) * x + WideF(kAces[4])) * x + WideF(kAces[5]);
  return above / below;
}

// --- Horizontal -----------------------------------------------------------------------------------------------------

// Symmetric (sign 1) or antisymmetric (-1) filter at 16 pixels of a row.
template <int kSign>
SHOAL_INLINE WideF filter_across(const HalfFilter& filter, const float* at) {
  WideF sum = WideF(filter[0]) * WideF::load(at);
  const int taps = static_cast<int>(filter.size());
  for (int k = 1; k < taps; ++k) {
    const WideF right = WideF::load(at + k), left = WideF::load(at - k);
    sum = sum + WideF(filter[static_cast<std::size_t>(k)]) * (kSign > 0 ? right + left : right - left);
  }
  return sum;
}

// A row of colours, apart, tone mapped and clamped, into the opponent space YCxCz (section 4.1, linearised CIELAB).
SHOAL_INLINE void opponent_row(const ToneCurve& tone, const float* rgb, int width_px, int stride_px,
                               float* const row[4]) {
  for (int x = 0; x < stride_px; ++x) {
    const float* pixel = rgb + 3 * (x < width_px ? x : width_px - 1);
    row[0][x] = pixel[0];
    row[1][x] = pixel[1];
    row[2][x] = pixel[2];
  }
  const auto ready = [&](const float* at) SHOAL_LAMBDA {
    // A NaN becomes 0: `max` gives its second operand then.
    WideF v = min(max(WideF::load(at), WideF(0.0f)), WideF(1e9f)) * WideF(tone.scale);
    if (tone.aces) v = aces(min(v, WideF(1e9f)));
    return min(v, WideF(1.0f));
  };
  for (int x = 0; x < stride_px; x += 16) {
    const Vec3<WideF> linear = {ready(row[0] + x), ready(row[1] + x), ready(row[2] + x)};
    const Vec3<WideF> t = multiply(kWhiteXyzFromRgb, linear);
    const WideF y = WideF(116.0f) * t.y - WideF(16.0f);
    y.store(row[0] + x);
    (WideF(500.0f) * (t.x - t.y)).store(row[1] + x);
    (WideF(200.0f) * (t.y - t.z)).store(row[2] + x);
    t.y.store(row[3] + x);  // luminance in [0, 1], of the features: (Y + 16) / 116
  }
}

void filter_rows(const FlipFilters& filters, const ToneCurve& tone, const float* rgb, int begin, int end,
                 float* scratch, FlipRows& out) {
  const int reach = filters.reach_px, width = out.width_px, stride = out.stride_px;
  float* row[4];
  for (int c = 0; c < 4; ++c) row[c] = scratch + c * (stride + 2 * reach + 32) + reach;
  for (int y = begin; y < end; ++y) {
    opponent_row(tone, rgb + static_cast<std::size_t>(y) * static_cast<std::size_t>(width) * 3, width, stride, row);
    for (float* r : row) {  // the picture's edge goes on
      for (int k = 1; k <= reach; ++k) r[-k] = r[0];
      for (int x = width; x < stride + reach; ++x) r[x] = r[width - 1];
    }
    const std::size_t offset = static_cast<std::size_t>(y) * static_cast<std::size_t>(stride);
    for (int x = 0; x < stride; x += 16) {
      const auto store = [&](FlipRows::Plane p, WideF v)
                             SHOAL_LAMBDA { v.store(out.plane[p].data() + offset + static_cast<std::size_t>(x)); };
      store(FlipRows::kAchromatic, filter_across<1>(filters.achromatic, row[0] + x));
      store(FlipRows::kRedGreen, filter_across<1>(filters.red_green, row[1] + x));
      store(FlipRows::kBlueYellowWide, filter_across<1>(filters.blue_yellow_wide, row[2] + x));
      store(FlipRows::kBlueYellowNarrow, filter_across<1>(filters.blue_yellow_narrow, row[2] + x));
      store(FlipRows::kSmooth, filter_across<1>(filters.smooth, row[3] + x));
      store(FlipRows::kEdge, filter_across<-1>(filters.edge, row[3] + x));
      store(FlipRows::kPoint, filter_across<1>(filters.point, row[3] + x));
    }
  }
}

// --- Vertical -------------------------------------------------------------------------------------------------------

struct Place {
  int x, y;
};

template <int kSign>
SHOAL_INLINE WideF filter_down(const HalfFilter& filter, const FlipRows& rows, FlipRows::Plane plane, Place at) {
  const float* column = rows.plane[plane].data() + at.x;
  const auto load = [&](int y) SHOAL_LAMBDA {
    return WideF::load(column + static_cast<std::size_t>(y) * static_cast<std::size_t>(rows.stride_px));
  };
  WideF sum = WideF(filter[0]) * load(at.y);
  const int taps = static_cast<int>(filter.size()), last = rows.height_px - 1;
  for (int k = 1; k < taps; ++k) {
    const WideF below = load(at.y + k < last ? at.y + k : last), above = load(at.y - k > 0 ? at.y - k : 0);
    sum = sum + WideF(filter[static_cast<std::size_t>(k)]) * (kSign > 0 ? below + above : below - above);
  }
  return sum;
}

// CIELAB's cube root with its straight piece near black.
SHOAL_INLINE WideF lab_curve(WideF t) {
  const WideF root = det_pow(t, WideF(1.0f / 3.0f));
  return select(t > WideF(216.0f / 24389.0f), root, t * WideF(841.0f / 108.0f) + WideF(4.0f / 29.0f));
}

// The filtered colour, back in the cube of displayable ones, as Hunt-adjusted CIELAB (sections 4.1.1, 4.1.2).
SHOAL_INLINE Vec3<WideF> seen_color(const FlipFilters& filters, const FlipRows& rows, Place at) {
  const WideF luma = filter_down<1>(filters.achromatic, rows, FlipRows::kAchromatic, at);
  const WideF cx = filter_down<1>(filters.red_green, rows, FlipRows::kRedGreen, at);
  const WideF cz = filter_down<1>(filters.blue_yellow_wide_rows, rows, FlipRows::kBlueYellowWide, at) +
                   filter_down<1>(filters.blue_yellow_narrow_rows, rows, FlipRows::kBlueYellowNarrow, at);
  const WideF y = (luma + WideF(16.0f)) * WideF(1.0f / 116.0f);
  const Vec3<WideF> xyz = {y + cx * WideF(1.0f / 500.0f), y, y - cz * WideF(1.0f / 200.0f)};
  Vec3<WideF> rgb = multiply(kRgbFromWhiteXyz, xyz);
  rgb = {clamp(rgb.x, WideF(0.0f), WideF(1.0f)), clamp(rgb.y, WideF(0.0f), WideF(1.0f)),
         clamp(rgb.z, WideF(0.0f), WideF(1.0f))};
  const Vec3<WideF> t = multiply(kWhiteXyzFromRgb, rgb);
  const WideF fx = lab_curve(t.x), fy = lab_curve(t.y), fz = lab_curve(t.z);
  const WideF lightness = WideF(116.0f) * fy - WideF(16.0f), hunt = WideF(0.01f) * lightness;
  return {lightness, hunt * (WideF(500.0f) * (fx - fy)), hunt * (WideF(200.0f) * (fy - fz))};
}

// HyAB distance, compressed and spread over 0..1 (section 4.1.3).
SHOAL_INLINE WideF color_error(Vec3<WideF> a, Vec3<WideF> b) {
  const Vec3<WideF> d = a - b;
  const WideF hyab = abs(d.x) + sqrt(d.y * d.y + d.z * d.z);
  const WideF power = det_pow(hyab, WideF(kColorExponent));
  const WideF knee = WideF(kColorKnee * kLargestColorError);
  const WideF low = power * WideF(kColorKneeError / (kColorKnee * kLargestColorError));
  const WideF high = WideF(kColorKneeError) +
                     (power - knee) * WideF((1.0f - kColorKneeError) / ((1.0f - kColorKnee) * kLargestColorError));
  return clamp(select(power < knee, low, high), WideF(0.0f), WideF(1.0f));
}

struct Features {
  WideF edge, point;
};
SHOAL_INLINE Features features(const FlipFilters& filters, const FlipRows& rows, Place at) {
  const WideF edge_x = filter_down<1>(filters.smooth, rows, FlipRows::kEdge, at);
  const WideF edge_y = filter_down<-1>(filters.edge, rows, FlipRows::kSmooth, at);
  const WideF point_x = filter_down<1>(filters.smooth, rows, FlipRows::kPoint, at);
  const WideF point_y = filter_down<1>(filters.point, rows, FlipRows::kSmooth, at);
  return {sqrt(edge_x * edge_x + edge_y * edge_y), sqrt(point_x * point_x + point_y * point_y)};
}

// Section 4.2: of edges and points the larger difference, to the power 1/2.
SHOAL_INLINE WideF feature_error(Features a, Features b) {
  const WideF most = max(abs(a.edge - b.edge), abs(a.point - b.point));
  return min(sqrt(most * WideF(0.70710678f)), WideF(1.0f));
}

void combine(const FlipFilters& filters, const FlipRows& reference, const FlipRows& test, int x_begin, int x_end,
             int y_begin, int y_end, float* error) {
  for (int y = y_begin; y < y_end; ++y) {
    for (int x = x_begin; x < x_end; x += 16) {
      const Place at{x, y};
      const WideF color = color_error(seen_color(filters, reference, at), seen_color(filters, test, at));
      const WideF feature = feature_error(features(filters, reference, at), features(filters, test, at));
      const WideF both = min(det_pow(color, WideF(1.0f) - feature), WideF(1.0f));  // section 4.3
      float* out = error + static_cast<std::size_t>(y) * static_cast<std::size_t>(reference.width_px) + x;
      const int lanes = x_end - x < 16 ? x_end - x : 16;
      float lane[16];
      both.store(lane);
      for (int i = 0; i < lanes; ++i) out[i] = lane[i] > out[i] ? lane[i] : out[i];
    }
  }
}

}  // namespace
}  // namespace shoal::inline SHOAL_ISA_NS

namespace shoal {

const FlipKernels& SHOAL_THIS_ISA(flip_kernels)() {
  static constexpr FlipKernels table{.filter_rows = &filter_rows, .combine = &combine};
  return table;
}

}  // namespace shoal
