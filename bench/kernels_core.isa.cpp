// core/math.h and vectors of lanes over arrays, one copy an ISA.
#include "bench/kernels.h"
#include "bench/vector_work.h"
#include "core/math.h"

namespace shoal::bench::inline SHOAL_ISA_NS {

namespace {

template <class Function>
SHOAL_INLINE void map(const float* in, float* out, std::size_t count, Function function) {
  for (std::size_t i = 0; i < count; i += 16) function(WideF::load(in + i)).store(out + i);
}

#define SHOAL_BENCH_MATH(name, expression)                                \
  void name(const float* in, float* out, std::size_t count) {             \
    map(in, out, count, [](WideF x) SHOAL_LAMBDA { return expression; }); \
  }
SHOAL_BENCH_MATH(run_copy, x)
SHOAL_BENCH_MATH(run_divide, WideF(1.0f) / x)
SHOAL_BENCH_MATH(run_sqrt, sqrt(x))
SHOAL_BENCH_MATH(run_sin, det_sin(x))
SHOAL_BENCH_MATH(run_tan, det_tan(x))
SHOAL_BENCH_MATH(run_atan2, det_atan2(x, WideF(0.5f)))
SHOAL_BENCH_MATH(run_acos, det_acos(x))
SHOAL_BENCH_MATH(run_exp2, det_exp2(x))
SHOAL_BENCH_MATH(run_exp, det_exp(x))
SHOAL_BENCH_MATH(run_log2, det_log2(x))
SHOAL_BENCH_MATH(run_pow, det_pow(x, WideF(2.2f)))
SHOAL_BENCH_MATH(run_glm_vectors, vector_work<Vec3<WideF>>(x))
SHOAL_BENCH_MATH(run_plain_vectors, vector_work<PlainVec3>(x))
#undef SHOAL_BENCH_MATH

constexpr MathKernel kMath[] = {
    {"copy", -1, 1, &run_copy},
    {"divide", 1, 2, &run_divide},
    {"sqrt", 0, 4, &run_sqrt},
    {"sin", -3, 3, &run_sin},
    {"sin_far", -1e6f, 1e6f, &run_sin},
    {"tan", -1.5f, 1.5f, &run_tan},
    {"atan2", -2, 2, &run_atan2},
    {"acos", -1, 1, &run_acos},
    {"exp2", -20, 20, &run_exp2},
    {"exp", -20, 20, &run_exp},
    {"log2", 0.01f, 100, &run_log2},
    {"pow", 0.01f, 4, &run_pow},
    {"glm_vectors", -1, 1, &run_glm_vectors},
    {"plain_vectors", -1, 1, &run_plain_vectors},
};

}  // namespace

}  // namespace shoal::bench::inline SHOAL_ISA_NS

namespace shoal::bench {
const CoreKernels& SHOAL_THIS_ISA(core_kernels)() {
  static constexpr CoreKernels table{.math = kMath, .math_count = sizeof kMath / sizeof kMath[0]};
  return table;
}
}  // namespace shoal::bench
