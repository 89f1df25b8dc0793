#pragma once

#include <cstdint>

#include "canyon/core/config/config.h"

namespace canyon::lidar {

/// How the diffuse reflectance varies within a surface.
enum class Brightness : std::uint8_t {
  kUniform,  ///< one value for each material
  kVaried,   ///< lighter and darker places, by the materials' lidar_spread and lidar_grain_m
};

/// What the walls of buildings have beside their material.
enum class Windows : std::uint8_t {
  kNone,
  kLattice,  ///< panes of glass by floor and bay
};

/// Keys of what varies within a surface.
struct TextureConfig {
  Brightness brightness = Brightness::kUniform;
  Windows windows = Windows::kNone;

  bool any() const { return brightness != Brightness::kUniform || windows != Windows::kNone; }
};
void visit(FieldVisitor& f, TextureConfig& c);

}  // namespace canyon::lidar
