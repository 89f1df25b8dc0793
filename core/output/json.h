#pragma once

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

/// JSON as canyon writes it: keys in the order in which they are set.
namespace canyon {

using Json = nlohmann::ordered_json;

/// A number, or null where it is undefined: NaN does not exist in JSON.
Json or_null(double value);
/// Three numbers, each or null; nine, row by row.
Json vector_json(const Eigen::Vector3d& v);
Json matrix_json(const Eigen::Matrix3d& m);

}  // namespace canyon
