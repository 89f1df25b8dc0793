#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/config/config.h"
#include "canyon/scene/tracing/instances.h"

namespace canyon::scene {

struct Site;

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

/// That each thing has a name of its own, which no building has, and each way points, all of them within the site; what
/// can be told before there is terrain.
Status check_ways(const std::vector<MovingConfig>& moving, const Site& site);

/// Where a moving thing may ever be along one leg of its way: within a distance of the leg, and below a height in W.
struct SweptRoom {
  Eigen::Vector2d from_W, to_W;
  double radius_m = 0.0, top_m = 0.0;

  /// The rectangle in W that holds it.
  Eigen::AlignedBox2d around() const;
};

/// What moves in a scene, over time: on the terrain, headed along its way. A function of time alone, so runs that share
/// a scene meet the same traffic.
class Traffic {
 public:
  /// Paths must lie on the terrain, names be those of nothing else that moves or stands. `scene` must outlive this.
  static Result<Traffic> make(const std::vector<MovingConfig>& moving, const Scene& scene);

  bool empty() const { return moving_.empty(); }
  std::vector<Instance> at(double t_s) const;
  /// Those that stay where they are from one time to a later one, by their place in the list, counted from 0.
  std::vector<std::size_t> standing(double from_s, double to_s) const;
  /// All that they ever take, whichever way they are tilted.
  std::vector<SweptRoom> swept() const;

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
