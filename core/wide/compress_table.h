// Which lanes of four a mask keeps, as byte shuffles: the table behind `compress` on SSE4.2 and NEON, and (by halves)
// on AVX2.
#pragma once

#include <cstdint>

#include "core/wide/isa_select.h"

namespace shoal::inline SHOAL_ISA_NS::wide_detail {

struct CompressTable {
  alignas(16) std::uint8_t byte[16][16];
};
constexpr CompressTable make_compress_table() {
  CompressTable t{};
  for (int bits = 0; bits < 16; ++bits) {
    int n = 0;
    for (int lane = 0; lane < 4; ++lane) {
      if (((bits >> lane) & 1) == 0) continue;
      for (int b = 0; b < 4; ++b) t.byte[bits][4 * n + b] = static_cast<std::uint8_t>(4 * lane + b);
      ++n;
    }
    // 0x80 gives a zero byte on both pshufb and tbl.
    for (int b = 4 * n; b < 16; ++b) t.byte[bits][b] = 0x80;
  }
  return t;
}
inline constexpr CompressTable kCompressTable = make_compress_table();

}  // namespace shoal::inline SHOAL_ISA_NS::wide_detail
