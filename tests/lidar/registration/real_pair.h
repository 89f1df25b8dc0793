#pragma once

#include <fstream>
#include <string>

#include "canyon/lidar/files/clouds/read_cloud.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::lidar::testing {

/// Two scans of a real sensor, and how they stand to one another by their publisher.
struct RealPair {
  CloudPlaces source, target;
  Pose reference;
};
inline RealPair real_pair(const std::string& source, const std::string& target, const std::string& reference) {
  RealPair out{*read_cloud(source), *read_cloud(target), {}};
  Eigen::Matrix4d T;
  std::ifstream file(reference);
  for (int i = 0; i < 16; ++i) file >> T(i / 4, i % 4);
  out.reference = Pose::from_matrix(T);
  return out;
}

}  // namespace canyon::lidar::testing

/// The pair of lidar/pair, as `pair`, or the test is skipped.
#define CANYON_REAL_PAIR(pair)                                        \
  CANYON_REAL_DATA(source_path, "lidar/pair/source.ply");             \
  CANYON_REAL_DATA(target_path, "lidar/pair/target.ply");             \
  CANYON_REAL_DATA(reference_path, "lidar/pair/T_target_source.txt"); \
  const canyon::lidar::testing::RealPair pair =                       \
      canyon::lidar::testing::real_pair(source_path, target_path, reference_path)
