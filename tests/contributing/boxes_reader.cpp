// A reader that nobody planned, as somebody would add it: this file, its line in scene/importers/importer.h, one row in
// importer.cpp, and one row in tests/mutation/scene_formats.cpp, which damages its files.
#include "canyon/core/files/files.h"
#include "canyon/core/files/line_reader.h"
#include "canyon/scene/importers/importer.h"

namespace canyon::scene {

/// Buildings as boxes, a line each: x and y of the middle, width along x, depth along y, height; metres.
Result<RawScene> read_boxes(const std::string& path, const ReadOptions&) {
  CANYON_TRY(std::string text, read_text_file(path));
  LineReader in(path, std::move(text));
  RawScene scene;
  std::string_view line;
  while (in.next(line)) {
    const auto words = split(line, " \t", true);
    if (words.size() != 5) return in.error(std::to_string(words.size()) + " numbers", "x y width depth height");
    double v[5];
    for (std::size_t i = 0; i < 5; ++i) {
      CANYON_TRY(v[i], parse_coordinate(in, words[i]));
    }
    if (v[2] <= 0.0 || v[3] <= 0.0 || v[4] <= 0.0) return in.error("a box without extent", "sizes above zero");
    RawFootprint box;
    box.object = scene.add_object("box " + std::to_string(in.number()), ObjectKind::kBuilding);
    const Eigen::Vector2d middle(v[0], v[1]), half(0.5 * v[2], 0.5 * v[3]);
    box.rings = {{middle - half,
                  {middle.x() + half.x(), middle.y() - half.y()},
                  middle + half,
                  {middle.x() - half.x(), middle.y() + half.y()}}};
    box.height_m = v[4];
    box.from.line = static_cast<std::uint32_t>(in.number());
    scene.footprints.push_back(std::move(box));
  }
  if (scene.footprints.empty()) return in.empty_file("box");
  return scene;
}

}  // namespace canyon::scene
