#pragma once

#include <memory>
#include <string>
#include <vector>

#include "canyon/core/config/config.h"
#include "canyon/scene/tracing/instances.h"

namespace canyon::scene {

/// One [[scene.moving]] of a mission: a thing that goes along a way at constant speed and stands at its ends.
struct MovingConfig {
  std::string name;
  std::string shape = "car";
  std::vector<double> path_m;  ///< x, y, x, y, ... in W
  double speed_m_s = 8.0;
  double start_s = 0.0;  ///< it stands at the first point until then
};
void visit(FieldVisitor& f, MovingConfig& c);

/// The shapes there are: "car" (4.5 x 1.8 x 1.5 m), "bus" (12 x 2.55 x 3 m), "person" (0.3 x 0.5 x 1.75 m).
std::vector<std::string> moving_shapes();

/// That each way has points, all of them within the rectangle; what can be told before there is terrain.
Status check_ways(const std::vector<MovingConfig>& moving, const Eigen::Vector2d& low_W, const Eigen::Vector2d& high_W);

/// What moves in a scene, over time: on the terrain, headed along its way. A function of time alone, so runs that share
/// a scene meet the same traffic.
class Traffic {
 public:
  /// Paths must lie on the terrain. `scene` must outlive this.
  static Result<Traffic> make(const std::vector<MovingConfig>& moving, const Scene& scene);

  bool empty() const { return moving_.empty(); }
  std::vector<Instance> at(double t_s) const;

 private:
  struct Moving {
    std::string name;
    std::shared_ptr<const RigidShape> shape;
    std::vector<Eigen::Vector2d> path_W;
    double speed_m_s, start_s;
  };
  const Scene* scene_ = nullptr;
  std::vector<Moving> moving_;
};

}  // namespace canyon::scene
