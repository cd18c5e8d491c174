// Changes of glTF files that stay files: one value of the JSON, or bytes of the binary chunk, and lengths that fit
// again. Without them nearly all changes end at the container or the JSON.
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>
#include <vector>

#include "tests/fuzz/fuzz_input.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

using nlohmann::json;
using Bytes = std::vector<std::uint8_t>;
using Random = std::minstd_rand;

constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;

std::uint32_t u32_at(const Bytes& bytes, std::size_t at) {
  std::uint32_t value;
  std::memcpy(&value, &bytes[at], 4);
  return value;
}
void append_u32(Bytes& bytes, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

struct Parts {
  bool binary = false;
  json root;
  Bytes bin;
};

bool split(const Bytes& file, Parts& parts) {
  parts.binary = file.size() >= 20 && std::memcmp(file.data(), "glTF", 4) == 0;
  Bytes text = file;
  if (parts.binary) {
    const std::size_t length = u32_at(file, 12);
    if (length > file.size() - 20) return false;
    const auto end = file.begin() + 20 + static_cast<std::ptrdiff_t>(length);
    text.assign(file.begin() + 20, end);
    if (file.end() - end > 8) parts.bin.assign(end + 8, file.end());
  }
  parts.root = json::parse(text.begin(), text.end(), nullptr, false);
  return parts.root.is_object();
}

Bytes joined(const Parts& parts) {
  const std::string dumped = parts.root.dump(-1, ' ', false, json::error_handler_t::replace);
  Bytes text(dumped.begin(), dumped.end());
  if (!parts.binary) return text;
  text.resize((text.size() + 3) / 4 * 4, ' ');
  Bytes bin = parts.bin, file = {'g', 'l', 'T', 'F'};
  bin.resize((bin.size() + 3) / 4 * 4, 0);
  append_u32(file, 2);
  append_u32(file, static_cast<std::uint32_t>(28 + text.size() + bin.size()));
  append_u32(file, static_cast<std::uint32_t>(text.size()));
  append_u32(file, kJsonChunk);
  file.insert(file.end(), text.begin(), text.end());
  append_u32(file, static_cast<std::uint32_t>(bin.size()));
  append_u32(file, kBinChunk);
  file.insert(file.end(), bin.begin(), bin.end());
  return file;
}

void collect(json& value, std::vector<json*>& all) {
  all.push_back(&value);
  if (!value.is_structured()) return;
  for (json& inner : value) collect(inner, all);
}

std::size_t below(Random& random, std::size_t n) { return random() % n; }

json interesting(Random& random) {
  static const json kValues = json::parse(
      R"([0, 1, 2, 3, 4, 5, 7, 8, 16, 64, 255, 256, 1000, 4096, 65535, 65536, 2147483647, 4294967295, 1e12, -1, 0.5,
          -0.5, 1e-30, 1e30, 1e308, 5120, 5121, 5122, 5123, 5125, 5126, "SCALAR", "VEC2", "VEC3", "VEC4", "MAT4",
          true, false, null, "", "data.bin", "image.png", [], {}, [0, 0, 0], [0, 0, 0, 0], "LINEAR", "STEP",
          "CUBICSPLINE", "weights", "rotation", "MASK", "BLEND", {"size": [1, 1]}])");
  return kValues[below(random, kValues.size())];
}

void mutate_json(json& root, Random& random) {
  std::vector<json*> all;
  collect(root, all);
  json& value = *all[below(random, all.size())];
  switch (below(random, 6)) {
    case 0:
      value = interesting(random);
      break;
    case 1:  // another place's value
      value = json(*all[below(random, all.size())]);
      break;
    case 2:
      if (value.is_array() && !value.empty()) {
        value.erase(below(random, value.size()));
      } else if (value.is_object() && !value.empty()) {
        value.erase(std::next(value.begin(), static_cast<std::ptrdiff_t>(below(random, value.size()))));
      } else {
        value = interesting(random);
      }
      break;
    case 3:  // once more
      if (value.is_array() && !value.empty()) {
        value.push_back(json(value[below(random, value.size())]));
      } else if (value.is_number()) {
        value = value.get<double>() + (below(random, 2) == 0 ? 1 : -1);
      }
      break;
    case 4:
      if (value.is_number_unsigned()) {
        value = below(random, 12);
      } else if (value.is_number()) {
        value = value.get<double>() * (below(random, 2) == 0 ? -1.0 : 1e3);
      }
      break;
    default:  // a member of another object
      if (value.is_object()) {
        json& other = *all[below(random, all.size())];
        if (other.is_object() && !other.empty()) {
          const auto member = std::next(other.begin(), static_cast<std::ptrdiff_t>(below(random, other.size())));
          const std::string key = member.key();
          const json copy = member.value();
          value[key] = copy;
        }
      }
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  Random random(seed);
  Parts parts;
  const Bytes file(data, data + size);
  if (below(random, 8) == 0 || !split(file, parts)) return LLVMFuzzerMutate(data, size, max_size);
  if (!parts.bin.empty() && below(random, 3) == 0) {
    const std::size_t old_size = parts.bin.size();
    parts.bin.resize(old_size + 16);
    parts.bin.resize(LLVMFuzzerMutate(parts.bin.data(), old_size, parts.bin.size()));
  } else {
    for (std::size_t i = 0, n = 1 + below(random, 3); i < n; ++i) mutate_json(parts.root, random);
  }
  const Bytes changed = joined(parts);
  if (changed.empty() || changed.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::memcpy(data, changed.data(), changed.size());
  return changed.size();
}
