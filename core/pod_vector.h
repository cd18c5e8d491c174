// A growable array of plain data, 64-byte aligned, for kernels: nothing of it is ever emitted out of line in an ISA's
// object (std::vector's weak symbols would be), and clearing keeps the memory for the next frame.
#pragma once

#include <cstddef>
#include <type_traits>

#include "core/wide/isa_select.h"

namespace shoal {

// Moves used_bytes to a new block of at least wanted_bytes, 64-byte aligned; frees the old one. Throws std::bad_alloc.
void* grow_storage(void* old, std::size_t used_bytes, std::size_t wanted_bytes);
void free_storage(void* p);

template <class T>
class PodVector {
 public:
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
  SHOAL_INLINE PodVector() = default;
  SHOAL_INLINE ~PodVector() { free_storage(data_); }
  PodVector(const PodVector&) = delete;
  PodVector& operator=(const PodVector&) = delete;
  SHOAL_INLINE PodVector(PodVector&& o) noexcept : data_(o.data_), size_(o.size_), capacity_(o.capacity_) {
    o.data_ = nullptr;
    o.size_ = o.capacity_ = 0;
  }

  SHOAL_INLINE T* data() { return data_; }
  SHOAL_INLINE const T* data() const { return data_; }
  SHOAL_INLINE std::size_t size() const { return size_; }
  SHOAL_INLINE T& operator[](std::size_t i) { return data_[i]; }
  SHOAL_INLINE const T& operator[](std::size_t i) const { return data_[i]; }
  SHOAL_INLINE void clear() { size_ = 0; }
  SHOAL_INLINE void pop() { --size_; }
  // One more element, indeterminate.
  SHOAL_INLINE T& push() {
    if (size_ == capacity_) reserve(size_ + 1);
    return data_[size_++];
  }
  // New elements are indeterminate.
  SHOAL_INLINE void resize(std::size_t size) {
    if (size > capacity_) reserve(size);
    size_ = size;
  }
  SHOAL_INLINE void reserve(std::size_t size) {
    if (size <= capacity_) return;
    const std::size_t grown = capacity_ + capacity_ / 2 + 16;
    capacity_ = size > grown ? size : grown;
    data_ = static_cast<T*>(grow_storage(data_, size_ * sizeof(T), capacity_ * sizeof(T)));
  }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace shoal
