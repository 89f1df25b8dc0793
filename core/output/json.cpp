#include "canyon/core/output/json.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace canyon {

Json or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json vector_json(const Eigen::Vector3d& v) {
  return Json::array({or_null(v.x()), or_null(v.y()), or_null(v.z())});
}

Json matrix_json(const Eigen::Matrix3d& m) {
  Json out = Json::array();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) out.push_back(or_null(m(row, column)));
  return out;
}

}  // namespace canyon
