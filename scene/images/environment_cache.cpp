#include "scene/images/environment_cache.h"

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <vector>

#include "core/digest.h"

namespace shoal {
namespace fs = std::filesystem;
namespace {

// The file consists of this text, the key, the fields that `describe` lists in little-endian order, and the digest of
// all bytes before it.
constexpr std::string_view kMagic = "shoal environment\n";
constexpr std::size_t kDigestSize = 32;

std::string file_name(const std::string& folder, const std::string& key) {
  return (fs::path(folder) / ("environment-" + key)).string();
}

template <class E, class Part>
void describe(E& e, Part part) {
  part(e.size, sizeof e.size);
  part(e.first_texel, sizeof e.first_texel);
  part(&e.scale, sizeof e.scale);
  part(e.irradiance, sizeof e.irradiance);
  part(e.lobe.data(), e.lobe.size() * sizeof e.lobe[0]);
  part(e.texels.data(), e.texels.size() * sizeof e.texels[0]);
}

// Returns whether every lookup stays inside the texels.
bool is_sound(const Environment& e) {
  std::int64_t texels = 0;
  for (std::size_t k = 0; k < 16; ++k) {
    const std::size_t last = kEnvironmentLevels - 1;
    if (k > last) {
      if (e.size[k] != e.size[last] || e.first_texel[k] != e.first_texel[last]) return false;
      continue;
    }
    if (e.size[k] < 1 || e.size[k] > kMaxEnvironmentSize || e.first_texel[k] != texels) return false;
    texels += (std::int64_t{e.size[k]} + 2) * (std::int64_t{e.size[k]} + 2);
  }
  if (static_cast<std::uint64_t>(texels) * 2 != e.texels.size()) return false;
  if (!(e.scale >= 0 && e.scale <= 1e9f)) return false;
  return std::all_of(std::begin(e.irradiance), std::end(e.irradiance),
                     [](Vec3f v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); });
}

std::vector<char> read_all(const std::string& path) {
  std::error_code ec;
  if (!fs::is_regular_file(path, ec)) return {};
  const std::uint64_t size = fs::file_size(path, ec);
  if (ec || size > std::uint64_t{1} << 30) return {};
  std::ifstream in(path, std::ios::binary);
  std::vector<char> bytes(static_cast<std::size_t>(size));
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (static_cast<std::uint64_t>(in.gcount()) != size) return {};
  return bytes;
}

}  // namespace

std::string environment_key(const EquirectImage& image) {
  Digest digest;
  const std::uint32_t head[3] = {kEnvironmentVersion, static_cast<std::uint32_t>(image.width),
                                 static_cast<std::uint32_t>(image.height)};
  digest.add(head, sizeof head);
  digest.add(image.rgb.data(), image.rgb.size() * sizeof(float));
  return digest.hex();
}

std::shared_ptr<const Environment> read_cached_environment(const std::string& folder, const std::string& key) {
  const std::vector<char> bytes = read_all(file_name(folder, key));
  const std::size_t head = kMagic.size() + key.size();
  auto e = std::make_shared<Environment>();
  e->lobe.resize(static_cast<std::size_t>(kLobeTableSize) * kLobeTableSize);
  std::size_t fixed = head + kDigestSize;
  describe(*e, [&](const void*, std::size_t size) { fixed += size; });
  if (bytes.size() < fixed || (bytes.size() - fixed) % 8 != 0) return nullptr;
  const std::string_view text(bytes.data(), bytes.size());
  if (text.substr(0, kMagic.size()) != kMagic || text.substr(kMagic.size(), key.size()) != key) return nullptr;
  const std::size_t body = bytes.size() - kDigestSize;
  if (text.substr(body) != digest_hex(bytes.data(), body)) return nullptr;
  e->texels.resize((bytes.size() - fixed) / sizeof(std::uint32_t));
  std::size_t at = head;
  describe(*e, [&](void* part, std::size_t size) {
    if (size != 0) std::memcpy(part, bytes.data() + at, size);
    at += size;
  });
  if (!is_sound(*e)) return nullptr;
  return e;
}

void write_cached_environment(const std::string& folder, const std::string& key, const Environment& environment) {
  std::error_code ec;
  fs::create_directories(folder, ec);
  std::string bytes = std::string(kMagic) + key;
  describe(environment,
           [&](const void* part, std::size_t size) { bytes.append(static_cast<const char*>(part), size); });
  bytes += digest_hex(bytes.data(), bytes.size());
  const std::string path = file_name(folder, key), beside = path + "." + std::to_string(getpid());
  {
    std::ofstream out(beside, std::ios::binary | std::ios::trunc);
    if (!out) return;
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (out) fs::rename(beside, path, ec);
    if (out && !ec) return;
  }
  fs::remove(beside, ec);
}

}  // namespace shoal
