#pragma once

#include <memory>
#include <string>

#include "canyon/core/earth/earth.h"

namespace canyon {

/// Height of the geoid above the WGS84 ellipsoid, and the model it is from ("egm96-5").
struct GeoidHeight {
  double undulation_m = 0.0;
  std::string model;
};

/// The finest of GeographicLib's geoid models that is installed (its default folders, or GEOGRAPHICLIB_GEOID_PATH);
/// where there is none, the built-in one: EGM96, the Earth's gravity model of 1996 to degree 360, on a grid of half a
/// degree, "egm96-30", within 1 m of the model everywhere and 0.04 m RMS. EGM96 itself is within about 1 m of the geoid
/// (Lemoine et al. 1998, NASA/TP-1998-206861). One object is not for several threads at once.
class Geoid {
 public:
  Geoid();
  /// The built-in one, whatever is installed.
  static Geoid built_in();
  Geoid(Geoid&&) noexcept;
  ~Geoid();

  double undulation_m(const Geodetic& g) const;
  const std::string& model() const;

 private:
  class Model;
  explicit Geoid(std::unique_ptr<Model> model);
  std::unique_ptr<Model> model_;
};

/// For one place.
GeoidHeight geoid_height(const Geodetic& g);

}  // namespace canyon
