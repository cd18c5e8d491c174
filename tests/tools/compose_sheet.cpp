// Lays pictures out as one contact sheet (scripts/contact_sheet).
//
//   compose_sheet OUT.png COLUMNS WIDTHxHEIGHT <LIST
//
// A line of LIST is a cell: LABEL <tab> NOTE <tab> PICTURE <tab> REFERENCE. The cell has the label and the note over
// the picture and, to its right, the reference, each scaled to fit WIDTHxHEIGHT with its aspect kept. An empty name
// leaves its place empty; a picture that cannot be read leaves it red. PNG and JPEG are read.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "core/error.h"
#include "scene/gltf/export_glb_file.h"
#include "scene/images/images.h"
#include "tests/tools/sheet_font.h"

namespace {

using shoal::Texture;

constexpr int kScale = 2, kMargin = 6, kLine = shoal::test::kGlyphHeight * kScale + 4;
constexpr std::uint8_t kPaper[3] = {32, 36, 40}, kFrame[3] = {54, 58, 62}, kInk[3] = {230, 230, 230},
                       kNoteInk[3] = {255, 190, 90}, kBroken[3] = {160, 20, 20};

struct Canvas {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;

  Canvas(int w, int h)
      : width(w), height(h), rgba(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * 4, 255) {}
  void set(int x, int y, const std::uint8_t* rgb) {
    if (x < 0 || y < 0 || x >= width || y >= height) return;
    std::copy_n(
        rgb, 3,
        &rgba[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) * 4]);
  }
  void fill(int x, int y, int w, int h, const std::uint8_t* rgb) {
    for (int j = 0; j < h; ++j) {
      for (int i = 0; i < w; ++i) set(x + i, y + j, rgb);
    }
  }
};

int width_of(const std::string& text) {
  return static_cast<int>(text.size()) * (shoal::test::kGlyphWidth + 1) * kScale;
}

// What does not fit before x_end is left out.
void write_text(Canvas& canvas, int x, int y, int x_end, const std::string& text, const std::uint8_t* rgb) {
  for (const char character : text) {
    if (x + shoal::test::kGlyphWidth * kScale > x_end) break;
    const shoal::test::Glyph& glyph = shoal::test::glyph_of(character);
    for (int row = 0; row < shoal::test::kGlyphHeight; ++row) {
      for (int column = 0; column < shoal::test::kGlyphWidth; ++column) {
        if ((glyph.rows[static_cast<std::size_t>(row)] >> (shoal::test::kGlyphWidth - 1 - column) & 1) == 0) continue;
        canvas.fill(x + column * kScale, y + row * kScale, kScale, kScale, rgb);
      }
    }
    x += (shoal::test::kGlyphWidth + 1) * kScale;
  }
}

// Mean of the pixels that a target pixel covers, over the frame's grey where they are transparent. Code values are
// averaged: this is for looking.
void place_picture(Canvas& canvas, int x0, int y0, int box_width, int box_height, const std::string& path) {
  canvas.fill(x0, y0, box_width, box_height, kFrame);
  if (path.empty()) return;
  Texture texture;
  try {
    texture = shoal::load_texture(path, true);
  } catch (const shoal::Error& error) {
    std::fprintf(stderr, "compose_sheet: warning: %s\n", error.what());
    canvas.fill(x0, y0, box_width, box_height, kBroken);
    return;
  }
  const std::vector<std::uint8_t> bytes = shoal::texture_bytes(texture);
  const int from_width = texture.width[0], from_height = texture.height[0];
  const double scale =
      std::min(static_cast<double>(box_width) / from_width, static_cast<double>(box_height) / from_height);
  const int width = std::max(1, static_cast<int>(std::floor(from_width * scale + 0.5)));
  const int height = std::max(1, static_cast<int>(std::floor(from_height * scale + 0.5)));
  for (int y = 0; y < height; ++y) {
    const int top = y * from_height / height, bottom = std::max(top + 1, (y + 1) * from_height / height);
    for (int x = 0; x < width; ++x) {
      const int left = x * from_width / width, right = std::max(left + 1, (x + 1) * from_width / width);
      double sum[3] = {0, 0, 0};
      for (int j = top; j < bottom; ++j) {
        for (int i = left; i < right; ++i) {
          const std::uint8_t* texel = &bytes[(static_cast<std::size_t>(j) * static_cast<std::size_t>(from_width) +
                                              static_cast<std::size_t>(i)) *
                                             4];
          for (int c = 0; c < 3; ++c) sum[c] += texel[c] * texel[3] + kFrame[c] * (255 - texel[3]);
        }
      }
      std::uint8_t rgb[3];
      for (int c = 0; c < 3; ++c) {
        rgb[c] = static_cast<std::uint8_t>(std::floor(sum[c] / (255.0 * (bottom - top) * (right - left)) + 0.5));
      }
      canvas.set(x0 + (box_width - width) / 2 + x, y0 + (box_height - height) / 2 + y, rgb);
    }
  }
}

struct Cell {
  std::string label, note, picture, reference;
};

std::vector<Cell> read_cells() {
  std::vector<Cell> cells;
  for (std::string line; std::getline(std::cin, line);) {
    std::string fields[4];
    std::size_t at = 0;
    for (std::string& field : fields) {
      const std::size_t end = std::min(line.find('\t', at), line.size());
      field = line.substr(std::min(at, line.size()), end - std::min(at, line.size()));
      at = end + 1;
    }
    cells.push_back({fields[0], fields[1], fields[2], fields[3]});
  }
  return cells;
}

void compose(const std::string& out, int columns, int width, int height) {
  const std::vector<Cell> cells = read_cells();
  if (cells.empty()) throw shoal::Error("standard input: no cell; expected a line for each");
  const int rows = (static_cast<int>(cells.size()) + columns - 1) / columns;
  const int cell_width = 2 * width + 2 * kMargin, cell_height = height + kLine + kMargin;
  Canvas canvas(columns * cell_width + kMargin, rows * cell_height + kMargin);
  canvas.fill(0, 0, canvas.width, canvas.height, kPaper);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const int x = kMargin + static_cast<int>(i) % columns * cell_width;
    const int y = kMargin + static_cast<int>(i) / columns * cell_height;
    const int x_end = x + 2 * width;
    const int note_x = x_end - width_of(cells[i].note);
    write_text(canvas, x, y, note_x, std::to_string(i + 1) + " " + cells[i].label, kInk);
    write_text(canvas, note_x, y, x_end, cells[i].note, kNoteInk);
    place_picture(canvas, x, y + kLine, width, height, cells[i].picture);
    place_picture(canvas, x + width, y + kLine, width, height, cells[i].reference);
  }
  const Texture sheet = shoal::make_texture_rgba8(canvas.width, canvas.height, canvas.rgba.data(), true);
  const std::vector<std::uint8_t> file = shoal::encode_texture(sheet, out);
  shoal::TemporaryFile target(out);
  if (std::fwrite(file.data(), 1, file.size(), target.stream()) != file.size()) {
    throw shoal::Error(out + ": cannot be written; expected room for it");
  }
  target.commit();
}

}  // namespace

int main(int count, char** texts) {
  int columns = 0, width = 0, height = 0;
  if (count != 4 || (columns = std::atoi(texts[2])) < 1 || std::sscanf(texts[3], "%dx%d", &width, &height) != 2 ||
      width < 16 || height < 16) {
    std::fprintf(stderr, "usage: compose_sheet OUT.png COLUMNS WIDTHxHEIGHT <LIST\n");
    return 2;
  }
  try {
    compose(texts[1], columns, width, height);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "compose_sheet: error: %s\n", error.what());
    return 1;
  }
}
