#include "canyon/gnss/paths/diffraction/edge_air.h"

namespace canyon::gnss {

bool ends_in_air(const scene::Edge& edge, const Eigen::Vector3d& point_W, const scene::SceneAt& scene) {
  const Eigen::Vector3d start_W = point_W + kOffEdge_m * (edge.normal_1_W + edge.normal_2_W);
  const Eigen::Vector3d &n1 = edge.normal_1_W, &n2 = edge.normal_2_W;
  if (n1.dot(n2) < -0.999) return true;  // a sheet
  return !scene.blocked(start_W, point_W + kEdgeProbe_m * (n1 - 0.5 * n2)) &&
         !scene.blocked(start_W, point_W + kEdgeProbe_m * (n2 - 0.5 * n1));
}

}  // namespace canyon::gnss
