#include "core/pod_vector.h"

#include <cstdlib>
#include <cstring>
#include <new>

namespace shoal {

void* grow_storage(void* old, std::size_t used_bytes, std::size_t wanted_bytes) {
  void* p = std::aligned_alloc(64, (wanted_bytes + 63) / 64 * 64);
  if (p == nullptr) throw std::bad_alloc();
  if (used_bytes > 0) std::memcpy(p, old, used_bytes);
  std::free(old);
  return p;
}

void free_storage(void* p) { std::free(p); }

}  // namespace shoal
