// Stage digests: XXH3-128 over little-endian rows, top to bottom.
#pragma once

#include <cstddef>
#include <string>

namespace shoal {

class Digest {
 public:
  Digest();
  ~Digest();
  Digest(const Digest&) = delete;
  Digest& operator=(const Digest&) = delete;

  void add(const void* data, std::size_t bytes);
  // 32 hexadecimal digits of what was added so far.
  std::string hex() const;

 private:
  void* state_;
};

std::string digest_hex(const void* data, std::size_t bytes);

}  // namespace shoal
