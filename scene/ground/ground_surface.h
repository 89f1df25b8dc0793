#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/scene/ground/ground_plan.h"
#include "canyon/scene/scene.h"

namespace canyon::scene {

/// The ground of an imported scene: triangles over the cells of a plan, without cracks. A cell that touches smaller
/// ones is a fan about its middle; all others are two triangles. Corners lie row by row from the south.
///
/// What it means for Scene::ground(): in full detail the height between the corners of a cell, as ever; elsewhere that
/// of a larger triangle, which, over an elevation model, is off by at most kSlope of the distance from what stands, as
/// far as heights were sampled. Between heights that are only known at buildings it is one guess in place of another.
struct GroundMesh {
  std::vector<Eigen::Vector2d> places;
  std::vector<double> height_m;  ///< 0 until it is filled
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint8_t> of_cell;  ///< how many triangles each cell has, in their order

  explicit GroundMesh(const GroundPlan& plan);
};

/// Fills in heights; corners where nothing is known take the mean of their known neighbours, those with which they
/// share a cell, ring by ring outwards. False if nothing is known anywhere.
bool fill_ground(GroundMesh& ground, const GroundHeight& height);

/// The smooth surface through scattered heights: at each place the plane that fits the heights around it best, weighted
/// by exp(-d^2 / 2 s^2), s = 25 m, or as wide as it takes for eight of them (local linear regression; Cleveland &
/// Devlin 1988). Without heights: 0.
class GroundFit {
 public:
  explicit GroundFit(std::vector<Eigen::Vector3d> heights);
  double operator()(const Eigen::Vector2d& p) const;

 private:
  int cell(double v, double origin, int count) const;
  const std::vector<std::uint32_t>& bucket(int column, int row) const {
    return buckets_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(column)];
  }
  std::vector<Eigen::Vector3d> heights_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  double bucket_m_ = 1.0;
  int columns_ = 0, rows_ = 0;
  std::vector<std::vector<std::uint32_t>> buckets_;  ///< so that only what is near is looked at
};

/// Heights of the fit at all corners.
void fill_ground(GroundMesh& ground, const GroundFit& fit);

/// Adds the ground as one terrain object.
void add_ground(const GroundMesh& ground, const std::string& material, SceneParts& parts);

}  // namespace canyon::scene
