#pragma once

#include <cstddef>
#include <vector>

namespace canyon::mission {

/// One return about B: across its ground plane, and above it.
struct PlaneReturn {
  float x_m, y_m;  ///< from B, level, W's axes
  float above_m;   ///< along B's z
};

/// The ground of one scan, in sectors about the vehicle: outwards from the place where it stands, the lowest returns
/// that a street's slope can lead to from the last, joined by straight lines (after Himmelsbach, von Hundelshausen and
/// Wuensche 2010). It knows nothing but this scan, so that no error of the estimate's height reaches it.
class PolarGround {
 public:
  static constexpr int kSectors = 240;
  static constexpr double kBin_m = 0.5;

  struct Rule {
    double max_slope = 0.12;  ///< against the vehicle's own plane
    double noise_m = 0.05;    ///< of a return's height
  };
  PolarGround(const Rule& rule, double reach_m);

  void fit(const std::vector<PlaneReturn>& returns);
  /// Where each of the returns lies that it was fitted to, in their order.
  struct Polar {
    int sector;
    float distance_m;
  };
  const std::vector<Polar>& polar() const { return polar_; }

  /// The sector of a direction, all of about the same width.
  static int sector(float x, float y);
  struct Height {
    float above_m;   ///< of the ground over B's plane
    float unsure_m;  ///< by how much it may be higher: nothing was seen of it from there on
  };
  /// At a distance in a sector.
  Height at(int sector, float distance_m) const;

 private:
  struct Lowest {
    float above_m, distance_m;
  };
  std::size_t slot(int sector, int bin) const {
    return static_cast<std::size_t>(sector) * static_cast<std::size_t>(bins_) + static_cast<std::size_t>(bin);
  }
  void walk(int sector);

  Rule rule_;
  int bins_;
  std::vector<Polar> polar_;
  std::vector<Lowest> lowest_;
  std::vector<float> height_, last_seen_;  ///< at the middle of each bin; where the ground of each sector ends
};

}  // namespace canyon::mission
