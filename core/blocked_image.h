// Image buffers in 4 x 4 blocks: sixteen pixels of one channel are one cache line and one wide value.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>

namespace shoal {

inline constexpr int kBlockSize = 4;  // pixels a side
inline constexpr int kBlockPixels = 16;
inline constexpr int kRegionSize = 64;  // pixels a side: the fixed grid that every image is padded to

// An array of plain values on a cache line of its own. Memory is not initialized, so pages of a big array cost nothing
// until they are written.
template <class T>
class AlignedArray {
 public:
  static_assert(std::is_trivially_copyable_v<T>);
  AlignedArray() = default;
  explicit AlignedArray(std::size_t size) { resize(size); }
  // Contents are lost, the new ones indeterminate.
  void resize(std::size_t size) {
    if (size == size_) return;
    data_.reset();
    size_ = size;
    if (size == 0) return;
    const std::size_t bytes = (size * sizeof(T) + 63) / 64 * 64;
    data_.reset(static_cast<T*>(std::aligned_alloc(64, bytes)));
    if (!data_) throw std::bad_alloc();
  }
  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  std::size_t size() const { return size_; }
  T& operator[](std::size_t i) { return data_.get()[i]; }
  const T& operator[](std::size_t i) const { return data_.get()[i]; }

 private:
  struct Free {
    void operator()(T* p) const { std::free(p); }
  };
  std::unique_ptr<T, Free> data_;
  std::size_t size_ = 0;
};

// Size of a frame in pixels, 4-pixel blocks and 64-pixel regions.
struct FrameGrid {
  int width_px = 0, height_px = 0;
  int regions_x = 0, regions_y = 0;  // 64-pixel regions that cover the frame
  int blocks_x = 0, blocks_y = 0;    // 4-pixel blocks of the padded image: 16 a region
  std::size_t block_count() const { return static_cast<std::size_t>(blocks_x) * static_cast<std::size_t>(blocks_y); }
  std::size_t region_count() const { return static_cast<std::size_t>(regions_x) * static_cast<std::size_t>(regions_y); }
  std::size_t pixel_slots() const { return block_count() * kBlockPixels; }
  // Index of a block's first pixel slot.
  std::size_t block_offset(int block_x, int block_y) const {
    return (static_cast<std::size_t>(block_y) * static_cast<std::size_t>(blocks_x) +
            static_cast<std::size_t>(block_x)) *
           kBlockPixels;
  }
  std::size_t slot(int x_px, int y_px) const {
    return block_offset(x_px >> 2, y_px >> 2) + static_cast<std::size_t>((y_px & 3) * 4 + (x_px & 3));
  }
};

inline FrameGrid make_frame_grid(int width_px, int height_px) {
  FrameGrid g;
  g.width_px = width_px;
  g.height_px = height_px;
  g.regions_x = (width_px + kRegionSize - 1) / kRegionSize;
  g.regions_y = (height_px + kRegionSize - 1) / kRegionSize;
  g.blocks_x = g.regions_x * (kRegionSize / kBlockSize);
  g.blocks_y = g.regions_y * (kRegionSize / kBlockSize);
  return g;
}

}  // namespace shoal
