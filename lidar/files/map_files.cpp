#include "canyon/lidar/files/map_files.h"

#include <array>
#include <cstring>

#include "canyon/core/files/pcd.h"

namespace canyon::lidar {

Result<ReadMap> read_map(const std::string& path) {
  CANYON_TRY(PcdReader in, PcdReader::open(path));
  std::array<std::size_t, 3> offset{};
  const std::array<const char*, 3> names{"x", "y", "z"};
  for (std::size_t k = 0; k < 3; ++k) {
    CANYON_TRY(offset[k], in.float_at(names[k]));
  }
  ReadMap out;
  while (true) {
    CANYON_TRY(const auto bytes, in.next());
    if (bytes.empty()) break;
    for (std::size_t at = 0; at < bytes.size(); at += in.point_bytes()) {
      Eigen::Vector3f p;
      for (std::size_t k = 0; k < 3; ++k)
        std::memcpy(&p[static_cast<Eigen::Index>(k)], bytes.data() + at + offset[k], sizeof(float));
      if (p.allFinite() && p.cwiseAbs().maxCoeff() < 1e7F)
        out.points.push_back(p);
      else
        ++out.not_finite;
    }
  }
  if (out.points.empty()) return Error{path, 0, "", "holds no finite point", "a map"};
  return out;
}

}  // namespace canyon::lidar
