#pragma once

#include <memory>
#include <string>
#include <vector>

#include "canyon/core/earth/local_frame.h"
#include "canyon/scene/scene.h"

/// Potsdamer Platz, Berlin: what was measured there on 2016-06-06 (smartLoc, TU Chemnitz) and its buildings (LoD2,
/// Geoportal Berlin), read from the shared recordings.
namespace canyon::gnss::testing {

/// Inverse of the transverse Mercator projection of ETRS89 / UTM zone 33N (EPSG:25833): Krueger's series to n^4 (Karney
/// 2011, J. Geodesy 85, 475), good to a micrometre in the zone.
Geodetic from_utm33(double easting_m, double northing_m, double h_m);

/// One pseudorange. The residual is relative to the free direct signal: modelled with precise orbits and atmosphere at
/// the true antenna, receiver clock from the satellites that plain ray casting predicts to be visible.
struct StreetObservation {
  double sow = 0.0;
  std::string satellite;
  double elevation_deg = 0.0, azimuth_deg = 0.0, cn0_dbhz = 0.0, residual_m = 0.0;
  bool cast_visible = false;   ///< by another program's ray casting
  double cast_excess_m = 0.0;  ///< its shortest single reflection; NaN if none
  Eigen::Vector3d antenna_W = Eigen::Vector3d::Zero();
};

struct Street {
  std::unique_ptr<scene::Scene> scene;
  std::vector<StreetObservation> observations;
};

/// `ground`: a level plane under the street as terrain. Throws std::runtime_error on files that are not as described.
Street read_street(const std::string& prisms, const std::string& trajectory, const std::string& observations,
                   bool ground);

}  // namespace canyon::gnss::testing
