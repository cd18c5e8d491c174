// The flat path by bisection of Snell's law, and the grid that the solvers' errors are stated over.
#pragma once

#include <algorithm>
#include <cmath>

namespace shoal_test {

// Apparent distance by bisection on the sine of the eye's side: Snell's law in its plainest form, a variable that the
// solvers do not use, and bounded.
inline double oracle_distance(double ior, bool eye_above, double eye_m, double far_m, double d_m) {
  const double n_eye = eye_above ? 1.0 : ior, n_far = eye_above ? ior : 1.0;
  const double largest = std::min(1.0, n_far / n_eye);  // of the eye side's sine
  // Near grazing the sine's digits run out: bisect the complement there. long double carries both.
  const auto tangent = [](long double sine) { return sine / std::sqrt((1.0L - sine) * (1.0L + sine)); };
  long double l = 0.0L, h = largest;
  for (int i = 0; i < 300; ++i) {
    const long double mid = 0.5L * (l + h);
    const long double far_sine = mid * n_eye / n_far;
    const bool beyond = far_sine >= 1.0L || mid >= 1.0L;
    const long double reach = beyond ? 0.0L : eye_m * tangent(mid) + far_m * tangent(far_sine);
    (beyond || reach > d_m ? h : l) = mid;
  }
  return static_cast<double>(d_m / tangent(l) - eye_m);
}

// Calls body(far_m, d_m) over d / a in (0, 50] x b / a in [1e-3, 100]; the eye is 2 m from the plane.
template <class Body>
void for_each_path(bool log_spaced, Body body) {
  for (int i = 1; i <= 200; ++i) {
    for (int j = 0; j <= 125; ++j) {
      const float u = log_spaced ? static_cast<float>(std::pow(10.0, -2.0 + (2.0 + std::log10(50.0)) * i / 200.0))
                                 : 0.25f * static_cast<float>(i);
      body(static_cast<float>(2.0 * std::pow(10.0, -3.0 + 5.0 * j / 125.0)), 2.0f * u);
    }
  }
}

// Pixels along the screen at 1080 lines and 60 degrees (935 px a unit), eye 2 m from the plane.
inline double pixels_between(double got, double want, double d_m) {
  return 935.0 * std::fabs(std::atan2(d_m, 2.0 + got) - std::atan2(d_m, 2.0 + want));
}

}  // namespace shoal_test
