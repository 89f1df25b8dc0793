#pragma once

#include <string>
#include <vector>

#include "canyon/core/files/pcd.h"
#include "canyon/lidar/registration/registration.h"

namespace canyon::lidar {

/// One cloud registered onto another, each in coordinates of its own, however large.
struct CloudPair {
  RegistrationResult result;  ///< poses in the clouds' own coordinates; covariances of xi in the source frame
  double preprocess_ms = 0, align_ms = 0;
  std::size_t source_points = 0, target_points = 0;  ///< after thinning
};

/// Works about each cloud's own middle, so that coordinates in doubles lose nothing. `prior` is in the clouds' own
/// coordinates; its covariance is of xi in a frame of the source's axes whose origin stands in the source's middle (the
/// median along each axis, of what is no missing return): far from the origin a turn about that is a shift of as many
/// kilometres.
CloudPair register_pair(const Registration& method, const CloudPlaces& source, const CloudPlaces& target,
                        const PosePrior& prior);

/// What is to be doubted of a cloud before it is registered, in one line; empty: nothing. Points that are not finite
/// are left out. Coordinates in single precision beyond 10 km are no finer than 1 mm.
std::string cloud_doubt(const std::string& path, const CloudPlaces& cloud);

}  // namespace canyon::lidar
