// The wide type: sixteen logical lanes on every machine, whatever its registers (docs/ARCHITECTURE.md, "Lanes").
//
// WideF, WideI and WideM hold sixteen floats, int32s and booleans. Code is written once, templated on the lane type F:
// with F = float it does one pixel, with F = WideF sixteen, and the bits are the same. core/wide/lanes.h gives float
// the same vocabulary. Every operation is exact IEEE or integer arithmetic; there is no fused multiply-add and no
// approximation, and no sum across lanes.
#pragma once

#include "core/wide/isa_select.h"

#if defined(SHOAL_ISA_AVX512)
#include "core/wide/native_avx512.h"
#include "core/wide/wide_native.h"
#elif defined(SHOAL_ISA_AVX2)
#include "core/wide/native_avx2.h"
#include "core/wide/wide_native.h"
#elif defined(SHOAL_ISA_SSE42)
#include "core/wide/native_sse42.h"
#include "core/wide/wide_native.h"
#elif defined(SHOAL_ISA_NEON)
#include "core/wide/native_neon.h"
#include "core/wide/wide_native.h"
#else
#include "core/wide/wide_scalar.h"
#endif
