// What a method owns: its options and its private data.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace shoal {

// Data that a method makes of the scene before the frames, or anew in each frame of an animated scene.
struct MethodData {
  virtual ~MethodData() = default;
  // Figures for reports: name and value.
  virtual std::vector<std::pair<std::string, double>> figures() const { return {}; }
};

// A method's option struct is plain and at most this large.
inline constexpr std::size_t kMaxOptionBytes = 64;

struct MethodState {
  alignas(8) std::byte options[kMaxOptionBytes] = {};
  std::unique_ptr<MethodData> data;  // null where the method has none

  template <class Options>
  const Options& options_as() const {
    static_assert(sizeof(Options) <= kMaxOptionBytes);
    return *reinterpret_cast<const Options*>(options);
  }
  template <class Data>
  const Data& data_as() const {
    return static_cast<const Data&>(*data);
  }
};

}  // namespace shoal
