// Writes the assets of data/assets/ anew.
//
//   make_assets DIR
#include <cstdio>
#include <exception>
#include <string>

#include "tests/assets/asset_builder.h"

int main(int count, char** texts) {
  if (count != 2) {
    std::fprintf(stderr, "usage: make_assets DIR\n");
    return 2;
  }
  try {
    const std::string folder = std::string(texts[1]) + "/";
    shoal::test::make_materials_asset(folder + "materials.glb");
    shoal::test::make_textures_asset(folder + "textures.glb");
    shoal::test::make_motion_asset(folder + "motion.glb");
    shoal::test::make_geometry_asset(folder + "geometry.glb");
    shoal::test::make_water_asset(folder + "water.glb");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_assets: error: %s\n", error.what());
    return 1;
  }
  return 0;
}
