// Which rays make two renderings of a frame differ (scripts/changed_pixels).
//
//   changed_pixels A.exr B.exr
//
// Both have the AOVs id.triangle, hit.kind and hit.id. Prints one line of CSV: pixels, pixels whose colour differs, and
// of those how many show another triangle to the eye's ray, how many show the same one but another hit behind the water,
// and how many differ in light alone.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "core/error.h"

namespace {

struct Picture {
  int width = 0, height = 0, channels = 0;
  std::vector<std::string> names;
  std::vector<float> values;  // ids are scaled to 0..1, the same for both pictures

  int channel(const std::string& name) const {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) throw shoal::Error("no channel " + name + "; expected --aov id.triangle,hit.kind,hit.id");
    return static_cast<int>(at - names.begin());
  }
  float at(std::size_t pixel, int c) const {
    return values[pixel * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c)];
  }
};

Picture load(const std::string& path) {
  const auto input = OIIO::ImageInput::open(path);
  if (!input) throw shoal::Error(path + ": cannot be read; expected an EXR file");
  const OIIO::ImageSpec& spec = input->spec();
  Picture p{spec.width, spec.height, spec.nchannels, spec.channelnames, {}};
  p.values.resize(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, p.values.data()))
    throw shoal::Error(path + ": " + input->geterror());
  return p;
}

// The one channel of an AOV, whatever its last letter is.
int aov(const Picture& p, const std::string& name) {
  for (const std::string& full : p.names)
    if (full == name || full.substr(0, full.rfind('.')) == name) return p.channel(full);
  return p.channel(name);
}

void run(const std::string& path_a, const std::string& path_b) {
  const Picture a = load(path_a), b = load(path_b);
  if (a.names != b.names || a.width != b.width || a.height != b.height)
    throw shoal::Error("the pictures differ in size or channels; expected two renderings of one frame");
  const int color[3] = {a.channel("R"), a.channel("G"), a.channel("B")};
  const int eye = aov(a, "id.triangle"), kind = aov(a, "hit.kind"), hit = aov(a, "hit.id");
  std::size_t differ = 0, by_eye = 0, by_hit = 0;
  const std::size_t pixels = static_cast<std::size_t>(a.width) * static_cast<std::size_t>(a.height);
  for (std::size_t i = 0; i < pixels; ++i) {
    const auto same = [&](int c) { return a.at(i, c) == b.at(i, c); };
    if (same(color[0]) && same(color[1]) && same(color[2])) continue;
    ++differ;
    if (!same(eye))
      ++by_eye;
    else if (!same(kind) || !same(hit))
      ++by_hit;
  }
  std::printf("%zu,%zu,%zu,%zu,%zu\n", pixels, differ, by_eye, by_hit, differ - by_eye - by_hit);
}

}  // namespace

int main(int count, char** texts) {
  try {
    if (count != 3) throw shoal::Error("expected two EXR files");
    run(texts[1], texts[2]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "changed_pixels: error: %s\n", error.what());
    return 1;
  }
}
