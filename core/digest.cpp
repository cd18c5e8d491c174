#include "core/digest.h"

#include <bit>
#include <cstdint>
#include <cstdio>
#include <new>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace shoal {

static_assert(std::endian::native == std::endian::little, "buffers are digested as they lie in memory");

namespace {
std::string to_hex(XXH128_hash_t hash) {
  char text[33];
  std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  return text;
}
XXH3_state_t* state_of(void* p) { return static_cast<XXH3_state_t*>(p); }
}  // namespace

Digest::Digest() : state_(XXH3_createState()) {
  if (state_ == nullptr) throw std::bad_alloc();
  XXH3_128bits_reset(state_of(state_));
}
Digest::~Digest() { XXH3_freeState(state_of(state_)); }
void Digest::add(const void* data, std::size_t bytes) { XXH3_128bits_update(state_of(state_), data, bytes); }
std::string Digest::hex() const { return to_hex(XXH3_128bits_digest(state_of(state_))); }

std::string digest_hex(const void* data, std::size_t bytes) { return to_hex(XXH3_128bits(data, bytes)); }

}  // namespace shoal
