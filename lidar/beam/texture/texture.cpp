#include "canyon/lidar/beam/texture/texture.h"

#include "canyon/core/model_table.h"

namespace canyon::lidar {
namespace {

constexpr ModelRow<Brightness> kBrightness[] = {
    {"uniform", Brightness::kUniform, "one value for each material"},
    {"varied", Brightness::kVaried, "lighter and darker places, by the materials' lidar_spread and lidar_grain_m"},
};
constexpr ModelRow<Windows> kWindows[] = {
    {"none", Windows::kNone, "all of its material"},
    {"lattice", Windows::kLattice, "panes of `glass`, one in each bay of each floor"},
};

}  // namespace

void visit(FieldVisitor& f, TextureConfig& c) {
  const ModelTable<Brightness> brightness(kBrightness);
  const ModelTable<Windows> windows(kWindows);
  f.choice("brightness", c.brightness, brightness,
           with_rows("how bright a matt surface is from place to place", brightness).c_str());
  f.choice("windows", c.windows, windows, with_rows("what a building's wall is made of", windows).c_str());
}

}  // namespace canyon::lidar
