#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/model_table.h"

namespace canyon {

/// Gravity (gravitation plus centrifugal) in E at a position in E, m/s^2.
using GravityFunction = Eigen::Vector3d (*)(const Eigen::Vector3d& p_E);

/// One row of the table of gravity models. Two usual "normal gravities" differ by 1.4e-6 m/s^2, which are 0.26 m after
/// ten minutes of free inertial navigation: a simulated log must be integrated with the gravity it was made with. For a
/// real log the choice does not matter, as the Earth's own anomalies are 10 to 100 times larger.
using GravityModel = ModelRow<GravityFunction>;
ModelTable<GravityFunction> gravity_models();
inline std::vector<std::string> gravity_names() {
  return model_names(gravity_models());
}
/// A model by name; throws ProgramError for a name that is not in the table.
inline GravityFunction gravity_by_name(std::string_view name) {
  return model_row(gravity_models(), name).make;
}

}  // namespace canyon
