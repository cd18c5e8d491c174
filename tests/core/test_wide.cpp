// Every operation of the wide type against plain integers and doubles, on random bits and on the edges of each type.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "core/wide/lanes.h"
#include "tests/core/isa_case.h"

using namespace shoal;

namespace {

using Floats = std::array<float, 16>;
using Ints = std::array<std::int32_t, 16>;

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr std::int32_t kMin = std::numeric_limits<std::int32_t>::min();
constexpr std::int32_t kMax = std::numeric_limits<std::int32_t>::max();
const float kNan = std::numeric_limits<float>::quiet_NaN();
const std::vector<float> kEdgeFloats = {0.0f,
                                        -0.0f,
                                        1.0f,
                                        -1.0f,
                                        0.5f,
                                        -0.5f,
                                        1.5f,
                                        2.5f,
                                        -2.5f,
                                        0x1p-149f,
                                        -0x1p-149f,
                                        0x1p-126f,
                                        0x1.fffffcp-127f,
                                        0x1.fffffep+127f,
                                        -0x1.fffffep+127f,
                                        8388608.0f,
                                        8388607.5f,
                                        -8388607.5f,
                                        16777216.0f,
                                        255.0f,
                                        256.0f,
                                        0x1p-64f,
                                        kInf,
                                        -kInf,
                                        kNan};
const std::vector<std::int32_t> kEdgeInts = {0,          1,     -1,       2,      255,      256,
                                             -256,       32767, 32768,    -32768, -32769,   65536,
                                             0x55555555, kMin,  kMin + 1, kMax,   kMax - 1, 16777217};

class Source {
 public:
  std::uint32_t bits() { return static_cast<std::uint32_t>(engine_()); }
  float any_float() {
    if (bits() % 3 == 0) return kEdgeFloats[bits() % kEdgeFloats.size()];
    return std::bit_cast<float>(bits());
  }
  std::int32_t any_int() {
    if (bits() % 3 == 0) return kEdgeInts[bits() % kEdgeInts.size()];
    return static_cast<std::int32_t>(bits());
  }
  Floats floats() {
    return filled<Floats>([&] { return any_float(); });
  }
  Ints ints() {
    return filled<Ints>([&] { return any_int(); });
  }
  Ints ints(std::int32_t low, std::int32_t high) {
    const std::uint32_t range = static_cast<std::uint32_t>(high - low) + 1u;
    return filled<Ints>([&] { return low + static_cast<std::int32_t>(bits() % range); });
  }
  template <class A, class Make>
  static A filled(Make make) {
    A a;
    for (auto& v : a) v = make();
    return a;
  }

 private:
  std::mt19937 engine_{20240607};
};

constexpr int kRounds = 2000;

WideF wide(const Floats& a) { return WideF::load(a.data()); }
WideI wide(const Ints& a) { return WideI::load(a.data()); }
Floats lanes(WideF a) {
  Floats r;
  a.store(r.data());
  return r;
}
Ints lanes(WideI a) {
  Ints r;
  a.store(r.data());
  return r;
}
bool same(float a, float b) {
  return (std::isnan(a) && std::isnan(b)) || std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}
bool same(std::int32_t a, std::int32_t b) { return a == b; }

// Counts, so that a failure says how many and which first, and passing costs no assertion a lane.
template <class A>
void check(const char* what, const A& got, const A& want) {
  for (std::size_t i = 0; i < got.size(); ++i) {
    if (same(got[i], want[i])) continue;
    INFO(what << ", lane " << i << ": got " << got[i] << ", want " << want[i]);
    CHECK(false);
    return;
  }
}
template <class Op>
Floats each(const Floats& a, const Floats& b, Op op) {
  Floats r;
  for (std::size_t i = 0; i < 16; ++i) r[i] = op(a[i], b[i]);
  return r;
}
template <class Op>
Ints each(const Ints& a, const Ints& b, Op op) {
  Ints r;
  for (std::size_t i = 0; i < 16; ++i) r[i] = static_cast<std::int32_t>(op(std::int64_t{a[i]}, std::int64_t{b[i]}));
  return r;
}
template <class A, class Test>
std::uint32_t bits_where(const A& a, const A& b, Test test) {
  std::uint32_t r = 0;
  for (std::size_t i = 0; i < 16; ++i) r |= test(a[i], b[i]) ? 1u << i : 0u;
  return r;
}

}  // namespace

// The double result of one operation on floats, rounded to float, is the correctly rounded float result (53 >= 2 24 +
// 2).
SHOAL_ISA_CASE(test_arithmetic, "float arithmetic is correctly rounded") {
  Source source;
  for (int round = 0; round < kRounds; ++round) {
    const Floats a = source.floats(), b = source.floats();
    check("+", lanes(wide(a) + wide(b)), each(a, b, [](double x, double y) { return static_cast<float>(x + y); }));
    check("-", lanes(wide(a) - wide(b)), each(a, b, [](double x, double y) { return static_cast<float>(x - y); }));
    check("*", lanes(wide(a) * wide(b)), each(a, b, [](double x, double y) { return static_cast<float>(x * y); }));
    check("/", lanes(wide(a) / wide(b)), each(a, b, [](double x, double y) { return static_cast<float>(x / y); }));
    check("sqrt", lanes(sqrt(wide(a))), each(a, a, [](double x, double) { return static_cast<float>(std::sqrt(x)); }));
    check("floor", lanes(floor(wide(a))),
          each(a, a, [](double x, double) { return static_cast<float>(std::floor(x)); }));
  }
}

SHOAL_ISA_CASE(test_signs, "float signs are bits") {
  Source source;
  for (int round = 0; round < kRounds; ++round) {
    const Floats a = source.floats();
    const std::uint32_t m = source.bits() & 0xFFFFu;
    const Floats negated = lanes(-wide(a)), absolute = lanes(abs(wide(a)));
    const Floats flipped = lanes(flip_sign_if(wide(a), mask_from_bits(m)));
    for (std::size_t i = 0; i < 16; ++i) {
      const auto in = std::bit_cast<std::uint32_t>(a[i]);
      REQUIRE(std::bit_cast<std::uint32_t>(negated[i]) == (in ^ 0x80000000u));
      REQUIRE(std::bit_cast<std::uint32_t>(absolute[i]) == (in & 0x7FFFFFFFu));
      REQUIRE(std::bit_cast<std::uint32_t>(flipped[i]) == (((m >> i) & 1u) != 0 ? in ^ 0x80000000u : in));
      if (!std::isnan(a[i])) REQUIRE(same(flip_sign_if(a[i], true), negated[i]));
    }
    check("as_int", lanes(as_float(as_int(wide(a)))), a);
  }
}

SHOAL_ISA_CASE(test_float_compare, "float comparisons, minimum and maximum") {
  Source source;
  for (int round = 0; round < kRounds; ++round) {
    const Floats a = source.floats();
    Floats b = source.floats();
    for (std::size_t i = 0; i < 16; ++i)
      if (source.bits() % 4 == 0) b[i] = a[i];
    const WideF x = wide(a), y = wide(b);
    CHECK(to_bits(x < y) == bits_where(a, b, [](double p, double q) { return p < q; }));
    CHECK(to_bits(x <= y) == bits_where(a, b, [](double p, double q) { return p <= q; }));
    CHECK(to_bits(x > y) == bits_where(a, b, [](double p, double q) { return p > q; }));
    CHECK(to_bits(x >= y) == bits_where(a, b, [](double p, double q) { return p >= q; }));
    CHECK(to_bits(x == y) == bits_where(a, b, [](double p, double q) { return p == q; }));
    CHECK(to_bits(x != y) == bits_where(a, b, [](double p, double q) { return p != q; }));
    // Second operand where they are equal (zeros of either sign) or unordered.
    check("min", lanes(min(x, y)), each(a, b, [](float p, float q) { return std::isless(p, q) ? p : q; }));
    check("max", lanes(max(x, y)), each(a, b, [](float p, float q) { return std::isgreater(p, q) ? p : q; }));
    check("min of float", each(a, b, [](float p, float q) { return shoal::min(p, q); }), lanes(min(x, y)));
    check("max of float", each(a, b, [](float p, float q) { return shoal::max(p, q); }), lanes(max(x, y)));
  }
  CHECK(same(extract(min(WideF(0.0f), WideF(-0.0f)), 3), -0.0f));
  CHECK(same(extract(max(WideF(-0.0f), WideF(0.0f)), 3), 0.0f));
  CHECK(extract(min(WideF(kNan), WideF(2.0f)), 15) == 2.0f);
}

SHOAL_ISA_CASE(test_int_arithmetic, "integers wrap") {
  Source source;
  for (int round = 0; round < kRounds; ++round) {
    const Ints a = source.ints(), b = source.ints();
    const WideI x = wide(a), y = wide(b);
    using I = std::int64_t;
    check("+", lanes(x + y), each(a, b, [](I p, I q) { return p + q; }));
    check("-", lanes(x - y), each(a, b, [](I p, I q) { return p - q; }));
    check("*", lanes(x * y), each(a, b, [](I p, I q) { return p * q; }));
    check("negate", lanes(-x), each(a, b, [](I p, I) { return -p; }));
    check("abs", lanes(abs(x)), each(a, b, [](I p, I) { return p < 0 ? -p : p; }));
    check("&", lanes(x & y), each(a, b, [](I p, I q) { return p & q; }));
    check("|", lanes(x | y), each(a, b, [](I p, I q) { return p | q; }));
    check("^", lanes(x ^ y), each(a, b, [](I p, I q) { return p ^ q; }));
    check("~", lanes(~x), each(a, b, [](I p, I) { return -1 - p; }));
    check("min", lanes(min(x, y)), each(a, b, [](I p, I q) { return std::min(p, q); }));
    check("max", lanes(max(x, y)), each(a, b, [](I p, I q) { return std::max(p, q); }));
    CHECK(to_bits(x < y) == bits_where(a, b, [](I p, I q) { return p < q; }));
    CHECK(to_bits(x <= y) == bits_where(a, b, [](I p, I q) { return p <= q; }));
    CHECK(to_bits(x > y) == bits_where(a, b, [](I p, I q) { return p > q; }));
    CHECK(to_bits(x >= y) == bits_where(a, b, [](I p, I q) { return p >= q; }));
    CHECK(to_bits(x == y) == bits_where(a, b, [](I p, I q) { return p == q; }));
    CHECK(to_bits(x != y) == bits_where(a, b, [](I p, I q) { return p != q; }));
  }
}

SHOAL_ISA_CASE(test_shifts, "shifts by one count and by a count a lane") {
  Source source;
  for (int round = 0; round < kRounds; ++round) {
    const Ints a = source.ints(), each_n = source.ints(0, 31);
    const int n = round % 32;
    Ints ns;
    ns.fill(n);
    // Division that rounds down is the arithmetic shift; on the unsigned value, the logical one.
    const auto left = [](std::int64_t v, std::int64_t s) { return v * (std::int64_t{1} << s); };
    const auto logical = [](std::int64_t v, std::int64_t s) { return (v & 0xFFFFFFFF) / (std::int64_t{1} << s); };
    const auto arithmetic = [](std::int64_t v, std::int64_t s) {
      return static_cast<std::int64_t>(std::floor(static_cast<double>(v) / static_cast<double>(std::int64_t{1} << s)));
    };
    check("<<", lanes(wide(a) << n), each(a, ns, left));
    check(">>", lanes(wide(a) >> n), each(a, ns, arithmetic));
    check("shift_right_logical", lanes(shift_right_logical(wide(a), n)), each(a, ns, logical));
    check("shift_left, lanes", lanes(shift_left(wide(a), wide(each_n))), each(a, each_n, left));
    check("shift_right, lanes", lanes(shift_right_logical(wide(a), wide(each_n))), each(a, each_n, logical));
    CHECK(shift_left(a[0], each_n[0]) == static_cast<std::int32_t>(left(a[0], each_n[0])));
    CHECK(shift_right_logical(a[0], n) == static_cast<std::int32_t>(logical(a[0], n)));
  }
  CHECK(extract(shift_left(WideI(3), WideI(31)), 7) == kMin);
}

SHOAL_ISA_CASE(test_masks, "masks are sixteen bits") {
  Source source;
  for (int round = 0; round < kRounds; ++round) {
    const std::uint32_t a = source.bits() & 0xFFFFu, b = source.bits() & 0xFFFFu;
    const WideM x = mask_from_bits(a | 0xABCD0000u), y = mask_from_bits(b);
    CHECK(to_bits(x) == a);
    CHECK(to_bits(x & y) == (a & b));
    CHECK(to_bits(x | y) == (a | b));
    CHECK(to_bits(x ^ y) == (a ^ b));
    CHECK(to_bits(!x) == (~a & 0xFFFFu));
    const Floats p = source.floats(), q = source.floats();
    const Ints i = source.ints(), j = source.ints();
    Floats want = q;
    Ints want_int = j;
    for (std::size_t k = 0; k < 16; ++k) {
      if (((a >> k) & 1u) == 0) continue;
      want[k] = p[k];
      want_int[k] = i[k];
    }
    check("select", lanes(select(x, wide(p), wide(q))), want);
    check("select of int", lanes(select(x, wide(i), wide(j))), want_int);
  }
  for (int lane = 0; lane < 16; ++lane) {
    const WideM one = mask_from_bits(1u << lane);
    CHECK((any(one) && !all(one) && !none(one)));
    CHECK((any(!one) && !all(!one) && !none(!one)));
  }
  CHECK((all(mask_from_bits(0xFFFFu)) && none(mask_from_bits(0))));
}

SHOAL_ISA_CASE(test_conversions, "conversions between float and int") {
  Source source;
  for (int round = 0; round < kRounds; ++round) {
    const Ints a = source.ints();
    Floats want;
    for (std::size_t i = 0; i < 16; ++i) want[i] = static_cast<float>(static_cast<double>(a[i]));
    check("to_float", lanes(to_float(wide(a))), want);
    CHECK(same(shoal::to_float(a[0]), want[0]));
    // Everything in the domain: halves, large numbers, denormals.
    const Floats f = Source::filled<Floats>([&] {
      const float v = source.any_float();
      if (source.bits() % 2 == 0)
        return 0.5f * static_cast<float>(static_cast<std::int32_t>(source.bits() % 4001u) - 2000);
      return std::fabs(v) <= 2147483520.0f ? v : 2147483520.0f;
    });
    Ints truncated, nearest;
    for (std::size_t i = 0; i < 16; ++i) {
      const double v = f[i], down = std::floor(v), rest = v - down;
      truncated[i] = static_cast<std::int32_t>(v < 0 ? std::ceil(v) : down);
      const bool up = rest > 0.5 || (rest == 0.5 && std::fmod(down, 2.0) != 0.0);
      nearest[i] = static_cast<std::int32_t>(up ? down + 1 : down);
    }
    check("to_int_trunc", lanes(to_int_trunc(wide(f))), truncated);
    check("to_int_nearest", lanes(to_int_nearest(wide(f))), nearest);
    CHECK(shoal::to_int_trunc(f[0]) == truncated[0]);
    CHECK(shoal::to_int_nearest(f[0]) == nearest[0]);
  }
}

SHOAL_ISA_CASE(test_permute, "permute, compress, extract, lane_index") {
  Source source;
  for (int round = 0; round < kRounds; ++round) {
    const Floats f = source.floats();
    const Ints v = source.ints(), index = source.ints();
    Floats moved;
    Ints moved_int;
    for (std::size_t i = 0; i < 16; ++i) {
      moved[i] = f[static_cast<std::size_t>(index[i] & 15)];
      moved_int[i] = v[static_cast<std::size_t>(index[i] & 15)];
    }
    check("permute", lanes(permute(wide(f), wide(index))), moved);
    check("permute of int", lanes(permute(wide(v), wide(index))), moved_int);
  }
  const Ints v = source.ints(1, kMax - 1);
  for (std::uint32_t m = 0; m < 0x10000u; ++m) {
    Ints want = {};
    std::size_t n = 0;
    for (std::size_t i = 0; i < 16; ++i)
      if (((m >> i) & 1u) != 0) want[n++] = v[i];
    if (lanes(compress(wide(v), mask_from_bits(m))) != want) FAIL("compress with mask " << m);
    if (lanes(as_int(compress(as_float(wide(v)), mask_from_bits(m)))) != want) FAIL("float compress with mask " << m);
  }
  for (int i = 0; i < 16; ++i) {
    CHECK(extract(lane_index(), i) == i);
    CHECK(extract(to_float(lane_index()), i) == static_cast<float>(i));
  }
}

SHOAL_ISA_CASE(test_memory, "loads, gathers and stores touch what they name and nothing else") {
  Source source;
  std::vector<float> table(300);
  std::vector<std::int32_t> table_int(300);
  for (std::size_t i = 0; i < table.size(); ++i) {
    table[i] = static_cast<float>(i) + 0.25f;
    table_int[i] = static_cast<std::int32_t>(source.bits());
  }
  // Indices of either sign, from the middle.
  const float* base = table.data() + 100;
  const std::int32_t* base_int = table_int.data() + 100;
  for (int round = 0; round < kRounds; ++round) {
    const Ints index = source.ints(-100, 198);
    const std::uint32_t m = source.bits() & 0xFFFFu;
    Ints wild = index;
    Floats want, want_masked;
    Ints want_int, want_int_masked, want_first, want_second;
    for (std::size_t i = 0; i < 16; ++i) {
      const auto at = static_cast<std::size_t>(index[i] + 100);
      const bool on = ((m >> i) & 1u) != 0;
      want[i] = table[at];
      want_int[i] = table_int[at];
      want_masked[i] = on ? table[at] : -7.0f;
      want_int_masked[i] = on ? table_int[at] : -7;
      want_first[i] = table_int[at];
      want_second[i] = table_int[at + 1];
      // Far outside of any mapping: read, it would end the program.
      if (!on) wild[i] = (i & 1u) != 0 ? kMin : kMax;
    }
    check("gather", lanes(gather(base, wide(index))), want);
    check("gather of int", lanes(gather(base_int, wide(index))), want_int);
    check("masked gather", lanes(gather(base, wide(wild), mask_from_bits(m), WideF(-7.0f))), want_masked);
    check("masked gather of int", lanes(gather(base_int, wide(wild), mask_from_bits(m), WideI(-7))), want_int_masked);
    WideI first, second;
    load_texel_pairs(reinterpret_cast<const std::uint32_t*>(base_int), wide(index), first, second);
    check("first texels", lanes(first), want_first);
    check("second texels", lanes(second), want_second);
  }
}

SHOAL_ISA_CASE(test_stores, "stores: unaligned, bytes, masked") {
  Source source;
  for (int round = 0; round < kRounds; ++round) {
    const std::size_t offset = source.bits() % 7u;
    const Ints v = source.ints(), old = source.ints();
    const std::uint32_t m = source.bits() & 0xFFFFu;

    std::array<std::int32_t, 32> memory;
    memory.fill(77);
    WideI::load(v.data()).store(memory.data() + offset);
    for (std::size_t i = 0; i < 32; ++i) REQUIRE(memory[i] == (i >= offset && i < offset + 16 ? v[i - offset] : 77));
    check("unaligned load", lanes(WideI::load(memory.data() + offset)), v);

    std::array<std::uint8_t, 32> bytes;
    bytes.fill(77);
    store_u8(bytes.data() + offset, wide(v));
    for (std::size_t i = 0; i < 32; ++i)
      REQUIRE(bytes[i] == (i >= offset && i < offset + 16 ? std::clamp(v[i - offset], 0, 255) : 77));
    const Ints back = lanes(load_u8(bytes.data() + offset));
    for (std::size_t i = 0; i < 16; ++i) REQUIRE(back[i] == bytes[offset + i]);

    Ints masked = old;
    store_masked(masked.data(), wide(v), mask_from_bits(m));
    std::array<float, 16> masked_float;
    masked_float.fill(-1.0f);
    store_masked(masked_float.data(), WideF(2.0f), mask_from_bits(m));
    for (std::size_t i = 0; i < 16; ++i) {
      REQUIRE(masked[i] == (((m >> i) & 1u) != 0 ? v[i] : old[i]));
      REQUIRE(masked_float[i] == (((m >> i) & 1u) != 0 ? 2.0f : -1.0f));
    }
  }
}

SHOAL_ISA_CASE(test_reductions, "reductions") {
  Source source;
  for (int round = 0; round < kRounds; ++round) {
    const Ints v = source.ints();
    CHECK(reduce_min(wide(v)) == *std::min_element(v.begin(), v.end()));
    CHECK(reduce_max(wide(v)) == *std::max_element(v.begin(), v.end()));
    Floats f = source.floats();
    for (float& x : f)
      if (std::isnan(x)) x = 3.0f;
    CHECK(reduce_min(wide(f)) == *std::min_element(f.begin(), f.end()));
    CHECK(reduce_max(wide(f)) == *std::max_element(f.begin(), f.end()));
  }
  // Which zero comes out is the fixed tree's doing: at ties the later lane, so lane 15's.
  Floats zeros = {};
  zeros[15] = -0.0f;
  CHECK(same(reduce_min(wide(zeros)), -0.0f));
  CHECK(same(reduce_max(wide(zeros)), -0.0f));
  zeros.fill(-0.0f);
  zeros[15] = 0.0f;
  CHECK(same(reduce_min(wide(zeros)), 0.0f));
  CHECK(same(reduce_max(wide(zeros)), 0.0f));
}
