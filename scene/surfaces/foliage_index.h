#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace canyon::scene {

/// A tree crown: an ellipsoid of leaves. Attenuates GNSS; for LIDAR it is a volume with gaps between the leaves (crowns
/// of the built-in city have clumps of leaves as triangles in the mesh too).
struct Foliage {
  Eigen::Vector3d center_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d radii_m{1, 1, 1};
  /// One-sided leaf area per volume of crown. Of leaves turned every way, a beam meets half their area: it stays clear
  /// over d metres with probability exp(-0.5 density d).
  double leaf_density_m2_m3 = kReferenceLeafDensity;

  /// What the specific attenuation of foliage is given for (ITU-R P.833: in leaf).
  static constexpr double kReferenceLeafDensity = 1.0;
};

/// The part of a ray inside one crown.
struct CrownPassage {
  double enter_m = 0.0, leave_m = 0.0;
  double leaf_density_m2_m3 = 0.0;
  std::uint32_t crown = 0;  ///< index into Scene::foliage()
};

/// Tree crowns in a grid over x, y, so that a ray meets only those beside it.
class FoliageIndex {
 public:
  FoliageIndex() = default;
  explicit FoliageIndex(const std::vector<Foliage>& crowns);

  /// Length of the way from p along the unit direction, up to max_m, inside of crowns, m, as if all were of the
  /// reference leaf density: the chords times density / reference, summed in the crowns' order (where crowns overlap,
  /// both count).
  double chords_m(const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W, double max_m) const;
  /// The chords themselves, in the crowns' order; replaces what is in `out`.
  void passages(const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W, double max_m,
                std::vector<CrownPassage>& out) const;

 private:
  struct Cell {
    double bottom_m = 1e300, top_m = -1e300;
    std::vector<std::uint32_t> crowns;  ///< ascending; whose bounding square overlaps the cell
  };
  /// Crowns that the ray may meet, ascending.
  void find(const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W, double max_m,
            std::vector<std::uint32_t>& met) const;
  void add_cell(const Cell& cell, const Eigen::Vector3d& p_W, const Eigen::Vector3d& direction_W, double enter_m,
                double leave_m, std::vector<std::uint32_t>& met) const;

  std::vector<Foliage> crowns_;
  double cell_m_ = 0.0, per_m_ = 0.0;                                               ///< edge of a cell, and its inverse
  Eigen::Vector3d low_ = Eigen::Vector3d::Zero(), high_ = Eigen::Vector3d::Zero();  ///< of all crowns
  /// All crowns lie where slope_ . (x, y, z) is within these: a layer as steep as the ground, which rays soon leave.
  Eigen::Vector3d slope_{0, 0, 1};
  double floor_m_ = 0.0, ceiling_m_ = 0.0;
  int columns_ = 0, rows_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace canyon::scene
