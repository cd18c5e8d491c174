// The instruction sets that Shoal has kernels for, and which of them this machine runs.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace shoal {

enum class Isa { kScalar, kSse42, kAvx2, kAvx512, kNeon };

// The name that --isa takes: "scalar", "sse4.2", "avx2", "avx512", "neon".
const char* isa_name(Isa isa);

// The opposite; nothing for any other word.
std::optional<Isa> parse_isa(std::string_view name);

// Whether this program has kernels for it: SHOAL_ISAS of the build.
bool is_built(Isa isa);

// What this machine runs and this program was built for, best first; empty where there is none. The x86 sets are the
// psABI's levels as the kernels are compiled: v2, v3 and v4, the last with AVX-512 F, BW, CD, DQ and VL.
std::vector<Isa> supported_isas();

// The first of supported_isas(). Throws Error where this machine runs none of them.
Isa best_isa();

// "isa 'scalar': ..." as UsageError.
[[noreturn]] void throw_isa_not_built(Isa isa);

}  // namespace shoal
